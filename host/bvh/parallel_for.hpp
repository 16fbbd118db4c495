// Independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace glim {

// Calls work(i) once for each i below `count`, the lowest first, on at most `threads` threads of which the caller's is one (0 is
// as good as 1). Which thread runs which call is left to chance: a call must write only what no other touches. Throws what a call threw.
void parallelFor(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work);

}  // namespace glim
