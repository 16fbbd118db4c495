#include "host/memory.hpp"

#include "host/message.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <new>

namespace glim {
namespace {

// A handler of std::terminate can reach nothing but a global.
std::string lineAtEnd;

thread_local std::size_t largestAllocation = std::numeric_limits<std::size_t>::max();

[[noreturn]] void endWithLine()
{
    try {
        if (std::current_exception()) {
            throw;
        }
    } catch (const std::bad_alloc&) {
        std::fputs(lineAtEnd.c_str(), stderr);
        std::_Exit(static_cast<int>(ExitCode::BadInput));
    } catch (...) {
    }
    std::abort();
}

std::uint64_t pageBytes() { return static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE)); }

}  // namespace

std::uint64_t machineBytes() { return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * pageBytes(); }

std::optional<AddressLimit> addressLimit()
{
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
        return std::nullopt;
    }
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const std::uint64_t bytes = limit.rlim_cur, taken = pages * pageBytes();
    return AddressLimit{bytes, bytes - std::min(bytes, taken)};
}

std::uint64_t availableBytes()
{
    const std::optional<AddressLimit> limit = addressLimit();
    return limit ? std::min(machineBytes(), limit->bytes) : machineBytes();
}

std::string memorySentence()
{
    return "there is not enough memory; the process may take " + std::to_string(availableBytes() >> 20U) + " MiB" +
           (addressLimit() ? " (ulimit -v)" : "");
}

void returnFreedMemory()
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

MemoryGuard::MemoryGuard(const std::filesystem::path& file)
{
    lineAtEnd = toLine(Severity::Error, Message(MessageId::OutOfMemory, {part::file(file), ": ", memorySentence(), "."})) + '\n';
    previous_ = std::set_terminate(endWithLine);
}

MemoryGuard::~MemoryGuard() { std::set_terminate(previous_); }

AllocationLimit::AllocationLimit(std::size_t bytes) { largestAllocation = bytes; }

AllocationLimit::~AllocationLimit() { largestAllocation = std::numeric_limits<std::size_t>::max(); }

}  // namespace glim

// Replaces the library's (C++20, [new.delete]). Its other forms would call these two, but those of sanitizers would not.
void* operator new(std::size_t bytes)
{
    if (bytes > glim::largestAllocation) {
        throw std::bad_alloc();
    }
    while (true) {
        if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) {
            return memory;
        }
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) {
            throw std::bad_alloc();
        }
        handler();
    }
}
void* operator new[](std::size_t bytes) { return operator new(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept
{
    try {
        return operator new(bytes);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void* operator new[](std::size_t bytes, const std::nothrow_t& tag) noexcept { return operator new(bytes, tag); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
