// A list of commands for the device, run once, in their order. All synchronisation is made here: a full barrier follows every command.
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

    // `push` holds the first of the layout's push constants, as many as the kernel reads; `groups` workgroups along x.
    void dispatch(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, std::uint32_t groups);
    // As dispatch, but the device reads the three group counts from `arguments`, `offset` bytes from its start.
    void dispatchIndirect(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, const Buffer& arguments,
                          std::uint64_t offset);
    // `bytes`: a multiple of 4, at most 64 KiB, as is the offset.
    void write(const Buffer& buffer, std::uint64_t offset, std::span<const std::byte> bytes);
    // The buffer's size must be a multiple of 4 bytes.
    void fillWithZero(const Buffer& buffer);
    // Offsets and size are in bytes.
    void copy(VkBuffer source, std::uint64_t sourceOffset, VkBuffer target, std::uint64_t bytes, std::uint64_t targetOffset = 0);
    // Fills the image with black and brings it into the layout that kernels expect.
    void clear(const StorageImage& image);
    // Scales `image` to `target`, a swapchain image of this size, and brings the target into the layout of a colour attachment.
    void blit(const StorageImage& image, VkImage target, VkExtent2D size);
    // Calls `write` with the command buffer, for libraries that write into one. They see to their own synchronisation.
    template <class Write>
    void record(Write&& write)
    {
        write(list());
    }

    // Lets the device run all commands, once those submitted before have ended. It may be called once. `done`, if given, is signalled
    // at their end.
    void submit(VkSemaphore done = VK_NULL_HANDLE);
    bool isSubmitted() const { return submitted_; }
    // Waits for their end. Throws DeviceError if the device fails or the validation layers have printed a message.
    void wait();
    void submitAndWait(VkSemaphore done = VK_NULL_HANDLE)
    {
        submit(done);
        wait();
    }

    // The device time of each dispatch, in their order, kMaxTimed at most; empty if the device has no timestamps. To be called after
    // wait.
    std::vector<KernelTime> times() const;

private:
    void begin(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push);
    void end(const Kernel& kernel);
    void barrier();
    void barrier(VkPipelineStageFlags stages, VkAccessFlags access);
    void transition(VkImage image, VkImageLayout from, VkImageLayout to);

    void copyToHost();
    VkCommandBuffer list() const { return submission_->buffer; }
    bool isTimed() const { return submission_->queries.get() != VK_NULL_HANDLE && timed_.size() < kMaxTimed; }

    const Device& device_;
    std::unique_ptr<Submission> submission_;
    bool submitted_ = false, ended_ = false;
    std::vector<std::string> timed_;  // kernel names, one per timed dispatch
};

}  // namespace glim
