// Kernels that are compiled while glim runs.
#include "host/preview/compile_shader.hpp"
#include "host/gpu/replaced_kernels.hpp"
#include "host/gpu/specialize.hpp"
#include "host/preview/stamps.hpp"
#include "kernels.hpp"
#include "places.h"
#include "shaders/shared/bindings.h"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim::test {
namespace {

class CompileShaderTest : public ::testing::Test {
protected:
    CompileShaderTest() { std::filesystem::copy(GLIM_SOURCE_DIR "/shaders", shaders_, std::filesystem::copy_options::recursive); }

    void replace(const std::string& file, const std::string& text, const std::string& by) const
    {
        std::string content = readFileBytes(shaders_ / file);
        const std::size_t at = content.find(text);
        ASSERT_NE(at, std::string::npos) << file << " has no " << text;
        writeText(shaders_ / file, content.replace(at, text.size(), by));
    }
    void expectTrouble(const EmbeddedShader& kernel, const std::string& expected) const
    {
        const CompiledShader made = compileShader(shaders_, kernel);
        EXPECT_EQ(made.words, nullptr);
        EXPECT_EQ(made.trouble, (shaders_ / expected).string());
    }

    ScratchFolder folder_;
    std::filesystem::path shaders_ = folder_ / "my shaders";
};

TEST_F(CompileShaderTest, SameWordsAsTheBuild)
{
    for (const EmbeddedShader& own : {kernels::shade_surface, kernels::accumulate, kernels::preview, kernels::course_bounce}) {
        const CompiledShader made = compileShader(shaders_, own);
        ASSERT_TRUE(made.words) << made.trouble;
        EXPECT_TRUE(std::ranges::equal(*made.words, own.words())) << own.name;
        EXPECT_EQ(made.trouble, "");
    }
    replace("lib/finite.glsl", "\n", "\n// A comment changes no word.\n");
    EXPECT_TRUE(std::ranges::equal(*compileShader(shaders_, kernels::preview).words, kernels::preview.words()));
}

TEST_F(CompileShaderTest, KnowsTheFilesOfAKernel)
{
    replace("kernels/preview.comp", "\"lib/display.glsl\"", "\"lib/my display.glsl\"");
    std::filesystem::copy(shaders_ / "lib/display.glsl", shaders_ / "lib/my display.glsl");
    const std::set<std::filesystem::path> files = compileShader(shaders_, kernels::preview).files;
    for (const char* file : {"kernels/preview.comp", "lib/my display.glsl", "access/display.glsl", "shared/display_types.h"}) {
        EXPECT_TRUE(files.contains(file)) << file;
    }
    EXPECT_FALSE(files.contains("lib/display.glsl"));
    EXPECT_FALSE(files.contains("lib/warp.glsl"));
}

TEST_F(CompileShaderTest, NamesTheLineOfAnError)
{
    replace("kernels/preview.comp", "uint index = ", "uint index = missing + ");
    expectTrouble(kernels::preview, "kernels/preview.comp:24: error: 'missing' : undeclared identifier");
    replace("lib/finite.glsl", "\n", "\n#error not this one\n");
    expectTrouble(kernels::preview, "lib/finite.glsl:2: error: '#error' : not this one");
    replace("lib/finite.glsl", "#error not this one", "float f(");
    const std::string trouble = compileShader(shaders_, kernels::preview).trouble, expected = shaders_ / "lib/finite.glsl:";
    EXPECT_EQ(trouble.substr(0, expected.size()), expected) << trouble;
    EXPECT_NE(trouble.find(": error: syntax error, unexpected "), std::string::npos) << trouble;
}

TEST_F(CompileShaderTest, WhatHasNoLineHasTheKernel)
{
    replace("kernels/preview.comp", "void main()", "void mine()");
    expectTrouble(kernels::preview,
                  "kernels/preview.comp: error: Linking compute stage: Missing entry point: Each stage requires one entry point");
    replace("kernels/preview.comp", "void mine()", "void main()");
    replace("kernels/preview.comp", "vec4(overCheckers(", "vec4(fma(vec3(1.0), vec3(float(pixel)), vec3(1.0)) + overCheckers(");
    expectTrouble(kernels::preview, "kernels/preview.comp: error: uses fma(), which a driver may leave unfused");
    std::filesystem::remove(shaders_ / "kernels/preview.comp");
    expectTrouble(kernels::preview, "kernels: error: there is no preview.comp");
}

// What the host fills must stay as it is. What another kernel of films has, one may take.
TEST_F(CompileShaderTest, RefusesAnotherInterface)
{
    const std::string file = "kernels/preview.comp", need = ", so it needs a build of glim";
    const auto expectMisfit = [&](const std::string& changed, const std::string& text, const std::string& by, const std::string& misfit) {
        replace(changed, text, by);
        expectTrouble(kernels::preview, file + ": error: " + misfit + need);
        replace(changed, by, text);
    };
    const std::string pass = "layout(push_constant, scalar) uniform DisplayBlock { DisplayPass pass; };";
    expectMisfit("access/display.glsl", pass, "layout(push_constant, scalar) uniform DisplayBlock { DisplayPass pass; float more; };",
                 "its push constants have another layout than in the host");
    expectMisfit("access/display.glsl", "local_size_x_id = kSpecWorkgroup", "local_size_x = 64",
                 "its workgroups have another size than in the host");
    expectMisfit("access/display.glsl", "kBindFolded", "99", "binding 99 (filmFoldedBuffer) is unknown to the host");
    expectMisfit(file, "uint index = ", "uint index = uint(double(pixel)) - pixel + ",
                 "SPIR-V's capability 10 is none that the host asks a device for");
    expectMisfit("access/display.glsl", "{ type name[]; }", "{ float more##name; type name[]; }",
                 "binding " + std::to_string(kBindBlocks) + " (filmBlocksBuffer) has another layout than in the host");
    EXPECT_EQ(compileShader(shaders_, kernels::preview).trouble, "");
    replace("kernels/add_splats.comp", "void main()", "#include \"access/light.glsl\"\nvoid main()");
    EXPECT_EQ(compileShader(shaders_, kernels::add_splats).trouble, "");
}

TEST(ReplacedKernelsTest, TakeThePlaceOfOwnOnesUntilTheyAreTakenBack)
{
    constexpr Arithmetic native{.exact = false};
    const std::vector<std::uint32_t> own = specialize(kernels::accumulate, {}, native);
    const std::span<const std::uint32_t> others = kernels::preview.words();
    EXPECT_EQ(replacedVersion(), 0U);
    replaceKernels({{"accumulate", std::make_shared<const std::vector<std::uint32_t>>(others.begin(), others.end())}});
    const std::uint32_t version = replacedVersion();
    EXPECT_NE(version, 0U);
    EXPECT_EQ(specialize(kernels::accumulate, {}, native), specialize(kernels::preview, {}, native));
    replaceKernels(replacedKernels());
    EXPECT_NE(replacedVersion(), version) << "kernels of before do not serve";
    replaceKernels({});
    EXPECT_EQ(replacedVersion(), 0U);
    EXPECT_EQ(specialize(kernels::accumulate, {}, native), own);
}

TEST(StampWatchTest, AChangeIsToRest)
{
    int now = 1;
    const auto read = [&now] { return now; };
    StampWatch<int> watch(std::chrono::milliseconds(0), now);
    EXPECT_FALSE(watch.hasChanged(1, read));
    now = 2;
    EXPECT_FALSE(watch.hasChanged(1, read)) << "may still be written";
    now = 3;
    EXPECT_FALSE(watch.hasChanged(1, read));
    EXPECT_TRUE(watch.hasChanged(1, read));
    EXPECT_EQ(watch.seen(), 3);
    EXPECT_FALSE(watch.hasChanged(3, read));
    StampWatch<int> slow(std::chrono::hours(1), now);
    now = 4;
    for (int i = 0; i < 3; ++i) {
        EXPECT_FALSE(slow.hasChanged(3, read)) << "once in an interval";
    }
}

}  // namespace
}  // namespace glim::test
