// Writes the tables on the page of chapter 16:
//   WELKIN_TABLE=docs/generated gpu_tests "[16_table]"
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "common/image/csv.hpp"
#include "tests/gpu/16_texture.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

std::vector<std::string> comments(const std::string& what) {
  return {what, "the same bits on every device", "source: WELKIN_TABLE=docs/generated gpu_tests \"[16_table]\""};
}

TextureRecipe seeded_recipe(NoiseKind kind, uint32_t side) {
  TextureRecipe recipe = small_recipe(kind, side, TexelFormat::bits16);
  recipe.seed = static_cast<uint32_t>(1000 * static_cast<int>(kind));
  return recipe;
}

}  // namespace

TEST_CASE("table of what the textures hold", "[.][16_table]") {
  struct Row {
    NoiseKind kind;
    uint32_t side;
    const char* name;
    std::array<const char*, 4> channels;
  };
  std::vector<std::vector<std::string>> rows;
  for (const Row& row :
       {Row{NoiseKind::base, 64, "base", {"Perlin-Worley", "Worley of 8 cells", "Worley of 16 cells", ""}},
        Row{NoiseKind::detail,
            32,
            "detail",
            {"Worley of 2 cells", "Worley of 4 cells", "Worley of 8 cells", "their sum"}},
        Row{NoiseKind::curl, 128, "curl", {"x", "y", "z", "stream function"}},
        Row{NoiseKind::weather, 256, "weather", {"coverage", "height", "type", "wetness"}},
        Row{NoiseKind::alligator, 64, "alligator", {"4 cells", "8 cells", "16 cells", "their sum"}}}) {
    const TextureRecipe recipe = seeded_recipe(row.kind, row.side);
    const std::vector<Four> texels = numbers_of(recipe, made_words(recipe));
    for (size_t channel = 0; channel < 4; ++channel) {
      if (*row.channels[channel] == '\0') continue;  // two texels a cell at this size
      double least = 2, greatest = -2, mean = 0, square = 0;
      for (const Four& t : texels) {
        const double v = t[channel], n = static_cast<double>(texels.size());
        least = std::min(least, v), greatest = std::max(greatest, v), mean += v / n, square += v * v / n;
      }
      const std::vector<double> power = spectrum(recipe, texels, channel);
      double all = 0, sum = 0;
      for (const double p : power) all += p;
      size_t tenth = 0, middle = 0, most = 0;
      for (size_t k = 0; k < power.size(); ++k) {
        sum += power[k];
        if (sum < 0.1 * all) tenth = k + 1;
        if (sum < 0.5 * all) middle = k + 1;
        if (sum < 0.9 * all) most = k + 1;
      }
      rows.push_back({row.name, row.channels[channel], fmt::format("{:.3f}", least), fmt::format("{:.3f}", greatest),
                      fmt::format("{:.3f}", mean), fmt::format("{:.3f}", std::sqrt(square - mean * mean)),
                      fmt::format("{}", tenth), fmt::format("{}", middle), fmt::format("{}", most)});
    }
  }
  write_csv(table_directory() + "/16_textures.csv",
            comments("sides of 64 (base, alligator), 32, 128 and 256 texels; below the frequency of 10, 50, 90 % lies "
                     "that much of the power, in waves a side"),
            {"texture", "channel", "least", "greatest", "mean", "deviation", "tenth", "middle", "ninety"}, rows);
}

// Blocks of 4 x 4 texels of a slice, as block-compressed formats keep them, with exact ends: what is lost at best.
// BC4, once a channel: 8 numbers from the block's least to its greatest. BC7, mode 6: all four channels on one line,
// the principal axis of the block's sixteen texels, at 16 places.
static std::vector<Four> compressed(const std::vector<Four>& texels, size_t side, bool on_one_line) {
  std::vector<Four> result(texels.size());
  const auto nearest = [](double v, double low, double high, int steps) {
    return high > low ? low + std::round((v - low) / (high - low) * steps) / steps * (high - low) : low;
  };
  for (size_t block = 0; block < texels.size() / 16; ++block) {
    const size_t across = side / 4, x = block % across * 4, y = block / across % across * 4,
                 z = block / across / across;
    std::array<std::array<double, 4>, 16> member{};  // less the mean
    std::array<double, 4> mean{}, axis{0.5, 0.5, 0.5, 0.5};
    const auto index = [&](size_t i) { return x + i % 4 + side * (y + i / 4 + side * z); };
    for (size_t i = 0; i < 16; ++i)
      for (size_t c = 0; c < 4; ++c) member[i][c] = texels[index(i)][c], mean[c] += member[i][c] / 16;
    for (size_t i = 0; i < 16; ++i)
      for (size_t c = 0; c < 4; ++c) member[i][c] -= mean[c];
    const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; };
    for (int step = 0; step < 20; ++step) {  // power iteration
      std::array<double, 4> next{};
      for (const auto& m : member)
        for (size_t c = 0; c < 4; ++c) next[c] += dot(axis, m) * m[c];
      const double length = std::sqrt(dot(next, next));
      for (size_t c = 0; length > 0 && c < 4; ++c) axis[c] = next[c] / length;
    }
    for (size_t c = 0; c < 4; ++c) {
      const auto value = [&](size_t i) { return on_one_line ? dot(axis, member[i]) : member[i][c]; };
      double low = 1e9, high = -1e9;
      for (size_t i = 0; i < 16; ++i) low = std::min(low, value(i)), high = std::max(high, value(i));
      for (size_t i = 0; i < 16; ++i) {
        const double kept = nearest(value(i), low, high, on_one_line ? 15 : 7);
        result[index(i)][c] = static_cast<float>(mean[c] + (on_one_line ? axis[c] : 1.0) * kept);
      }
    }
  }
  return result;
}

TEST_CASE("table of formats", "[.][16_table]") {
  std::vector<std::vector<std::string>> rows;
  const TextureRecipe exact = seeded_recipe(NoiseKind::base, 128);
  const std::vector<Four> reference = numbers_of(exact, made_words(exact));
  const auto add = [&](const char* name, uint64_t bytes, const std::vector<Four>& texels) {
    double worst = 0, square = 0;
    for (size_t i = 0; i < texels.size(); ++i)
      for (size_t c = 0; c < 3; ++c) {
        const double error = std::abs(static_cast<double>(texels[i][c]) - static_cast<double>(reference[i][c]));
        worst = std::max(worst, error), square += error * error / static_cast<double>(3 * texels.size());
      }
    rows.push_back(
        {name, fmt::format("{}", bytes), fmt::format("{:.2g}", worst), fmt::format("{:.2g}", std::sqrt(square))});
  };
  TextureRecipe full = seeded_recipe(NoiseKind::base, 128);
  const uint64_t sixteen_bits = full.bytes();
  add("BC7 mode 6", sixteen_bits / 8, compressed(reference, 128, true));
  add("BC4 once a channel", sixteen_bits / 4, compressed(reference, 128, false));
  for (const auto& [name, format] :
       {std::pair{"8", TexelFormat::bits8}, {"half", TexelFormat::half}, {"16", TexelFormat::bits16}}) {
    TextureRecipe recipe = exact;
    recipe.format = full.format = format;
    add(name, full.bytes(), numbers_of(recipe, made_words(recipe)));
  }
  write_csv(
      table_directory() + "/16_formats.csv",
      comments("bytes of the base texture of 128^3 with mips; difference of a texel's first three numbers from those "
               "of 16 bits; block-compressed: at best, computed and not made"),
      {"format", "bytes", "worst", "rms"}, rows);
}
