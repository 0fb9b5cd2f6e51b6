// Chapter 16 against what is known of it: the processor's bits, closed forms, derivatives, and the exact period.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "tests/gpu/16_texture.hpp"
#include "tests/reference/quadrature.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

uint32_t bits_of(float v) {
  uint32_t bits = 0;
  std::memcpy(&bits, &v, sizeof bits);
  return bits == 0x80000000u ? 0u : bits;  // -0 is 0
}

bool same(const Four& a, const Four& b) {
  for (size_t c = 0; c < 4; ++c)
    if (bits_of(a[c]) != bits_of(b[c])) return false;
  return true;
}

// Places within `reach` cells of the origin: anywhere, on corners, edges and faces of cells, and the numbers beside
// those.
std::vector<NoiseItem> places(size_t count, double reach, float cells, Random& random) {
  std::vector<NoiseItem> items(count);
  for (NoiseItem& item : items) {
    const uint32_t kind = random.next();
    const auto one = [&](uint32_t how) {
      const float v = static_cast<float>(random.uniform(-reach, reach));
      if (how == 0) return std::round(v);
      if (how == 1) return std::nextafter(std::round(v), random.next() % 2 == 0 ? 1e9f : -1e9f);
      return v;
    };
    item.x = one(kind % 6), item.y = one(kind / 6 % 6), item.z = one(kind / 36 % 6);
    item.cells = cells, item.seed = static_cast<float>(random.next() % 10000);
  }
  return items;
}

Four twin(Part part, const NoiseItem& i) {
  const int cells = static_cast<int>(i.cells);
  const uint32_t seed = static_cast<uint32_t>(i.seed);
  const noise::Octaves octaves{static_cast<int>(i.octaves), i.gain};
  switch (part) {
    case Part::perlin3: return noise::perlin3(i.x, i.y, i.z, cells, seed);
    case Part::perlin2: return noise::perlin2(i.x, i.y, cells, seed);
    case Part::worley3: {
      const float v = noise::worley(i.x, i.y, i.z, cells, seed);
      return {v, v, v, v};
    }
    case Part::worley2: {
      const float v = noise::worley(i.x, i.y, 0.0f, cells, seed, true);
      return {v, v, v, v};
    }
    case Part::alligator: {
      const float v = noise::alligator(i.x, i.y, i.z, cells, seed);
      return {v, v, v, v};
    }
    case Part::curl2: return noise::curl2(i.x, i.y, cells, octaves, seed);
    case Part::curl3: return noise::curl3(i.x, i.y, i.z, cells, octaves, seed);
    default: return noise::texel(static_cast<noise::Kind>(cells), i.x, i.y, i.z, octaves, seed);
  }
}

size_t count_other_bits(Part part, const std::vector<NoiseItem>& items) {
  const std::vector<Four> device = evaluate_noise(part, items);
  size_t others = 0;
  for (size_t i = 0; i < items.size(); ++i) others += !same(device[i], twin(part, items[i]));
  return others;
}

// The variance of Perlin noise with gradients of length sqrt(2): by symmetry 2 P^(n-1) Q with P the mean of s^2 +
// (1-s)^2 and Q that of (1-s)^2 t^2 + s^2 (1-t)^2, s(t) the quintic; corners are independent. (n axes, each with
// E[g_i^2] = 2/n.)
double perlin_variance(int axes) {
  const auto s = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
  const auto mean = [](const auto& f) {
    double sum = 0;
    for (int i = 0; i < 1000; ++i) sum += f((i + 0.5) / 1000);
    return sum / 1000;
  };
  const double p = mean([&](double t) { return s(t) * s(t) + (1 - s(t)) * (1 - s(t)); });
  const double q = mean([&](double t) { return (1 - s(t)) * (1 - s(t)) * t * t + s(t) * s(t) * (1 - t) * (1 - t); });
  return 2 * std::pow(p, axes - 1) * q;
}

}  // namespace

TEST_CASE("truth: noise has the processor's bits at 1.2 million places") {
  Random random(16);
  size_t places_asked = 0;
  const auto check = [&](Part part, size_t count, float cells) {
    CAPTURE(static_cast<int>(part), cells);
    CHECK(count_other_bits(part, places(count, 3.0 * static_cast<double>(cells), cells, random)) == 0);
    places_asked += count;
  };
  for (const float cells : {1.0f, 2.0f, 8.0f, 64.0f}) {
    check(Part::perlin3, 100000, cells);
    check(Part::perlin2, 100000, cells);
    check(Part::worley3, 40000, cells);
    check(Part::worley2, 40000, cells);
    check(Part::alligator, 20000, cells);
  }
  CHECK(places_asked == 1200000);
}

TEST_CASE("truth: sums of octaves, curls and every texture's recipe have the processor's bits") {
  Random random(17);
  for (const int count : {1, 3, 6}) {
    for (const float gain : {0.25f, 0.5f}) {
      std::vector<NoiseItem> items = places(4000, 1.0, 4.0f, random);
      for (NoiseItem& item : items)
        item.octaves = static_cast<float>(count), item.gain = gain, item.full = noise::Octaves{count, gain}.full();
      CAPTURE(count, gain);
      CHECK(count_other_bits(Part::curl2, items) == 0);
      CHECK(count_other_bits(Part::curl3, items) == 0);
      for (const float kind : {0.0f, 1.0f, 2.0f, 3.0f, 4.0f}) {
        for (NoiseItem& item : items) item.cells = kind;
        CAPTURE(kind);
        CHECK(count_other_bits(Part::texel, items) == 0);
      }
    }
  }
}

TEST_CASE("truth: the hash is pcg4d, and its bits are even") {
  std::vector<NoiseItem> items;
  for (int i = 0; i < 65536; ++i)
    items.push_back({static_cast<float>(i % 64), static_cast<float>(i / 64 % 64), static_cast<float>(i / 4096), 0, 5});
  const std::vector<Four> device = evaluate_noise(Part::hash, items);
  size_t others = 0;
  std::array<double, 4> mean{}, square{};
  for (size_t i = 0; i < items.size(); ++i) {
    const noise::Hash h =
        noise::hashed(static_cast<int>(items[i].x), static_cast<int>(items[i].y), static_cast<int>(items[i].z), 5);
    for (size_t c = 0; c < 4; ++c) {
      others += device[i][c] != noise::unit<float>(h[c]);
      mean[c] += device[i][c] / 65536.0, square[c] += device[i][c] * device[i][c] / 65536.0;
    }
  }
  CHECK(others == 0);
  for (size_t c = 0; c < 4; ++c) {  // 4 standard errors of a uniform number's mean and mean square
    CHECK(mean[c] == Approx(0.5).margin(4 * std::sqrt(1.0 / 12) / 256));
    CHECK(square[c] == Approx(1.0 / 3).margin(4 * std::sqrt(4.0 / 45) / 256));
  }
}

TEST_CASE("truth: a period further the noise is the same, to the bit") {
  Random random(18);
  for (const Part part : {Part::perlin3, Part::perlin2, Part::worley3, Part::worley2, Part::alligator}) {
    for (const float cells : {1.0f, 4.0f, 32.0f}) {
      // Places on a grid of 2^-10, where a period more or less loses no bit of the place.
      std::vector<NoiseItem> here, there;
      for (int i = 0; i < 4000; ++i) {
        const auto place = [&] {
          return std::round(static_cast<float>(random.uniform(0.0, static_cast<double>(cells))) * 1024.0f) / 1024.0f;
        };
        NoiseItem item{place(), place(), place(), cells, 3};
        here.push_back(item);
        const auto moved = [&](float v) {
          return v + cells * static_cast<float>(static_cast<int>(random.next() % 7) - 3);
        };
        item.x = moved(item.x), item.y = moved(item.y), item.z = moved(item.z);
        there.push_back(item);
      }
      const std::vector<Four> a = evaluate_noise(part, here), b = evaluate_noise(part, there);
      size_t others = 0;
      for (size_t i = 0; i < a.size(); ++i) others += !same(a[i], b[i]);
      CAPTURE(static_cast<int>(part), cells);
      CHECK(others == 0);
    }
  }
}

TEST_CASE("truth: Perlin noise has mean 0, the variance of its closed form, and vanishes at corners") {
  Random random(19);
  for (const Part part : {Part::perlin3, Part::perlin2}) {
    std::vector<NoiseItem> items(200000);
    for (NoiseItem& item : items) {  // every item with a seed of its own: independent
      item = {static_cast<float>(random.uniform(0, 8)), static_cast<float>(random.uniform(0, 8)),
              static_cast<float>(random.uniform(0, 8)), 8};
      item.seed = static_cast<float>(random.next() >> 8);
    }
    const std::vector<Four> values = evaluate_noise(part, items);
    double mean = 0, square = 0, fourth = 0, most = 0;
    for (const Four& v : values) {
      const double x = v[0], n = static_cast<double>(values.size());
      mean += x / n, square += x * x / n, fourth += x * x * x * x / n, most = std::max(most, std::abs(x));
    }
    const double expected = perlin_variance(part == Part::perlin3 ? 3 : 2), n = static_cast<double>(values.size());
    CHECK(std::abs(mean) < 4 * std::sqrt(expected / n));  // 4 standard errors
    CHECK(square == Approx(expected).margin(4 * std::sqrt((fourth - square * square) / n)));
    CHECK(most <= 1.0);
    for (NoiseItem& item : items) item.x = std::floor(item.x), item.y = std::floor(item.y), item.z = std::floor(item.z);
    double at_corners = 0;
    for (const Four& v : evaluate_noise(part, items))
      at_corners = std::max(at_corners, static_cast<double>(std::abs(v[0])));
    CHECK(at_corners == 0);
  }
}

TEST_CASE("truth: derivatives are derivatives") {
  Random random(20);
  const double h = 1e-5;  // central differences in double: error h^2 f'''/6 below 1e-8, rounding 1e-16/h
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(0, 8), y = random.uniform(0, 8), z = random.uniform(0, 8);
    const auto at = noise::perlin3(x, y, z, 8, 1u);
    const auto along = [&](double dx, double dy, double dz) {
      return (noise::perlin3(x + dx, y + dy, z + dz, 8, 1u)[0] - noise::perlin3(x - dx, y - dy, z - dz, 8, 1u)[0]) /
             (2 * h);
    };
    CHECK(along(h, 0, 0) == Approx(at[1]).margin(1e-7));
    CHECK(along(0, h, 0) == Approx(at[2]).margin(1e-7));
    CHECK(along(0, 0, h) == Approx(at[3]).margin(1e-7));
    const auto flat = noise::perlin2(x, y, 8, 1u);
    CHECK((noise::perlin2(x + h, y, 8, 1u)[0] - noise::perlin2(x - h, y, 8, 1u)[0]) / (2 * h) ==
          Approx(flat[1]).margin(1e-7));
    CHECK((noise::perlin2(x, y + h, 8, 1u)[0] - noise::perlin2(x, y - h, 8, 1u)[0]) / (2 * h) ==
          Approx(flat[2]).margin(1e-7));
  }
}

TEST_CASE("truth: curls have no divergence; three noises side by side have") {
  Random random(21);
  const double h = 1e-5;
  const noise::Octaves octaves{3, 0.25f};
  double flat = 0, full = 0, naive = 0, slope = 0;
  for (int i = 0; i < 2000; ++i) {
    const double p[3] = {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
    const auto divergence = [&](const auto& field, size_t axes) {
      double sum = 0;
      for (size_t axis = 0; axis < axes; ++axis) {
        double up[3] = {p[0], p[1], p[2]}, down[3] = {p[0], p[1], p[2]};
        up[axis] += h, down[axis] -= h;
        const double change = (field(up)[axis] - field(down)[axis]) / (2 * h);
        sum += change;
        slope = std::max(slope, std::abs(change));
      }
      return std::abs(sum);
    };
    flat = std::max(flat, divergence([&](const double* q) { return noise::curl2(q[0], q[1], 4, octaves, 1u); }, 2));
    full =
        std::max(full, divergence([&](const double* q) { return noise::curl3(q[0], q[1], q[2], 4, octaves, 1u); }, 3));
    naive = std::max(naive, divergence(
                                [&](const double* q) {
                                  const auto n = [&](uint32_t seed) {
                                    return noise::perlin3(4 * q[0], 4 * q[1], 4 * q[2], 4, seed)[0];
                                  };
                                  return std::array<double, 3>{n(1), n(2), n(3)};
                                },
                                3));
  }
  // Second derivatives are continuous, third ones jump at the faces of cells: an error of h f''' there, of the largest
  // slope.
  CHECK(flat < 2e-3 * slope);
  CHECK(full < 2e-3 * slope);
  CHECK(naive > 5.0);
}

TEST_CASE("truth: 1/x from whole numbers is 1/x") {
  Random random(22);
  std::vector<NoiseItem> items(100000);
  for (NoiseItem& item : items) item.x = static_cast<float>(random.log_uniform(0x1p-40, 0x1p40));
  items[0].x = 1.0f, items[1].x = 2.0f, items[2].x = std::nextafter(2.0f, 0.0f), items[3].x = 0.5f;
  const std::vector<Four> device = evaluate_noise(Part::numbers, items);
  double worst = 0;
  for (size_t i = 0; i < items.size(); ++i)
    worst = std::max(worst, std::abs(device[i][0] * static_cast<double>(items[i].x) - 1.0));
  CHECK(worst < 1.5 * 0x1p-23);  // one and a half units in the last place
  CHECK(device[0][0] == 1.0f);
  CHECK(device[1][0] == 0.5f);
}
