// Reading SPIR-V (specification 1.5: 2.3 physical layout, 3 binary form). See spirv.hpp.
#include "common/gpu/spirv.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <spirv/unified1/spirv.hpp>
#include <stdexcept>

namespace welkin::gpu {
namespace {

struct Instruction {
  spv::Op op = spv::OpNop;
  std::vector<uint32_t> words;  // operands
};

constexpr uint32_t kItself = ~0u;  // in place of a member's number: the id as a whole

struct Module {
  std::map<uint32_t, std::string> names;
  // Of an id, or a member of it: decoration -> first operand, or 1.
  std::map<std::pair<uint32_t, uint32_t>, std::map<uint32_t, uint32_t>> decorations;
  std::map<uint32_t, Instruction> types;  // also constants, by result id
  std::vector<Instruction> variables;     // type, id, storage class
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;

  std::string name(uint32_t id) const { return names.contains(id) ? names.at(id) : ""; }
  bool decorated(uint32_t id, spv::Decoration which, uint32_t member = kItself) const {
    const auto found = decorations.find({id, member});
    return found != decorations.end() && found->second.contains(which);
  }
  uint32_t decoration(uint32_t id, spv::Decoration which, uint32_t member = kItself) const {
    return decorated(id, which, member) ? decorations.at({id, member}).at(which) : 0;
  }
};

std::string text(std::span<const uint32_t> words) {
  const char* characters = reinterpret_cast<const char*>(words.data());
  return {characters, strnlen(characters, words.size_bytes())};
}

VkShaderStageFlagBits stage_of(uint32_t model) {
  return model == spv::ExecutionModelVertex     ? VK_SHADER_STAGE_VERTEX_BIT
         : model == spv::ExecutionModelFragment ? VK_SHADER_STAGE_FRAGMENT_BIT
                                                : VK_SHADER_STAGE_COMPUTE_BIT;
}

// Operands are asked for with at(): those of a damaged file need not be there.
void take(Module& module, spv::Op op, const std::vector<uint32_t>& w) {
  switch (op) {
    case spv::OpEntryPoint: module.stage = stage_of(w.at(0)); break;
    case spv::OpName: module.names[w.at(0)] = text(std::span(w).subspan(w.empty() ? 0 : 1)); break;
    case spv::OpDecorate: module.decorations[{w.at(0), kItself}][w.at(1)] = w.size() > 2 ? w.at(2) : 1; break;
    case spv::OpMemberDecorate: module.decorations[{w.at(0), w.at(1)}][w.at(2)] = w.size() > 3 ? w.at(3) : 1; break;
    case spv::OpVariable: module.variables.push_back({op, w}); break;
    case spv::OpConstant:
    case spv::OpSpecConstant:
    case spv::OpSpecConstantTrue:
    case spv::OpSpecConstantFalse: module.types[w.at(1)] = {op, w}; break;
    default:
      if (op >= spv::OpTypeVoid && op <= spv::OpTypePointer) module.types[w.at(0)] = {op, w};
  }
}

// Bytes of a type in a block; 0 for an array without end.
uint32_t size_of(const Module& module, uint32_t type) {
  const Instruction& t = module.types.at(type);
  switch (t.op) {
    case spv::OpTypeInt:
    case spv::OpTypeFloat: return t.words.at(1) / 8;
    case spv::OpTypeVector: return size_of(module, t.words.at(1)) * t.words.at(2);
    case spv::OpTypeMatrix: return 16 * t.words.at(2);
    case spv::OpTypeArray:
      return module.decoration(type, spv::DecorationArrayStride) * module.types.at(t.words.at(2)).words.at(2);
    case spv::OpTypeStruct: {
      uint32_t end = 0;
      for (uint32_t member = 0; member + 1 < t.words.size(); ++member)
        end = std::max(
            end, module.decoration(type, spv::DecorationOffset, member) + size_of(module, t.words.at(member + 1)));
      return end;
    }
    default: return 0;
  }
}

// True if the block, or every member of it, carries the decoration.
bool block_is(const Module& module, uint32_t type, spv::Decoration which) {
  for (uint32_t member = 0; member + 1 < module.types.at(type).words.size(); ++member)
    if (!module.decorated(type, which, member)) return false;
  return true;
}

VkFormat format_of(uint32_t image_format) {
  static const std::map<uint32_t, VkFormat> formats{{spv::ImageFormatRgba32f, VK_FORMAT_R32G32B32A32_SFLOAT},
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

ShaderBinding binding_of(const Module& module, uint32_t id, uint32_t type, uint32_t storage_class) {
  ShaderBinding binding{.slot = module.decoration(id, spv::DecorationBinding), .stages = module.stage};
  const Instruction& t = module.types.at(type);
  if (t.op == spv::OpTypeStruct) {
    binding.name = module.name(type);
    const bool storage =
        storage_class == spv::StorageClassStorageBuffer || module.decorated(type, spv::DecorationBufferBlock);
    binding.type = storage ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    binding.bytes = size_of(module, type);
    binding.reads = !storage || !block_is(module, type, spv::DecorationNonReadable);
    binding.writes = storage && !block_is(module, type, spv::DecorationNonWritable);
    return binding;
  }
  binding.name = module.name(id);
  const bool sampled = t.op == spv::OpTypeSampledImage;
  const Instruction& image = sampled ? module.types.at(t.words.at(1)) : t;
  binding.type = sampled ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  binding.volume = image.words.at(2) == spv::Dim3D;
  if (sampled) return binding;
  binding.format = format_of(image.words.at(7));
  binding.reads = !module.decorated(id, spv::DecorationNonReadable);
  binding.writes = !module.decorated(id, spv::DecorationNonWritable);
  return binding;
}

}  // namespace

ShaderInterface reflect(std::span<const uint32_t> words, const std::string& shader) try {
  Module module;
  std::set<uint32_t> functions, called;
  spv::Op op = spv::OpNop;
  for (size_t at = 5; at < words.size();) {  // after the header
    const uint32_t count = words[at] >> 16;
    if (count == 0 || at + count > words.size()) fail("shader {}: its SPIR-V is cut short; build it again", shader);
    op = static_cast<spv::Op>(words[at] & 0xffff);
    const std::vector<uint32_t> operands{words.begin() + at + 1, words.begin() + at + count};
    if (op == spv::OpFunction) functions.insert(operands.at(1));
    if (op == spv::OpFunctionCall) called.insert(operands.at(2));
    if (op == spv::OpEntryPoint) called.insert(operands.at(1));
    take(module, op, operands);
    at += count;
  }
  if (op != spv::OpFunctionEnd || !std::ranges::includes(functions, called))
    fail("shader {}: its SPIR-V is cut short; build it again", shader);
  ShaderInterface result{.stage = module.stage};
  for (const Instruction& variable : module.variables) {
    const uint32_t id = variable.words.at(1), storage_class = variable.words.at(2);
    const uint32_t type = module.types.at(variable.words.at(0)).words.at(2);  // of what the pointer points to
    if (storage_class == spv::StorageClassPushConstant) result.push_constant_bytes = size_of(module, type);
    if (!module.decorated(id, spv::DecorationBinding)) continue;
    if (module.decoration(id, spv::DecorationDescriptorSet) != 0)
      fail("shader {}: descriptor set 0 is the only one", shader);
    result.bindings.push_back(binding_of(module, id, type, storage_class));
  }
  for (const auto& [id, constant] : module.types) {
    if (!module.decorated(id, spv::DecorationSpecId)) continue;
    const bool real =
        constant.op == spv::OpSpecConstant && module.types.at(constant.words.at(0)).op == spv::OpTypeFloat;
    const bool boolean = constant.op != spv::OpSpecConstant;
    result.constants.push_back({module.name(id), module.decoration(id, spv::DecorationSpecId),
                                boolean ? ShaderConstant::Type::boolean
                                : real  ? ShaderConstant::Type::real
                                        : ShaderConstant::Type::integer});
  }
  return result;
} catch (const std::out_of_range&) {
  fail("shader {}: its SPIR-V is damaged; build it again", shader);
}

}  // namespace welkin::gpu
