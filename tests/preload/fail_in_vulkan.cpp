// Preloaded into glim: a driver that fails, or a device that is far away.
//
// GLIM_LOSE_DEVICE_AT  n: the n-th submission and everything that waits from there on answers VK_ERROR_DEVICE_LOST
// GLIM_REFUSE_MEMORY_AT  n: the n-th allocation and all after it answer VK_ERROR_OUT_OF_DEVICE_MEMORY
// GLIM_REFUSE_OBJECTS_AT  n: the n-th object and all after it are not made: VK_ERROR_OUT_OF_HOST_MEMORY
// GLIM_LACK_FEATURES  set: the device has none of Vulkan's features
// GLIM_DELAY_MS  n: each submission and each wait for its end takes n ms longer
#include <dlfcn.h>

#include <vulkan/vulkan.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace {

template <class Function>
Function original(const char* name)
{
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

// Whether the call after `before` others is to fail.
bool isDue(const char* variable, int before)
{
    const char* at = std::getenv(variable);
    return at != nullptr && before + 1 >= std::atoi(at);
}

std::atomic<int> submissions = 0, allocations = 0, objects = 0;

bool isLost() { return isDue("GLIM_LOSE_DEVICE_AT", submissions - 1); }

void delay()
{
    if (const char* milliseconds = std::getenv("GLIM_DELAY_MS")) {
        std::this_thread::sleep_for(std::chrono::milliseconds(std::atoi(milliseconds)));
    }
}

void clear(VkBool32* first, const VkBool32* last) { std::memset(first, 0, static_cast<std::size_t>(last - first + 1) * sizeof(VkBool32)); }

}  // namespace

extern "C" {

VkResult vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* submits, VkFence fence)
{
    ++submissions;
    delay();
    static const auto next = original<PFN_vkQueueSubmit>("vkQueueSubmit");
    return isLost() ? VK_ERROR_DEVICE_LOST : next(queue, count, submits, fence);
}

VkResult vkQueueWaitIdle(VkQueue queue)
{
    static const auto next = original<PFN_vkQueueWaitIdle>("vkQueueWaitIdle");
    const VkResult ended = next(queue);  // a lost device runs nothing any more
    return isLost() ? VK_ERROR_DEVICE_LOST : ended;
}

VkResult vkWaitForFences(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout)
{
    static const auto next = original<PFN_vkWaitForFences>("vkWaitForFences");
    delay();
    return isLost() ? VK_ERROR_DEVICE_LOST : next(device, count, fences, all, timeout);
}

VkResult vkGetQueryPoolResults(VkDevice device, VkQueryPool pool, uint32_t first, uint32_t count, size_t bytes, void* data,
                               VkDeviceSize stride, VkQueryResultFlags flags)
{
    static const auto next = original<PFN_vkGetQueryPoolResults>("vkGetQueryPoolResults");
    return isLost() ? VK_ERROR_DEVICE_LOST : next(device, pool, first, count, bytes, data, stride, flags);
}

VkResult vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* callbacks, VkDeviceMemory* memory)
{
    static const auto next = original<PFN_vkAllocateMemory>("vkAllocateMemory");
    return isDue("GLIM_REFUSE_MEMORY_AT", allocations++) ? VK_ERROR_OUT_OF_DEVICE_MEMORY : next(device, info, callbacks, memory);
}

#define GLIM_REFUSE(Object)                                                                                                      \
    VkResult vkCreate##Object(VkDevice device, const Vk##Object##CreateInfo* info, const VkAllocationCallbacks* callbacks,       \
                              Vk##Object* object)                                                                                \
    {                                                                                                                            \
        static const auto next = original<PFN_vkCreate##Object>("vkCreate" #Object);                                             \
        return isDue("GLIM_REFUSE_OBJECTS_AT", objects++) ? VK_ERROR_OUT_OF_HOST_MEMORY : next(device, info, callbacks, object); \
    }
GLIM_REFUSE(Buffer)
GLIM_REFUSE(BufferView)
GLIM_REFUSE(CommandPool)
GLIM_REFUSE(DescriptorPool)
GLIM_REFUSE(DescriptorSetLayout)
GLIM_REFUSE(Fence)
GLIM_REFUSE(PipelineLayout)
GLIM_REFUSE(QueryPool)
GLIM_REFUSE(ShaderModule)

VkResult vkAllocateCommandBuffers(VkDevice device, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* buffers)
{
    static const auto next = original<PFN_vkAllocateCommandBuffers>("vkAllocateCommandBuffers");
    return isDue("GLIM_REFUSE_OBJECTS_AT", objects++) ? VK_ERROR_OUT_OF_HOST_MEMORY : next(device, info, buffers);
}

VkResult vkAllocateDescriptorSets(VkDevice device, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* sets)
{
    static const auto next = original<PFN_vkAllocateDescriptorSets>("vkAllocateDescriptorSets");
    return isDue("GLIM_REFUSE_OBJECTS_AT", objects++) ? VK_ERROR_OUT_OF_HOST_MEMORY : next(device, info, sets);
}

void vkGetPhysicalDeviceFeatures2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features)
{
    static const auto next = original<PFN_vkGetPhysicalDeviceFeatures2>("vkGetPhysicalDeviceFeatures2");
    next(device, features);
    if (std::getenv("GLIM_LACK_FEATURES") == nullptr) {
        return;
    }
    clear(&features->features.robustBufferAccess, &features->features.inheritedQueries);
    for (auto* part = static_cast<VkBaseOutStructure*>(features->pNext); part != nullptr; part = part->pNext) {
        if (part->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) {
            auto& newer = reinterpret_cast<VkPhysicalDeviceVulkan12Features&>(*part);
            clear(&newer.samplerMirrorClampToEdge, &newer.subgroupBroadcastDynamicId);
        }
    }
}

}  // extern "C"
