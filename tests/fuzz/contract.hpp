// What glim promises of any input: it is read, or refused with one sentence, in a second.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace glim::fuzz {

// A second of CPU time of all threads, which leaves out what else the machine does; four with sanitizers, which are that much slower.
double maxSeconds();

// Runs `step` and says how it breaks the promise, if it does. It may throw InputError that begins with `start`. Memory is limited from
// outside (tools/fuzz).
std::optional<std::string> findDefect(const std::string& start, const std::function<void()>& step);

}  // namespace glim::fuzz
