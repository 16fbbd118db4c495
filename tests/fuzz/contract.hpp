// What glim promises of any input: it is read, or refused with one sentence, in a second.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace glim::fuzz {

// CPU seconds of all threads, which do not count what else the machine does. Sanitizers take about three times as long, measured with the
// corpus.
constexpr double kMostSeconds = 1.0, kMostSanitizedSeconds = 4.0;

// Runs `step` and says how it breaks the promise, if it does. It may throw InputError that begins with `start`. Memory is limited from
// outside (tools/fuzz).
std::optional<std::string> findDefect(const std::string& start, const std::function<void()>& step);

}  // namespace glim::fuzz
