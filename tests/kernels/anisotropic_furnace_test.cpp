// White anisotropic metals give back all light, whatever their widths and wherever they are seen from.
#include "tests/support/albedo_buffer.hpp"

#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/materials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>

namespace glim::anisotropic_furnace_test {

struct Case {
    vec3 wo;
    MaterialCase material;
};

constexpr int kSteps = 9;
constexpr std::array<double, 8> kCosines = {1.0, 0.9, 0.7, 0.5, 0.342, 0.2, 0.07, 0.02};
constexpr std::array<double, 8> kAzimuths = {0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 87.0, 90.0};  // degrees from the tangent

// The midpoints are off by 5e-5: seen by more of them.
TEST(AnisotropicFurnaceTest, WhiteMetalsReflectAllLight)
{
    std::vector<Case> cases;
    for (int roughness = 0; roughness < kSteps; ++roughness) {
        for (int strength = 0; strength < kSteps; ++strength) {
            for (std::size_t i = 0; i < kCosines.size() * kAzimuths.size(); ++i) {
                Case c{directionAt(kCosines[i / kAzimuths.size()], kAzimuths[i % kAzimuths.size()] * std::numbers::pi / 180.0),
                       plainMaterial(static_cast<float>(roughness) / (kSteps - 1), 1.0F)};
                c.material.base = vec3(1.0F);
                c.material.anisotropy = static_cast<float>(strength) / (kSteps - 1);
                cases.push_back(c);
            }
        }
    }
    const AlbedoBuffer albedos;
    KernelTest test(test_kernels::anisotropic_furnace_test);
    test.features(kFeaturePrincipled | kFeatureAnisotropy).buffers(albedos.bound()).cases(cases).resultsOf<float>(cases.size());
    test.run();
    const std::vector<float> results = test.results<float>();
    const auto [least, most] = std::ranges::minmax_element(results);
    for (const auto at : {least, most}) {
        const Case& c = cases[static_cast<std::size_t>(at - results.begin())];
        std::cout << "white anisotropic metals: albedo " << *at << " at roughness " << c.material.roughness << ", strength "
                  << c.material.anisotropy << ", from (" << c.wo.x << ", " << c.wo.y << ", " << c.wo.z << ")\n";
    }
}

}  // namespace glim::anisotropic_furnace_test
