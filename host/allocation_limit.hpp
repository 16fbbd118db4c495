// A bound for libraries that take the sizes of their containers from a file.
#pragma once

#include <cstddef>

namespace glim {

// While it lives, operator new throws std::bad_alloc in this thread where more than so many bytes are asked for at once. Limits do not nest.
class AllocationLimit {
public:
    explicit AllocationLimit(std::size_t bytes);
    ~AllocationLimit();
    AllocationLimit(const AllocationLimit&) = delete;
    AllocationLimit& operator=(const AllocationLimit&) = delete;
};

}  // namespace glim
