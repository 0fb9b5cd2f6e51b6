// The relief of a scene as three maps: height in km, slopes, and what covers it. Made from noise, or read from a PNG.
// CPU.
//
// A map is a square of `size` x `size` samples around the scene's place: column i lies at x = ((i + 1/2)/size - 1/2)
// extent to the east, row j at y = (1/2 - (j + 1/2)/size) extent to the north, so that row 0 is the north edge, as in a
// picture. (x, y) of a point: where its vertical pierces the sphere, projected straight down onto the tangent plane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/scene/scene.hpp"

namespace welkin {

struct TerrainMap {
  int size = 0;
  double extent_km = 0.0;
  std::vector<float> height_km;               // size * size, 0 and above
  std::vector<std::array<float, 2>> slope;    // dh/dx, dh/dy
  std::vector<std::array<uint8_t, 4>> cover;  // share of grass, rock, snow, bare ground (the planet's own), of 255
  float highest_km = 0.0;
};

// The same bits on every machine: integer hashes, one order of evaluation, no library function but sqrt.
// Throws Error: a file that is not a square 16-bit grayscale PNG of 2 to 4096 samples a side.
TerrainMap make_terrain_map(const Terrain& terrain);

// Throws Error if the map is wider than the planet's radius: the map is projected along the vertical of the scene's
// place, and so far out that projection no longer reaches the ground everywhere.
void check_fits_planet(const Terrain& terrain, double ground_radius_km);

// Maxima over squares of patches, for walks over the map (shaders/11_aerial_perspective/height_field.glsl). Patch (i,
// j) is the square between samples i - 1 and i, j - 1 and j; the outermost patches lie beyond the outer samples and are
// level, which makes size + 1 patches a side. A node of level k holds the highest corner of 2^k x 2^k patches. Levels
// 1, 2, ... lie below each other in one picture `width` wide, level k from row 2 width - (2 width >> (k - 1)) on.
struct HeightMaxima {
  int levels = 0;
  int width = 0, rows = 0;
  std::vector<float> highest_km;  // width * rows
};
HeightMaxima height_maxima(const TerrainMap& map);

// Height at (x, y), bilinear between samples, the edge's value beyond; 0 outside of the square.
double height_at(const TerrainMap& map, double x_km, double y_km);

}  // namespace welkin
