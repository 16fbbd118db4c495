// A film has the same bits on all devices that round sums and products to nearest: also where everything else is as bad as Vulkan allows.
#include "host/flatten/flatten_scene.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/support/arithmetic_device.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_device.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace glim {
namespace {

// Of the repository: all with tools/test --long. Kernels of adverse arithmetic take some seconds to compile.
std::vector<std::string> comparedScenes()
{
    if (samplesFor(1) == 1) {
        return {"cornell_spheres", "materials", "textures", "veach_mis"};
    }
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(GLIM_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() == ".gltf") {
            names.push_back(entry.path().stem().string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

RenderSettings settingsOf(Schedule schedule)
{
    RenderSettings settings;
    settings.width = 64;
    settings.height = 48;
    settings.sampleEnd = 16;
    settings.schedule = schedule;
    return settings;
}

Film renderOn(Device& device, const FlatScene& flat, const Camera& camera, const RenderSettings& settings)
{
    return Renderer(device, flat, flattenCamera(camera, 64.0F / 48.0F), settings).render([](const RenderProgress&) { return true; });
}

class ArithmeticTest : public testing::TestWithParam<std::string> {
protected:
    void expectSameFilms(const std::string& arithmetic, const std::vector<RenderSettings>& films)
    {
        const std::unique_ptr<Device> device = deviceWith(arithmetic);
        for (const RenderSettings& settings : films) {
            EXPECT_TRUE(sameBits(renderOn(testDevice(), flat, camera, settings), renderOn(*device, flat, camera, settings)))
                << arithmetic << ", " << getName(settings.schedule);
        }
    }

    const Scene scene = loadGltf(GLIM_SOURCE_DIR "/scenes/" + GetParam() + ".gltf");
    const FlatScene flat = flattened(scene);
    const Camera camera = scene.cameras.front();
};

// tools/test --long takes both schedules and more seeds, among them the worst one of all.
TEST_P(ArithmeticTest, FilmsDoNotLeanOnMoreThanVulkanPromises)
{
    expectSameFilms("adverse:1", {settingsOf(Schedule::Wavefront)});
    if (samplesFor(1) > 1) {
        for (const char* const arithmetic : {"exact", "adverse:0", "adverse:2", "adverse:3", "adverse:4", "adverse:5"}) {
            expectSameFilms(arithmetic, {settingsOf(Schedule::Wavefront), settingsOf(Schedule::Persistent)});
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ArithmeticTest, testing::ValuesIn(comparedScenes()),
                         [](const testing::TestParamInfo<std::string>& scene) { return scene.param; });

}  // namespace
}  // namespace glim
