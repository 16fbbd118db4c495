// The repository's scenes against long renders kept with their variance (golden/*.exr). GLIM_WRITE_GOLDEN=1 makes them anew,
// from another seed; a picture that changes on purpose needs that and a look at it.
#include "host/image/exr.hpp"
#include "host/measure/z_test.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

namespace glim {
namespace {

constexpr std::uint32_t kGoldenSide = 48;
constexpr std::uint32_t kGoldenSamples = 2048, kTestSamples = 256;

struct Golden {
    const char* scene;
    bool blocks;  // whether 8x8 blocks are normal enough: not with caustics (64 x 256 samples against 100 skewness^2)
    std::uint32_t samples = kTestSamples;
};

void PrintTo(const Golden& golden, std::ostream* out) { *out << golden.scene; }

Film renderFile(const std::string& scene, std::uint32_t spp, std::uint32_t seed)
{
    RenderSettings settings = squareSettings(kGoldenSide, spp);
    settings.seed = seed;
    return renderScene(loadGltf(std::string(GLIM_SOURCE_DIR "/scenes/") + scene + ".gltf"), settings);
}

void writeGolden(const std::string& file, const Picture& picture)
{
    Image image;
    image.width = picture.width;
    image.height = picture.height;
    const char* const names[] = {"R", "G", "B"};
    for (int k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
            image.channels[names[k]].push_back(picture.radiance[i][k]);
            image.channels[std::string("variance.") + names[k]].push_back(picture.variance[i][k]);
        }
    }
    writeExr(file, image);
}

class GoldenTest : public testing::TestWithParam<Golden> {};

TEST_P(GoldenTest, AgreesWithTheLongRender)
{
    const std::string scene = GetParam().scene;
    const std::string file = GLIM_SOURCE_DIR "/tests/renders/golden/" + scene + ".exr";
    if (std::getenv("GLIM_WRITE_GOLDEN") != nullptr) {
        writeGolden(file, makePicture(renderFile(scene, kGoldenSamples, 1)));
    }
    const Picture golden = makePicture(readExr(file), file);
    const ZTest test = zTest(makePicture(renderFile(scene, GetParam().samples, 2)), golden, 1e-4);
    std::printf("%s: z of means %.2f %.2f %.2f (limit %.2f), worst block %.2f (limit %.2f), sees a bias of %.2e\n", scene.c_str(),
                test.meanZ[0], test.meanZ[1], test.meanZ[2], test.meanLimit, test.worstZ, test.blockLimit, test.detectableBias);
    EXPECT_TRUE(test.meansAgree());
    if (GetParam().blocks) {
        EXPECT_TRUE(test.blocksAgree()) << "at (" << test.worstX << ", " << test.worstY << ")";
        EXPECT_TRUE(test.spreadAgrees());
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GoldenTest,
                         testing::Values(Golden{"cornell", true}, Golden{"cornell_spheres", true}, Golden{"cornell_mirror_glass", false},
                                         Golden{"cornell_gems", false}, Golden{"light_point", true}, Golden{"light_spot", true},
                                         Golden{"light_directional", true}, Golden{"many_lights", true}, Golden{"veach_mis", true},
                                         Golden{"furnace", true}, Golden{"closed_room", true}, Golden{"shaded_lamp", false},
                                         Golden{"materials", true, 64}, Golden{"textures", true}, Golden{"normal_map", true},
                                         Golden{"alpha", true}, Golden{"liquid", false}, Golden{"wax", false}, Golden{"sun_glass", false},
                                         Golden{"sun_water", false}, Golden{"product", false}, Golden{"car_paint", true},
                                         Golden{"cloth", true}),
                         [](const testing::TestParamInfo<Golden>& golden) { return std::string(golden.param.scene); });

}  // namespace
}  // namespace glim
