#include "tests/fuzz/contract.hpp"

#include "host/error.hpp"

#include <ctime>

namespace glim::fuzz {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

double cpuSeconds()
{
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Words of the file are shortened before they get into a sentence. `Message` cuts the middle out of more than 8 KiB, which must not
// hide that they were not: what is left of it has 7 KiB.
constexpr std::size_t kLongest = 4096;

std::optional<std::string> findSentenceDefect(const std::string& sentence, const std::string& start)
{
    if (sentence.rfind(start, 0) != 0) {
        return "does not begin with \"" + start + "\": " + sentence;
    }
    if (sentence.size() < start.size() + 10) {
        return "says too little: " + sentence;
    }
    if (sentence.size() > kLongest) {
        return "is a sentence of " + std::to_string(sentence.size()) + " bytes";
    }
    if (escaped(sentence) != sentence) {
        return "holds bytes that a terminal may obey: " + escaped(sentence);
    }
    return std::nullopt;
}

}  // namespace

double maxSeconds() { return kSanitized ? 4.0 : 1.0; }

std::optional<std::string> findDefect(const std::string& start, const std::function<void()>& step)
{
    const double begin = cpuSeconds();
    try {
        step();
    } catch (const InputError& error) {
        if (const auto defect = findSentenceDefect(error.what(), start)) {
            return defect;
        }
    } catch (const std::exception& error) {
        return std::string("throws what is no InputError: ") + error.what();
    }
    const double seconds = cpuSeconds() - begin;
    return seconds <= maxSeconds()
               ? std::nullopt
               : std::optional("takes " + std::to_string(seconds) + " s of CPU time; expected " + std::to_string(maxSeconds()));
}

}  // namespace glim::fuzz
