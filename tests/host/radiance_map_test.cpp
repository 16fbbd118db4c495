#include "host/image/radiance_map.hpp"

#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>

#include <gtest/gtest.h>

#include <fstream>

namespace glim {
namespace {

class RadianceMapTest : public ::testing::Test {
protected:
    RadianceMap read(const std::string& bytes)
    {
        const std::filesystem::path file = folder_.path() / "map.hdr";
        std::ofstream(file, std::ios::binary) << bytes;
        return readRadianceMap(file);
    }
    void expectRefused(const std::string& bytes, MessageId id, test::Parts parts = {})
    {
        parts.file = "map.hdr";
        test::expectRefusal<InputError>([&] { read(bytes); }, id, parts);
    }

    test::ScratchFolder folder_;
};

const std::string kHeader = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";

std::string pixel(int r, int g, int b, int e)
{
    return {static_cast<char>(r), static_cast<char>(g), static_cast<char>(b), static_cast<char>(e)};
}

TEST_F(RadianceMapTest, PlainPixelsAreMantissasTimesAPowerOfTwo)
{
    const RadianceMap map = read(kHeader + "-Y 1 +X 2\n" + pixel(128, 64, 32, 129) + pixel(200, 1, 0, 0));
    ASSERT_EQ(map.width, 2U);
    ASSERT_EQ(map.height, 1U);
    EXPECT_EQ(map.texels[0], glm::vec3(1.0F, 0.5F, 0.25F));
    EXPECT_EQ(map.texels[1], glm::vec3(0.0F)) << "exponent 0 is black";
}

TEST_F(RadianceMapTest, HeadersMayEndTheirLinesAsWindowsDoes)
{
    const RadianceMap map = read("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\nEXPOSURE=2\r\n\r\n-Y 1 +X 2\r\n" + pixel(128, 64, 32, 129) +
                                 pixel('\r', '\n', 0, 136));
    EXPECT_EQ(map.texels.at(0), glm::vec3(0.5F, 0.25F, 0.125F));
    EXPECT_EQ(map.texels.at(1), glm::vec3(6.5F, 5.0F, 0.0F));
}

// What Blender calls multilayer: the picture is the combined pass of a view layer.
TEST_F(RadianceMapTest, TheCombinedLayerOfSeveral)
{
    const auto write = [&](const std::vector<std::pair<std::string, float>>& channels) {
        Image image;
        image.width = 2;
        image.height = 1;
        for (const auto& [name, value] : channels) {
            image.channels[name] = {value, value};
        }
        const std::filesystem::path file = folder_.path() / "layers.exr";
        writeExr(file, image);
        return file;
    };
    const std::vector<std::pair<std::string, float>> layers{
        {"ViewLayer.Combined.R", 1.0F}, {"ViewLayer.Combined.G", 2.0F}, {"ViewLayer.Combined.B", 3.0F}, {"ViewLayer.Combined.A", 1.0F},
        {"ViewLayer.Depth.Z", 9.0F},    {"ViewLayer.DiffCol.R", 7.0F},  {"ViewLayer.DiffCol.G", 7.0F},  {"ViewLayer.DiffCol.B", 7.0F}};
    EXPECT_EQ(readRadianceMap(write(layers)).texels.at(1), glm::vec3(1, 2, 3));
    test::expectRefusal<InputError>(
        [&] {
            readRadianceMap(write({layers.begin() + 4, layers.end()}));
        },
        MessageId::Missing, {.file = "layers.exr", .expected = "channels R, G and B"});
}

// Blender may write each pass as a part of its own.
TEST_F(RadianceMapTest, TheCombinedPartOfSeveral)
{
    const auto read = [&](const std::vector<std::pair<std::string, std::string>>& parts) {  // name and the beginning of its channels'
        const Imath::Box2i window({0, 0}, {1, 0});
        std::vector<Imf::Header> headers;
        for (const auto& [name, layer] : parts) {
            Imf::Header& header = headers.emplace_back(window, window);
            header.setName(name);
            header.setType(Imf::SCANLINEIMAGE);
            for (const char* color : {"R", "G", "B"}) {
                header.channels().insert(layer + color, Imf::Channel(Imf::FLOAT));
            }
        }
        const std::filesystem::path path = folder_.path() / "parts.exr";
        {
            Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
            for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
                std::array<float, 2> row{static_cast<float>(i), static_cast<float>(i)};
                Imf::FrameBuffer frame;
                for (const char* color : {"R", "G", "B"}) {
                    frame.insert(parts[static_cast<std::size_t>(i)].second + color, Imf::Slice::Make(Imf::FLOAT, row.data(), window));
                }
                Imf::OutputPart part(file, i);
                part.setFrameBuffer(frame);
                part.writePixels(1);
            }
        }
        return readRadianceMap(path).texels.at(1);
    };
    EXPECT_EQ(read({{"ViewLayer.AO", ""}, {"ViewLayer.Combined", ""}, {"ViewLayer.DiffCol", ""}}), glm::vec3(1.0F));
    EXPECT_EQ(read({{"a", "ViewLayer.AO."}, {"b", "ViewLayer.DiffCol."}, {"c", "ViewLayer.Combined."}}), glm::vec3(2.0F));
    EXPECT_EQ(read({{"left", ""}, {"right", ""}}), glm::vec3(0.0F));
}

TEST_F(RadianceMapTest, EveryOrderOfTheAxes)
{
    // The picture: a b above c d, as the reds 1 2 3 4.
    const glm::vec4 expected(1, 2, 3, 4);
    const std::pair<const char*, std::array<int, 4>> orders[] = {
        {"-Y 2 +X 2", {1, 2, 3, 4}}, {"-Y 2 -X 2", {2, 1, 4, 3}}, {"+Y 2 +X 2", {3, 4, 1, 2}}, {"+Y 2 -X 2", {4, 3, 2, 1}},
        {"+X 2 -Y 2", {1, 3, 2, 4}}, {"-X 2 -Y 2", {2, 4, 1, 3}}, {"+X 2 +Y 2", {3, 1, 4, 2}}, {"-X 2 +Y 2", {4, 2, 3, 1}}};
    for (const auto& [resolution, reds] : orders) {
        std::string bytes = kHeader + resolution + "\n";
        for (const int red : reds) {
            bytes += pixel(red, 0, 0, 136);
        }
        const RadianceMap map = read(bytes);
        EXPECT_EQ(glm::vec4(map.texels[0].r, map.texels[1].r, map.texels[2].r, map.texels[3].r), expected) << resolution;
    }
}

TEST_F(RadianceMapTest, RunsOldAndNew)
{
    const RadianceMap old =
        read(kHeader + "-Y 1 +X 6\n" + pixel(8, 0, 0, 136) + pixel(1, 1, 1, 3) + pixel(9, 0, 0, 136) + pixel(1, 1, 1, 1));
    for (std::size_t x = 0; x < 6; ++x) {
        EXPECT_EQ(old.texels[x].r, x < 4 ? 8.0F : 9.0F) << x;
    }
    std::string bytes = kHeader + "-Y 1 +X 10\n" + pixel(2, 2, 0, 10);
    bytes += std::string{char(128 + 7), 5, 3, 1, 2, 3};      // red: seven fives, then 1 2 3
    bytes += std::string{char(128 + 10), 6};                 // green
    bytes += std::string{10, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9};  // blue
    bytes += std::string{char(128 + 10), char(136)};
    const RadianceMap map = read(bytes);
    EXPECT_EQ(map.texels[6], glm::vec3(5, 6, 6));
    EXPECT_EQ(map.texels[9], glm::vec3(3, 6, 9));
}

TEST_F(RadianceMapTest, ExposureDivides)
{
    const RadianceMap map =
        read("#?RGBE\nEXPOSURE=2\nEXPOSURE= 4\nCOLORCORR= 1 2 4\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + pixel(128, 128, 128, 129));
    EXPECT_EQ(map.texels[0], glm::vec3(0.125F, 0.0625F, 0.03125F));
}

TEST_F(RadianceMapTest, SaysWhatIsWrong)
{
    expectRefused("hello", MessageId::UnknownFormat, {.expected = "OpenEXR nor Radiance"});
    expectRefused("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", MessageId::UnknownFormat, {.value = "32-bit_rle_xyze"});
    expectRefused("#?RADIANCE\nEXPOSURE=-1\n\n", MessageId::OutOfRange, {.value = "EXPOSURE=-1"});
    expectRefused(kHeader + "-Y 99999 +X 99999\n", MessageId::OutOfRange, {.place = "resolution", .value = "-Y 99999 +X 99999"});
    expectRefused(kHeader + "-Y 2 +X 1\n" + pixel(1, 2, 3, 4), MessageId::FileDamaged, {.place = "row 1"});
    expectRefused(kHeader + "-Y 8192 +X 16384\n" + std::string(8191 * 12, 'x'), MessageId::FileDamaged, {.place = "row 8191"});
    expectRefused(kHeader + "-Y 1 +X 2\n" + pixel(1, 1, 1, 9), MessageId::FileDamaged, {.place = "pixel 0 of row 0", .value = "9"});
    expectRefused("#?RADIANCE\n", MessageId::FileDamaged, {.expected = "a line with its resolution"});
    std::string lines = "#?RADIANCE\n";
    for (int line = 0; line < 5000; ++line) {
        lines += "A=1\n";
    }
    expectRefused(lines, MessageId::TooLarge, {.expected = "4096 lines"});
    test::expectRefusal<InputError>([&] { readRadianceMap(folder_.path()); }, MessageId::WrongType, {.value = "a folder"});
    test::expectRefusal<InputError>([&] { readRadianceMap(folder_ / "missing.exr"); }, MessageId::FileMissing, {.file = "missing.exr"});
}

TEST_F(RadianceMapTest, SurvivesMutants)
{
    Random random(3);
    std::string good = kHeader + "-Y 3 +X 10\n";
    for (int row = 0; row < 3; ++row) {
        good += pixel(2, 2, 0, 10);
        for (int c = 0; c < 4; ++c) {
            good += std::string{char(128 + 5), 7, 5, 1, 2, 3, 4, 5};
        }
    }
    ASSERT_EQ(read(good).texels.size(), 30U);
    for (int i = 0; i < 500; ++i) {
        std::string bytes = good.substr(0, random.below(2) == 0 ? good.size() : random.below(static_cast<std::uint32_t>(good.size())));
        for (std::uint32_t k = 0; k < 1 + random.below(4) && !bytes.empty(); ++k) {
            bytes[random.below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(random.below(256));
        }
        try {
            EXPECT_LE(read(bytes).texels.size(), kMaxMapTexels);
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()), "");
        }
    }
}

}  // namespace
}  // namespace glim
