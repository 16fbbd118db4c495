#include "tests/support/hard_case.hpp"

#include "tests/harness/statistics.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>

namespace glim {
namespace {

constexpr std::size_t kHardTrials = 4'000'000;

bool isHard() { return std::getenv("GLIM_HARD") != nullptr; }

std::size_t roundsOf(std::size_t trials) { return (kHardTrials + trials - 1) / trials; }

}  // namespace

int hardRounds(std::size_t trials) { return isHard() ? static_cast<int>(roundsOf(trials)) : testRounds(); }

std::size_t hardTrials(std::size_t trials, std::size_t raysEach) { return isHard() ? trials * roundsOf(trials * raysEach) : trials; }

void printHardCase(const std::string& number, const std::string& what, double trials, const std::string& result, const std::string& naive)
{
    std::printf("%s | %s | %s trials | %s | %s\n", number.c_str(), what.c_str(), figure(trials).c_str(), result.c_str(), naive.c_str());
}

std::string figure(double value)
{
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
}

}  // namespace glim
