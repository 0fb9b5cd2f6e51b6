// Pipelines and descriptor sets. See pipeline.hpp.
#include "common/gpu/pipeline.hpp"

#include <array>

#include "common/gpu/shader_file.hpp"

namespace welkin::gpu {
namespace {

// Value i of a Specialization goes to constant i.
SpecializationMap numbered(const Specialization& values) {
  SpecializationMap map;
  for (uint32_t i = 0; i < values.size(); ++i) map.add(i, values[i]);
  return map;
}

ShaderModule create_shader_module(const Device& device, const std::vector<uint32_t>& words) {
  const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                      .codeSize = words.size() * sizeof(uint32_t),
                                      .pCode = words.data()};
  return create<ShaderModule>(device, vkCreateShaderModule, info, "vkCreateShaderModule");
}

void write(const Device& device, const DescriptorSet& set, uint32_t slot, VkDescriptorType type,
           const VkDescriptorImageInfo* image, const VkDescriptorBufferInfo* buffer) {
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set.handle,
                                   .dstBinding = slot,
                                   .descriptorCount = 1,
                                   .descriptorType = type,
                                   .pImageInfo = image,
                                   .pBufferInfo = buffer};
  vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
}

}  // namespace

SetLayout create_set_layout(const Device& device, const std::vector<Binding>& bindings) {
  std::vector<VkDescriptorSetLayoutBinding> entries;
  for (const Binding& binding : bindings)
    entries.push_back(
        {.binding = binding.slot, .descriptorType = binding.type, .descriptorCount = 1, .stageFlags = binding.stages});
  const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                             .bindingCount = static_cast<uint32_t>(entries.size()),
                                             .pBindings = entries.data()};
  return create<SetLayout>(device, vkCreateDescriptorSetLayout, info, "vkCreateDescriptorSetLayout");
}

PipelineLayout create_pipeline_layout(const Device& device, VkDescriptorSetLayout set_layout, VkShaderStageFlags stages,
                                      uint32_t push_constant_bytes) {
  const VkPushConstantRange range{.stageFlags = stages, .offset = 0, .size = push_constant_bytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &set_layout,
                                        .pushConstantRangeCount = push_constant_bytes > 0 ? 1u : 0u,
                                        .pPushConstantRanges = &range};
  return create<PipelineLayout>(device, vkCreatePipelineLayout, info, "vkCreatePipelineLayout");
}

// [compute]
static VkPipelineShaderStageCreateInfo stage_of(VkShaderStageFlagBits which, VkShaderModule module,
                                                const VkSpecializationInfo& constants) {
  return {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
          .stage = which,
          .module = module,
          .pName = "main",
          .pSpecializationInfo = &constants};
}

ComputePipeline create_compute_pipeline(const Device& device, const std::string& name,
                                        const std::vector<uint32_t>& words, std::vector<Binding> bindings,
                                        uint32_t push_constant_bytes, const SpecializationMap& constants) {
  ComputePipeline pipeline;
  pipeline.set_layout = create_set_layout(device, bindings);
  pipeline.layout =
      create_pipeline_layout(device, pipeline.set_layout, VK_SHADER_STAGE_COMPUTE_BIT, push_constant_bytes);
  pipeline.bindings = std::move(bindings);
  const ShaderModule module = create_shader_module(device, words);  // needed only while the pipeline is made
  const VkSpecializationInfo special = constants.info();
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .stage = stage_of(VK_SHADER_STAGE_COMPUTE_BIT, module, special),
                                         .layout = pipeline.layout};
  VkPipeline handle = VK_NULL_HANDLE;
  check(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &handle),
        ("vkCreateComputePipelines of " + name).c_str());
  pipeline.handle = PipelineHandle(device, handle);
  device.set_name(VK_OBJECT_TYPE_PIPELINE, handle, name);
  return pipeline;
}

ComputePipeline create_compute_pipeline(const Device& device, const std::string& shader, std::vector<Binding> bindings,
                                        uint32_t push_constant_bytes, const Specialization& specialization) {
  return create_compute_pipeline(device, shader, load_spirv(shader), std::move(bindings), push_constant_bytes,
                                 numbered(specialization));
}
// [/compute]

PipelineHandle create_graphics_pipeline(const Device& device, const std::string& vertex_shader,
                                        const std::string& fragment_shader, VkPipelineLayout layout, VkFormat format,
                                        const Specialization& specialization) {
  const SpecializationMap constants = numbered(specialization);
  const VkSpecializationInfo special = constants.info();
  const ShaderModule vertex = create_shader_module(device, load_spirv(vertex_shader));
  const ShaderModule fragment = create_shader_module(device, load_spirv(fragment_shader));
  const std::array stages{stage_of(VK_SHADER_STAGE_VERTEX_BIT, vertex, special),
                          stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, special)};
  const VkPipelineVertexInputStateCreateInfo input{.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .polygonMode = VK_POLYGON_MODE_FILL,
      .cullMode = VK_CULL_MODE_NONE,
      .lineWidth = 1.0f};
  const VkPipelineMultisampleStateCreateInfo samples{.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                     .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineColorBlendAttachmentState all_channels{.colorWriteMask = 0xF};
  const VkPipelineColorBlendStateCreateInfo blend{.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
                                                  .attachmentCount = 1,
                                                  .pAttachments = &all_channels};
  const std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
                                                 .dynamicStateCount = static_cast<uint32_t>(dynamic_states.size()),
                                                 .pDynamicStates = dynamic_states.data()};
  const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                .colorAttachmentCount = 1,
                                                .pColorAttachmentFormats = &format};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = static_cast<uint32_t>(stages.size()),
                                          .pStages = stages.data(),
                                          .pVertexInputState = &input,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &raster,
                                          .pMultisampleState = &samples,
                                          .pColorBlendState = &blend,
                                          .pDynamicState = &dynamic,
                                          .layout = layout};
  VkPipeline handle = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &handle), "vkCreateGraphicsPipelines");
  return PipelineHandle(device, handle);
}

DescriptorSet create_descriptor_set(const Device& device, VkDescriptorSetLayout layout,
                                    const std::vector<Binding>& bindings) {
  std::vector<VkDescriptorPoolSize> sizes;
  for (const Binding& binding : bindings) sizes.push_back({binding.type, 1});
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .maxSets = 1,
                                             .poolSizeCount = static_cast<uint32_t>(sizes.size()),
                                             .pPoolSizes = sizes.data()};
  DescriptorSet set{.pool =
                        create<DescriptorPool>(device, vkCreateDescriptorPool, pool_info, "vkCreateDescriptorPool")};
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = set.pool,
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &layout};
  check(vkAllocateDescriptorSets(device, &info, &set.handle), "vkAllocateDescriptorSets");
  return set;
}

void write_image_view(const Device& device, const DescriptorSet& set, uint32_t slot, VkDescriptorType type,
                      VkImageView view, VkSampler sampler) {
  const VkDescriptorImageInfo info{.sampler = sampler, .imageView = view, .imageLayout = VK_IMAGE_LAYOUT_GENERAL};
  write(device, set, slot, type, &info, nullptr);
}

void write_storage_image(const Device& device, const DescriptorSet& set, uint32_t slot, const Image& image) {
  write_image_view(device, set, slot, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, image.view, VK_NULL_HANDLE);
}

void write_buffer(const Device& device, const DescriptorSet& set, uint32_t slot, VkDescriptorType type,
                  const Buffer& buffer, VkDeviceSize range) {
  const VkDescriptorBufferInfo info{.buffer = buffer.handle, .offset = 0, .range = range};
  write(device, set, slot, type, nullptr, &info);
}

}  // namespace welkin::gpu
