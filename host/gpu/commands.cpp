#include "host/gpu/commands.hpp"

#include <cassert>

namespace glim {

Commands::Commands(const Device& device)
    : device_(device),
      pool_(device),
      fence_(device),
      queries_(device)
{
    VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = device.queueFamily();
    check(vkCreateCommandPool(device.handle(), &poolInfo, nullptr, pool_.receive()), "create a command pool");
    VkCommandBufferAllocateInfo bufferInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    bufferInfo.commandPool = pool_.get();
    bufferInfo.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    bufferInfo.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle(), &bufferInfo, &buffer_), "allocate a command buffer");
    const VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device.handle(), &fenceInfo, nullptr, fence_.receive()), "create a fence");
    VkCommandBufferBeginInfo beginInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    beginInfo.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(buffer_, &beginInfo), "begin a command buffer");
    if (device.description().nanosecondsPerTick > 0.0F) {
        VkQueryPoolCreateInfo queryInfo{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        queryInfo.queryType = VK_QUERY_TYPE_TIMESTAMP;
        queryInfo.queryCount = 2 * kMaxTimed;
        check(vkCreateQueryPool(device.handle(), &queryInfo, nullptr, queries_.receive()), "create a query pool");
        vkResetQueryPool(device.handle(), queries_.get(), 0, 2 * kMaxTimed);
    }
}

void Commands::begin(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push)
{
    assert(push.size() <= kernel.layout().pushSize());
    const VkDescriptorSet set = bindings.set();
    const VkPipelineLayout layout = kernel.layout().pipelineLayout();
    vkCmdBindPipeline(buffer_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
    vkCmdBindDescriptorSets(buffer_, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set, 0, nullptr);
    if (!push.empty()) {
        vkCmdPushConstants(buffer_, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, static_cast<std::uint32_t>(push.size()), push.data());
    }
    if (queries_.get() != VK_NULL_HANDLE && timed_.size() < kMaxTimed) {
        vkCmdWriteTimestamp(buffer_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_.get(), static_cast<std::uint32_t>(2 * timed_.size()));
    }
}

void Commands::end(const Kernel& kernel)
{
    if (queries_.get() != VK_NULL_HANDLE && timed_.size() < kMaxTimed) {
        vkCmdWriteTimestamp(buffer_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_.get(),
                            static_cast<std::uint32_t>(2 * timed_.size() + 1));
        timed_.push_back(kernel.name());
    }
    barrier();
}

void Commands::barrier()
{
    const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    memory.srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
    memory.dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT |
                           VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(buffer_, stages, stages | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &memory, 0,
                         nullptr, 0, nullptr);
}

void Commands::dispatch(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, std::uint32_t groups)
{
    assert(groups <= device_.description().maxGroups);
    begin(kernel, bindings, push);
    vkCmdDispatch(buffer_, groups, 1, 1);
    end(kernel);
}

void Commands::dispatchIndirect(const Kernel& kernel, const Bindings& bindings, std::span<const std::byte> push, const Buffer& arguments,
                                std::uint64_t offset)
{
    begin(kernel, bindings, push);
    vkCmdDispatchIndirect(buffer_, arguments.handle(), offset);
    end(kernel);
}

void Commands::fillWithZero(const Buffer& buffer)
{
    assert(buffer.size() % 4 == 0);
    vkCmdFillBuffer(buffer_, buffer.handle(), 0, VK_WHOLE_SIZE, 0);
    barrier();
}

void Commands::copy(VkBuffer source, std::uint64_t sourceOffset, VkBuffer target, std::uint64_t bytes, std::uint64_t targetOffset)
{
    const VkBufferCopy region{sourceOffset, targetOffset, bytes};
    vkCmdCopyBuffer(buffer_, source, target, 1, &region);
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
    vkCmdPipelineBarrier(buffer_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                         &change);
}

void Commands::clear(const StorageImage& image)
{
    transition(image.handle(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    const VkClearColorValue black{{0.0F, 0.0F, 0.0F, 1.0F}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(buffer_, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
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
    vkCmdBlitImage(buffer_, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                   VK_FILTER_NEAREST);
    transition(image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_GENERAL);
    transition(target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}

void Commands::submitAndWait(VkSemaphore done)
{
    check(vkEndCommandBuffer(buffer_), "end a command buffer");
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1;
    info.pCommandBuffers = &buffer_;
    info.signalSemaphoreCount = done == VK_NULL_HANDLE ? 0 : 1;
    info.pSignalSemaphores = &done;
    check(vkQueueSubmit(device_.queue(), 1, &info, fence_.get()), "submit work");
    check(vkWaitForFences(device_.handle(), 1, fence_.address(), VK_TRUE, UINT64_MAX), "wait for the device");
    device_.instance().refuseMessages();
}

std::vector<KernelTime> Commands::times() const
{
    std::vector<std::uint64_t> ticks(2 * timed_.size());
    if (!ticks.empty()) {
        check(vkGetQueryPoolResults(device_.handle(), queries_.get(), 0, static_cast<std::uint32_t>(ticks.size()),
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
