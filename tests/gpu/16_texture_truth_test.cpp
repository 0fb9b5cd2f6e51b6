// Whole textures of chapter 16: the processor's words, ranges, means, spectra, mips, and what a format loses.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/16_texture.hpp"
#include "tests/gpu/16_viewer.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

struct Statistics {
  double least = 1e9, greatest = -1e9, mean = 0, deviation = 0;
};

Statistics statistics_of(const std::vector<Four>& texels, size_t channel) {
  Statistics s;
  double square = 0;
  for (const Four& t : texels) {
    const double v = t[channel];
    s.least = std::min(s.least, v), s.greatest = std::max(s.greatest, v), s.mean += v, square += v * v;
  }
  s.mean /= static_cast<double>(texels.size());
  s.deviation = std::sqrt(std::max(square / static_cast<double>(texels.size()) - s.mean * s.mean, 0.0));
  return s;
}

double sum_between(const std::vector<double>& power, double from, double to) {
  double sum = 0;
  for (size_t k = 0; k < power.size(); ++k)
    if (static_cast<double>(k) >= from && static_cast<double>(k) <= to) sum += power[k];
  return sum;
}

constexpr NoiseKind kKinds[] = {NoiseKind::base, NoiseKind::detail, NoiseKind::curl, NoiseKind::weather,
                                NoiseKind::alligator};

}  // namespace

TEST_CASE("truth: textures of every kind, size and format have the processor's words, mips included") {
  const auto check = [](const TextureRecipe& recipe) {
    CAPTURE(recipe.text());
    const std::string device = made_words(recipe), processor = twin_words(recipe);
    REQUIRE(device.size() == recipe.bytes());
    CHECK((device == processor));  // bytes: nothing to print
  };
  for (const NoiseKind kind : kKinds)
    for (const TexelFormat format : {TexelFormat::bits8, TexelFormat::bits16, TexelFormat::half})
      check(small_recipe(kind, 16, format));
  for (const NoiseKind kind : kKinds) check(small_recipe(kind, 32));
  check(small_recipe(NoiseKind::curl, 128, TexelFormat::bits16));
  check(small_recipe(NoiseKind::weather, 128));
  for (const int octaves : {1, 2, 6}) {
    TextureRecipe recipe = small_recipe(NoiseKind::weather, 64);
    recipe.octaves = octaves;
    check(recipe);
  }
}

TEST_CASE("truth: after normalisation both ends of every channel's range are hit") {
  for (const NoiseKind kind : kKinds)
    for (const TexelFormat format : {TexelFormat::bits8, TexelFormat::bits16, TexelFormat::half}) {
      const TextureRecipe recipe = small_recipe(kind, 32, format);
      const std::vector<Four> texels = numbers_of(recipe, made_words(recipe));
      double longest = 0;
      for (size_t channel = 0; channel < 4; ++channel) {
        const Statistics s = statistics_of(texels, channel);
        CAPTURE(recipe.text(), channel);
        if (recipe.is_signed()) {
          CHECK(std::max(-s.least, s.greatest) <= 1.0);
          if (channel < 3) longest = std::max({longest, -s.least, s.greatest});
          continue;
        }
        CHECK(s.least == 0.0);
        CHECK(s.greatest == Approx(1.0).margin(format == TexelFormat::half ? 0x1p-11 : 0.0));
      }
      if (recipe.is_signed()) CHECK(longest == Approx(1.0).margin(0x1p-11));
    }
}

TEST_CASE("truth: the energy of every channel lies at its own cells") {
  // A channel of c cells a side has most of its power within an octave of c/2 ... 2c waves a side, the middle of it
  // (half of the power below, half above) at a cell or a little less. Measured: 70 to 92 %.
  struct Case {
    NoiseKind kind;
    size_t channel;
    double cells;
  };
  const TextureRecipe base = small_recipe(NoiseKind::base, 64, TexelFormat::bits16);
  const TextureRecipe alligator = small_recipe(NoiseKind::alligator, 64, TexelFormat::bits16);
  const std::vector<Four> base_texels = numbers_of(base, made_words(base)),
                          alligator_texels = numbers_of(alligator, made_words(alligator));
  for (const Case c : {Case{NoiseKind::base, 1, 8}, Case{NoiseKind::base, 2, 16}, Case{NoiseKind::alligator, 0, 4},
                       Case{NoiseKind::alligator, 1, 8}, Case{NoiseKind::alligator, 2, 16}}) {
    const bool is_base = c.kind == NoiseKind::base;
    const std::vector<double> power =
        spectrum(is_base ? base : alligator, is_base ? base_texels : alligator_texels, c.channel);
    const double all = sum_between(power, 1, 64);
    size_t middle = 0;
    for (double sum = 0; sum < 0.5 * all; ++middle) sum += power[middle];
    CAPTURE(static_cast<int>(c.kind), c.channel, middle, sum_between(power, c.cells / 2, 2 * c.cells) / all);
    CHECK(sum_between(power, c.cells / 2, 2 * c.cells) > 0.65 * all);
    CHECK(static_cast<double>(middle) > 0.5 * c.cells);
    CHECK(static_cast<double>(middle) < 1.3 * c.cells);
  }
}

TEST_CASE("truth: an octave is twice as fine and has a quarter of the power") {
  // Perlin octaves with seeds of their own add up: the variance of n of them is var (1 + 1/4 + …) full^2.
  Random random(5);
  double variance[4] = {};
  for (const int count : {1, 2, 3}) {
    std::vector<NoiseItem> items(100000);
    for (NoiseItem& item : items)
      item = {static_cast<float>(random.uniform(0, 1)),
              static_cast<float>(random.uniform(0, 1)),
              0.0f,
              4.0f,
              static_cast<float>(random.next() >> 8),
              static_cast<float>(count),
              0.5f,
              noise::Octaves{count, 0.5f}.full()};
    double square = 0;
    for (const Four& v : evaluate_noise(Part::curl2, items)) square += static_cast<double>(v[3]) * v[3];
    variance[count] = square / static_cast<double>(items.size()) / std::pow(noise::Octaves{count, 0.5f}.full(), 2);
  }
  CHECK(variance[2] / variance[1] == Approx(1.25).epsilon(0.03));  // 4 standard errors: 0.6 % each
  CHECK(variance[3] / variance[1] == Approx(1.3125).epsilon(0.03));
}

TEST_CASE("truth: a mip is the mean of the one before, so the mean stays") {
  for (const NoiseKind kind : kKinds)
    for (const TexelFormat format : {TexelFormat::bits8, TexelFormat::bits16}) {
      const TextureRecipe recipe = small_recipe(kind, 32, format);
      const std::string words = made_words(recipe);
      const double step = format == TexelFormat::bits8 ? (recipe.is_signed() ? 1.0 / 127 : 1.0 / 255)
                                                       : (recipe.is_signed() ? 1.0 / 32767 : 1.0 / 65535);
      for (size_t channel = 0; channel < 4; ++channel) {
        const double mean = statistics_of(numbers_of(recipe, words), channel).mean;
        for (uint32_t mip = 1; mip < recipe.mips(); ++mip) {
          const std::vector<Four> texels = numbers_of(recipe, words, mip);
          const double n = static_cast<double>(texels.size());
          CAPTURE(recipe.text(), channel, mip);
          // Both means are of numbers rounded by up to half a step: 6 standard deviations of that mean, which is 0.29
          // steps over the root of how many there are; half a step and no more where there is one.
          const double rounding = std::min(0.5, 6 * 0.29 / std::sqrt(n)) + std::min(0.5, 6 * 0.29 / std::sqrt(n * 4));
          CHECK(statistics_of(texels, channel).mean == Approx(mean).margin(rounding * step));
        }
      }
    }
}

TEST_CASE("truth: the curl texture's own differences have little divergence") {
  // Central differences of the texels, rounded to 16 bits: what is left is the differences' own error and the
  // rounding's.
  const TextureRecipe recipe = small_recipe(NoiseKind::curl, 128, TexelFormat::bits16);
  const std::vector<Four> texels = numbers_of(recipe, made_words(recipe));
  const size_t n = 128;
  const auto at = [&](size_t x, size_t y) -> const Four& { return texels[x % n + n * (y % n)]; };
  double divergence = 0, slope = 0, along_stream = 0, speed = 0;
  for (size_t y = 0; y < n; ++y)
    for (size_t x = 0; x < n; ++x) {
      const double du = at(x + 1, y)[0] - at(x + n - 1, y)[0], dv = at(x, y + 1)[1] - at(x, y + n - 1)[1];
      divergence += (du + dv) * (du + dv), slope += du * du + dv * dv;
      // The field runs along the lines on which the stream function w is constant.
      const double dw_dx = at(x + 1, y)[3] - at(x + n - 1, y)[3], dw_dy = at(x, y + 1)[3] - at(x, y + n - 1)[3];
      along_stream += std::pow(at(x, y)[0] * dw_dx + at(x, y)[1] * dw_dy, 2);
      speed += (std::pow(at(x, y)[0], 2) + std::pow(at(x, y)[1], 2)) * (dw_dx * dw_dx + dw_dy * dw_dy);
    }
  CAPTURE(std::sqrt(divergence / slope), std::sqrt(along_stream / speed));
  CHECK(divergence < 0.05 * 0.05 * slope);
  CHECK(along_stream < 0.02 * 0.02 * speed);
}

TEST_CASE("truth: seeds make other noise of the same kind, and the same seed the same words") {
  const TextureRecipe one = small_recipe(NoiseKind::base, 32);
  TextureRecipe other = one;
  other.seed = one.seed + 1;
  const std::string words = made_words(one), again = made_words(one), others = made_words(other);
  CHECK((words == again));
  CHECK((words != others));
  const std::vector<Four> a = numbers_of(one, words), b = numbers_of(other, others);
  for (size_t channel = 1; channel < 4; ++channel) {
    const Statistics sa = statistics_of(a, channel), sb = statistics_of(b, channel);
    double product = 0;
    for (size_t i = 0; i < a.size(); ++i) product += (a[i][channel] - sa.mean) * (b[i][channel] - sb.mean);
    const double correlation = product / static_cast<double>(a.size()) / (sa.deviation * sb.deviation);
    const double cells = std::pow(8.0 * std::pow(2.0, static_cast<double>(channel) - 1), 3);
    CAPTURE(channel, correlation);
    CHECK(std::abs(correlation) < 5 / std::sqrt(cells));  // as many independent cells
    CHECK(sa.mean == Approx(sb.mean).margin(0.1));
    CHECK(sa.deviation == Approx(sb.deviation).epsilon(0.25));
  }
}

TEST_CASE("truth: between texels, what a format and its filter lose") {
  // The picture of half a texture, 36 pixels high, against the trilinear mean of 16-bit texels in double. 8 bits:
  // texels are off by up to 1/510, and a driver may filter them to 8 bits as well. 16 bits: what is left is the
  // filter's own weights, which the software driver has in full, and others in 256ths (of steps of up to 0.4 between
  // texels).
  TextureRecipe recipe = small_recipe(NoiseKind::base, 32, TexelFormat::bits16);
  recipe.seed = 0;
  const std::vector<Four> texels = numbers_of(recipe, made_words(recipe));
  const auto expected = [&](uint32_t x, uint32_t y) {
    const double at[3] = {(x + 0.5) / 36 * 16 - 0.5, (y + 0.5) / 36 * 16 - 0.5, 0.25 * 32 - 0.5};
    double sum = 0;
    for (int n = 0; n < 8; ++n) {
      double weight = 1;
      size_t index = 0, stride = 1;
      for (size_t axis = 0; axis < 3; ++axis, stride *= 32) {
        const double low = std::floor(at[axis]), t = at[axis] - low;
        const int corner = n >> axis & 1;
        weight *= corner == 1 ? t : 1 - t;
        index += stride * ((static_cast<size_t>(static_cast<int>(low) + corner + 32)) % 32);
      }
      sum += weight * static_cast<double>(texels[index][0]);
    }
    return sum;
  };
  const auto worst_of = [&](const char* format) {
    ViewerFixture frame({"noise.show=base", "noise.tiles=0.5", format}, {64, 36});
    const Image picture = frame.picture();
    double worst = 0;
    for (uint32_t y = 0; y < 36; ++y)
      for (uint32_t x = 0; x < 64; ++x)
        worst = std::max(worst, std::abs(static_cast<double>(picture.pixels[y * 64 + x].r) - expected(x, y)));
    return worst;
  };
  const double eight = worst_of("noise.format=8"), sixteen = worst_of("noise.format=16"),
               half = worst_of("noise.format=half");
  CAPTURE(eight, sixteen, half);
  CHECK(eight > 1.0 / 510 - 2e-4);
  CHECK(eight < 4.0 / 510);  // half a step of the texel, and half of one for each axis's mean
  CHECK(sixteen < (device().candidate().software ? 2e-5 : 2e-3));
  CHECK(half < (device().candidate().software ? 3e-4 : 2e-3));
}
