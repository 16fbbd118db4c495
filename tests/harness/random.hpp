// Random numbers for test cases, the same with every standard library.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace glim {

class Random {
public:
    explicit Random(std::uint64_t seed)
        : engine_(seed)
    {}

    std::uint32_t bits() { return static_cast<std::uint32_t>(engine_() >> 32); }
    // In [0, count). The bias of at most count * 2^-32 does not matter for choosing cases.
    std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(static_cast<std::uint64_t>(bits()) * count >> 32); }
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  // [0, 1)
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    double logUniform(double low, double high) { return low * std::pow(high / low, uniform()); }
    float unitFloat() { return static_cast<float>(bits() >> 8) * 0x1p-24F; }  // [0, 1)
    double normal() { return std::sqrt(-2.0 * std::log(1.0 - uniform())) * std::cos(2.0 * std::numbers::pi * uniform()); }
    glm::dvec3 normalVector() { return {normal(), normal(), normal()}; }
    glm::dvec3 direction() { return glm::normalize(normalVector()); }

private:
    std::mt19937_64 engine_;
};

}  // namespace glim
