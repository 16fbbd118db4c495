// What `glim compare` says of two pictures, as a table or as JSON.
#pragma once

#include "host/measure/compare_images.hpp"
#include "host/measure/z_test.hpp"

#include <optional>
#include <string>

namespace glim {

// Whether a test of noise makes sense, which supposes that the two noises have nothing to do with each other.
enum class Relation { Independent, SharedSamples, Identical };

struct CompareReport {
    Comparison result;
    Relation relation = Relation::Independent;
    std::optional<ZTest> test;
};

// Both to stdout.
void printTable(const CompareReport& report);
void printJson(const CompareReport& report);

}  // namespace glim
