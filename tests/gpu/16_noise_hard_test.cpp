// What must not upset noise: named cases, the naive form failing beside the one that holds.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/gpu/16_texture.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

// The largest jump between neighbours along x: inside the texture, and from its last column to its first.
struct Jumps {
  double inside = 0, around = 0;
};
Jumps jumps_of(const std::vector<double>& field, size_t n) {
  Jumps jumps;
  for (size_t i = 0; i < field.size(); ++i) {
    const bool last = i % n == n - 1;
    double& most = last ? jumps.around : jumps.inside;
    most = std::max(most, std::abs(field[last ? i + 1 - n : i + 1] - field[i]));
  }
  return jumps;
}

}  // namespace

TEST_CASE("hard: no seam where a texture repeats") {
  // Naive: cells that do not wrap. The last column then knows nothing of the first.
  const size_t n = 64;
  std::vector<double> robust, naive;
  for (size_t y = 0; y < n; ++y)
    for (size_t x = 0; x < n; ++x) {
      const auto at = [&](size_t i) { return (static_cast<double>(i) + 0.5) / static_cast<double>(n) * 4; };
      robust.push_back(noise::worley(at(x), at(y), 1.3, 4, 3u));
      naive.push_back(noise::worley(at(x), at(y), 1.3, 1 << 20, 3u));
    }
  CHECK(jumps_of(robust, n).around <= 1.2 * jumps_of(robust, n).inside);
  CHECK(jumps_of(naive, n).around > 3.0 * jumps_of(naive, n).inside);

  // And as the device makes them, along each side.
  for (const NoiseKind kind : {NoiseKind::base, NoiseKind::detail, NoiseKind::weather, NoiseKind::alligator}) {
    const TextureRecipe recipe = small_recipe(kind, kind == NoiseKind::weather ? 128 : 64, TexelFormat::bits16);
    const std::vector<Four> texels = numbers_of(recipe, made_words(recipe));
    for (size_t axis = 0; axis < (recipe.volume ? 3u : 2u); ++axis) {
      std::vector<double> turned(texels.size());  // with `axis` as the fastest
      const size_t side = recipe.side;
      for (size_t i = 0; i < texels.size(); ++i) {
        const size_t x = i % side, y = i / side % side, z = i / side / side;
        const size_t at = axis == 0 ? i : axis == 1 ? y + side * (x + side * z) : z + side * (y + side * x);
        turned[at] = texels[i][0];
      }
      const Jumps jumps = jumps_of(turned, side);
      CAPTURE(static_cast<int>(kind), axis, jumps.inside, jumps.around);
      CHECK(jumps.around <= 1.1 * jumps.inside);
    }
  }
}

TEST_CASE("hard: eight cells are not enough for Worley noise") {
  // The eight cells towards larger coordinates miss every nearer point on the other side.
  Random random(31);
  size_t wrong = 0, jumped = 0;
  const size_t count = 20000;
  for (size_t i = 0; i < count; ++i) {
    const double x = random.uniform(0, 8), y = random.uniform(0, 8), z = random.uniform(0, 8);
    wrong += noise::worley(x, y, z, 8, 1u) != noise::worley(x, y, z, 8, 1u, false, 0);
    // Across the face of a cell, a millionth of a cell wide.
    const double face = std::floor(x), e = 5e-7;
    const auto jump = [&](int from) {
      return std::abs(noise::worley(face + 8 + e, y, z, 8, 1u, false, from) -
                      noise::worley(face + 8 - e, y, z, 8, 1u, false, from));
    };
    CHECK(jump(-1) < 1e-5);
    jumped += jump(0) > 0.05;
  }
  CHECK(wrong > count / 4);  // 30 % of all places
  CHECK(jumped > count / 10);
}

TEST_CASE("hard: no point within a cell's width: the domes have ended, at 0 and without a step") {
  // Such places are there (a random lattice leaves holes), but few; the distance to points beyond would be needed there
  // by a noise that does not end.
  Random random(32);
  std::vector<NoiseItem> items(400000);
  for (NoiseItem& item : items)
    item = {static_cast<float>(random.uniform(0, 16)), static_cast<float>(random.uniform(0, 16)),
            static_cast<float>(random.uniform(0, 16)), 16, static_cast<float>(random.next() % 1000)};
  size_t empty = 0;
  float least = 1, greatest = 0;
  for (const Four& v : evaluate_noise(Part::worley3, items)) {
    empty += v[0] == 0.0f;
    least = std::min(least, v[0]), greatest = std::max(greatest, v[0]);
  }
  CHECK(empty > 0);
  CHECK(empty < items.size() / 500);
  CHECK(least == 0.0f);
  CHECK(greatest <= 1.0f);
}

TEST_CASE("hard: the low bits of a hash are alike in neighbouring cells") {
  // With gradients drawn from the lowest bits the corners of a cell are not independent: the variance of 2-D Perlin
  // noise was 1.5 % off its closed form, 25 standard errors of four million numbers. From the highest bits it is that
  // of independent ones.
  const auto correlation = [](int shift) {
    double sum = 0;
    const int count = 400000;
    for (int i = 0; i < count; ++i) {
      const uint32_t seed = static_cast<uint32_t>(i) * 40503u;
      const auto sign = [&](int x, int y) { return (noise::hashed(x, y, 0, seed)[0] >> shift & 1) != 0 ? 1.0 : -1.0; };
      sum += sign(3, 5) * sign(4, 5);
    }
    return std::abs(sum) / count;
  };
  CHECK(correlation(31) < 5 / std::sqrt(400000.0));
  CHECK(correlation(0) > 0.05);
}

TEST_CASE("hard: octaves do not vanish together") {
  // Every corner of a lattice is one of all finer ones: unshifted, the sum of octaves is 0 at each, a grid of grey
  // dots.
  const noise::Octaves octaves{4, 0.5f};
  double robust = 0, naive = 0, anywhere = 0;
  int count = 0;
  for (uint32_t seed = 0; seed < 50; ++seed)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j, ++count) {
        const double x = i / 4.0, y = j / 4.0;
        const auto square = [&](double at, bool shifted) {
          return std::pow(noise::perlin_fbm(at, y, 0.0, true, 4, octaves, 100 * seed, shifted)[0], 2);
        };
        robust += square(x, true), naive += square(x, false), anywhere += square(x + 0.11, true);
      }
  CHECK(naive == 0.0);
  CHECK(robust / anywhere == Approx(1.0).margin(0.25));  // 800 numbers each, of 50 patterns
}

TEST_CASE("hard: places left of the origin, on corners and on the last bit before them") {
  const float inf_step = std::numeric_limits<float>::denorm_min();
  std::vector<NoiseItem> items;
  for (const float x : {-1.0f, -0.0f, 0.0f, inf_step, -inf_step, -1e-7f, 0.99999994f, 1.0f, -4096.0f, 8191.9995f})
    for (const float cells : {1.0f, 8.0f})
      for (const NoiseItem& item : {NoiseItem{x, x, x, cells, 1}, NoiseItem{x, 0.25f, -0.75f, cells, 1}})
        items.push_back(item);
  for (const Part part : {Part::perlin3, Part::worley3, Part::alligator})
    for (const Four& v : evaluate_noise(part, items)) {
      CHECK(std::isfinite(v[0]));
      CHECK(std::abs(v[0]) <= 1.0f);
    }
}

TEST_CASE("hard: one cell a side still tiles, its own neighbour all around") {
  Random random(33);
  std::vector<NoiseItem> items;
  for (int i = 0; i < 2000; ++i)
    items.push_back({static_cast<float>(random.uniform(0, 1)), static_cast<float>(random.uniform(0, 1)),
                     static_cast<float>(random.uniform(0, 1)), 1, static_cast<float>(i)});
  for (const Part part : {Part::perlin3, Part::worley3, Part::alligator}) {
    float least = 2, greatest = -2;
    for (const Four& v : evaluate_noise(part, items)) {
      least = std::min(least, v[0]), greatest = std::max(greatest, v[0]);
      CHECK(std::isfinite(v[0]));
    }
    CHECK(greatest - least > 0.3f);
  }
}

TEST_CASE("hard: a product and a sum fused into one rounding are other bits") {
  // What `precise` and -ffp-contract=off are for: of a million corners' planes, many differ in the last bit where one
  // device fuses and another does not; and a difference of one bit is one of a whole step where it is rounded to 8.
  Random random(34);
  size_t others = 0;
  for (int i = 0; i < 100000; ++i) {
    const float a = static_cast<float>(random.uniform(0, 1)), b = static_cast<float>(random.uniform(-1, 1)),
                t = static_cast<float>(random.uniform(0, 1));
    const float fused = std::fma(t, b - a, a), apart = noise::lerp(a, b, t);
    others += fused != apart;
  }
  CHECK(others > 10000);
}

TEST_CASE("hard: rounding to a format is the same at both ends, at ties and below the least normal half") {
  std::vector<NoiseItem> items;
  for (const float x : {0.0f, -0.0f, 1.0f, -1.0f, 2.0f, -2.0f, 0.5f, 0.00196078f, 0.00196079f, 0x1p-14f, 0x1p-15f,
                        0x1.8p-24f, 0x1p-25f, 0x1.002p0f, 0.33325195f, 0.99999994f, 1e-30f, -1e-9f})
    items.push_back({x, 0, 0, 0, 0});
  Random random(35);
  for (int i = 0; i < 50000; ++i) items.push_back({static_cast<float>(random.uniform(-1, 1)), 0, 0, 0, 0});
  const std::vector<Four> device = evaluate_noise(Part::numbers, items);
  double half = 0, eight = 0, sixteen = 0;
  for (size_t i = 0; i < items.size(); ++i) {
    const double x = std::clamp(static_cast<double>(items[i].x), -2.0, 2.0);
    const uint32_t bits = static_cast<uint32_t>(device[i][1]);
    const int exponent = static_cast<int>(bits >> 10 & 31);
    const double digits = static_cast<double>(bits & 1023);
    const double value = std::ldexp(exponent == 0 ? digits : 1024 + digits, std::max(exponent, 1) - 25);
    const double spacing = std::ldexp(1.0, std::max(std::ilogb(std::max(std::abs(x), 0x1p-14)), -14) - 10);
    half = std::max(half, std::abs(std::abs(x) - value) / spacing);
    CHECK(((bits & 0x8000u) != 0) == std::signbit(items[i].x));
    eight = std::max(eight, std::abs(static_cast<double>(device[i][2]) - 255 * std::clamp(x, 0.0, 1.0)));
    const double back = static_cast<double>(static_cast<int16_t>(static_cast<uint16_t>(device[i][3])));
    sixteen = std::max(sixteen, std::abs(back - 32767 * std::clamp(x, -1.0, 1.0)));
  }
  CHECK(half <= 0.5);
  CHECK(eight <= 0.5 + 1e-4);    // the product with 255 is rounded itself
  CHECK(sixteen <= 0.5 + 4e-3);  // and with 32767: to 2^-9 of a step
}
