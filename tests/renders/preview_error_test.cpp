// The window shows the error that a film has against a target, and a checkerboard where it is transparent.
#include "host/denoise/denoised_picture.hpp"
#include "host/measure/error_map.hpp"
#include "host/preview/error_layer.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_pictures.hpp"
#include "host/render/robust_radiance.hpp"
#include "shaders/shared/display_colors.h"
#include "tests/support/preview_fixture.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <iterator>
#include <sstream>
#include <utility>

namespace glim::test {
namespace {

const std::string kToErrors = "0 key V\n0 key V\n0 key V\n0 key V\n0 key V\n0 key V\n";  // it is the last of seven layers

std::vector<std::string> listOf(const std::string& options)
{
    std::istringstream words(options);
    return {std::istream_iterator<std::string>(words), {}};
}

Pixels errorsOf(const Film& film, double target)
{
    const Picture picture = makePicture(film);
    Pixels expected;
    for (const float error : mapErrors(picture, robustRadiance(film))) {
        const Rgb8 color = roundToBytes(errorColor(static_cast<double>(error), target));
        expected.push_back({color[0], color[1], color[2]});
    }
    return expected;
}

// Of all samples, though they are few more than those of the estimate before.
TEST_F(PreviewTest, ShowsTheErrorAgainstTheTarget)
{
    const Pixels shown = windowAtWriting(screen, "0 key N\n0 samples 1\n" + kToErrors + "0 samples 79\n0 key P\n", {"--spp", "79"});
    const Film plain = render("--spp 79");
    EXPECT_TRUE(sameBits(film(1), plain));
    EXPECT_EQ(picture(1), rendered()) << "the light is written";
    const Pixels expected = errorsOf(plain, kFirstTarget);
    EXPECT_EQ(countOthers(shown, expected), 0);
    const auto isBelow = [](const auto& color) { return color[0] == 0; };
    const auto below = std::ranges::count_if(expected, isBelow);
    EXPECT_GT(below, 100);
    EXPECT_LT(below, static_cast<long>(expected.size()) - 100);
}

// The slider's place is known from a look at the window.
TEST_F(PreviewTest, TheTargetIsChosenInThePanel)
{
    width = 100;
    height = 470;
    panels = true;
    for (const auto& [end, target] : {std::pair("1", 1e-6), {"300", 1.0}}) {
        const std::string drag = std::string("0.3 drag left 60,420 ") + end + ",420\n";
        const Pixels shown = windowAtWriting(
            screen, "0 samples 64\n" + kToErrors + "0.1 samples 64\n" + drag + "0.3 key H\n0 key H\n0.1 samples 64\n0 key P\n",
            {"--spp", "64", "--bounces", "1"});
        EXPECT_EQ(countOthers(shown, errorsOf(film(1), target)), 0) << target;
        removePictures();
    }
}

// Too few samples for any estimate: grey, as bright as the picture.
TEST_F(PreviewTest, AnUnknownErrorIsGrey)
{
    const Pixels shown = windowAtWriting(screen, "0 samples 8\n" + kToErrors + "0.1 samples 8\n0 key P\n", {"--spp", "8"});
    render("--spp 8");
    Pixels grey;
    for (const auto& [r, g, b] : rendered()) {
        const int level = static_cast<int>(0.2126 * r + 0.7152 * g + 0.0722 * b + 0.5);
        grey.push_back({level, level, level});
    }
    EXPECT_EQ(countOthers(shown, grey), 0);
}

// A move begins another picture, of which nothing is known at first. V goes on to the shaded picture.
TEST_F(PreviewTest, TheErrorIsThatOfThePresentView)
{
    const std::string moved = "0 samples 64\n" + kToErrors + "0.1 samples 64\n0 drag left 10,10 40,30\n0.2 samples 64\n0 key C\n";
    const Pixels shown = windowAtWriting(screen, moved + "0 key P\n", {"--spp", "64"});
    EXPECT_EQ(countOthers(shown, errorsOf(film(1), kFirstTarget)), 0);
    removePictures();
    const Pixels shaded = windowAtWriting(screen, moved + "0 key N\n0 key V\n0.1 samples 64\n0 key P\n", {"--spp", "64"});
    EXPECT_EQ(countOthers(shaded, picture(1)), 0);
}

TEST_F(PreviewTest, TransparentPixelsShowACheckerboard)
{
    const std::string options = "--spp 8 --environment 1,1,1 --environment-background off --zoom 0.5";
    const Pixels shown = windowAtWriting(screen, "0 samples 8\n0 key P\n", listOf(options));
    EXPECT_TRUE(sameBits(film(1), render(options)));
    EXPECT_EQ(countOthers(shown, overCheckerboard(film(1))), 0);
    EXPECT_EQ(shown[0], (std::array{153, 153, 153}));
    EXPECT_EQ(shown[kCheckerSide], (std::array{102, 102, 102}));
    EXPECT_EQ(shown[kCheckerSide * width], (std::array{102, 102, 102}));
    const auto isMixed = [](const PixelMoments& pixel) { return pixel.alpha > 0.0F && pixel.alpha < 1.0F; };
    EXPECT_GT(std::ranges::count_if(film(1).pixels, isMixed), 20) << "edges";
}

TEST_F(PreviewTest, ADenoisedPictureIsTransparentToo)
{
    const std::string options = "--spp 512 --environment 1,1,1 --environment-background off --zoom 0.5";
    const Pixels shown = windowAtWriting(screen, "0 samples 512\n6 key P\n", listOf(options));
    const auto denoised = readDenoised(folder / "cornell_spheres-001.exr");
    ASSERT_TRUE(denoised);
    EXPECT_EQ(countOthers(shown, overCheckerboard(showDenoised(film(1), *denoised))), 0);
    EXPECT_GT(countOthers(shown, overCheckerboard(film(1))), 20) << "the noisy one";
}

// The same of files in `glim view`.
TEST_F(PreviewTest, AFilmThatIsViewedIsTransparentToo)
{
    const Film transparent = render("--spp 8 --environment 1,1,1 --environment-background off --zoom 0.5");
    GlimCall session = call("", {});
    session.arguments = {"view", "r.exr", "--size", "96x72", "--script", "script"};
    const Pixels expected = overCheckerboard(transparent);
    int others = -1;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    session.signalWhen = [&](const std::string&) {
        others = countOthers(windowOf(screen.pixels()), expected);
        return others == 0 || std::chrono::steady_clock::now() > end;
    };
    session.signal = SIGTERM;
    EXPECT_EQ(runGlim(session).err, "");
    EXPECT_EQ(others, 0);
}

}  // namespace
}  // namespace glim::test
