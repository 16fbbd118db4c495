// The kernels' SPIR-V that a run keeps for the next one.
#include "host/render/film_file.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <map>

namespace glim::test {
namespace {

namespace fs = std::filesystem;

class KernelCacheTest : public testing::Test {
protected:
    // The film of a run with this folder, and these variables besides.
    Film render(const std::map<std::string, std::string>& more = {}, const std::string& scene = "cornell.gltf")
    {
        GlimCall call;
        call.arguments = {"render", sceneFile(scene), "-o", "f.exr", "--size", "16x16", "--spp", "1"};
        call.environment["GLIM_CACHE_DIR"] = (folder_ / "cache").string();
        for (const auto& [name, value] : more) {
            call.environment[name] = value;
        }
        call.folder = folder_.path();
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return readFilm(folder_ / "f.exr");
    }
    // The files of kernels, with their numbers: another one has another.
    std::map<fs::path, ino_t> files() const
    {
        std::map<fs::path, ino_t> files;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "cache")) {
            if (entry.path().extension() == ".spirv") {
                struct stat status = {};
                EXPECT_EQ(stat(entry.path().c_str(), &status), 0);
                files[entry.path()] = status.st_ino;
            }
        }
        return files;
    }

    ScratchFolder folder_;
};

TEST_F(KernelCacheTest, HoldsTheSpirvOfTheRunBefore)
{
    const Film picture = render();
    const auto first = files();
    EXPECT_GT(first.size(), 4U);
    EXPECT_TRUE(sameBits(render(), picture));
    EXPECT_EQ(files(), first) << "there was nothing to make";

    render({{"GLIM_ARITHMETIC", "exact"}});
    auto both = files();
    EXPECT_GT(both.size(), first.size()) << "arithmetic is part of the key";
    for (const auto& [path, inode] : first) {
        EXPECT_EQ(both[path], inode);
    }
    render({{"GLIM_ARITHMETIC", "adverse:1"}});
    EXPECT_EQ(files(), both) << "adverse kernels are not kept";
}

// Kernels of one name, with other constants.
TEST_F(KernelCacheTest, AnotherScenesKernelsAreItsOwn)
{
    render();
    const Film kept = render({}, "light_point.gltf");
    EXPECT_TRUE(sameBits(kept, render({{"GLIM_CACHE_DIR", ""}}, "light_point.gltf")));
}

TEST_F(KernelCacheTest, DamagedFilesAreMadeAgain)
{
    const Film picture = render();
    std::map<fs::path, std::string> whole;
    for (const auto& [path, inode] : files()) {
        whole[path] = readFileBytes(path);
        std::string damaged = whole[path];
        damaged[damaged.size() - 5] = static_cast<char>(damaged[damaged.size() - 5] ^ 1);
        writeText(path, damaged);
    }
    EXPECT_TRUE(sameBits(render(), picture));
    for (const auto& [path, content] : whole) {
        EXPECT_EQ(readFileBytes(path), content) << path;
    }
}

}  // namespace
}  // namespace glim::test
