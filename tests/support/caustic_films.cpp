#include "tests/support/caustic_films.hpp"

#include "host/measure/z_test.hpp"
#include "tests/harness/test_device.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace glim {

Film renderCaustics(const FlatScene& flat, const FlatCamera& camera, RenderSettings settings, bool byLightPaths)
{
    settings.caustics = byLightPaths;
    settings.schedule = Schedule::Persistent;
    Renderer renderer(testDevice(), flat, camera, settings);
    Film film = renderer.render([](const RenderProgress&) { return true; });
    EXPECT_EQ(renderer.statistics().nonFinite, 0U);
    return film;
}

void expectAgreement(const std::string& name, const Picture& picture, const Picture& reference)
{
    const ZTest test = zTest(picture, reference, kCausticsLevel);
    std::printf("%s: z of means %.2f %.2f %.2f, of blocks at most %.2f; sees a bias of %.2g\n", name.c_str(), test.meanZ[0], test.meanZ[1],
                test.meanZ[2], test.worstZ, test.detectableBias);
    EXPECT_TRUE(test.meansAgree()) << name << ": " << test.meanZ[0] << ' ' << test.meanZ[1] << ' ' << test.meanZ[2];
    EXPECT_TRUE(test.blocksAgree()) << name << ": " << test.worstZ << " at " << test.worstX << ", " << test.worstY;
}

double meanOfSplats(const Film& film)
{
    double sum = 0.0;
    for (const SplatMoments& splat : film.splats) {
        sum += static_cast<double>(splat.mean.r + splat.mean.g + splat.mean.b);
    }
    return sum / (3.0 * static_cast<double>(film.splats.size()));
}

}  // namespace glim
