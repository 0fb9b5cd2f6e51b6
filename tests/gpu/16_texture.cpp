// See 16_texture.hpp.
#include "tests/gpu/16_texture.hpp"

#include <cmath>
#include <complex>
#include <cstring>
#include <glm/gtc/packing.hpp>

namespace welkin::test {
namespace {

// In float, step by step as the shader: the shader's own tests compare it with 1 / x.
float twin_reciprocal(float x) {
  int exponent = 0;
  const float m = std::frexp(x, &exponent);  // 1/2 ... 1
  const uint32_t start = 0x80000000u / static_cast<uint32_t>(std::floor(m * 65536.0f));
  float y = std::ldexp(static_cast<float>(start), -16 - (exponent - 1));
  for (int i = 0; i < 2; ++i) y = y * (2.0f - x * y);
  return y;
}

uint32_t twin_half(double v) {
  const double size = std::min(std::abs(v), 65504.0);
  const int e = size < 0x1p-14 ? -14 : std::ilogb(size);
  const long steps = std::lrint(std::ldexp(size, 10 - e));  // to even; 1024 ... 2048 of a normal number
  const uint32_t sign = std::signbit(v) ? 0x8000u : 0u;
  return sign | (size < 0x1p-14 ? static_cast<uint32_t>(steps) : static_cast<uint32_t>((e + 14) * 1024 + steps));
}

uint32_t twin_number(const TextureRecipe& recipe, float v) {
  const bool is_signed = recipe.is_signed();
  if (recipe.format == TexelFormat::half) return twin_half(std::clamp(v, is_signed ? -1.0f : 0.0f, 1.0f));
  const int bits = recipe.format == TexelFormat::bits8 ? 8 : 16;
  const int most = (1 << (is_signed ? bits - 1 : bits)) - 1;
  const float size = std::min(std::abs(v), 1.0f) * static_cast<float>(most) + 0.5f;
  const int steps = static_cast<int>(size);
  if (!is_signed) return v > 0.0f ? static_cast<uint32_t>(steps) : 0u;
  return static_cast<uint32_t>(v < 0.0f ? -steps : steps) & ((1u << bits) - 1u);
}

noise::Octaves octaves_of(const TextureRecipe& recipe) { return {recipe.octaves, recipe.is_signed() ? 0.25f : 0.5f}; }

std::vector<Four> twin_raw(const TextureRecipe& recipe) {
  const uint32_t n = recipe.side;
  std::vector<Four> raw;
  const auto at = [&](uint32_t i) { return (static_cast<float>(i) + 0.5f) / static_cast<float>(n); };
  for (uint32_t k = 0; k < (recipe.volume ? n : 1); ++k)
    for (uint32_t j = 0; j < n; ++j)
      for (uint32_t i = 0; i < n; ++i)
        raw.push_back(
            noise::texel(static_cast<noise::Kind>(recipe.kind), at(i), at(j), at(k), octaves_of(recipe), recipe.seed));
  return raw;
}

std::vector<Four> twin_mip(const std::vector<Four>& finer, uint32_t side, bool volume) {
  std::vector<Four> coarser;
  const uint32_t half = side / 2, slices = volume ? 2 : 1;
  for (uint32_t z = 0; z < (volume ? half : 1); ++z)
    for (uint32_t y = 0; y < half; ++y)
      for (uint32_t x = 0; x < half; ++x) {
        Four sum{};
        for (uint32_t k = 0; k < slices; ++k)
          for (uint32_t j = 0; j < 2; ++j)
            for (uint32_t i = 0; i < 2; ++i)
              for (size_t c = 0; c < 4; ++c)
                sum[c] = sum[c] + finer[2 * x + i + side * (2 * y + j + side * (slices * z + k))][c];
        for (float& s : sum) s = s * (volume ? 0.125f : 0.25f);
        coarser.push_back(sum);
      }
  return coarser;
}

}  // namespace

std::vector<Four> evaluate_noise(Part part, const std::vector<NoiseItem>& items) {
  std::vector<float> inputs(items.size() * 8);
  std::memcpy(inputs.data(), items.data(), inputs.size() * sizeof(float));
  const uint32_t what = static_cast<uint32_t>(part);
  const std::vector<float> flat = evaluate("tests/16_noise.comp", inputs, 8, 4, gpu::Specialization{what});
  std::vector<Four> results(items.size());
  std::memcpy(results.data(), flat.data(), flat.size() * sizeof(float));
  return results;
}

TextureRecipe small_recipe(NoiseKind kind, uint32_t side, TexelFormat format) {
  return {.name = "noise of a test",
          .kind = kind,
          .side = side,
          .volume = kind != NoiseKind::curl && kind != NoiseKind::weather,
          .octaves = 3,
          .seed = 7,
          .format = format};
}

std::string made_words(const TextureRecipe& recipe) {
  TextureMaker maker(device(), recipe, true);
  maker.run();
  return std::string(maker.words());
}

std::string twin_words(const TextureRecipe& recipe) {
  std::vector<Four> level = twin_raw(recipe);
  Four least = level.front(), greatest = level.front(), zero, scale;
  for (const Four& v : level)
    for (size_t c = 0; c < 4; ++c) least[c] = std::min(least[c], v[c]), greatest[c] = std::max(greatest[c], v[c]);
  for (size_t c = 0; c < 4; ++c) {
    zero[c] = recipe.is_signed() ? 0.0f : least[c];
    scale[c] = recipe.is_signed() ? std::max(-least[c], greatest[c]) : greatest[c] - least[c];
  }
  if (recipe.is_signed()) scale[0] = scale[1] = scale[2] = std::max({scale[0], scale[1], scale[2]});
  for (float& s : scale) s = twin_reciprocal(s);

  std::string words;
  for (uint32_t mip = 0; mip < recipe.mips(); ++mip) {
    if (mip > 0) level = twin_mip(level, recipe.side_of(mip - 1), recipe.volume);
    for (const Four& v : level)
      for (size_t c = 0; c < 4; ++c) {
        const uint32_t number = twin_number(recipe, (v[c] - zero[c]) * scale[c]);
        words += static_cast<char>(number & 255);
        if (recipe.format != TexelFormat::bits8) words += static_cast<char>(number >> 8);
      }
  }
  return words;
}

std::vector<Four> numbers_of(const TextureRecipe& recipe, std::string_view words, uint32_t mip) {
  size_t at = 0;
  for (uint32_t finer = 0; finer < mip; ++finer) at += recipe.bytes_of(finer);
  std::vector<Four> texels(recipe.bytes_of(mip) / recipe.texel_bytes());
  const auto byte = [&] { return static_cast<uint32_t>(static_cast<unsigned char>(words[at++])); };
  for (Four& texel : texels)
    for (float& number : texel) {
      const uint32_t low = byte();
      if (recipe.format == TexelFormat::bits8) {
        number = recipe.is_signed() ? static_cast<float>(static_cast<int8_t>(low)) / 127.0f
                                    : static_cast<float>(low) / 255.0f;
        continue;
      }
      const uint32_t whole = low | byte() << 8;
      number = recipe.format == TexelFormat::half ? glm::unpackHalf1x16(static_cast<uint16_t>(whole))
               : recipe.is_signed()               ? static_cast<float>(static_cast<int16_t>(whole)) / 32767.0f
                                                  : static_cast<float>(whole) / 65535.0f;
    }
  return texels;
}

std::vector<double> spectrum(const TextureRecipe& recipe, const std::vector<Four>& texels, size_t channel) {
  using Complex = std::complex<double>;
  const size_t n = recipe.side, axes = recipe.volume ? 3 : 2;
  std::vector<Complex> field(texels.size()), line(n), turn(n);
  for (size_t i = 0; i < field.size(); ++i) field[i] = texels[i][channel];
  for (size_t k = 0; k < n; ++k)
    turn[k] = std::polar(1.0, -2.0 * 3.14159265358979323846 * static_cast<double>(k) / static_cast<double>(n));
  size_t stride = 1;
  for (size_t axis = 0; axis < axes; ++axis, stride *= n)
    for (size_t begin = 0; begin < field.size(); ++begin) {
      if (begin / stride % n != 0) continue;
      for (size_t k = 0; k < n; ++k) {
        line[k] = 0.0;
        for (size_t i = 0; i < n; ++i) line[k] += field[begin + i * stride] * turn[i * k % n];
      }
      for (size_t k = 0; k < n; ++k) field[begin + k * stride] = line[k] / static_cast<double>(n);
    }
  std::vector<double> power(n);
  for (size_t i = 1; i < field.size(); ++i) {
    const auto wave = [&](size_t k) { return static_cast<double>(std::min(k % n, n - k % n)); };
    const double k = std::hypot(wave(i), wave(i / n), axes == 3 ? wave(i / n / n) : 0.0);
    power[static_cast<size_t>(std::lround(k))] += std::norm(field[i]);
  }
  return power;
}

}  // namespace welkin::test
