// What a compiled shader says of itself: its bindings by name, its constants by name, its push constants, its stage.
//
// Read from the SPIR-V's own words (names, decorations, types): a tenth of a millisecond a shader.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/gpu/vk.hpp"

namespace welkin::gpu {

struct ShaderBinding {
  std::string name;  // of the image, or of the block ("Air" in `uniform Air { … }`)
  uint32_t slot = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  bool reads = true, writes = false;      // by its qualifiers: readonly, writeonly, neither
  VkFormat format = VK_FORMAT_UNDEFINED;  // of a storage image
  bool volume = false;                    // a 3-D image
  uint32_t bytes = 0;                     // of a block, without a last array of any length
  VkShaderStageFlags stages = 0;
};

struct ShaderConstant {
  enum class Type { boolean, integer, real };
  std::string name;
  uint32_t id = 0;
  Type type = Type::integer;
};

struct ShaderInterface {
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
  std::vector<ShaderBinding> bindings;
  std::vector<ShaderConstant> constants;
  uint32_t push_constant_bytes = 0;
};

// words: a whole SPIR-V module with names (the compiler's default); shader: its name, for messages. Throws Error if it
// is cut short or uses a descriptor set other than 0.
ShaderInterface reflect(std::span<const uint32_t> words, const std::string& shader);

}  // namespace welkin::gpu
