// Writes the tables on the page of chapter 16:
//   WELKIN_TABLE=docs/generated gpu_tests "[16_table]"
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "common/image/csv.hpp"
#include "tests/gpu/16_texture.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

std::string directory() {
  const char* path = std::getenv("WELKIN_TABLE");
  if (path == nullptr) throw std::runtime_error("WELKIN_TABLE names no directory");
  return path;
}

std::vector<std::string> comments(const std::string& what) {
  return {what, "the same bits on every device", "source: WELKIN_TABLE=docs/generated gpu_tests \"[16_table]\""};
}

TextureRecipe default_recipe(NoiseKind kind, uint32_t side) {
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
    const TextureRecipe recipe = default_recipe(row.kind, row.side);
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
  write_csv(directory() + "/16_textures.csv",
            comments("sides of 64 (base, alligator), 32, 128 and 256 texels; below the frequency of 10, 50, 90 % lies "
                     "that much of the power, in waves a side"),
            {"texture", "channel", "least", "greatest", "mean", "deviation", "tenth", "middle", "ninety"}, rows);
}

TEST_CASE("table of formats", "[.][16_table]") {
  std::vector<std::vector<std::string>> rows;
  const TextureRecipe exact = default_recipe(NoiseKind::base, 64);
  const std::vector<Four> reference = numbers_of(exact, made_words(exact));
  for (const auto& [name, format] :
       {std::pair{"8", TexelFormat::bits8}, {"16", TexelFormat::bits16}, {"half", TexelFormat::half}}) {
    TextureRecipe recipe = exact;
    recipe.format = format;
    const std::vector<Four> texels = numbers_of(recipe, made_words(recipe));
    double worst = 0, square = 0;
    for (size_t i = 0; i < texels.size(); ++i) {
      const double error = std::abs(static_cast<double>(texels[i][0]) - static_cast<double>(reference[i][0]));
      worst = std::max(worst, error), square += error * error / static_cast<double>(texels.size());
    }
    recipe.side = 128;
    rows.push_back({name, fmt::format("{}", recipe.bytes()), fmt::format("{:.2g}", worst),
                    fmt::format("{:.2g}", std::sqrt(square))});
  }
  write_csv(
      directory() + "/16_formats.csv",
      comments(
          "bytes of the base texture of 128^3 with mips; difference of a texel's number from that of 16 bits (64^3)"),
      {"format", "bytes", "worst", "rms"}, rows);
}
