// The hard cases: how long they run, and the line each prints, which begins with its H-number. The table in tests/README.md is made of
// these lines.
#pragma once

#include <cstddef>
#include <string>

namespace glim {

// Rounds, each with a seed of its own, that a test of so many trials makes: with tools/test --hard (GLIM_HARD=1) as many as have 4e6
// trials, else testRounds().
int hardRounds(std::size_t trials);

// `trials`, but with --hard as many as have 4e6 rays or numbers, rounded up to whole multiples of `trials`.
std::size_t hardTrials(std::size_t trials, std::size_t raysEach = 1);

// "H9 | radius 1 from 1e4 | 400000 trials | misses 0 | misses .19": the case, the trials, what glim does, and what simpler code does.
void printHardCase(const std::string& number, const std::string& what, double trials, const std::string& result,
                   const std::string& naive = "");

// Three significant digits, as short as they go.
std::string figure(double value);

}  // namespace glim
