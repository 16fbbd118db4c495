// A program that links this counts calls: its functions take the place of the loader's, and call them.
#include "tests/support/vulkan_calls.hpp"

#include <dlfcn.h>

#include <vulkan/vulkan.h>

namespace glim::test {
namespace {

VulkanCalls calls;

template <class Function>
Function original(const char* name)
{
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

VulkanCalls vulkanCalls() { return calls; }

}  // namespace glim::test

#define GLIM_COUNT(Result, name, counter, parameters, arguments)               \
    Result name parameters                                                     \
    {                                                                          \
        static const auto next = glim::test::original<decltype(&name)>(#name); \
        ++glim::test::calls.counter;                                           \
        return next arguments;                                                 \
    }

extern "C" {

GLIM_COUNT(VkResult, vkQueueSubmit, submits, (VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence),
           (queue, count, submits, fence))
GLIM_COUNT(VkResult, vkWaitForFences, waits, (VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout),
           (device, count, fences, all, timeout))
GLIM_COUNT(void, vkCmdDispatch, dispatches, (VkCommandBuffer buffer, uint32_t x, uint32_t y, uint32_t z), (buffer, x, y, z))
GLIM_COUNT(void, vkCmdDispatchIndirect, dispatches, (VkCommandBuffer buffer, VkBuffer arguments, VkDeviceSize offset),
           (buffer, arguments, offset))
GLIM_COUNT(void, vkCmdPipelineBarrier, barriers,
           (VkCommandBuffer buffer, VkPipelineStageFlags from, VkPipelineStageFlags to, VkDependencyFlags flags, uint32_t memoryCount,
            const VkMemoryBarrier* memory, uint32_t bufferCount, const VkBufferMemoryBarrier* buffers, uint32_t imageCount,
            const VkImageMemoryBarrier* images),
           (buffer, from, to, flags, memoryCount, memory, bufferCount, buffers, imageCount, images))
GLIM_COUNT(void, vkCmdCopyBuffer, copies,
           (VkCommandBuffer buffer, VkBuffer source, VkBuffer target, uint32_t count, const VkBufferCopy* regions),
           (buffer, source, target, count, regions))
GLIM_COUNT(VkResult, vkCreateCommandPool, objects,
           (VkDevice device, const VkCommandPoolCreateInfo* info, const VkAllocationCallbacks* callbacks, VkCommandPool* pool),
           (device, info, callbacks, pool))
GLIM_COUNT(VkResult, vkCreateFence, objects,
           (VkDevice device, const VkFenceCreateInfo* info, const VkAllocationCallbacks* callbacks, VkFence* fence),
           (device, info, callbacks, fence))
GLIM_COUNT(VkResult, vkCreateQueryPool, objects,
           (VkDevice device, const VkQueryPoolCreateInfo* info, const VkAllocationCallbacks* callbacks, VkQueryPool* pool),
           (device, info, callbacks, pool))
GLIM_COUNT(VkResult, vkAllocateMemory, objects,
           (VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory),
           (device, info, callbacks, memory))

}  // extern "C"
