// The memory that this process may take.
#pragma once

#include "host/error.hpp"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <optional>

namespace glim {

std::uint64_t machineBytes();
// What a limit on its addresses (ulimit -v) lets the process take in all, and what is left of it. Nothing without a limit.
struct AddressLimit {
    std::uint64_t bytes, left;
};
std::optional<AddressLimit> addressLimit();
// The lesser of the machine's and the limit.
std::uint64_t availableBytes();

// "there is not enough memory; the process may take N MiB", and "(ulimit -v)" if that is a limit
std::string memorySentence();

// Gives what was freed, and is in small pieces, back to the operating system.
void returnFreedMemory();

// While it lives, a destructor that finds no memory, from where no exception can leave, ends the program as an InputError would: a sentence
// that names `file`, and exit code 1. nlohmann-json has such destructors.
class MemoryGuard {
public:
    explicit MemoryGuard(const std::filesystem::path& file);
    ~MemoryGuard();
    MemoryGuard(const MemoryGuard&) = delete;
    MemoryGuard& operator=(const MemoryGuard&) = delete;

private:
    std::terminate_handler previous_;
};

// While it lives, operator new throws std::bad_alloc in this thread where more than so many bytes are asked for at once: for libraries that
// take the sizes of their containers from a file. Limits do not nest.
class AllocationLimit {
public:
    explicit AllocationLimit(std::size_t bytes);
    ~AllocationLimit();
    AllocationLimit(const AllocationLimit&) = delete;
    AllocationLimit& operator=(const AllocationLimit&) = delete;
};

}  // namespace glim
