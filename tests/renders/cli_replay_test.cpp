// How a user finds a firefly: render with --suspects, then --replay the sample that it names. And what both refuse.
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>

namespace glim::test {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

GlimRun renderIn(const ScratchFolder& folder, Arguments arguments, const Arguments& more)
{
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), more.begin(), more.end());
    GlimCall call;
    call.arguments = arguments;
    call.folder = folder.path();
    return runForMessages(call);
}

json jsonIn(const ScratchFolder& folder, const char* name) { return json::parse(readFileBytes(folder / name)); }

// The sum, in order and in float32, of what the text says is added; exact numbers make it the bits of the radiance.
glm::vec3 sumOfText(const std::string& text)
{
    static const std::regex kAdds(R"(adds \(([^,]+), ([^,]+), ([^)]+)\))");
    glm::vec3 sum(0.0F);
    for (std::sregex_iterator i(text.begin(), text.end(), kAdds), end; i != end; ++i) {
        sum += glm::vec3(std::stof((*i)[1]), std::stof((*i)[2]), std::stof((*i)[3]));
    }
    return sum;
}

glm::vec3 vectorOf(const json& j) { return {j.at(0).get<float>(), j.at(1).get<float>(), j.at(2).get<float>()}; }

glm::vec3 sumOfJson(const json& path)
{
    glm::vec3 sum(0.0F);
    for (const json& vertex : path.at("vertices")) {
        sum += vectorOf(vertex.at("emission").at("added"));
        for (const json& each : vertex.at("sampledLights")) {
            sum += vectorOf(each.at("added"));
        }
    }
    return sum;
}

void expectNamed(const json& vertex, const std::string& out)
{
    const json& surface = vertex.at("surface");
    if (!surface.is_null()) {
        EXPECT_NE(out.find("bounce " + vertex.at("bounce").dump() + ": " + surface.at("object").get<std::string>()), std::string::npos);
        EXPECT_NE(out.find("material " + surface.at("material").get<std::string>()), std::string::npos);
    }
}

TEST(CommandLineTest, SuspectsAreReplayedToTheSameBits)
{
    const std::vector<std::pair<std::string, Arguments>> cases{
        {"cornell_mirror_glass.gltf", {"--spp", "6"}},
        {"veach_mis.gltf", {"--samples", "30:34", "--direct", "lights"}},
        {"light_spot.gltf", {"--adaptive", "course", "--max-spp", "16", "--batch", "4", "--look-from", "0,1,3", "--look-at", "0,1,0"}}};
    for (const auto& [scene, options] : cases) {
        SCOPED_TRACE(scene);
        const ScratchFolder folder;
        Arguments same{sceneFile(scene), "--size", "24x16", "--seed", "7"};
        same.insert(same.end(), options.begin(), options.end());
        const GlimRun render = renderIn(folder, same, {"-o", "x.exr", "--suspects", "2", "--stats", "s.json"});
        ASSERT_EQ(render.exitCode, 0) << render.err;
        EXPECT_EQ(countLines(render.out), 4U) << render.out;
        const json suspects = jsonIn(folder, "s.json").at("suspects");
        ASSERT_EQ(suspects.size(), 2U);
        double last = 1e30;
        for (const json& suspect : suspects) {
            EXPECT_LE(suspect.at("luminance").get<double>(), last);
            last = suspect.at("luminance");
            const std::string place = suspect.at("replay");
            EXPECT_NE(render.out.find("--replay " + place + "\n"), std::string::npos) << render.out;
            const GlimRun replay = renderIn(folder, same, {"--replay", place, "--stats", "r.json"});
            ASSERT_EQ(replay.exitCode, 0) << replay.err;
            const json path = jsonIn(folder, "r.json");
            EXPECT_EQ(path.at("radiance"), suspect.at("radiance"));
            const glm::vec3 radiance = vectorOf(path.at("radiance"));
            EXPECT_EQ(sumOfText(replay.out), radiance) << replay.out;
            EXPECT_EQ(sumOfJson(path), radiance);
            EXPECT_EQ(path.at("x"), suspect.at("x"));
            EXPECT_EQ(path.at("y"), suspect.at("y"));
            EXPECT_EQ(path.at("sample"), suspect.at("sample"));
            for (const json& vertex : path.at("vertices")) {
                expectNamed(vertex, replay.out);
            }
        }
        EXPECT_EQ(folder.entries(), 3);
    }
}

TEST(CommandLineTest, NoSuspectsUnlessAskedFor)
{
    const ScratchFolder folder;
    const GlimRun run = renderIn(folder, {sceneFile("cornell.gltf"), "--size", "8x8"}, {"--spp", "1", "-o", "x.exr", "--stats", "s.json"});
    EXPECT_EQ(countLines(run.out), 1U) << run.out;
    EXPECT_TRUE(jsonIn(folder, "s.json").at("suspects").is_null());
}

TEST(CommandLineTest, ReplaysOfWhatIsNotThereAreRefused)
{
    const ScratchFolder folder;
    const Arguments scene{sceneFile("cornell.gltf"), "--size", "24x16"};
    const auto expect = [&](const Arguments& options, int exitCode, MessageId id, const Parts& parts) {
        expectRefused(renderIn(folder, scene, options), exitCode, id, parts);
    };
    const std::string inside = "X from 0 to 23 and Y from 0 to 15";
    expect({"--replay", "24,0,0"}, 1, MessageId::OutOfRange, {{}, "--replay", "24,0", inside});
    expect({"--replay", "0,16,0"}, 1, MessageId::OutOfRange, {{}, "--replay", "0,16", inside});
    expect({"--replay", "0,0"}, 2, MessageId::Malformed, {{}, "--replay", "0,0", "SAMPLE from 0 to 2147483647"});
    expect({"--replay", "0,0,4", "--spp", "4"}, 2, MessageId::OutOfRange, {{}, "--replay", "0,0,4", "0 to 3"});
    expect({"--replay", "0,0,0", "-o", "x.exr"}, 2, MessageId::Conflict, {.place = "--output", .value = "x.exr"});
    expect({"--replay", "0,0,0", "--stats", "r.txt"}, 2, MessageId::UnknownFormat, {.file = "r.txt", .expected = ".json"});
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace glim::test
