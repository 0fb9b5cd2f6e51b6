// Compute and graphics pipelines and the descriptor sets bound to them.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "common/gpu/resources.hpp"

namespace welkin::gpu {

struct Binding {
  uint32_t slot = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  VkShaderStageFlags stages = VK_SHADER_STAGE_COMPUTE_BIT;
};

// Specialization constants: value i goes to constant_id i (a bool is 0 or 1, a float its bits).
using Specialization = std::vector<uint32_t>;

// The same as Vulkan takes them: which 4 bytes are the value of which constant_id.
struct SpecializationMap {
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<uint32_t> values;

  void add(uint32_t id, uint32_t value) {
    entries.push_back({.constantID = id, .offset = static_cast<uint32_t>(4 * values.size()), .size = 4});
    values.push_back(value);
  }
  VkSpecializationInfo info() const {
    return {static_cast<uint32_t>(entries.size()), entries.data(), 4 * values.size(), values.data()};
  }
};

struct ComputePipeline {
  SetLayout set_layout;
  PipelineLayout layout;
  PipelineHandle handle;
  std::vector<Binding> bindings;
};

// `shader` as in load_spirv. push_constant_bytes <= 128, the portable limit.
ComputePipeline create_compute_pipeline(const Device& device, const std::string& shader, std::vector<Binding> bindings,
                                        uint32_t push_constant_bytes, const Specialization& specialization = {});
// From a shader's words; its name is for debuggers.
ComputePipeline create_compute_pipeline(const Device& device, const std::string& name,
                                        const std::vector<uint32_t>& words, std::vector<Binding> bindings,
                                        uint32_t push_constant_bytes, const SpecializationMap& constants);

SetLayout create_set_layout(const Device& device, const std::vector<Binding>& bindings);
PipelineLayout create_pipeline_layout(const Device& device, VkDescriptorSetLayout set_layout, VkShaderStageFlags stages,
                                      uint32_t push_constant_bytes);
// Triangles without vertex input (the vertex shader makes or fetches its vertex), culling, blending or depth, drawn
// into one image of `format`; viewport and scissor are set when recording. Both stages get the constants.
PipelineHandle create_graphics_pipeline(const Device& device, const std::string& vertex_shader,
                                        const std::string& fragment_shader, VkPipelineLayout layout, VkFormat format,
                                        const Specialization& specialization = {});

// One descriptor set with a pool of its own: allocated once, written only while no frame is in flight.
struct DescriptorSet {
  DescriptorPool pool;
  VkDescriptorSet handle = VK_NULL_HANDLE;
};
DescriptorSet create_descriptor_set(const Device& device, VkDescriptorSetLayout layout,
                                    const std::vector<Binding>& bindings);
void write_storage_image(const Device& device, const DescriptorSet& set, uint32_t slot, const Image& image);
// The image is read in layout GENERAL; a sampler is for VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER.
void write_image_view(const Device& device, const DescriptorSet& set, uint32_t slot, VkDescriptorType type,
                      VkImageView view, VkSampler sampler);
void write_buffer(const Device& device, const DescriptorSet& set, uint32_t slot, VkDescriptorType type,
                  const Buffer& buffer, VkDeviceSize range = VK_WHOLE_SIZE);

// Binds pipeline, set and push constants, then starts enough workgroups of local size 8x8 to cover `size`.
template <typename Push>
void dispatch_over(VkCommandBuffer commands, const ComputePipeline& pipeline, const DescriptorSet& set,
                   const Push& push, VkExtent2D size) {
  static_assert(sizeof(Push) <= 128, "push constants: 128 bytes is what every device has");
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set.handle, 0, nullptr);
  vkCmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(Push), &push);
  vkCmdDispatch(commands, (size.width + 7) / 8, (size.height + 7) / 8, 1);
}

}  // namespace welkin::gpu
