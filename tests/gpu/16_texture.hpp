// Chapter 16 for tests: the shader's functions over arrays, textures as the device makes them, and as the processor
// does.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "chapters/16_noise/texture.hpp"
#include "tests/gpu/harness.hpp"
#include "tests/reference/noise.hpp"

namespace welkin::test {

// Which function of tests/gpu/shaders/16_noise.comp.
enum class Part { perlin3, perlin2, worley3, worley2, alligator, curl2, curl3, texel, numbers, hash };

struct NoiseItem {
  float x, y, z, cells, seed, octaves = 1.0f, gain = 0.5f, full = 1.0f;
};
static_assert(sizeof(NoiseItem) == 32);

using Four = std::array<float, 4>;
std::vector<Four> evaluate_noise(Part part, const std::vector<NoiseItem>& items);

// A small texture's recipe.
TextureRecipe small_recipe(NoiseKind kind, uint32_t side = 32, TexelFormat format = TexelFormat::bits8);

// Words of a texture: made by the device, and by the processor from tests/reference/noise.hpp.
std::string made_words(const TextureRecipe& recipe);
std::string twin_words(const TextureRecipe& recipe);

// A mip of a texture's words as numbers, 0 ... 1 or -1 ... 1.
std::vector<Four> numbers_of(const TextureRecipe& recipe, std::string_view words, uint32_t mip = 0);

// Power by frequency of one channel, waves a side: [k] holds that of k - 1/2 <= |frequency| < k + 1/2. Without the
// mean.
std::vector<double> spectrum(const TextureRecipe& recipe, const std::vector<Four>& texels, size_t channel);

}  // namespace welkin::test
