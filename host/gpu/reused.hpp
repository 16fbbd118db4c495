// What one submission leaves to the next: making these objects takes longer than many a submission.
#pragma once

#include "host/gpu/owned.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace glim {

// The size of the staging buffer in bytes. A longer copy is made in parts, so that a large scene needs little host memory beside its own.
inline constexpr std::uint64_t kStagingBytes = std::uint64_t{16} << 20;

// The most dispatches of a submission that are timed.
inline constexpr std::uint32_t kMaxTimed = 1024;

struct Submission {
    explicit Submission(const Device& device);

    Owned<VkCommandPool, vkDestroyCommandPool> pool;
    VkCommandBuffer buffer = VK_NULL_HANDLE;  // of the pool
    Owned<VkFence, vkDestroyFence> fence;
    Owned<VkQueryPool, vkDestroyQueryPool> queries;  // none if the device has no timestamps
};

// A buffer in host memory, for copies to and from memory that the host does not map.
class HostBuffer {
public:
    HostBuffer(const Device& device, std::uint64_t size);

    VkBuffer handle() const { return handle_.get(); }
    std::byte* mapped() const { return static_cast<std::byte*>(mapped_); }

private:
    Owned<VkDeviceMemory, vkFreeMemory> memory_;  // outlives the buffer
    Owned<VkBuffer, vkDestroyBuffer> handle_;
    void* mapped_ = nullptr;
};

// The host's copy of a buffer. Each submission that is waited for brings it up to date.
class HostCopy {
public:
    HostCopy(Reused& reused, const Device& device, VkBuffer of, std::uint64_t size);
    ~HostCopy();
    HostCopy(const HostCopy&) = delete;
    HostCopy& operator=(const HostCopy&) = delete;

    void record(VkCommandBuffer commands) const;
    const std::byte* mapped() const { return copy_.mapped(); }

private:
    Reused& reused_;
    VkBuffer of_;
    std::uint64_t size_;
    HostBuffer copy_;
};

class Reused {
public:
    explicit Reused(const Device& device)
        : device_(device)
    {}

    // Ready to be recorded.
    std::unique_ptr<Submission> take();
    // After its end; the first `timed` dispatches were timed.
    void giveBack(std::unique_ptr<Submission> submission, std::uint32_t timed);
    // Of kStagingBytes.
    const HostBuffer& staging();

    const std::vector<const HostCopy*>& hostCopies() const { return hostCopies_; }

private:
    friend class HostCopy;

    const Device& device_;
    std::vector<std::unique_ptr<Submission>> idle_;
    std::optional<HostBuffer> staging_;
    std::vector<const HostCopy*> hostCopies_;
};

}  // namespace glim
