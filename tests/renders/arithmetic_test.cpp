// A film has the same bits on all devices that round sums and products to nearest: also where everything else is as bad as Vulkan allows.
#include "host/denoise/nl_means.hpp"
#include "host/render/identify.hpp"
#include "places.h"
#include "tests/harness/arithmetic_device.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <span>

namespace glim {
namespace {

// Of the repository: all with tools/test --long. Else of each kind one, since kernels of adverse arithmetic take some seconds to compile:
// cornell_mirror_glass has light paths, materials and textures have environments.
std::vector<std::string> comparedScenes()
{
    if (samplesFor(1) == 1) {
        return {"cornell_mirror_glass", "cornell_spheres", "materials", "textures", "veach_mis"};
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

RenderSettings settingsOf(Schedule schedule, Aov aov = Aov::Radiance)
{
    RenderSettings settings;
    settings.width = 64;
    settings.height = 48;
    settings.sampleEnd = minSamplesForError(0);  // that the denoiser knows the noise
    settings.schedule = schedule;
    settings.aov = aov;
    return settings;
}

struct Rendered {
    Film film;  // with the layers of surfaces
    Image ids;
    std::vector<glm::vec3> denoised;
};

Rendered renderOn(Device& device, const PreparedScene& prepared, const RenderSettings& settings)
{
    const FlatCamera camera = flattenCamera(prepared.scene.cameras.front(), 64.0F / 48.0F);
    const auto always = [](auto&&...) { return true; };
    Renderer renderer(device, prepared.flat, camera, settings);
    Rendered rendered;
    rendered.film = renderer.render(always);
    if (settings.aov == Aov::Radiance) {
        rendered.ids = Identifier(renderer, prepared, camera).rows(rendered.film, 0, settings.height);
        rendered.denoised = NlMeans(device).denoise(rendered.film, always).value();
    }
    return rendered;
}

// By their bits: mattes are numbers that need not be finite.
bool sameIds(const Image& a, const Image& b)
{
    return a.counts == b.counts && std::ranges::equal(a.channels, b.channels, [](const auto& x, const auto& y) {
               return x.first == y.first && std::ranges::equal(std::as_bytes(std::span(x.second)), std::as_bytes(std::span(y.second)));
           });
}

class ArithmeticTest : public testing::TestWithParam<std::string> {
protected:
    void expectSame(const std::string& arithmetic, const std::vector<RenderSettings>& renders)
    {
        const std::unique_ptr<Device> device = deviceWith(arithmetic);
        for (const RenderSettings& settings : renders) {
            SCOPED_TRACE(arithmetic + ", " + getName(settings.schedule) + ", view " + std::to_string(static_cast<int>(settings.aov)));
            const Rendered own = renderOn(testDevice(), prepared, settings), other = renderOn(*device, prepared, settings);
            EXPECT_TRUE(sameBits(own.film, other.film));
            EXPECT_TRUE(sameIds(own.ids, other.ids));
            EXPECT_TRUE(own.denoised == other.denoised);
        }
    }

    const PreparedScene prepared = prepareScene(GLIM_SOURCE_DIR "/scenes/" + GetParam() + ".gltf", {});
};

// Pictures with the layers of their surfaces and light paths, ids, denoised pictures, views. tools/test --long takes both schedules, all
// views and more seeds, among them the worst one of all.
TEST_P(ArithmeticTest, FilmsDoNotLeanOnMoreThanVulkanPromises)
{
    expectSame("adverse:1", {settingsOf(Schedule::Wavefront), settingsOf(Schedule::Wavefront, Aov::BvhSteps)});
    if (samplesFor(1) > 1) {
        std::vector<RenderSettings> renders = {settingsOf(Schedule::Persistent)};
        for (const Aov aov : {Aov::Radiance, Aov::Normal, Aov::Depth, Aov::Albedo, Aov::BvhSteps}) {
            renders.push_back(settingsOf(Schedule::Wavefront, aov));
        }
        for (const char* const arithmetic : {"exact", "adverse:0", "adverse:2", "adverse:3", "adverse:4", "adverse:5"}) {
            expectSame(arithmetic, renders);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ArithmeticTest, testing::ValuesIn(comparedScenes()),
                         [](const testing::TestParamInfo<std::string>& scene) { return scene.param; });

}  // namespace
}  // namespace glim
