// Time that passes, whatever the clock on the wall does.
#pragma once

#include <chrono>

namespace glim {

using Clock = std::chrono::steady_clock;

inline double secondsBetween(Clock::time_point begin, Clock::time_point end) { return std::chrono::duration<double>(end - begin).count(); }

inline double secondsSince(Clock::time_point begin) { return secondsBetween(begin, Clock::now()); }

}  // namespace glim
