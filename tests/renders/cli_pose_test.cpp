// Poses and times on the command line.
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

using nlohmann::json;

class CommandLinePoseTest : public ::testing::Test {
protected:
    // A triangle that grows from 1 m to 3 m in two seconds, and a skin that nobody wears.
    void SetUp() override
    {
        GltfBuilder builder;
        builder.addNode({{"mesh", builder.addTriangleMesh()}});
        builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
        builder.addNode({{"camera", 0}, {"translation", {0, 0, 5}}});
        builder.append("skins", {{"joints", {0}}});
        const std::size_t times = builder.addAccessor(toBytes<float>({0, 2}), kFloat, "SCALAR", 2);
        builder.append("animations", {{"name", "grow"},
                                      {"samplers", {{{"input", times}, {"output", builder.addVec3({1, 1, 1, 3, 3, 3})}}}},
                                      {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
        writeText(folder_ / "scene.gltf", builder.toGltf());
    }
    GlimRun run(const std::vector<std::string>& arguments) const
    {
        GlimCall call;
        call.arguments = arguments;
        call.folder = folder_.path();
        return runForMessages(call);
    }
    void render(const std::string& at, const std::string& samples, const std::string& output) const
    {
        const GlimRun done = run({"render", "scene.gltf", "--at", at, "--samples", samples, "--size", "8x8", "-o", output});
        EXPECT_EQ(done.exitCode, 0) << done.err;
    }

    ScratchFolder folder_;
};

TEST_F(CommandLinePoseTest, InspectListsAnimationsAndPosesTheScene)
{
    const GlimRun rest = run({"inspect", "scene.gltf"});
    EXPECT_NE(rest.out.find("  animation 0 \"grow\", 2 s\n"), std::string::npos) << rest.out;
    EXPECT_NE(rest.out.find("  skins 1\n  morph targets 0\n"), std::string::npos) << rest.out;
    const auto isRestPose = [](const Said& said) {
        return said.message.id == MessageId::RestPose && said.message.value == "0 (\"grow\", 2 s)";
    };
    EXPECT_TRUE(std::ranges::any_of(findMessages(rest.err), isRestPose)) << rest.err;
    const json posed = json::parse(run({"inspect", "scene.gltf", "--json", "--at", "1", "--animation", "grow"}).out);
    EXPECT_EQ(posed.at("animations"), json::array({{{"name", "grow"}, {"seconds", 2}}}));
    EXPECT_EQ(posed.at("bounds").at("high"), json::array({2, 2, 0}));
}

TEST_F(CommandLinePoseTest, FilmsOfTwoTimesAreNotMerged)
{
    render("1", "0:2", "a.exr");
    render("1", "2:4", "b.exr");
    render("1.5", "2:4", "c.exr");
    EXPECT_EQ(run({"merge", "a.exr", "b.exr", "-o", "m.exr"}).exitCode, 0);
    const GlimRun refused = run({"merge", "a.exr", "c.exr", "-o", "m.exr"});
    expectRefused(refused, 1, MessageId::Mismatch, {.file = "c.exr"});
}

TEST_F(CommandLinePoseTest, AnAnimationNeedsATime)
{
    const GlimRun refused = run({"render", "scene.gltf", "--animation", "grow", "-o", "x.exr"});
    expectRefused(refused, 2, MessageId::Requires, {.place = "--animation", .value = "grow", .expected = "--at"});
}

}  // namespace
}  // namespace glim::test
