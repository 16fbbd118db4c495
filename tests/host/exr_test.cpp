#include "host/image/exr.hpp"
#include "host/error.hpp"
#include "host/image/radiance_map.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace glim {
namespace {

using test::expectRefusal;
using test::readFileBytes;
using test::ScratchFolder;
using test::writeText;

// Values that would change on a careless way through half, text or arithmetic.
Image makeImage()
{
    using Limits = std::numeric_limits<float>;
    Image image;
    image.width = 5;
    image.height = 2;
    image.channels["R"] = {
        0.0F,          -0.0F,    1.0F / 3.0F, Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), Limits::denorm_min(),
        Limits::max(), 65536.0F, -1e-30F};
    image.channels["albedo.G"] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    image.counts["count.X"] = {0, 1, (1U << 24) + 1, 0xFFFFFFFFU, 4, 5, 6, 7, 8, 9};
    image.attributes = {{"glim:seed", 4294967295.0}, {"glim:scene", std::string("a \"b\"\nc")}, {"third", 1.0 / 3.0}};
    OpaqueBytes& bytes = image.attributes["bytes"].emplace<OpaqueBytes>();
    for (int i = 0; i < 1000; ++i) {
        bytes.push_back(static_cast<std::byte>(i));
    }
    return image;
}

TEST(Exr, ReadsBackEveryBitItWrote)
{
    const ScratchFolder folder;
    const Image image = makeImage();
    writeExr(folder / "a.exr", image);
    const Image back = readExr(folder / "a.exr");
    ASSERT_EQ(back.width, 5U);
    ASSERT_EQ(back.height, 2U);
    ASSERT_EQ(back.channels.size(), 2U);
    for (const auto& [name, plane] : image.channels) {
        ASSERT_EQ(back.channels.at(name).size(), plane.size());
        EXPECT_EQ(std::memcmp(back.channels.at(name).data(), plane.data(), plane.size() * sizeof(float)), 0) << name;
    }
    EXPECT_EQ(back.counts, image.counts);
    EXPECT_EQ(back.attributes, image.attributes);
    const Image header = readExrHeader(folder / "a.exr");
    EXPECT_EQ(header.width, 5U);
    EXPECT_TRUE(header.channels.empty());
    EXPECT_EQ(header.attributes, back.attributes);
}

TEST(Exr, TheSameImageGivesTheSameBytes)
{
    const ScratchFolder folder;
    writeExr(folder / "a.exr", makeImage());
    writeExr(folder / "b.exr", makeImage());
    EXPECT_EQ(readFileBytes(folder / "a.exr"), readFileBytes(folder / "b.exr"));
    EXPECT_EQ(folder.entries(), 2);
}

// Rows of bands that end within OpenEXR's own chunks of 16.
TEST(Exr, BandsMakeTheSameFile)
{
    const ScratchFolder folder;
    Image image;
    image.width = 3;
    image.height = 50;
    image.attributes = {{"third", 1.0 / 3.0}};
    for (std::uint32_t i = 0; i < 150; ++i) {
        image.channels["R"].push_back(static_cast<float>(i));
        image.counts["count.X"].push_back(1000 - i);
    }
    writeExr(folder / "a.exr", image);
    {
        const ExrWriter left(folder / "b.exr", image);
    }
    EXPECT_EQ(folder.entries(), 1) << "what is not committed leaves nothing";
    ExrWriter writer(folder / "b.exr", image);
    for (std::uint32_t row = 0; row < 50; row += 7) {
        Image band;
        band.width = 3;
        band.height = std::min(7U, 50 - row);
        const std::size_t begin = 3 * row, end = begin + 3 * band.height;
        band.channels["R"].assign(&image.channels["R"][begin], &image.channels["R"][begin] + (end - begin));
        band.counts["count.X"].assign(&image.counts["count.X"][begin], &image.counts["count.X"][begin] + (end - begin));
        writer.write(band);
    }
    writer.commit();
    EXPECT_EQ(readFileBytes(folder / "a.exr"), readFileBytes(folder / "b.exr"));
    EXPECT_EQ(readExr(folder / "b.exr").counts, image.counts);
}

TEST(Exr, IsFloatZipRec709FromTheTopLeft)
{
    const ScratchFolder folder;
    writeExr(folder / "a.exr", makeImage());
    const Imf::InputFile file((folder / "a.exr").c_str());
    EXPECT_EQ(file.header().channels()["R"].type, Imf::FLOAT);
    EXPECT_EQ(file.header().channels()["count.X"].type, Imf::UINT);
    EXPECT_EQ(file.header().compression(), Imf::ZIP_COMPRESSION);
    EXPECT_EQ(file.header().dataWindow().min, Imath::V2i(0, 0));
    EXPECT_EQ(file.header().dataWindow(), file.header().displayWindow());
    const auto& primaries = file.header().typedAttribute<Imf::ChromaticitiesAttribute>("chromaticities").value();
    EXPECT_FLOAT_EQ(primaries.red.x, 0.64F);
    EXPECT_FLOAT_EQ(primaries.green.y, 0.60F);
    EXPECT_FLOAT_EQ(primaries.blue.x, 0.15F);
    EXPECT_FLOAT_EQ(primaries.white.x, 0.3127F);
}

TEST(Exr, RowsThatItLacksAreInTheDisplayWindowAlone)
{
    const ScratchFolder folder;
    Image image = makeImage();
    image.rowsAbove = 3;
    image.rowsBelow = 2;
    writeExr(folder / "a.exr", image);
    const Imf::InputFile file((folder / "a.exr").c_str());
    const int right = static_cast<int>(image.width) - 1, bottom = static_cast<int>(image.height) + 2;
    EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({0, 3}, {right, bottom}));
    EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {right, bottom + 2}));
    const Image read = readExr(folder / "a.exr");
    EXPECT_EQ(read.rowsAbove, 3U);
    EXPECT_EQ(read.rowsBelow, 2U);
    EXPECT_EQ(read.counts, image.counts);
}

// Half values x + 100 y at the pixel (x, y) of a window with negative corner.
template <class File>
void writeHalves(File& file, std::vector<Imath::half>& pixels, const Imath::Box2i& window)
{
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    pixels.clear();
    for (int y = window.min.y; y <= window.max.y; ++y) {
        for (int x = window.min.x; x <= window.max.x; ++x) {
            pixels.emplace_back(static_cast<float>(x + 100 * y));
        }
    }
    Imf::FrameBuffer frame;
    frame.insert("R", Imf::Slice::Make(Imf::HALF, pixels.data(), window.min, width, height));
    file.setFrameBuffer(frame);
}

void expectHalves(const Image& image)
{
    ASSERT_EQ(image.width, 21U);
    ASSERT_EQ(image.height, 5U);
    const auto& plane = image.channels.at("R");
    for (std::uint32_t y = 0; y < 5; ++y) {
        for (std::uint32_t x = 0; x < 21; ++x) {
            EXPECT_EQ(plane[y * 21 + x], static_cast<float>(x) - 7 + 100 * (static_cast<float>(y) - 2));
        }
    }
}

TEST(Exr, ReadsHalfScanLinesOfAWindowFromBottomToTop)
{
    const ScratchFolder folder;
    const Imath::Box2i window({-7, -2}, {13, 2});
    Imf::Header header(Imath::Box2i({0, 0}, {99, 99}), window);
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.lineOrder() = Imf::DECREASING_Y;
    {
        std::vector<Imath::half> pixels;
        Imf::OutputFile file((folder / "a.exr").c_str(), header);
        writeHalves(file, pixels, window);
        file.writePixels(5);
    }
    expectHalves(readExr(folder / "a.exr"));
}

TEST(Exr, KnowsWhereAPartOfALargerPictureLies)
{
    const ScratchFolder folder;
    const Imath::Box2i window({7, 2}, {9, 5});
    Imf::Header header(Imath::Box2i({1, 1}, {99, 99}), window);
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    {
        std::vector<Imath::half> pixels;
        Imf::OutputFile file((folder / "a.exr").c_str(), header);
        writeHalves(file, pixels, window);
        file.writePixels(4);
    }
    const Image image = readExr(folder / "a.exr");
    EXPECT_EQ(image.columnsLeft, 6U);
    EXPECT_EQ(image.rowsAbove, 1U);
    EXPECT_EQ(image.rowsBelow, 94U);
}

TEST(Exr, SaysThatOnlyTheFirstOfSeveralPartsIsRead)
{
    const ScratchFolder folder;
    const Imath::Box2i window({0, 0}, {20, 4});
    std::vector<Imf::Header> headers(2, Imf::Header(window, window));
    for (std::size_t i = 0; i < 2; ++i) {
        headers[i].channels().insert("R", Imf::Channel(Imf::HALF));
        headers[i].setName("part " + std::to_string(i));
        headers[i].setType(Imf::SCANLINEIMAGE);
    }
    {
        Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 2);
        for (int i = 0; i < 2; ++i) {
            std::vector<Imath::half> pixels;
            Imf::OutputPart part(file, i);
            writeHalves(part, pixels, window);
            part.writePixels(5);
        }
    }
    std::vector<Message> said;
    listenToMessages([&said](Severity, const Message& message) { said.push_back(message); });
    EXPECT_EQ(readExr(folder / "a.exr").channels.at("R")[20], 20.0F);
    listenToMessages({});
    ASSERT_EQ(said.size(), 1U);
    test::expectMessage(said[0], MessageId::PartsIgnored, {.file = "a.exr"});
}

TEST(Exr, ReadsTheFinestLevelOfTiles)
{
    const ScratchFolder folder;
    const Imath::Box2i window({-7, -2}, {13, 2});
    Imf::Header header(window, window);
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    header.setTileDescription(Imf::TileDescription(8, 4, Imf::MIPMAP_LEVELS));
    {
        std::vector<Imath::half> pixels;
        Imf::TiledOutputFile file((folder / "a.exr").c_str(), header);
        writeHalves(file, pixels, window);
        for (int level = 0; level < file.numLevels(); ++level) {
            file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
        }
    }
    expectHalves(readExr(folder / "a.exr"));
}

TEST(Exr, RefusesWhatItCannotReadWhole)
{
    const ScratchFolder folder;
    auto expectUnreadable = [&](const char* name, MessageId id) {
        expectRefusal<InputError>([&] { readExr(folder / name); }, id, {.file = folder / name});
    };
    expectUnreadable("missing.exr", MessageId::FileMissing);
    std::filesystem::create_directory(folder / "folder.exr");
    expectUnreadable("folder.exr", MessageId::WrongType);
    writeText(folder / "empty.exr", "");
    expectUnreadable("empty.exr", MessageId::UnknownFormat);
    writeText(folder / "text.exr", "P6 1 1 255 abc");
    expectUnreadable("text.exr", MessageId::UnknownFormat);
}

TEST(Exr, RefusesEveryTruncation)
{
    const ScratchFolder folder;
    Image image;
    image.width = image.height = 40;
    for (int i = 0; i < 1600; ++i) {
        image.channels["R"].push_back(static_cast<float>(i * 7919 % 1601));
    }
    writeExr(folder / "a.exr", image);
    const std::string bytes = readFileBytes(folder / "a.exr");
    for (std::size_t length = 4; length < bytes.size(); length += 37) {
        writeText(folder / "cut.exr", bytes.substr(0, length));
        EXPECT_THROW(readExr(folder / "cut.exr"), InputError) << length << " of " << bytes.size();
    }
}

// The last column and row that a header names, at the end of its data window.
void claimCorner(std::string& bytes, std::int32_t x, std::int32_t y)
{
    const std::string name("dataWindow\0box2i\0", 17);
    const std::size_t corner = bytes.find(name) + name.size() + 4 + 8;
    std::memcpy(&bytes[corner], &x, sizeof x);
    std::memcpy(&bytes[corner + 4], &y, sizeof y);
}

TEST(Exr, RefusesDamagedWindowsBeforeTheyCostMemory)
{
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
                                               Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION}) {
        const ScratchFolder folder;
        Imf::Header header(40, 40);
        header.compression() = compression;
        const std::vector<float> pixels(1600);
        Imf::FrameBuffer frame;
        for (const char* name : {"R", "G", "B"}) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            frame.insert(name, Imf::Slice::Make(Imf::FLOAT, pixels.data(), {0, 0}, 40, 40));
        }
        {
            Imf::OutputFile file((folder / "a.exr").c_str(), header);
            file.setFrameBuffer(frame);
            file.writePixels(40);
        }
        const std::string sound = readFileBytes(folder / "a.exr");
        const std::pair<std::int32_t, std::int32_t> corners[] = {
            {1 << 17, 39}, {39, 1 << 17}, {1 << 20, 1 << 10}, {39, 0x7ffffffe}, {0x7ffffffe, 39}};
        for (const auto& [x, y] : corners) {
            std::string bytes = sound;
            claimCorner(bytes, x, y);
            writeText(folder / "a.exr", bytes);
            EXPECT_THROW(readExr(folder / "a.exr"), InputError) << compression << ": " << x << " " << y;
            EXPECT_THROW(readRadianceMap(folder / "a.exr"), InputError) << compression << ": " << x << " " << y;
        }
    }
}

// OpenEXR would allocate what the attribute's size says, or read the next attribute at a wrong place and allocate what it says.
TEST(Exr, RefusesAttributesThatLieAboutTheirSize)
{
    using namespace std::string_literals;
    const ScratchFolder folder;
    writeExr(folder / "good.exr", makeImage());
    const std::string good = readFileBytes(folder / "good.exr");
    const auto expectRefused = [&](const std::string& name, std::size_t byte, char value, const test::Parts& parts) {
        std::string bytes = good;
        bytes[bytes.find(name) + name.size() + byte] = value;
        writeText(folder / "bad.exr", bytes);
        expectRefusal<InputError>([&] { readExr(folder / "bad.exr"); }, MessageId::FileDamaged, parts);
        expectRefusal<InputError>([&] { readExrHeader(folder / "bad.exr"); }, MessageId::FileDamaged, parts);
        expectRefusal<InputError>([&] { readRadianceMap(folder / "bad.exr"); }, MessageId::FileDamaged, parts);
    };
    expectRefused("glim:scene\0string\0"s, 3, 0x7f, {"bad.exr", "glim:scene", "2130706439", "at most the "});
    expectRefused("dataWindow\0box2i\0"s, 0, 15, {"bad.exr", "dataWindow", "15"});
    expectRefused("channels\0chlist\0"s, 0, 20, {"bad.exr", "channels", "20"});
}

TEST(Exr, RefusesAFileWhoseWriterStoppedEarly)
{
    const ScratchFolder folder;
    Imf::Header header(4, 40);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    const std::vector<float> pixels(160);
    {
        Imf::OutputFile file((folder / "a.exr").c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("R", Imf::Slice::Make(Imf::FLOAT, pixels.data(), {0, 0}, 4, 40));
        file.setFrameBuffer(frame);
        file.writePixels(20);
    }
    expectRefusal<InputError>([&] { readExr(folder / "a.exr"); }, MessageId::FileDamaged, {.file = "a.exr", .value = "incomplete"});
}

TEST(Exr, RefusesSubsampledChannels)
{
    const ScratchFolder folder;
    Imf::Header header(4, 4);
    header.channels().insert("RY", Imf::Channel(Imf::FLOAT, 2, 2));
    const float pixels[4] = {};
    {
        Imf::OutputFile file((folder / "a.exr").c_str(), header);
        Imf::FrameBuffer frame;
        frame.insert("RY", Imf::Slice::Make(Imf::FLOAT, pixels, {0, 0}, 4, 4, 4, 8, 2, 2));
        file.setFrameBuffer(frame);
        file.writePixels(4);
    }
    expectRefusal<InputError>([&] { readExr(folder / "a.exr"); }, MessageId::Unsupported, {.file = "a.exr", .place = "RY"});
}

TEST(Exr, AFailedWriteLeavesTheOldFile)
{
    const ScratchFolder folder;
    writeExr(folder / "a.exr", makeImage());
    const std::string before = readFileBytes(folder / "a.exr");
    Image broken;  // OpenEXR refuses an image without pixels
    EXPECT_THROW(writeExr(folder / "a.exr", broken), InputError);
    EXPECT_EQ(readFileBytes(folder / "a.exr"), before);
    EXPECT_EQ(folder.entries(), 1);
}

}  // namespace
}  // namespace glim
