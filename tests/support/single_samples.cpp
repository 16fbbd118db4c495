#include "tests/support/single_samples.hpp"

#include "host/flatten/flatten_scene.hpp"
#include "host/render/renderer.hpp"
#include "shaders/shared/path_types.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

namespace glim {

std::vector<Film> renderSingleSamples(const Scene& scene, const RenderSettings& settings)
{
    const FlatScene flat = flattened(scene);
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    RenderResources resources(testDevice(), flat, flattenCamera(scene.cameras.front(), aspect), settings);
    const std::unique_ptr<Tile> tile = resources.makeTile(0, settings.width * settings.height);
    Pass pass = tile->pass();
    pass.pixelCount = tile->count();
    pass.sampleCount = 1;
    pass.accumulate = kEndsBlock;
    std::vector<Film> films(settings.sampleEnd);
    for (pass.firstSample = 0; pass.firstSample < settings.sampleEnd; ++pass.firstSample) {
        PassTracer(resources).trace(*tile, pass, nullptr);
        Film& film = films[pass.firstSample];
        film.width = settings.width;
        film.height = settings.height;
        film.pixels = tile->readPages();
        tile->clear();
    }
    RenderSettings last = settings;
    last.sampleBegin = settings.sampleEnd - 1;
    const Film whole = renderScene(scene, last);
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
        EXPECT_EQ(films.back().pixels[i].mean, whole.pixels[i].mean) << "pixel " << i;
        EXPECT_EQ(films.back().pixels[i].count, whole.pixels[i].count) << "pixel " << i;
    }
    return films;
}

}  // namespace glim
