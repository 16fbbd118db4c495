// Runs independent pieces of work on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace glim {

// Calls work(i) once for each i below `count`, in ascending order, on at most `threads` threads, one of which is the caller's (0 counts
// as 1). Any thread may run any call, so a call must write only what no other call touches. Rethrows what a call threw.
void parallelFor(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work);

}  // namespace glim
