// Several pictures by one call: frames, turntables and lists of cameras.
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

using nlohmann::json;

class SequenceTest : public ::testing::Test {
protected:
    // A triangle that grows from 1 m to 3 m in two seconds. No camera, if `cameras` is 0.
    void writeScene(int cameras)
    {
        GltfBuilder builder;
        const std::size_t mesh = builder.addTriangleMesh();
        builder.append("materials", {{"doubleSided", true}});  // cameras go around it
        builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
        builder.addNode({{"mesh", mesh}});
        for (int i = 0; i < cameras; ++i) {
            builder.append(
                "cameras",
                {{"name", "camera " + std::to_string(i)}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
            builder.addNode({{"camera", i}, {"translation", {0.5 * i, 0.25, 5 - i}}});
        }
        const std::size_t times = builder.addAccessor(toBytes<float>({0, 2}), kFloat, "SCALAR", 2);
        builder.append("animations", {{"name", "grow"},
                                      {"samplers", {{{"input", times}, {"output", builder.addVec3({1, 1, 1, 3, 3, 3})}}}},
                                      {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
        writeText(folder_ / "scene.gltf", builder.toGltf());
    }
    GlimRun run(std::vector<std::string> arguments) const
    {
        GlimCall call;
        call.arguments = {"render", "scene.gltf", "--size", "12x8"};
        call.arguments.insert(call.arguments.end(), arguments.begin(), arguments.end());
        call.folder = folder_.path();
        return runForMessages(call);
    }
    GlimRun expectDone(const std::vector<std::string>& arguments) const
    {
        GlimRun done = run(arguments);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return done;
    }
    Film film(const char* name) const { return readFilm(folder_ / name); }
    json statistics(const char* name) const { return json::parse(readFileBytes(folder_ / name)); }
    // Whether two films are of the same scene and have the same bits.
    void expectSame(const char* a, const char* b) const
    {
        const Film one = film(a), other = film(b);
        EXPECT_TRUE(sameBits(one.pixels, other.pixels)) << a << ", " << b;
        EXPECT_EQ(one.identity.scene, other.identity.scene) << a << ", " << b;
        EXPECT_EQ(one.identity.settings, other.identity.settings) << a << ", " << b;
    }

    ScratchFolder folder_;
};

TEST_F(SequenceTest, FramesAreThePicturesOfTheirTimes)
{
    writeScene(1);
    expectDone({"--frames", "0:10:5", "--fps", "10", "--spp", "2", "-o", "f.###.exr", "--png", "p#.png", "--stats", "s.##.json"});
    EXPECT_EQ(folder_.entries(), 1 + 3 * 3);
    int i = 0;
    for (const auto& [at, name, stats] :
         {std::tuple("0", "f.000.exr", "s.00.json"), {"0.5", "f.005.exr", "s.05.json"}, {"1", "f.010.exr", "s.10.json"}}) {
        expectDone({"--at", at, "--spp", "2", "-o", "one.exr", "--stats", "one.json"});
        expectSame(name, "one.exr");
        // Counters begin anew with each picture.
        EXPECT_EQ(statistics(stats).at("rays"), statistics("one.json").at("rays")) << name;
        EXPECT_EQ(statistics(stats).at("samples"), 12 * 8 * 2);
        EXPECT_TRUE(std::filesystem::exists(folder_.path() / ("p" + std::to_string(5 * i++) + ".png")));
    }
    EXPECT_FALSE(sameBits(film("f.000.exr").pixels, film("f.010.exr").pixels));
}

TEST_F(SequenceTest, OfPicturesAlone)
{
    writeScene(1);
    expectDone({"--frames", "0:1", "--spp", "2", "-o", "p.##.png"});
    EXPECT_EQ(folder_.entries(), 1 + 2);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "p.01.png"));
}

// The material is diffuse alone at first, then also metal, which other kernels draw.
TEST_F(SequenceTest, KernelsAreThoseThatEachPictureNeeds)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    builder.append("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
                                 {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
    const std::size_t times = builder.addAccessor(toBytes<float>({0, 1}), kFloat, "SCALAR", 2);
    const std::size_t values = builder.addAccessor(toBytes<float>({0, 1}), kFloat, "SCALAR", 2);
    const json pointer = {{"pointer", "/materials/0/pbrMetallicRoughness/metallicFactor"}};
    builder.append(
        "animations",
        {{"samplers", {{{"input", times}, {"output", values}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", pointer}}}}}}}}});
    builder.document["extensionsUsed"] = {"KHR_animation_pointer", "KHR_materials_specular"};
    writeText(folder_ / "scene.gltf", builder.toGltf());
    expectDone({"--frames", "0:1", "--fps", "1", "--spp", "8", "-o", "f#.exr"});
    for (const char* second : {"0", "1"}) {
        expectDone({"--at", second, "--spp", "8", "-o", "one.exr"});
        expectSame(("f" + std::string(second) + ".exr").c_str(), "one.exr");
    }
}

TEST_F(SequenceTest, OfOnePictureToo)
{
    writeScene(1);
    const std::vector<std::string> frame{"--frames", "3:3", "--spp", "2", "-o", "f#.exr"};
    expectDone(frame);
    EXPECT_NE(expectDone(frame).out.find("f3.exr: is whole and was kept\n0 of 1 pictures"), std::string::npos);
}

TEST_F(SequenceTest, WholeFilmsAreKept)
{
    writeScene(1);
    const std::vector<std::string> frames{"--frames", "1:4", "--spp", "3", "-o", "f#.exr", "--png", "f#.png"};
    expectDone(frames);
    const auto written = [this](const char* name) { return std::filesystem::last_write_time(folder_ / name); };
    expectDone({"--at", "0.125", "--spp", "3", "-o", "f3.exr"});                // of the right time
    expectDone({"--at", "0.08333333333333333", "--spp", "2", "-o", "f2.exr"});  // of too few samples
    expectDone({"--at", "0.1", "--spp", "3", "-o", "f4.exr"});                  // of another time
    writeText(folder_ / "f1.exr", "no film");
    const auto third = written("f3.exr");
    const GlimRun again = expectDone(frames);
    EXPECT_NE(again.out.find("3 of 4 pictures rendered in "), std::string::npos) << again.out;
    EXPECT_NE(again.out.find("f3.exr: is whole and was kept\n"), std::string::npos) << again.out;
    EXPECT_EQ(written("f3.exr"), third);
    expectDone({"--at", "0.041666666666666664", "--spp", "3", "-o", "one.exr"});
    expectSame("f1.exr", "one.exr");

    Film older = film("f3.exr");
    older.identity.kernels = "0123456789abcdef";
    writeFilm(folder_ / "f3.exr", older);
    EXPECT_NE(expectDone(frames).out.find("1 of 4 pictures"), std::string::npos) << "a film of other kernels has other bits";

    std::filesystem::remove(folder_ / "f2.png");
    EXPECT_NE(expectDone(frames).out.find("0 of 4 pictures"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "f2.png"));
    for (const std::vector<std::string>& other :
         std::vector<std::vector<std::string>>{{"--bounces", "3"}, {"--seed", "1"}, {"--environment", "1,2,3"}, {"--stats", "s#.json"}}) {
        std::vector<std::string> changed = frames;
        changed.insert(changed.end(), other.begin(), other.end());
        EXPECT_NE(expectDone(changed).out.find("4 of 4 pictures"), std::string::npos) << other[0];
    }
}

// What the camera sees at the end is larger than the picture: the camera is the one of the rest pose.
TEST_F(SequenceTest, AFramedCameraStaysWhereItIs)
{
    writeScene(0);
    expectDone({"--frames", "0:2:2", "--fps", "1", "--spp", "16", "--view", "depth", "-o", "f#.exr"});
    const Film begin = film("f0.exr"), end = film("f2.exr");
    const auto covered = [](const Film& film) {
        return std::count_if(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& pixel) { return pixel.alpha > 0.5F; });
    };
    EXPECT_GT(covered(begin), 12 * 8 / 10);
    EXPECT_GT(covered(end), 2 * covered(begin));
    expectDone({"--at", "2", "--spp", "16", "--view", "depth", "-o", "one.exr"});
    expectSame("f2.exr", "one.exr");
}

TEST_F(SequenceTest, TurntablesGoAroundTheScene)
{
    writeScene(1);
    expectDone({"--turntable", "4", "--spp", "16", "--view", "normal", "-o", "t#.exr"});
    for (const char* name : {"t0.exr", "t1.exr", "t2.exr", "t3.exr"}) {
        const std::vector<PixelMoments> pixels = film(name).pixels;
        EXPECT_FALSE(std::all_of(pixels.begin(), pixels.end(), [](const PixelMoments& pixel) { return pixel.alpha == 0.0F; })) << name;
    }
    EXPECT_FALSE(sameBits(film("t0.exr").pixels, film("t1.exr").pixels));
    EXPECT_FALSE(sameBits(film("t0.exr").pixels, film("t2.exr").pixels));
}

TEST_F(SequenceTest, CamerasOfTheFileAreAllRendered)
{
    writeScene(3);
    expectDone({"--camera", "all", "--spp", "2", "-o", "c#.exr", "--stats", "c#.json"});
    for (const char* index : {"0", "1", "2"}) {
        expectDone({"--camera", index, "--spp", "2", "-o", "one.exr", "--stats", "one.json"});
        EXPECT_EQ(statistics(("c" + std::string(index) + ".json").c_str()).at("rays"), statistics("one.json").at("rays")) << index;
        expectSame(("c" + std::string(index) + ".exr").c_str(), "one.exr");
    }
}

TEST_F(SequenceTest, CamerasMayBeListed)
{
    writeScene(2);
    writeText(folder_ / "list.json", R"([{"from": [1, 2, 3], "at": [0, 0, 0], "up": [1, 1, 0], "zoom": 2},
        {"camera": "camera 1"}, {"camera": 1, "matrix": [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 4, 0.5, 0.25, 1]},
        {"yfov": 0.5}])");
    expectDone({"--cameras", "list.json", "--spp", "2", "-o", "c#.exr", "--lens-radius", "0.1", "--focal-distance", "3"});
    const std::vector<std::string> lens{"--spp", "2", "-o", "one.exr", "--lens-radius", "0.1", "--focal-distance", "3"};
    const auto expectPicture = [&](const char* name, std::vector<std::string> options) {
        options.insert(options.end(), lens.begin(), lens.end());
        expectDone(options);
        expectSame(name, "one.exr");
    };
    expectPicture("c0.exr", {"--look-from", "1,2,3", "--look-at", "0,0,0", "--look-up", "1,1,0", "--zoom", "2"});
    expectPicture("c1.exr", {"--camera", "1"});
    expectPicture("c2.exr", {"--camera", "1", "--look-from", "4,0.5,0.25", "--look-at", "3,0.5,0.25"});
    // tan(.5) / tan(.25)
    expectPicture("c3.exr", {"--look-from", "0,0.25,5", "--look-at", "0,0.25,4", "--zoom", "2.139493927324549"});
}

TEST_F(SequenceTest, ListsOfCamerasThatAreWrongAreRefused)
{
    writeScene(1);
    const auto expect = [this](const std::string& list, MessageId id, Parts parts) {
        writeText(folder_ / "list.json", list);
        parts.file = "list.json";
        const GlimRun refused = run({"--cameras", "list.json", "-o", "c#.exr"});
        EXPECT_EQ(refused.exitCode, 1);
        expectSaid(refused, id, parts);
        EXPECT_EQ(folder_.entries(), 2) << "something was written";
    };
    expect("[", MessageId::Malformed, {.value = "2"});
    expect("[]", MessageId::WrongType, {.expected = "at least one camera"});
    expect("[3]", MessageId::WrongType, {.place = "[0]", .value = "3"});
    expect(R"([{}, {"form": [0, 0, 0]}])", MessageId::UnknownName,
           {.place = "[1]", .value = "form", .expected = "camera, from, at, up, zoom, matrix, axes or yfov"});
    expect(R"([{"from": [0, 0, 1]}])", MessageId::Requires, {.place = "[0]", .value = "from and at"});
    expect(R"([{"from": [0, 0], "at": [0, 0, 0]}])", MessageId::WrongType, {.place = "[0].from", .value = "[0,0]"});
    expect(R"([{"zoom": 2}])", MessageId::Requires, {.place = "[0]", .value = "zoom"});
    expect(R"([{"yfov": 4}])", MessageId::OutOfRange, {.place = "[0].yfov", .value = "4"});
    expect(R"([{"camera": 7}])", MessageId::UnknownName, {.place = "[0]", .value = "7", .expected = "0 \"camera 0\""});
    expect(R"([{}, {"from": [1, 1, 1], "at": [1, 1, 1]}])", MessageId::Degenerate, {.place = "[1]", .expected = "another point"});
    expect(R"([{"matrix": [1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1]}])", MessageId::Degenerate, {.place = "[0].matrix"});
}

TEST_F(SequenceTest, OptionsThatContradictEachOtherAreRefused)
{
    writeScene(1);
    const auto expect = [this](const std::vector<std::string>& arguments, MessageId id, const Parts& parts) {
        SCOPED_TRACE(parts.place);
        expectRefused(run(arguments), 2, id, parts);
    };
    expect({"--frames", "2:1", "-o", "f#.exr"}, MessageId::OutOfRange, {.place = "--frames", .value = "2:1"});
    expect({"--frames", "1:2", "-o", "f.exr"}, MessageId::Conflict, {.place = "--output", .value = "f.exr"});
    expect({"--frames", "1:2", "-o", "f#.exr", "--image", "f.jpg"}, MessageId::Conflict, {.place = "--image", .value = "f.jpg"});
    expect({"--frames", "1:2", "-o", "f#.exr", "--png", "#-#.png"}, MessageId::Conflict, {.place = "--image", .value = "#-#.png"});
    expect({"--frames", "1:2", "--at", "1", "-o", "f#.exr"}, MessageId::Conflict, {.place = "--at", .value = "--frames"});
    expect({"--frames", "1:2", "--turntable", "3", "-o", "f#.exr"}, MessageId::Conflict, {.place = "--frames", .value = "--turntable"});
    expect({"--frames", "1:2", "--camera", "all", "-o", "f#.exr"}, MessageId::Conflict,
           {.place = "--frames", .value = "1:2", .expected = "--camera"});
    expect({"--turntable", "3", "--camera", "0", "-o", "f#.exr"}, MessageId::Conflict, {.place = "--camera", .value = "--turntable"});
    expect({"--frames", "1:20", "-o", "f#.exr", "--ids", "f##.exr"}, MessageId::Duplicate, {.place = "--ids", .value = "f##.exr"});
    expect({"--fps", "3", "-o", "f.exr"}, MessageId::Requires, {.place = "--fps", .expected = "--frames"});
    expect({"--camera", "all", "--replay", "1,1,1"}, MessageId::Conflict, {.place = "--replay"});
}

TEST_F(SequenceTest, ProgressSaysWhichPicture)
{
    writeScene(1);
    const GlimRun done = expectDone({"--frames", "0:2", "--spp", "2", "--progress", "json", "-o", "f#.exr"});
    const std::string last = done.err.substr(done.err.rfind('{', done.err.size() - 3));
    const json line = json::parse(done.err.substr(done.err.rfind("{\"picture\"")));
    EXPECT_EQ(line.at("picture"), 3) << last;
    EXPECT_EQ(line.at("pictures"), 3);
    EXPECT_EQ(line.at("etaSeconds"), 0.0);
    EXPECT_EQ(line.at("allEtaSeconds"), 0.0);
    const std::size_t first = done.err.rfind("{\"picture\":1,");
    ASSERT_NE(first, std::string::npos) << done.err;
    const json firstDone = json::parse(done.err.substr(first, done.err.find('\n', first) - first));
    EXPECT_EQ(firstDone.at("etaSeconds"), 0.0);
    EXPECT_GT(firstDone.at("allEtaSeconds"), 0.0);
}

}  // namespace
}  // namespace glim::test
