#include "host/gpu/commands.hpp"

#include <cassert>
#include <utility>

namespace glim {
namespace {

constexpr VkPipelineStageFlags kWritingStages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;

}  // namespace

Commands::Commands(const Device& device)
    : device_(device),
      submission_(device.reused().take())
{}

Commands::~Commands()
{
    if (submitted_ && !ended_) {
        vkQueueWaitIdle(device_.queue());
    }
    if (ended_) {
        device_.reused().giveBack(std::move(submission_), static_cast<std::uint32_t>(timed_.size()));
    }
}

void Commands::begin(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push)
{
    assert(push.size() <= kernel.layout().pushSize());
    const VkDescriptorSet set = bindings.set();
    const VkPipelineLayout layout = kernel.layout().pipelineLayout();
    vkCmdBindPipeline(list(), VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
    vkCmdBindDescriptorSets(list(), VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    if (!push.empty()) {
        vkCmdPushConstants(list(), layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, static_cast<std::uint32_t>(push.size()), push.data());
    }
    if (isTimed()) {
        vkCmdWriteTimestamp(list(), VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, submission_->queries.get(),
                            static_cast<std::uint32_t>(2 * timed_.size()));
    }
}

void Commands::end(const Kernel& kernel)
{
    if (isTimed()) {
        vkCmdWriteTimestamp(list(), VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, submission_->queries.get(),
                            static_cast<std::uint32_t>(2 * timed_.size() + 1));
        timed_.push_back(kernel.name());
    }
    barrier();
}

void Commands::barrier()
{
    barrier(kWritingStages | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                                                                      VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                                                                      VK_ACCESS_TRANSFER_WRITE_BIT);
}

// From all that wrote before to what reads in these stages.
void Commands::barrier(VkPipelineStageFlags stages, VkAccessFlags access)
{
    VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    memory.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    memory.dstAccessMask = access;
    vkCmdPipelineBarrier(list(), kWritingStages, stages, 0, 1, &memory, 0, nullptr, 0, nullptr);
}

void Commands::dispatch(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, std::uint32_t groups)
{
    assert(groups <= device_.description().maxGroups);
    begin(kernel, bindings, push);
    vkCmdDispatch(list(), groups, 1, 1);
    end(kernel);
}

void Commands::dispatchIndirect(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, const Buffer& arguments,
                                std::uint64_t offset)
{
    begin(kernel, bindings, push);
    vkCmdDispatchIndirect(list(), arguments.handle(), offset);
    end(kernel);
}

void Commands::write(const Buffer& buffer, std::uint64_t offset, std::span<const std::byte> bytes)
{
    vkCmdUpdateBuffer(list(), buffer.handle(), offset, bytes.size(), bytes.data());
    barrier();
}

void Commands::fillWithZero(const Buffer& buffer)
{
    assert(buffer.size() % 4 == 0);
    vkCmdFillBuffer(list(), buffer.handle(), 0, VK_WHOLE_SIZE, 0);
    barrier();
}

void Commands::copy(VkBuffer source, std::uint64_t sourceOffset, VkBuffer target, std::uint64_t bytes, std::uint64_t targetOffset)
{
    const VkBufferCopy region{sourceOffset, targetOffset, bytes};
    vkCmdCopyBuffer(list(), source, target, 1, &region);
    barrier();
}

// Changes the layout of the whole image, with a full barrier.
void Commands::transition(VkImage image, VkImageLayout from, VkImageLayout to)
{
    VkImageMemoryBarrier change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    change.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    change.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    change.oldLayout = from;
    change.newLayout = to;
    change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    change.image = image;
    change.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(list(), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                         &change);
}

void Commands::clear(const StorageImage& image)
{
    transition(image.handle(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkClearColorValue black{{0.0F, 0.0F, 0.0F, 1.0F}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(list(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
    transition(image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
}

void Commands::blit(const StorageImage& image, VkImage target, VkExtent2D size)
{
    transition(image.handle(), VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    transition(target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {static_cast<std::int32_t>(image.width()), static_cast<std::int32_t>(image.height()), 1};
    region.dstOffsets[1] = {static_cast<std::int32_t>(size.width), static_cast<std::int32_t>(size.height), 1};
    vkCmdBlitImage(list(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                   VK_FILTER_NEAREST);
    transition(image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    transition(target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

// Of all that the host keeps copies of.
void Commands::copyToHost()
{
    for (const HostCopy* each : device_.reused().hostCopies()) {
        each->record(list());
    }
}

void Commands::submit(VkSemaphore done)
{
    copyToHost();
    barrier(VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);  // once: after each dispatch it cost an H100 1 % of a render
    const VkCommandBuffer commands = list();
    check(vkEndCommandBuffer(commands), "end a command buffer");
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    info.signalSemaphoreCount = done == VK_NULL_HANDLE ? 0 : 1;
    info.pSignalSemaphores = &done;
    check(vkQueueSubmit(device_.queue(), 1, &info, submission_->fence.get()), "submit work");
    submitted_ = true;
}

void Commands::wait()
{
    check(vkWaitForFences(device_.handle(), 1, submission_->fence.address(), VK_TRUE, UINT64_MAX), "wait for the device");
    ended_ = true;
    device_.instance().refuseMessages();
}

std::vector<KernelTime> Commands::times() const
{
    std::vector<std::uint64_t> ticks(2 * timed_.size());
    if (!ticks.empty()) {
        check(vkGetQueryPoolResults(device_.handle(), submission_->queries.get(), 0, static_cast<std::uint32_t>(ticks.size()),
                                    ticks.size() * sizeof(ticks[0]), ticks.data(), sizeof(ticks[0]),
                                    VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              "read timestamps");
    }
    std::vector<KernelTime> times;
    for (std::size_t i = 0; i < timed_.size(); ++i) {
        const auto elapsed = static_cast<double>((ticks[2 * i + 1] - ticks[2 * i]) & device_.description().tickMask);
        times.push_back({timed_[i], elapsed * static_cast<double>(device_.description().nanosecondsPerTick) * 1e-9});
    }
    return times;
}

}  // namespace glim
