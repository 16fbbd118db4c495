#include "host/gpu/kernel.hpp"

#include "host/gpu/replaced_kernels.hpp"

#include <algorithm>

namespace glim {
namespace {

std::vector<VkDescriptorPoolSize> poolSizes(const KernelLayout& layout)
{
    std::vector<VkDescriptorPoolSize> sizes;
    for (const VkDescriptorSetLayoutBinding& binding : layout.bindings()) {
        sizes.push_back({binding.descriptorType, 1});
    }
    return sizes;
}

VkWriteDescriptorSet writeOf(VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type)
{
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = type;
    return write;
}

void refuseTooMany(const Device& device, const char* what, std::size_t used, std::size_t allowed)
{
    if (used > allowed) {
        throw DeviceError(MessageId::DeviceLimit,
                          {"glim's kernels use ", part::value(std::to_string(used)), " ", part::place(what), ", but device \"",
                           device.description().name, "\" allows ", part::expected(std::to_string(allowed)), "."});
    }
}

}  // namespace

KernelLayout::KernelLayout(const Device& device, const std::vector<BindingSlot>& slots, std::uint32_t pushSize,
                           const std::vector<std::uint32_t>& images)
    : device_(device),
      pushSize_(pushSize),
      setLayout_(device),
      pipelineLayout_(device)
{
    for (const BindingSlot& slot : slots) {
        if (hasStorage(slot.kind)) {
            bindings_.push_back({slot.binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        }
        if (hasTexels(slot.kind)) {
            texelBindings_[slot.binding] = slot.kind == BufferKind::Both ? slot.texels : slot.binding;
            bindings_.push_back(
                {texelBindings_[slot.binding], VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
        }
    }
    for (const std::uint32_t image : images) {
        bindings_.push_back({image, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
    }
    const auto storage = static_cast<std::uint32_t>(
        std::count_if(slots.begin(), slots.end(), [](const BindingSlot& slot) { return hasStorage(slot.kind); }));
    refuseTooMany(device, "storage buffers", storage, device.description().maxStorageBuffers);
    refuseTooMany(device, "texel buffers", texelBindings_.size(), device.description().maxTexelBuffers);
    refuseTooMany(device, "buffers and images", bindings_.size(), device.description().maxResources);
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = static_cast<std::uint32_t>(bindings_.size());
    setInfo.pBindings = bindings_.data();
    check(vkCreateDescriptorSetLayout(device.handle(), &setInfo, nullptr, setLayout_.receive()), "create a descriptor layout");

    const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushSize};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = setLayout_.address();
    info.pushConstantRangeCount = pushSize > 0 ? 1 : 0;
    info.pPushConstantRanges = &push;
    check(vkCreatePipelineLayout(device.handle(), &info, nullptr, pipelineLayout_.receive()), "create a pipeline layout");
}

Bindings::Bindings(const KernelLayout& layout, const std::map<std::uint32_t, const Buffer*>& buffers,
                   const std::map<std::uint32_t, const StorageImage*>& images)
    : pool_(layout.device())
{
    const VkDevice device = layout.device().handle();
    const std::vector<VkDescriptorPoolSize> sizes = poolSizes(layout);
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    poolInfo.pPoolSizes = sizes.data();
    check(vkCreateDescriptorPool(device, &poolInfo, nullptr, pool_.receive()), "create a descriptor pool");
    VkDescriptorSetAllocateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    const VkDescriptorSetLayout setLayout = layout.setLayout();
    setInfo.descriptorPool = pool_.get();
    setInfo.descriptorSetCount = 1;
    setInfo.pSetLayouts = &setLayout;
    check(vkAllocateDescriptorSets(device, &setInfo, &set_), "allocate a descriptor set");

    for (const auto& [binding, buffer] : buffers) {
        if (hasStorage(buffer->kind())) {
            const VkDescriptorBufferInfo range{buffer->handle(), 0, VK_WHOLE_SIZE};
            VkWriteDescriptorSet write = writeOf(set_, binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
            write.pBufferInfo = &range;
            vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        }
        if (hasTexels(buffer->kind())) {
            const VkBufferView view = buffer->texelView();
            VkWriteDescriptorSet write = writeOf(set_, layout.texelBinding(binding), VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER);
            write.pTexelBufferView = &view;
            vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
        }
    }
    for (const auto& [binding, image] : images) {
        const VkDescriptorImageInfo whole{VK_NULL_HANDLE, image->view(), VK_IMAGE_LAYOUT_GENERAL};
        VkWriteDescriptorSet write = writeOf(set_, binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
        write.pImageInfo = &whole;
        vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
    }
}

Kernel::Kernel(const KernelLayout& layout, const EmbeddedShader& shader, const Specialization& specialization)
    : layout_(&layout),
      name_(shader.name),
      pipeline_(layout.device())
{
    const VkDevice device = layout.device().handle();
    const std::vector<std::uint32_t> spirv = specialize(shader, specialization, layout.device().arithmetic());
    VkShaderModuleCreateInfo moduleInfo{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    moduleInfo.codeSize = spirv.size() * sizeof(std::uint32_t);
    moduleInfo.pCode = spirv.data();
    Owned<VkShaderModule, vkDestroyShaderModule> module(layout.device());
    check(vkCreateShaderModule(device, &moduleInfo, nullptr, module.receive()), "load kernel " + name_);

    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module.get();
    info.stage.pName = "main";
    info.layout = layout.pipelineLayout();
    const VkPipelineCache cache = findReplaced(shader) ? VK_NULL_HANDLE : layout.device().pipelines().handle();
    check(vkCreateComputePipelines(device, cache, 1, &info, nullptr, pipeline_.receive()), "compile kernel " + name_);
    layout.device().setName(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_.get()), name_);
}

}  // namespace glim
