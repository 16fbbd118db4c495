// Directions by guide or BSDF are weighted by the density of both, as is the light sample. Without a guide there is the BSDF alone.
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/albedo_buffer.hpp"
#include "tests/support/guide_records.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim::guided_bsdf_test {

struct Case {
    vec3 p, n;
    vec2 u;
    float uLobe;
    vec3 lightWi;
    std::uint32_t hasGuide;
};

struct Result {
    vec3 wi;
    float pdf, bsdfPdf, weight, lightPdf, guidePdf, guidePdfOfLight, share;
};

TEST(GuidedBsdfTest, DensitiesAreThoseOfBoth)
{
    Random random(8);
    const Guide guide = guideOf(recordsOfBall(200000, random));
    Buffer texels(testDevice(), "guide", BufferKind::Texel, guide.texels.size() * sizeof(uvec4));
    upload(texels, std::span<const uvec4>(guide.texels));
    constexpr std::uint32_t kCount = 40000;
    const vec3 n(1, 0, 0);
    std::vector<Case> cases;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const vec3 p(glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
        cases.push_back({p, n, glm::min(vec2(random.uniform(), random.uniform()), vec2(0x1.fffffep-1F)),
                         std::min(static_cast<float>(random.uniform()), 0x1.fffffep-1F), vec3(random.direction()), i % 4 != 0 ? 1U : 0U});
    }
    const AlbedoBuffer albedos;
    KernelTest test(test_kernels::guided_bsdf_test);
    test.buffers(albedos.bound()).buffers({{kBindGuide, &texels}}).cases(cases).resultsOf<Result>(cases.size()).run();
    const auto pdfOf = [&](const vec3& w) { return std::max(0.0F, glm::dot(n, w)) / 3.14159265F; };
    const std::vector<Result> results = test.results<Result>();
    double others = 0.0, above = 0.0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const Result& r = results[i];
        EXPECT_EQ(r.share, cases[i].hasGuide != 0 ? 0.7F : 0.0F);
        const float light = pdfOf(cases[i].lightWi);
        EXPECT_NEAR(r.lightPdf, light > 0.0F ? r.share * r.guidePdfOfLight + (1.0F - r.share) * light : 0.0F, 1e-5F * r.lightPdf);
        EXPECT_NEAR(r.bsdfPdf, pdfOf(r.wi), 1e-5F);
        if (r.bsdfPdf > 0.0F) {
            above += 1.0;
            EXPECT_NEAR(r.weight * r.pdf, 0.5F * r.bsdfPdf, 1e-5F * r.bsdfPdf);
            // At the edges of leaves a sample has another density than the one that is looked up.
            const float mix = r.share * r.guidePdf + (1.0F - r.share) * r.bsdfPdf;
            others += std::abs(r.pdf - mix) > 1e-3F * mix ? 1.0 : 0.0;
        } else {
            EXPECT_EQ(r.weight, 0.0F) << "below the surface";
        }
    }
    EXPECT_LT(others, 1e-3 * above);
    EXPECT_GT(above, 0.7 * kCount);
}

}  // namespace glim::guided_bsdf_test
