#include "host/allocation_limit.hpp"

#include <cstdlib>
#include <limits>
#include <new>

namespace {

thread_local std::size_t most = std::numeric_limits<std::size_t>::max();

}  // namespace

// Replaces the library's (C++20, [new.delete]). Its other forms would call these two, but those of sanitizers would not.
void* operator new(std::size_t bytes)
{
    if (bytes > most) {
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

namespace glim {

AllocationLimit::AllocationLimit(std::size_t bytes) { most = bytes; }

AllocationLimit::~AllocationLimit() { most = std::numeric_limits<std::size_t>::max(); }

}  // namespace glim
