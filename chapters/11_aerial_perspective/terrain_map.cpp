// Making and reading height maps. See terrain_map.hpp.
#include "chapters/11_aerial_perspective/terrain_map.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "common/error.hpp"
#include "common/image/png.hpp"
#include "common/scene/one_line.hpp"

namespace welkin {
namespace {

constexpr uint32_t kLargestSide = 4096;

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// [noise]
// A number for every lattice point and seed: integers only, so that all machines agree.
uint32_t hash(int32_t x, int32_t y, uint32_t seed) {
  uint32_t h = static_cast<uint32_t>(x) * 0x9E3779B1u ^ static_cast<uint32_t>(y) * 0x85EBCA77u ^ seed * 0xC2B2AE3Du;
  h ^= h >> 15, h *= 0x2C1B3C6Du, h ^= h >> 12, h *= 0x297A2D39u, h ^= h >> 15;
  return h;
}

// Gradient noise, about -1 ... 1, smooth to its second derivative. Eight directions, whose components need no sine.
double noise(double x, double y, uint32_t seed) {
  const double floor_x = std::floor(x), floor_y = std::floor(y);
  const int32_t i = static_cast<int32_t>(floor_x), j = static_cast<int32_t>(floor_y);
  const double u = x - floor_x, v = y - floor_y;
  const auto corner = [&](int32_t di, int32_t dj) {
    static constexpr double kDirections[8][2] = {
        {1, 0},  {0.70710678118654752, 0.70710678118654752},   {0, 1},  {-0.70710678118654752, 0.70710678118654752},
        {-1, 0}, {-0.70710678118654752, -0.70710678118654752}, {0, -1}, {0.70710678118654752, -0.70710678118654752}};
    const double* direction = kDirections[hash(i + di, j + dj, seed) >> 29];
    return direction[0] * (u - di) + direction[1] * (v - dj);
  };
  const auto fade = [](double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); };
  const double a = fade(u), b = fade(v);
  const double low = corner(0, 0) + a * (corner(1, 0) - corner(0, 0)),
               high = corner(0, 1) + a * (corner(1, 1) - corner(0, 1));
  return 1.5 * (low + b * (high - low));
}

// Ridges: 1 - |noise| has its crests where noise changes sign. Finer octaves grow on crests and leave valleys smooth.
double ridges(double x, double y, uint32_t seed) {
  double sum = 0.0, share = 0.5, carried = 1.0;
  for (uint32_t octave = 0; octave < 7; ++octave) {
    const double crest = std::max(1.0 - std::abs(noise(x, y, seed + octave)), 0.0);
    const double value = crest * crest * carried;
    sum += share * value;
    carried = std::min(value * 1.6, 1.0);
    // The next octave is turned by atan(3/4), so that the lattices never line up.
    const double turned_x = 2.03 * (0.8 * x - 0.6 * y) + 17.3, turned_y = 2.03 * (0.6 * x + 0.8 * y) - 9.1;
    x = turned_x, y = turned_y, share *= 0.5;
  }
  return sum;
}
// [/noise]

// [hills]
// The scene's place is the top of a knoll. Around it lies a valley with low hills, further out stand ranges, and at the
// map's edge, where the sphere begins, the ground is level again. Relative height; x, y in km.
double hill(double x, double y, double extent_km, uint32_t seed) {
  const double from_place = std::sqrt(x * x + y * y), half = 0.5 * extent_km;
  const double to_edge = std::max(std::abs(x), std::abs(y)) / half;
  const double wide = noise(x / 9.0, y / 9.0, seed + 40);
  const double ranges = smooth_step(0.1, 0.44, from_place / half + 0.07 * wide);
  const double crest = ridges(x / 15.0, y / 15.0, seed);
  // Hills of some 200 m, in rows: their crests are ridges, too, but rounder ones.
  const double row = 1.0 - std::abs(noise(x / 4.3 + 0.4 * wide, y / 4.3, seed + 50));
  const double low = smooth_step(0.012, 0.09, from_place / half) *
                     (0.075 * row * row * row + 0.02 * (1.0 + noise(x / 1.3, y / 1.3, seed + 51)));
  const double knoll = 1.0 / (1.0 + from_place * from_place / 0.7);
  const double bumps = 0.004 * noise(x / 0.61, y / 0.61, seed + 52) + 0.0016 * noise(x / 0.29, y / 0.29, seed + 53);
  return (1.0 - smooth_step(0.8, 0.97, to_edge)) *
         (0.01 + 0.055 * knoll * knoll + low + bumps + ranges * crest * crest * 1.7);
}
// [/hills]

// Fills the rows on all processors: making hills takes half of the time a start takes.
template <typename Fill>
void in_parallel(int rows, const Fill& fill) {
  const int parts = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16);
  std::vector<std::jthread> threads;  // joined at the end of the block
  for (int part = 0; part < parts; ++part) threads.emplace_back(fill, rows * part / parts, rows * (part + 1) / parts);
}

std::vector<float> make_heights(const Terrain& terrain) {
  const int n = terrain.size;
  std::vector<float> heights(static_cast<size_t>(n) * n);
  const auto fill = [&](int first, int last) {
    for (int j = first; j < last; ++j)
      for (int i = 0; i < n; ++i) {
        const double x = ((i + 0.5) / n - 0.5) * terrain.extent_km, y = (0.5 - (j + 0.5) / n) * terrain.extent_km;
        const double height = hill(x, y, terrain.extent_km, static_cast<uint32_t>(terrain.seed) * 101u);
        heights[static_cast<size_t>(j) * n + i] = static_cast<float>(std::max(height, 0.0));
      }
  };
  in_parallel(n, fill);
  const float highest = *std::max_element(heights.begin(), heights.end());
  for (float& height : heights) height *= static_cast<float>(terrain.height_km) / std::max(highest, 1e-6f);
  return heights;
}

// [read]
std::vector<float> read_heights(const Terrain& terrain, int& size) {
  constexpr const char* accepted = "accepted is a square 16-bit grayscale PNG of 2 to 4096 samples a side";
  Image16 picture;
  try {
    picture = image::read_png16(terrain.height_map);  // 8 bits are refused: slopes would be stairs
  } catch (const Error& error) {
    fail("height map: {}; {}", one_line(error.what()), accepted);
  }
  const std::string name = one_line(terrain.height_map);
  if (picture.width != picture.height)
    fail("height map: {}: {} x {} samples, not square; {}", name, picture.width, picture.height, accepted);
  if (picture.width < 2 || picture.width > kLargestSide)
    fail("height map: {}: {} samples a side; {}", name, picture.width, accepted);
  size = static_cast<int>(picture.width);
  std::vector<float> heights;
  heights.reserve(picture.gray.size());
  for (const uint16_t sample : picture.gray)
    heights.push_back(static_cast<float>(sample / 65535.0 * terrain.height_km));
  return heights;
}
// [/read]

// [slopes_and_cover]
// Slopes by central differences; cover from slope and height: rock where it is steep, snow high up, grass elsewhere,
// and bare ground towards the edge of the map, where it has to look like the sphere beyond.
void add_slopes_and_cover(TerrainMap& map) {
  const int n = map.size;
  const double texel_km = map.extent_km / n;
  const auto height = [&](int i, int j) {
    return static_cast<double>(
        map.height_km[static_cast<size_t>(std::clamp(j, 0, n - 1)) * n + std::clamp(i, 0, n - 1)]);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double dx = (height(i + 1, j) - height(i - 1, j)) / (2.0 * texel_km),
                   dy = (height(i, j - 1) - height(i, j + 1)) / (2.0 * texel_km);
      const double x = ((i + 0.5) / n - 0.5) * map.extent_km, y = (0.5 - (j + 0.5) / n) * map.extent_km;
      const double steep = std::sqrt(dx * dx + dy * dy),
                   patch = noise(x / 1.3, y / 1.3, 7u) + 0.5 * noise(x / 0.4, y / 0.4, 8u);
      const double to_edge = std::max(std::abs(x), std::abs(y)) / (0.5 * map.extent_km);
      double bare = std::max(smooth_step(0.7, 0.95, to_edge),
                             0.55 * smooth_step(-0.3, 0.9, patch) * (1.0 - smooth_step(0.05, 0.3, height(i, j))));
      const double snow = smooth_step(1.5, 1.9, height(i, j) + 0.2 * patch - 0.5 * steep) * (1.0 - bare);
      const double rock = smooth_step(0.2, 0.45, steep + 0.08 * patch + 0.12 * smooth_step(0.8, 1.6, height(i, j))) *
                          (1.0 - bare - snow);
      const auto share = [](double value) {
        return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
      };
      map.slope.push_back({static_cast<float>(dx), static_cast<float>(dy)});
      map.cover.push_back({share(1.0 - bare - snow - rock), share(rock), share(snow), share(bare)});
    }
}
// [/slopes_and_cover]

}  // namespace

TerrainMap make_terrain_map(const Terrain& terrain) {
  TerrainMap map{.size = terrain.size, .extent_km = terrain.extent_km};
  map.height_km = terrain.height_map.empty() ? make_heights(terrain) : read_heights(terrain, map.size);
  map.highest_km = *std::max_element(map.height_km.begin(), map.height_km.end());
  map.slope.reserve(map.height_km.size());
  map.cover.reserve(map.height_km.size());
  add_slopes_and_cover(map);
  return map;
}

void check_fits_planet(const Terrain& terrain, double ground_radius_km) {
  if (terrain.extent_km > ground_radius_km)
    fail("terrain.extent_km: a map of {} km on a planet of {} km radius; accepted is at most the radius",
         terrain.extent_km, ground_radius_km);
}

// [height_maxima]
HeightMaxima height_maxima(const TerrainMap& map) {
  const int n = map.size;
  HeightMaxima maxima{.levels = 1};
  while ((8 << maxima.levels) < n + 1) ++maxima.levels;          // about eight nodes a side remain
  const int side = ((n >> maxima.levels) + 1) << maxima.levels;  // in patches: whole nodes of every level
  maxima.width = side / 2;
  maxima.rows = side - (side >> maxima.levels);
  maxima.highest_km.assign(static_cast<size_t>(maxima.width) * maxima.rows, 0.0f);
  const auto row_of = [side](int level) { return side - (side >> (level - 1)); };
  const auto at = [&](int level, int i, int j) -> float& {
    return maxima.highest_km[static_cast<size_t>(row_of(level) + j) * maxima.width + i];
  };
  // A node of level 1 is two patches wide: three samples a side, 2 i - 1 to 2 i + 1.
  for (int j = 0; j < n + 2; ++j)
    for (int i = 0; i < n + 2; ++i) {
      const float height =
          map.height_km[static_cast<size_t>(std::clamp(j - 1, 0, n - 1)) * n + std::clamp(i - 1, 0, n - 1)];
      for (const int y : {(j - 1) / 2, j / 2})
        for (const int x : {(i - 1) / 2, i / 2})
          if (x < side / 2 && y < side / 2) at(1, x, y) = std::max(at(1, x, y), height);
    }
  for (int level = 2; level <= maxima.levels; ++level)
    for (int j = 0; j < side >> (level - 1); ++j)
      for (int i = 0; i < side >> (level - 1); ++i)
        at(level, i / 2, j / 2) = std::max(at(level, i / 2, j / 2), at(level - 1, i, j));
  return maxima;
}
// [/height_maxima]

double height_at(const TerrainMap& map, double x_km, double y_km) {
  if (std::max(std::abs(x_km), std::abs(y_km)) > 0.5 * map.extent_km) return 0.0;
  const double column = std::clamp((x_km / map.extent_km + 0.5) * map.size - 0.5, 0.0, map.size - 1.0);
  const double row = std::clamp((0.5 - y_km / map.extent_km) * map.size - 0.5, 0.0, map.size - 1.0);
  const int i = std::min(static_cast<int>(column), map.size - 2), j = std::min(static_cast<int>(row), map.size - 2);
  const double u = column - i, v = row - j;
  const auto at = [&](int x, int y) {
    return static_cast<double>(map.height_km[static_cast<size_t>(y) * map.size + x]);
  };
  return (at(i, j) * (1 - u) + at(i + 1, j) * u) * (1 - v) + (at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u) * v;
}

}  // namespace welkin
