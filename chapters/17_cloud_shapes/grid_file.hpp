// Density grids from files. CPU.
//
// A file is 256 bytes of text, padded with blanks: "welkin-grid 1", "name ...", "corners nx ny nz", "box_km lx ly lz"
// and a note, a line each; then nx ny nz float32, little-endian, x fastest. Sample (i, j, k) is the density at the
// corner (i lx / (nx - 1), ...); between corners it is trilinear, outside the box 0.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace welkin {

struct DensityGrid {
  std::array<int, 3> corners{};
  std::vector<float> density;  // 0 ... 1000
  float largest = 0.0f;
};

// Throws Error, one line: not a grid, cut short, too long, fewer than 2 or more than 512 corners a side, a sample that
// is negative, above 1000 or not a number. Memory is taken when the file's length fits what its text says.
DensityGrid read_grid(const std::filesystem::path& file);

}  // namespace welkin
