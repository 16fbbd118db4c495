// Files for compositing: half floats where they are enough, nothing lost but the last bits, and what they do not hold is said.
#include "host/render/layers_file.hpp"
#include "host/image/exr.hpp"
#include "host/message.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim {
namespace {

Film smallFilm()
{
    Film film = test::simulateFilm(0, 64);
    film.crop = Crop{{3, 2}, {film.width, film.height}, {20, 10}};
    return film;
}

TEST(LayersFileTest, HasTheStandardLayersOfTheFilm)
{
    const test::ScratchFolder folder;
    const Film film = smallFilm();
    const std::vector<PixelMoments> shown = shownPixels(film);
    std::vector<std::uintmax_t> sizes;
    for (const ExrCompression compression :
         {ExrCompression::Zip, ExrCompression::Zips, ExrCompression::Piz, ExrCompression::Rle, ExrCompression::None}) {
        writeLayers(folder / "a.exr", film, compression);
        sizes.push_back(std::filesystem::file_size(folder / "a.exr"));
        const Image image = readExr(folder / "a.exr");
        EXPECT_EQ(image.channels.size(), 11U);
        EXPECT_TRUE(image.counts.empty());
        EXPECT_FALSE(image.attributes.contains("glim:film"));
        EXPECT_EQ(image.columnsLeft, 3U);
        for (std::size_t i = 0; i < shown.size(); ++i) {
            EXPECT_EQ(image.channels.at("depth.Z")[i], shown[i].depth);
            EXPECT_NEAR(image.channels.at("G")[i], shown[i].mean.g, 0x1p-11F * shown[i].mean.g + 0x1p-25F);
            EXPECT_NEAR(image.channels.at("albedo.B")[i], shown[i].albedo.b, 0x1p-11F * shown[i].albedo.b + 0x1p-25F);
            EXPECT_NEAR(image.channels.at("normal.X")[i], shown[i].normal.x, 0x1p-11F * std::abs(shown[i].normal.x) + 0x1p-25F);
            EXPECT_NEAR(image.channels.at("A")[i], shown[i].alpha, 0x1p-11F);
        }
    }
    EXPECT_LT(sizes.front(), sizes.back()) << "zip against none";
}

TEST(LayersFileTest, WhatIsTooBrightIsTheBrightest)
{
    const test::ScratchFolder folder;
    Film film = smallFilm();
    film.pixels[0].mean = glm::vec3(65520.0F, 65504.0F, 1e30F);
    film.pixels[1].mean.r = std::numeric_limits<float>::infinity();
    writeLayers(folder / "a.exr", film);
    const Image image = readExr(folder / "a.exr");
    EXPECT_EQ(image.channels.at("R")[0], 65504.0F);
    EXPECT_EQ(image.channels.at("G")[0], 65504.0F);
    EXPECT_EQ(image.channels.at("B")[0], 65504.0F);
    EXPECT_TRUE(std::isinf(image.channels.at("R")[1]));
}

}  // namespace
}  // namespace glim
