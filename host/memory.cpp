#include "host/memory.hpp"

#include "host/message.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>

namespace glim {
namespace {

// A handler of std::terminate can reach nothing but a global.
std::string sentenceAtEnd;

[[noreturn]] void endWithSentence()
{
    try {
        if (std::current_exception()) {
            throw;
        }
    } catch (const std::bad_alloc&) {
        std::fputs(sentenceAtEnd.c_str(), stderr);
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

MemoryGuard::MemoryGuard(const std::filesystem::path& file)
{
    sentenceAtEnd = escaped("glim: " + file.string() + ": " + memorySentence()) + ".\n";
    previous_ = std::set_terminate(endWithSentence);
}

MemoryGuard::~MemoryGuard() { std::set_terminate(previous_); }

}  // namespace glim
