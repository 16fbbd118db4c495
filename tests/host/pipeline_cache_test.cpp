// Kernels on disk, with a driver that keeps some: the calls below stand before those of the Vulkan library, whose software drivers put
// nothing into a pipeline cache.
#include "host/gpu/pipeline_cache.hpp"

#include "host/gpu/kernel.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace {

struct KeepingDriver {
    std::string read;      // what the last cache was made of
    std::string holds;     // what the cache holds
    int compiled = 0;      // kernels, through a cache
    bool refuses = false;  // every cache
};

KeepingDriver* keepingDriver = nullptr;

constexpr const char* kEmptyCache = "header";

template <class Function>
Function original(const char* name)
{
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

VkResult vkCreatePipelineCache(VkDevice device, const VkPipelineCacheCreateInfo* info, const VkAllocationCallbacks* callbacks,
                               VkPipelineCache* cache)
{
    static const auto next = original<PFN_vkCreatePipelineCache>("vkCreatePipelineCache");
    if (keepingDriver == nullptr) {
        return next(device, info, callbacks, cache);
    }
    if (keepingDriver->refuses) {
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    }
    keepingDriver->read.assign(static_cast<const char*>(info->pInitialData), info->initialDataSize);
    keepingDriver->holds = keepingDriver->read.empty() ? kEmptyCache : keepingDriver->read;
    const VkPipelineCacheCreateInfo none{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    return next(device, &none, callbacks, cache);
}

VkResult vkGetPipelineCacheData(VkDevice device, VkPipelineCache cache, size_t* bytes, void* data)
{
    static const auto next = original<PFN_vkGetPipelineCacheData>("vkGetPipelineCacheData");
    if (keepingDriver == nullptr) {
        return next(device, cache, bytes, data);
    }
    if (data != nullptr) {
        std::memcpy(data, keepingDriver->holds.data(), *bytes);
    }
    *bytes = keepingDriver->holds.size();
    return VK_SUCCESS;
}

VkResult vkCreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count, const VkComputePipelineCreateInfo* infos,
                                  const VkAllocationCallbacks* callbacks, VkPipeline* pipelines)
{
    static const auto next = original<PFN_vkCreateComputePipelines>("vkCreateComputePipelines");
    if (keepingDriver != nullptr && cache != VK_NULL_HANDLE) {
        ++keepingDriver->compiled;
        keepingDriver->holds += " kernel";
    }
    return next(device, cache, count, infos, callbacks, pipelines);
}

}  // extern "C"

namespace glim::test {
namespace {

namespace fs = std::filesystem;

const std::string kOneKernel = "header kernel", kTwoKernels = "header kernel kernel";

TEST(CacheFile, IsOpenedWholeForItsKeyAlone)
{
    const std::string cache("\0code\n", 6);
    const std::string file = sealCache("driver 1", cache);
    ASSERT_EQ(openCache("driver 1", file), cache);
    EXPECT_EQ(openCache("driver 1", sealCache("driver 1", "")), "");
    for (const char* other : {"driver 2", "driver 1 ", "driver ", "", "driver 1\n"}) {
        EXPECT_FALSE(openCache(other, file)) << other;
    }
    for (std::size_t length = 0; length < file.size(); ++length) {
        EXPECT_FALSE(openCache("driver 1", std::string_view(file).substr(0, length))) << length;
    }
    EXPECT_FALSE(openCache("driver 1", file + '\0'));
    for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
        std::string flipped = file;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
        EXPECT_FALSE(openCache("driver 1", flipped)) << bit;
    }
}

class PipelineCacheTest : public testing::Test {
protected:
    PipelineCacheTest()
    {
        keepingDriver = &driver_;
        use(folder_ / "some" / "cache");
    }
    ~PipelineCacheTest() override
    {
        keepingDriver = nullptr;
        setenv("GLIM_CACHE_DIR", "", 1);
    }

    void use(const fs::path& cache)
    {
        cache_ = cache;
        setenv("GLIM_CACHE_DIR", cache.c_str(), 1);
    }
    // What a run of glim does. Returns what the driver was given to read.
    std::string compile(int kernels)
    {
        Device device(instance_);
        compile(device, kernels);
        return driver_.read;
    }
    void compile(const Device& device, int kernels) const
    {
        const KernelLayout layout(device, {{kBindProbed, BufferKind::Readback}}, 0);
        for (int i = 0; i < kernels; ++i) {
            const Kernel kernel(layout, kernels::probe_arithmetic, {{kSpecWorkgroup, 64}});
        }
    }
    std::vector<fs::path> files() const
    {
        std::vector<fs::path> files;
        if (fs::exists(cache_)) {
            for (const fs::directory_entry& entry : fs::directory_iterator(cache_)) {
                if (entry.path().extension() != ".spirv") {  // of kernels before they are compiled
                    files.push_back(entry.path());
                }
            }
        }
        return files;
    }
    // The only one.
    fs::path file() const
    {
        const std::vector<fs::path> all = files();
        EXPECT_EQ(all.size(), 1U);
        return all.empty() ? fs::path() : all[0];
    }

    ScratchFolder folder_;
    fs::path cache_;
    KeepingDriver driver_;
    VulkanInstance instance_;
};

mode_t modeOf(const fs::path& path)
{
    struct stat status = {};
    EXPECT_EQ(stat(path.c_str(), &status), 0) << path;
    return status.st_mode & 07777;
}

ino_t inodeOf(const fs::path& path)
{
    struct stat status = {};
    EXPECT_EQ(stat(path.c_str(), &status), 0) << path;
    return status.st_ino;
}

TEST_F(PipelineCacheTest, HoldsTheKernelsOfTheRunBefore)
{
    EXPECT_EQ(compile(1), "");
    EXPECT_EQ(driver_.compiled, 1) << "kernels are compiled through the cache";
    EXPECT_EQ(modeOf(file()), 0600U);
    EXPECT_EQ(modeOf(cache_), 0700U);
    EXPECT_EQ(modeOf(cache_.parent_path()), 0700U);
    const ino_t written = inodeOf(file());
    EXPECT_EQ(compile(0), kOneKernel);
    EXPECT_EQ(inodeOf(file()), written) << "there was nothing to write";
    EXPECT_EQ(compile(1), kOneKernel);
    EXPECT_EQ(compile(0), kTwoKernels);
}

TEST_F(PipelineCacheTest, IsNotWrittenWithoutKernels)
{
    EXPECT_EQ(compile(0), "");
    EXPECT_TRUE(files().empty());
    EXPECT_FALSE(fs::exists(cache_));
}

TEST_F(PipelineCacheTest, IsWrittenBeforeTheDeviceIsGone)
{
    Device device(instance_);
    compile(device, 1);
    device.pipelines().write();
    const ino_t written = inodeOf(file());
    device.pipelines().write();
    EXPECT_EQ(inodeOf(file()), written);
}

TEST_F(PipelineCacheTest, NoDriverSeesADamagedFile)
{
    compile(1);
    const std::string whole = readFileBytes(file());
    std::string flipped = whole;
    flipped.back() = static_cast<char>(flipped.back() ^ 1);
    std::string foreign = whole;
    foreign.replace(foreign.find("vendor "), 8, "vendor x");
    for (const std::string& damaged : {flipped, foreign, whole.substr(0, whole.size() - 1), std::string(), whole + whole}) {
        writeText(file(), damaged);
        EXPECT_EQ(compile(1), "");
        EXPECT_EQ(readFileBytes(file()), whole) << "it is replaced";
    }
}

TEST_F(PipelineCacheTest, AFileThatOthersMayWriteIsNotRead)
{
    compile(1);
    for (const mode_t others : {S_IWGRP, S_IWOTH}) {
        ASSERT_EQ(chmod(file().c_str(), 0600 | others), 0);
        EXPECT_EQ(compile(1), "");
        EXPECT_EQ(modeOf(file()), 0600U);
    }
}

TEST_F(PipelineCacheTest, WhatIsNotAFileOfOursIsLeftAlone)
{
    compile(1);
    const fs::path path = file();
    const std::string whole = readFileBytes(path);
    const fs::path elsewhere = folder_ / "elsewhere";
    writeText(elsewhere, whole);

    fs::remove(path);
    fs::create_symlink(elsewhere, path);
    EXPECT_EQ(compile(2), "") << "a link is not followed";
    EXPECT_TRUE(fs::is_symlink(path));
    EXPECT_EQ(readFileBytes(elsewhere), whole);

    fs::remove(path);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    EXPECT_EQ(compile(2), "");
    EXPECT_TRUE(fs::is_fifo(path));

    fs::remove(path);
    fs::create_directory(path);
    EXPECT_EQ(compile(2), "");
    EXPECT_TRUE(fs::is_directory(path));
}

TEST_F(PipelineCacheTest, AnotherUsersFolderIsLeftAlone)
{
    if (geteuid() == 0) {
        fs::create_directories(cache_);
        ASSERT_EQ(chown(cache_.c_str(), 1, 1), 0);
    } else {
        use("/");
    }
    const std::size_t before = files().size();
    EXPECT_EQ(compile(1), "");
    EXPECT_EQ(files().size(), before);
}

TEST_F(PipelineCacheTest, WithoutAPlaceKernelsAreCompiledAllTheSame)
{
    writeText(folder_ / "file", "");
    for (const fs::path& nowhere : {fs::path(), folder_ / "file", folder_ / "file" / "cache", fs::path("/proc/glim")}) {
        use(nowhere);
        EXPECT_EQ(compile(1), "") << nowhere;
        EXPECT_EQ(readFileBytes(folder_ / "file"), "");
        EXPECT_EQ(folder_.entries(), 1);
    }
    EXPECT_EQ(driver_.compiled, 4);
    driver_.refuses = true;
    use(folder_ / "cache");
    compile(1);
    EXPECT_EQ(driver_.compiled, 4) << "the driver has no cache";
    EXPECT_FALSE(fs::exists(cache_));
}

TEST_F(PipelineCacheTest, AFullDiskKeepsTheOldFile)
{
    compile(1);
    const std::string before = readFileBytes(file());
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit tiny{1, limit.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &tiny);
    compile(1);
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(readFileBytes(file()), before);
}

TEST_F(PipelineCacheTest, RunsAtTheSameTimeLeaveOneWholeFile)
{
    {
        Device first(instance_);
        compile(first, 1);
        Device second(instance_);
        compile(second, 2);
    }
    EXPECT_EQ(compile(0), kTwoKernels);
}

TEST_F(PipelineCacheTest, TheOldestDriversFilesGoFirst)
{
    fs::create_directories(cache_);
    for (const int age : {1, 2, 3}) {
        const fs::path old = cache_ / ("of driver " + std::to_string(age) + ".kernels");
        writeText(old, "");
        fs::resize_file(old, CacheFile::kMaxBytes / 2 - 4096);
        fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(age));
    }
    writeText(cache_ / "notes.txt", "{}");
    compile(1);
    EXPECT_EQ(files().size(), 4U) << "two old ones, the new one and notes.txt";
    EXPECT_FALSE(fs::exists(cache_ / "of driver 3.kernels"));
    EXPECT_EQ(compile(0), kOneKernel);
}

TEST_F(PipelineCacheTest, TooManyKernelsBeginAnew)
{
    compile(1);
    {
        const Device device(instance_);
        driver_.holds.append(CacheFile::kMaxBytes, 'x');
    }
    EXPECT_TRUE(files().empty());
    EXPECT_EQ(compile(1), "");
    EXPECT_EQ(compile(0), kOneKernel);
}

}  // namespace
}  // namespace glim::test
