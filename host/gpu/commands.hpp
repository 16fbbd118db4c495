// A list of dispatches, run once. Synchronisation has its home here: a full barrier between any two commands.
#pragma once

#include "host/gpu/kernel.hpp"
#include "host/gpu/storage_image.hpp"

namespace glim {

struct KernelTime {
    std::string kernel;
    double seconds;
};

class Commands {
public:
    explicit Commands(const Device& device);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    // `push` holds exactly the layout's push constants; `groups` workgroups along x.
    void dispatch(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push,
                  std::uint32_t groups);
    // As dispatch, the three group counts read from `arguments` at `offset` bytes when it runs.
    void dispatchIndirect(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push,
                          const Buffer& arguments, std::uint64_t offset);
    void fillWithZero(const Buffer& buffer);
    // From `offset` in the source to the start of the target, bytes.
    void copy(VkBuffer source, std::uint64_t offset, VkBuffer target, std::uint64_t bytes);
    // Makes it black, and ready for kernels.
    void clear(const StorageImage& image);
    // Stretches `image` over `target`, a swapchain's image of this size, and makes it ready to present.
    void blit(const StorageImage& image, VkImage target, VkExtent2D size);

    // Runs everything recorded and waits for it; then the object is spent. Signals `done` too, if given. Throws DeviceError if
    // the device fails or the validation layers have spoken.
    void submitAndWait(VkSemaphore done = VK_NULL_HANDLE);

    // Device seconds of each dispatch in order; empty without timestamps. After submitAndWait.
    std::vector<KernelTime> times() const;

private:
    void begin(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push);
    void end(const Kernel& kernel);
    void barrier();
    void transition(VkImage image, VkImageLayout from, VkImageLayout to);

    // Dispatches that one object times; further ones run untimed.
    static constexpr std::uint32_t kMaxTimed = 1024;

    const Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer buffer_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    std::vector<std::string> timed_;  // kernel names, one per timed dispatch
};

}  // namespace glim
