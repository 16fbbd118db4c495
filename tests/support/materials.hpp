// Materials for tests of the BSDF: a plain one, and random ones.
#pragma once

#include "tests/harness/random.hpp"
#include "tests/support/material_case.h"

#include <cmath>
#include <numbers>

namespace glim {

inline MaterialCase plainMaterial(float roughness = 0.5F, float metallic = 0.0F)
{
    MaterialCase m{};
    m.base = {0.8F, 0.5F, 0.2F};
    m.metallic = metallic;
    m.roughness = roughness;
    m.ior = 1.5F;
    m.specular = 1.0F;
    m.specularColor = vec3(1.0F);
    m.coatNormal = {0.0F, 0.0F, 1.0F};
    m.filmIor = 1.3F;
    m.filmThickness = 400.0F;
    m.diffuseTransmissionColor = vec3(1.0F);
    return m;
}

inline vec3 directionAt(double cosine, double azimuth)
{
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
    return vec3(glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine));
}

// Opaque, each layer in half of them.
inline MaterialCase randomOpaque(Random& random)
{
    const auto number = [&random] { return random.unitFloat(); };
    const auto half = [&] { return random.below(2) == 0 ? number() : 0.0F; };
    MaterialCase m = plainMaterial(number(), random.below(3) == 0 ? number() : static_cast<float>(random.below(2)));
    m.base = {number(), number(), number()};
    m.ior = 1.0F + 1.5F * number();
    m.specular = number();
    m.specularColor = {number(), number(), 2.0F * number()};
    m.anisotropy = half();
    m.clearcoat = half();
    m.clearcoatRoughness = half();
    m.sheenColor = random.below(2) == 0 ? vec3(number(), number(), number()) : vec3(0.0F);
    m.sheenRoughness = number();
    return m;
}

}  // namespace glim
