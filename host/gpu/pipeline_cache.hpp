// The compiled kernels of a device, kept on disk from one run to the next: in $GLIM_CACHE_DIR, $XDG_CACHE_HOME/glim or ~/.cache/glim. Each
// driver has a file of its own. It begins with the driver's key and a digest, and the driver sees no byte of a file that does not fit both:
// a driver that is handed damaged code may do anything. What is wrong with a file, or keeps it from being written, is no error: the kernels
// are compiled again.
//
// Processes that write at the same time replace each other's files, which are whole at any time. The kernels that the last one did not
// have are compiled and added by the next that needs them.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace glim {

// A cache as a file for the driver of this key, and the cache of such a file. None if the file is damaged or another driver's.
std::string sealCache(std::string_view key, std::string_view cache);
std::optional<std::string_view> openCache(std::string_view key, std::string_view file);

class PipelineCache {
public:
    // The files of all drivers together, in bytes. Those that were written longest ago go first. A driver whose own kernels are more
    // begins with none again.
    static constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20;

    PipelineCache(VkPhysicalDevice physical, VkDevice device);
    // Writes what is new.
    ~PipelineCache();
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

    VkPipelineCache handle() const { return handle_; }

    // Writes the file if kernels have been added since it was read or written.
    void write() noexcept;

private:
    std::size_t size() const;

    VkDevice device_;
    std::string key_;
    std::filesystem::path file_;               // empty where nothing is kept
    VkPipelineCache handle_ = VK_NULL_HANDLE;  // none if the driver could not make one
    std::size_t written_ = 0;                  // bytes that need not be written: what the driver made of the file, or an empty cache
};

}  // namespace glim
