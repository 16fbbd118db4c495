// Compute kernels, the layout of their bindings, and the buffers and images bound to them.
#pragma once

#include "host/gpu/buffer.hpp"
#include "host/gpu/specialize.hpp"
#include "host/gpu/storage_image.hpp"

#include <map>

namespace glim {

struct BindingSlot {
    std::uint32_t binding;
    BufferKind kind;
    std::uint32_t texels = 0;  // for BufferKind::Both: the binding of its texels
};

// The bindings that several kernels share, all in set 0, and the size of their push constants in bytes.
class KernelLayout {
public:
    // `images` are the bindings of storage images.
    KernelLayout(const Device& device, const std::vector<BindingSlot>& slots, std::uint32_t pushSize,
                 const std::vector<std::uint32_t>& images = {});

    const Device& device() const { return device_; }
    const std::vector<VkDescriptorSetLayoutBinding>& bindings() const { return bindings_; }
    VkDescriptorSetLayout setLayout() const { return setLayout_.get(); }
    VkPipelineLayout pipelineLayout() const { return pipelineLayout_.get(); }
    std::uint32_t pushSize() const { return pushSize_; }
    // Where the texels of the buffer at `binding` are bound. The buffer must have texels.
    std::uint32_t texelBinding(std::uint32_t binding) const { return texelBindings_.at(binding); }

private:
    const Device& device_;
    std::vector<VkDescriptorSetLayoutBinding> bindings_;
    std::map<std::uint32_t, std::uint32_t> texelBindings_;
    std::uint32_t pushSize_;
    Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout> setLayout_;
    Owned<VkPipelineLayout, vkDestroyPipelineLayout> pipelineLayout_;
};

// The buffers and images at the bindings of a layout. A binding that no kernel uses may stay empty.
class Bindings {
public:
    Bindings(const KernelLayout& layout, const std::map<std::uint32_t, const Buffer*>& buffers,
             const std::map<std::uint32_t, const StorageImage*>& images = {});

    VkDescriptorSet set() const { return set_; }

private:
    Owned<VkDescriptorPool, vkDestroyDescriptorPool> pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;  // of the pool
};

class Kernel {
public:
    Kernel(const KernelLayout& layout, const EmbeddedShader& shader, const Specialization& specialization);

    const std::string& name() const { return name_; }
    const KernelLayout& layout() const { return *layout_; }
    VkPipeline pipeline() const { return pipeline_.get(); }

private:
    const KernelLayout* layout_;
    std::string name_;
    Owned<VkPipeline, vkDestroyPipeline> pipeline_;
};

}  // namespace glim
