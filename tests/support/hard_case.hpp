// The hard cases: how long they run, and the line that each prints, which begins with its H-number. The table in
// tests/MEASUREMENTS.md is made of these lines.
#pragma once

#include <cstddef>
#include <string>

namespace glim {

// How many rounds, each with its own seed, a test with so many trials a round makes: testRounds(), or with tools/test --hard
// (GLIM_HARD=1) enough for 4e6 trials.
int hardRounds(std::size_t trials);

// `trials`, or with --hard enough for 4e6 rays or numbers, rounded up to a multiple of `trials`.
std::size_t hardTrials(std::size_t trials, std::size_t raysEach = 1);

// "H9 | radius 1 from 1e4 | 400000 trials | misses 0 | misses .19": the case, the trials, what glim does, and what simpler code does.
void printHardCase(const std::string& number, const std::string& what, double trials, const std::string& result,
                   const std::string& naive = "");

// Three significant digits, without zeros at the end.
std::string figure(double value);

}  // namespace glim
