#include "host/gpu/reused.hpp"

#include "host/gpu/buffer.hpp"

#include <utility>

namespace glim {

Submission::Submission(const Device& device)
    : pool(device),
      fence(device),
      queries(device)
{
    VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    poolInfo.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    poolInfo.queueFamilyIndex = device.queueFamily();
    check(vkCreateCommandPool(device.handle(), &poolInfo, nullptr, pool.receive()), "create a command pool");
    VkCommandBufferAllocateInfo bufferInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    bufferInfo.commandPool = pool.get();
    bufferInfo.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    bufferInfo.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle(), &bufferInfo, &buffer), "allocate a command buffer");
    const VkFenceCreateInfo fenceInfo{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device.handle(), &fenceInfo, nullptr, fence.receive()), "create a fence");
    if (device.description().nanosecondsPerTick > 0.0F) {
        VkQueryPoolCreateInfo queryInfo{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        queryInfo.queryType = VK_QUERY_TYPE_TIMESTAMP;
        queryInfo.queryCount = 2 * kMaxTimed;
        check(vkCreateQueryPool(device.handle(), &queryInfo, nullptr, queries.receive()), "create a query pool");
        vkResetQueryPool(device.handle(), queries.get(), 0, 2 * kMaxTimed);
    }
}

HostBuffer::HostBuffer(const Device& device, std::uint64_t size)
    : memory_(device),
      handle_(device)
{
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = size;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    check(vkCreateBuffer(device.handle(), &info, nullptr, handle_.receive()), "create a staging buffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), handle_.get(), &needs);
    VkMemoryPropertyFlags have = 0;
    VkMemoryAllocateInfo allocation{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocation.allocationSize = needs.size;
    allocation.memoryTypeIndex =
        device.findMemoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                              VK_MEMORY_PROPERTY_HOST_CACHED_BIT, &have);
    const VkResult result = vkAllocateMemory(device.handle(), &allocation, nullptr, memory_.receive());
    refuseIfOutOfMemory(result, "copies to and from the device", needs.size, device.description());
    check(result, "allocate a staging buffer");
    check(vkBindBufferMemory(device.handle(), handle_.get(), memory_.get(), 0), "bind a staging buffer");
    check(vkMapMemory(device.handle(), memory_.get(), 0, VK_WHOLE_SIZE, 0, &mapped_), "map a staging buffer");
}

HostCopy::HostCopy(Reused& reused, const Device& device, VkBuffer of, std::uint64_t size)
    : reused_(reused),
      of_(of),
      size_(size),
      copy_(device, size)
{
    reused_.hostCopies_.push_back(this);
}

HostCopy::~HostCopy() { std::erase(reused_.hostCopies_, this); }

void HostCopy::record(VkCommandBuffer commands) const
{
    const VkBufferCopy region{0, 0, size_};
    vkCmdCopyBuffer(commands, of_, copy_.handle(), 1, &region);
}

std::unique_ptr<Submission> Reused::take()
{
    std::unique_ptr<Submission> taken;
    if (idle_.empty()) {
        taken = std::make_unique<Submission>(device_);
    } else {
        taken = std::move(idle_.back());
        idle_.pop_back();
    }
    VkCommandBufferBeginInfo beginInfo{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    beginInfo.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(taken->buffer, &beginInfo), "begin a command buffer");
    return taken;
}

void Reused::giveBack(std::unique_ptr<Submission> submission, std::uint32_t timed)
{
    if (timed > 0) {
        vkResetQueryPool(device_.handle(), submission->queries.get(), 0, 2 * timed);
    }
    if (vkResetCommandPool(device_.handle(), submission->pool.get(), 0) == VK_SUCCESS &&
        vkResetFences(device_.handle(), 1, submission->fence.address()) == VK_SUCCESS) {
        idle_.push_back(std::move(submission));
    }
}

const HostBuffer& Reused::staging()
{
    if (!staging_) {
        staging_.emplace(device_, kStagingBytes);
    }
    return *staging_;
}

}  // namespace glim
