// Each option of `glim render` changes the picture, or leaves every bit of it where it must.
#include "host/render/film_file.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

namespace glim::test {
namespace {

class OptionsTest : public testing::Test {
protected:
    // A file of scenes/, small, with `options` separated by blanks.
    Film render(const std::string& options, const char* scene = "cornell_spheres.gltf") const
    {
        GlimCall call;
        call.arguments = {"render", sceneFile(scene), "-o", "x.exr", "--size", "12x12"};
        std::istringstream words(options);
        for (std::string word; words >> word;) {
            call.arguments.push_back(word);
        }
        call.folder = folder_.path();
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 0) << options << ": " << run.err;
        return readFilm(folder_ / "x.exr");
    }

private:
    ScratchFolder folder_;
};

TEST_F(OptionsTest, ChangeThePicture)
{
    const std::pair<const char*, const char*> kPairs[] = {
        {"", "--direct lights"},
        {"", "--direct hemisphere"},
        {"", "--direct bsdf"},
        {"--direct lights", "--direct lights --light-samples 2"},
        {"--direct hemisphere", "--direct hemisphere --light-samples 2"},
        {"", "--paths emission"},
        {"", "--paths direct"},
        {"", "--paths indirect"},
        {"", "--bounces 3"},
        {"", "--roulette fixed:0.7"},
        {"--roulette fixed:0.7", "--roulette fixed:0.8"},
        {"", "--roulette none"},
        {"", "--intersector moller-trumbore"},
        {"", "--sampler independent"},
        {"", "--lens-radius 0.1 --focal-distance 3"},
        {"--lens-radius 0.1 --focal-distance 3", "--lens-radius 0.1 --focal-distance 2"},
        {"", "--view normal"},
        {"", "--view depth"},
        {"", "--view albedo"},
        {"", "--view bvh-steps"},
    };
    std::map<std::string, Film> films;  // by options
    const auto makeFilm = [&](const std::string& options) -> const Film& {
        const auto found = films.find(options);
        return found != films.end() ? found->second : films.emplace(options, render("--spp 4 " + options)).first->second;
    };
    for (const auto& [one, other] : kPairs) {
        EXPECT_FALSE(sameBits(makeFilm(one), makeFilm(other))) << other;
    }
    const auto steps = [this](const char* rule) {
        return render("--spp 4 --view bvh-steps --split " + std::string(rule), "many_lights.gltf");
    };
    const Film mean = steps("mean");
    EXPECT_FALSE(sameBits(steps("sah"), mean));
    EXPECT_FALSE(sameBits(mean, steps("median")));
}

TEST_F(OptionsTest, ChangeNoBitWhereOnlyTheTracingDiffers)
{
    const Film film = render("--spp 8");
    for (const char* options :
         {"--accelerator none", "--schedule persistent", "--split mean", "--split median", "--direct mis", "--paths all",
          "--roulette throughput", "--adaptive off", "--view shaded", "--lens-radius 0 --focal-distance 2"}) {
        EXPECT_TRUE(sameBits(film, render(std::string("--spp 8 ") + options))) << options;
    }
}

TEST_F(OptionsTest, OfAdaptiveRendersChangeWhereTheyStop)
{
    const std::string plain = "--bounces 1 --adaptive course --max-spp 256 --tolerance 0.3";
    const Film film = render(plain);
    for (const char* other :
         {"--bounces 1 --adaptive course --max-spp 256 --tolerance 0.2", "--bounces 1 --adaptive course --max-spp 128 --tolerance 0.3",
          "--bounces 1 --adaptive course --max-spp 256 --tolerance 0.3 --batch 16",
          "--bounces 1 --adaptive course:literal --max-spp 256 --tolerance 0.3", "--bounces 1 --sampler independent --spp 256"}) {
        const Film changed = render(other);
        const auto sameCounts = std::equal(film.pixels.begin(), film.pixels.end(), changed.pixels.begin(),
                                           [](const PixelMoments& a, const PixelMoments& b) { return a.count == b.count; });
        EXPECT_FALSE(sameCounts) << other;
    }
}

}  // namespace
}  // namespace glim::test
