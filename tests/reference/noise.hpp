// The noise of chapter 16 written again for the processor, from its formulas and not from the shader's text. In float
// it must give the shader's bits (products and sums one by one, in the order the formulas stand in; the tests are
// compiled with -ffp-contract=off); in double it shows that derivatives are derivatives and curls have no divergence.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace welkin::test::noise {

using Hash = std::array<uint32_t, 4>;

// pcg4d of Jarzynski and Olano 2020.
inline Hash hashed(int x, int y, int z, uint32_t seed) {
  Hash v{static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(z), seed};
  const auto mix = [&] { v[0] += v[1] * v[3], v[1] += v[2] * v[0], v[2] += v[0] * v[1], v[3] += v[1] * v[2]; };
  for (uint32_t& n : v) n = n * 1664525u + 1013904223u;
  mix();
  for (uint32_t& n : v) n ^= n >> 16;
  mix();
  return v;
}

template <typename T>
T unit(uint32_t bits) {
  return static_cast<T>(bits >> 8) / T(16777216);  // a power of two: exact
}

inline int repeated(int cell, int period) { return ((cell % period) + period) % period; }

// A value and its derivatives along x, y, z.
template <typename T>
using Sloped = std::array<T, 4>;

template <typename T>
T lerp(T a, T b, T t) {
  return a + t * (b - a);
}

// a at t = 0 becomes b at t = 1 by the quintic; `axis` (1 to 3) is the direction t runs in.
template <typename T>
Sloped<T> blended(const Sloped<T>& a, const Sloped<T>& b, T t, size_t axis) {
  const T s = t * t * t * (t * (t * T(6) - T(15)) + T(10)), ds = T(30) * t * t * (t * (t - T(2)) + T(1));
  Sloped<T> c;
  for (size_t i = 0; i < 4; ++i) c[i] = lerp(a[i], b[i], s);
  c[axis] = c[axis] + ds * (b[0] - a[0]);
  return c;
}

template <typename T>
Sloped<T> perlin3(T x, T y, T z, int period, uint32_t seed) {
  const T fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const int cx = static_cast<int>(fx), cy = static_cast<int>(fy), cz = static_cast<int>(fz);
  std::array<Sloped<T>, 8> corner;
  for (int n = 0; n < 8; ++n) {
    const int i = n & 1, j = n >> 1 & 1, k = n >> 2;
    const Hash h = hashed(repeated(cx + i, period), repeated(cy + j, period), repeated(cz + k, period), seed);
    const T first = h[0] >> 31 == 0 ? T(1) : T(-1), second = h[1] >> 31 == 0 ? T(1) : T(-1);
    const size_t missing = ((h[2] >> 16) * 3) >> 16;
    std::array<T, 3> g{};
    g[missing == 0 ? 1 : 0] = first;
    g[missing == 2 ? 1 : 2] = second;
    const T dx = (x - fx) - T(i), dy = (y - fy) - T(j), dz = (z - fz) - T(k);
    corner[static_cast<size_t>(n)] = {g[0] * dx + g[1] * dy + g[2] * dz, g[0], g[1], g[2]};
  }
  std::array<Sloped<T>, 4> edge;
  for (size_t n = 0; n < 4; ++n) edge[n] = blended(corner[2 * n], corner[2 * n + 1], x - fx, 1);
  return blended(blended(edge[0], edge[1], y - fy, 2), blended(edge[2], edge[3], y - fy, 2), z - fz, 3);
}

template <typename T>
Sloped<T> perlin2(T x, T y, int period, uint32_t seed) {
  const T fx = std::floor(x), fy = std::floor(y);
  std::array<Sloped<T>, 4> corner;
  for (int n = 0; n < 4; ++n) {
    const int i = n & 1, j = n >> 1;
    const Hash h =
        hashed(repeated(static_cast<int>(fx) + i, period), repeated(static_cast<int>(fy) + j, period), 0, seed);
    const T first = h[0] >> 31 == 0 ? T(1) : T(-1), second = h[1] >> 31 == 0 ? T(1) : T(-1);
    std::array<T, 2> g{first, second};
    if (h[2] >> 31 != 0) g = {T(0), T(0)}, g[second < T(0) ? 0 : 1] = first * T(1.41421356f);
    corner[static_cast<size_t>(n)] = {g[0] * ((x - fx) - T(i)) + g[1] * ((y - fy) - T(j)), g[0], g[1], T(0)};
  }
  return blended(blended(corner[0], corner[1], x - fx, 1), blended(corner[2], corner[3], x - fx, 1), y - fy, 2);
}

// Calls found(squared distance, the cell's hash) for every cell from `from` to 1 around (x, y, z); flat: of one layer.
template <typename T, typename Found>
void around(T x, T y, T z, int period, uint32_t seed, bool flat, int from, const Found& found) {
  const T fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  for (int k = flat ? 0 : from; k <= (flat ? 0 : 1); ++k)
    for (int j = from; j <= 1; ++j)
      for (int i = from; i <= 1; ++i) {
        const auto cell = [&](T corner, int offset) { return repeated(static_cast<int>(corner) + offset, period); };
        const Hash h = hashed(cell(fx, i), cell(fy, j), flat ? 0 : cell(fz, k), seed);
        const T dx = unit<T>(h[0]) + T(i) - (x - fx), dy = unit<T>(h[1]) + T(j) - (y - fy),
                dz = unit<T>(h[2]) + T(k) - (z - fz);
        found(flat ? dx * dx + dy * dy : dx * dx + dy * dy + dz * dz, h);
      }
}

// from: -1 for all neighbours, 0 for the eight cells towards larger coordinates, which is not enough.
template <typename T>
T worley(T x, T y, T z, int period, uint32_t seed, bool flat = false, int from = -1) {
  T nearest(1);
  around(x, y, z, period, seed, flat, from, [&](T squared, const Hash&) { nearest = std::min(nearest, squared); });
  return T(1) - nearest;
}

template <typename T>
T alligator(T x, T y, T z, int period, uint32_t seed) {
  std::vector<T> balls;
  around(x, y, z, period, seed, false, -1, [&](T squared, const Hash& h) {
    const T inside = std::max(T(1) - squared, T(0));
    balls.push_back(unit<T>(h[3]) * (inside * inside * (T(3) - T(2) * inside)));
  });
  std::partial_sort(balls.begin(), balls.begin() + 2, balls.end(), std::greater<>());
  return balls[0] - balls[1];
}

struct Octaves {
  int count;
  float gain;
  float full() const { return (1.0f - gain) / (1.0f - static_cast<float>(std::pow(static_cast<double>(gain), count))); }
};

// Sum over octaves of strength * one(cells, seed of the octave), times `full`.
template <typename T, typename One>
auto fbm(const Octaves& octaves, int cells, uint32_t seed, const One& one) {
  auto sum = one(cells, seed);  // of strength 1; 0 + 1 * x is x
  T strength(1);
  for (int i = 1; i < octaves.count; ++i) {
    strength *= T(octaves.gain);
    const auto octave = one(cells << i, seed + static_cast<uint32_t>(i) * 0x9E3779B9u);
    for (size_t c = 0; c < sum.size(); ++c) sum[c] = sum[c] + strength * octave[c];
  }
  for (T& s : sum) s = s * T(octaves.full());
  return sum;
}

// Not shifted: corners of all octaves' lattices coincide.
template <typename T>
Sloped<T> perlin_fbm(T x, T y, T z, bool flat, int cells, const Octaves& octaves, uint32_t seed, bool shifted = true) {
  return fbm<T>(octaves, cells, seed, [&](int n, uint32_t s) {
    const T f = static_cast<T>(n);
    const Hash h = hashed(-1, -1, -1, s);
    const auto moved = [&](T at, size_t axis) { return at * f + T(shifted ? h[axis] >> 24 : 0) / T(256); };
    Sloped<T> v = flat ? perlin2(moved(x, 0), moved(y, 1), n, s) : perlin3(moved(x, 0), moved(y, 1), moved(z, 2), n, s);
    for (size_t i = 1; i < 4; ++i) v[i] = v[i] * f;
    return v;
  });
}

template <typename T>
T worley_fbm(T x, T y, T z, bool flat, int cells, const Octaves& octaves, uint32_t seed) {
  return fbm<T>(octaves, cells, seed, [&](int n, uint32_t s) {
    const T f = static_cast<T>(n);
    return std::array<T, 1>{worley(x * f, y * f, z * f, n, s, flat)};
  })[0];
}

template <typename T>
T dilated(T perlin, T worley) {
  const T low = T(0.5) + T(0.5) * perlin;
  return worley + low * low * (T(1) - worley);
}

template <typename T>
std::array<T, 4> curl2(T x, T y, int cells, const Octaves& octaves, uint32_t seed) {
  const Sloped<T> a = perlin_fbm(x, y, T(0), true, cells, octaves, seed),
                  b = perlin_fbm(x, y, T(0), true, cells, octaves, seed + 1),
                  c = perlin_fbm(x, y, T(0), true, cells, octaves, seed + 2);
  return {c[2], -c[1], b[1] - a[2], c[0]};
}

template <typename T>
std::array<T, 4> curl3(T x, T y, T z, int cells, const Octaves& octaves, uint32_t seed) {
  const Sloped<T> a = perlin_fbm(x, y, z, false, cells, octaves, seed),
                  b = perlin_fbm(x, y, z, false, cells, octaves, seed + 1),
                  c = perlin_fbm(x, y, z, false, cells, octaves, seed + 2);
  return {c[2] - b[3], a[3] - c[1], b[1] - a[2], T(0)};
}

enum class Kind { base, detail, curl, weather, alligator };

inline std::array<float, 4> texel(Kind kind, float x, float y, float z, const Octaves& o, uint32_t seed) {
  const auto w = [&](int n, uint32_t s) {
    const float f = static_cast<float>(n);
    return worley(x * f, y * f, z * f, n, s);
  };
  const auto a = [&](int n, uint32_t s) {
    const float f = static_cast<float>(n);
    return alligator(x * f, y * f, z * f, n, s);
  };
  const auto p = [&](bool flat, int cells, uint32_t s) { return perlin_fbm(x, y, z, flat, cells, o, s)[0]; };
  const auto summed = [](float r, float g, float b) {
    return std::array<float, 4>{r, g, b, 0.5f * r + 0.25f * g + 0.125f * b};
  };
  switch (kind) {
    case Kind::base:
      return {dilated(p(false, 4, seed), worley_fbm(x, y, z, false, 8, o, seed + 10)), w(8, seed + 20),
              w(16, seed + 30), w(32, seed + 40)};
    case Kind::detail: return summed(w(2, seed), w(4, seed + 10), w(8, seed + 20));
    case Kind::curl: return curl2(x, y, 4, o, seed);
    case Kind::weather: {
      const float coverage = dilated(p(true, 4, seed), worley_fbm(x, y, z, true, 8, o, seed + 10));
      return {coverage, coverage + 0.5f * p(true, 2, seed + 20), p(true, 2, seed + 30), p(true, 4, seed + 40)};
    }
    case Kind::alligator: return summed(a(4, seed), a(8, seed + 10), a(16, seed + 20));
  }
  return {};
}

}  // namespace welkin::test::noise
