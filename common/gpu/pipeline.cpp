// Pipelines and descriptor sets. See pipeline.hpp.
#include "common/gpu/pipeline.hpp"

#include "common/gpu/shader_file.hpp"

namespace welkin::gpu {

SetLayout create_set_layout(const Device& device, const std::vector<Binding>& bindings) {
  std::vector<VkDescriptorSetLayoutBinding> entries;
  for (const Binding& binding : bindings)
    entries.push_back(
        {.binding = binding.slot, .descriptorType = binding.type, .descriptorCount = 1, .stageFlags = binding.stages});
  const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                             .bindingCount = static_cast<uint32_t>(entries.size()),
                                             .pBindings = entries.data()};
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(device, &info, nullptr, &layout), "vkCreateDescriptorSetLayout");
  return SetLayout(device, layout);
}

PipelineLayout create_pipeline_layout(const Device& device, VkDescriptorSetLayout set_layout, VkShaderStageFlags stages,
                                      uint32_t push_constant_bytes) {
  const VkPushConstantRange range{.stageFlags = stages, .offset = 0, .size = push_constant_bytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set_layout,
                                        .pushConstantRangeCount = push_constant_bytes > 0 ? 1u : 0u,
                                        .pPushConstantRanges = &range};
  VkPipelineLayout layout = VK_NULL_HANDLE;
  check(vkCreatePipelineLayout(device, &info, nullptr, &layout), "vkCreatePipelineLayout");
  return PipelineLayout(device, layout);
}

ShaderModule create_shader_module(const Device& device, const std::string& shader) {
  const std::vector<uint32_t> words = load_spirv(shader);
  const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                      .codeSize = words.size() * sizeof(uint32_t),
                                      .pCode = words.data()};
  VkShaderModule module = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device, &info, nullptr, &module), "vkCreateShaderModule");
  return ShaderModule(device, module);
}

// [compute]
ComputePipeline create_compute_pipeline(const Device& device, const std::string& shader, std::vector<Binding> bindings,
                                        uint32_t push_constant_bytes, const Specialization& specialization) {
  ComputePipeline pipeline;
  pipeline.set_layout = create_set_layout(device, bindings);
  pipeline.layout =
      create_pipeline_layout(device, pipeline.set_layout, VK_SHADER_STAGE_COMPUTE_BIT, push_constant_bytes);
  pipeline.bindings = std::move(bindings);

  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t i = 0; i < specialization.size(); ++i) entries.push_back({.constantID = i, .offset = 4 * i, .size = 4});
  const VkSpecializationInfo constants{.mapEntryCount = static_cast<uint32_t>(entries.size()),
                                       .pMapEntries = entries.data(),
                                       .dataSize = specialization.size() * sizeof(uint32_t),
                                       .pData = specialization.data()};
  const ShaderModule module = create_shader_module(device, shader);  // needed only while the pipeline is made
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                   .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                   .module = module,
                                                   .pName = "main",
                                                   .pSpecializationInfo = &constants},
                                         .layout = pipeline.layout};
  VkPipeline handle = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &handle), "vkCreateComputePipelines");
  pipeline.handle = PipelineHandle(device, handle);
  device.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(handle), shader);
  return pipeline;
}
// [/compute]

DescriptorSet create_descriptor_set(const Device& device, VkDescriptorSetLayout layout,
                                    const std::vector<Binding>& bindings) {
  std::vector<VkDescriptorPoolSize> sizes;
  for (const Binding& binding : bindings) sizes.push_back({binding.type, 1});
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = static_cast<uint32_t>(sizes.size()),
                                             .pPoolSizes = sizes.data()};
  DescriptorSet set;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
  set.pool = DescriptorPool(device, pool);
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool,
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &layout};
  check(vkAllocateDescriptorSets(device, &info, &set.handle), "vkAllocateDescriptorSets");
  return set;
}

void write_image_view(const Device& device, const DescriptorSet& set, uint32_t slot, VkDescriptorType type,
                      VkImageView view, VkSampler sampler) {
  const VkDescriptorImageInfo info{.sampler = sampler, .imageView = view, .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set.handle,
                                   .dstBinding = slot,
                                   .descriptorCount = 1,
                                   .descriptorType = type,
                                   .pImageInfo = &info};
  vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
}

void write_storage_image(const Device& device, const DescriptorSet& set, uint32_t slot, const Image& image) {
  write_image_view(device, set, slot, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, image.view, VK_NULL_HANDLE);
}

void write_sampled_image(const Device& device, const DescriptorSet& set, uint32_t slot, const Image& image,
                         VkSampler sampler) {
  write_image_view(device, set, slot, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, image.view, sampler);
}

void write_buffer(const Device& device, const DescriptorSet& set, uint32_t slot, VkDescriptorType type,
                  const Buffer& buffer, VkDeviceSize range) {
  const VkDescriptorBufferInfo info{.buffer = buffer.handle, .offset = 0, .range = range};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set.handle,
                                   .dstBinding = slot,
                                   .descriptorCount = 1,
                                   .descriptorType = type,
                                   .pBufferInfo = &info};
  vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
}

}  // namespace welkin::gpu
