// Cases that tests/oracle/write_cases.py has written: rows of float32, each a Case.
#pragma once

#include "places.h"
#include "shaders/shared/vocabulary.h"
#include "tests/support/kernel_test.hpp"
#include "tests/support/test_data.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace glim {

template <class Case>
std::vector<Case> oracleCases(const std::string& name)
{
    const std::string path = (testData("oracle", GLIM_ORACLE_CASES) / (name + ".bin")).string();
    const std::uintmax_t size = std::filesystem::file_size(path);
    std::vector<Case> cases(size / sizeof(Case));
    std::ifstream file(path, std::ios::binary);
    file.read(reinterpret_cast<char*>(cases.data()), static_cast<std::streamsize>(size));
    if (!file || cases.empty() || size % sizeof(Case) != 0) {
        throw std::runtime_error(path + ": " + std::to_string(size) + " bytes, expected rows of " + std::to_string(sizeof(Case)));
    }
    return cases;
}

// Prints the largest of each of the two errors that a kernel gave per case.
inline void printLargest(const std::string& what, const std::vector<vec2>& errors)
{
    vec2 largest(0.0F);
    for (const vec2& error : errors) {
        largest = glm::max(largest, error);
    }
    std::cout << "  " << what << ": " << errors.size() << " cases, errors up to " << largest.x << ", " << largest.y << '\n';
}

// Runs a kernel whose results are the errors of two numbers.
template <class Case>
void compareWithOracle(const std::string& what, const EmbeddedShader& shader, const std::vector<Case>& cases,
                       const std::map<std::uint32_t, const Buffer*>& buffers = {})
{
    KernelTest test(shader);
    test.buffers(buffers).cases(cases).template resultsOf<vec2>(cases.size()).run();
    printLargest(what, test.results<vec2>());
}

}  // namespace glim
