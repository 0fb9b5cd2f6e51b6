// Reading SPIR-V, by Khronos' own reader of it, SPIRV-Cross. See spirv.hpp.
#include "common/gpu/spirv.hpp"

#include <map>
#include <spirv_cross/spirv_cross.hpp>

namespace welkin::gpu {
namespace {

using spirv_cross::SPIRType;

VkShaderStageFlagBits stage_of(spv::ExecutionModel model) {
  return model == spv::ExecutionModelVertex     ? VK_SHADER_STAGE_VERTEX_BIT
         : model == spv::ExecutionModelFragment ? VK_SHADER_STAGE_FRAGMENT_BIT
                                                : VK_SHADER_STAGE_COMPUTE_BIT;
}

VkFormat format_of(spv::ImageFormat image_format) {
  static const std::map<spv::ImageFormat, VkFormat> formats{{spv::ImageFormatRgba32f, VK_FORMAT_R32G32B32A32_SFLOAT},
                                                            {spv::ImageFormatRgba16f, VK_FORMAT_R16G16B16A16_SFLOAT},
                                                            {spv::ImageFormatR32f, VK_FORMAT_R32_SFLOAT},
                                                            {spv::ImageFormatRg32f, VK_FORMAT_R32G32_SFLOAT},
                                                            {spv::ImageFormatR16f, VK_FORMAT_R16_SFLOAT},
                                                            {spv::ImageFormatRg16f, VK_FORMAT_R16G16_SFLOAT},
                                                            {spv::ImageFormatRgba8, VK_FORMAT_R8G8B8A8_UNORM},
                                                            {spv::ImageFormatRg8, VK_FORMAT_R8G8_UNORM},
                                                            {spv::ImageFormatR8, VK_FORMAT_R8_UNORM},
                                                            {spv::ImageFormatRgba16, VK_FORMAT_R16G16B16A16_UNORM},
                                                            {spv::ImageFormatR16, VK_FORMAT_R16_UNORM},
                                                            {spv::ImageFormatR32ui, VK_FORMAT_R32_UINT}};
  const auto found = formats.find(image_format);
  return found != formats.end() ? found->second : VK_FORMAT_UNDEFINED;
}

ShaderBinding binding_of(const spirv_cross::Compiler& compiler, const spirv_cross::Resource& resource,
                         VkDescriptorType type) {
  const SPIRType& held = compiler.get_type(resource.base_type_id);
  ShaderBinding binding{.name = resource.name,
                        .slot = compiler.get_decoration(resource.id, spv::DecorationBinding),
                        .type = type,
                        .stages = stage_of(compiler.get_execution_model())};
  const bool block = held.basetype == SPIRType::Struct;
  if (block) binding.bytes = static_cast<uint32_t>(compiler.get_declared_struct_size(held));
  if (!block) binding.volume = held.image.dim == spv::Dim3D;
  if (type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) binding.format = format_of(held.image.format);
  if (type != VK_DESCRIPTOR_TYPE_STORAGE_IMAGE && type != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER) return binding;
  const spirv_cross::Bitset said =
      block ? compiler.get_buffer_block_flags(resource.id) : compiler.get_decoration_bitset(resource.id);
  binding.reads = !said.get(spv::DecorationNonReadable);
  binding.writes = !said.get(spv::DecorationNonWritable);
  return binding;
}

}  // namespace

ShaderInterface reflect(std::span<const uint32_t> words, const std::string& shader) try {
  const spirv_cross::Compiler compiler(words.data(), words.size());
  const spirv_cross::ShaderResources resources = compiler.get_shader_resources();
  ShaderInterface result{.stage = stage_of(compiler.get_execution_model())};
  std::map<uint32_t, ShaderBinding> bindings;  // by id: in the order in which the shader declares them
  const auto add = [&](const auto& list, VkDescriptorType type) {
    for (const spirv_cross::Resource& resource : list) {
      if (compiler.get_decoration(resource.id, spv::DecorationDescriptorSet) != 0)
        fail("shader {}: descriptor set 0 is the only one", shader);
      bindings.emplace(resource.id, binding_of(compiler, resource, type));
    }
  };
  add(resources.uniform_buffers, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  add(resources.storage_buffers, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  add(resources.storage_images, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
  add(resources.sampled_images, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
  for (auto& [id, binding] : bindings) result.bindings.push_back(std::move(binding));
  for (const spirv_cross::Resource& block : resources.push_constant_buffers)
    result.push_constant_bytes =
        static_cast<uint32_t>(compiler.get_declared_struct_size(compiler.get_type(block.base_type_id)));
  for (const auto& [id, number] : compiler.get_specialization_constants()) {
    const SPIRType::BaseType type = compiler.get_type(compiler.get_constant(id).constant_type).basetype;
    result.constants.push_back({compiler.get_name(id), number,
                                type == SPIRType::Boolean ? ShaderConstant::Type::boolean
                                : type == SPIRType::Float ? ShaderConstant::Type::real
                                                          : ShaderConstant::Type::integer});
  }
  return result;
} catch (const spirv_cross::CompilerError&) {
  fail("shader {}: its SPIR-V is cut short; build it again", shader);
}

}  // namespace welkin::gpu
