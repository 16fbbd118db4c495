// The report of `glim compare`, as a table or as JSON.
#pragma once

#include "host/measure/compare_images.hpp"
#include "host/measure/z_test.hpp"

#include <optional>
#include <string>

namespace glim {

// How the noise of two pictures is related. A z-test assumes that it is independent.
enum class Relation { Independent, SharedSamples, Identical };

struct CompareReport {
    Comparison result;
    Relation relation = Relation::Independent;
    std::optional<bool> sameBits;  // of two films: whether all sums of all pixels are equal (glim:pixels)
    std::optional<ZTest> test;
};

// Both to stdout.
void printTable(const CompareReport& report);
void printJson(const CompareReport& report);

}  // namespace glim
