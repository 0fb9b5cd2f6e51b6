// Reading density grids. See grid_file.hpp.
#include "chapters/17_cloud_shapes/grid_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <sstream>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "common/scene/one_line.hpp"

namespace welkin {
namespace {

constexpr size_t kTextBytes = 256, kMostCorners = 512, kMostBytes = kTextBytes + (size_t{1} << 27);
constexpr const char* kMagic = "welkin-grid 1";

// The three whole numbers after "corners", a line of the text; zeros if there are none.
std::array<long, 3> corners_of(const std::string& text) {
  std::istringstream lines(text);
  std::array<long, 3> corners{};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key, rest;
    if (!(words >> key) || key != "corners") continue;
    if (!(words >> corners[0] >> corners[1] >> corners[2]) || (words >> rest)) return {};
  }
  return corners;
}

}  // namespace

// [read_grid]
DensityGrid read_grid(const std::filesystem::path& file) {
  static_assert(std::endian::native == std::endian::little, "samples are copied as they are");
  const std::string shown = one_line(file.string());
  const std::string bytes = read_file(file, kMostBytes);
  if (!bytes.starts_with(kMagic) || bytes.size() < kTextBytes)
    fail("grid file {}: accepted is a file that begins with 256 bytes of text, the first line \"{}\"", shown, kMagic);
  const std::array<long, 3> corners = corners_of(bytes.substr(0, kTextBytes));
  const auto good = [](long n) { return n >= 2 && n <= long{kMostCorners}; };
  if (!std::all_of(corners.begin(), corners.end(), good))
    fail("grid file {}: corners {} {} {}; accepted is a line \"corners nx ny nz\" of 2 to {} a side", shown, corners[0],
         corners[1], corners[2], kMostCorners);
  const size_t samples =
      static_cast<size_t>(corners[0]) * static_cast<size_t>(corners[1]) * static_cast<size_t>(corners[2]);
  if (bytes.size() != kTextBytes + samples * sizeof(float))
    fail("grid file {}: {} bytes; {} x {} x {} corners are {}", shown, bytes.size(), corners[0], corners[1], corners[2],
         kTextBytes + samples * sizeof(float));
  DensityGrid grid{.density = std::vector<float>(samples)};
  std::memcpy(grid.density.data(), bytes.data() + kTextBytes, samples * sizeof(float));
  for (size_t axis = 0; axis < 3; ++axis) grid.corners[axis] = static_cast<int>(corners[axis]);
  for (size_t i = 0; i < samples; ++i)
    if (!(grid.density[i] >= 0.0f && grid.density[i] <= 1000.0f))
      fail("grid file {}: sample {} is {:g}; accepted is a density from 0 to 1000", shown, i, grid.density[i]);
  grid.largest = *std::max_element(grid.density.begin(), grid.density.end());
  return grid;
}
// [/read_grid]

}  // namespace welkin
