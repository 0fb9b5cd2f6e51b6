// Reading density grids. See grid_file.hpp.
#include "chapters/17_cloud_shapes/grid_file.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <sstream>
#include <vector>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "common/scene/one_line.hpp"

namespace welkin {
namespace {

constexpr size_t kTextBytes = 256, kMostCorners = 512, kMostBytes = kTextBytes + (size_t{1} << 27);
constexpr const char* kMagic = "welkin-grid 1";

// The lines of the text that begin with a word, without it and the blanks about it.
std::vector<std::string> lines_of(const std::string& text, const std::string& word) {
  std::istringstream lines(text);
  std::vector<std::string> found;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key, rest;
    if (!(words >> key) || key != word) continue;
    std::getline(words >> std::ws, rest);
    found.push_back(rest.substr(0, rest.find_last_not_of(" \r") + 1));
  }
  return found;
}

// Three numbers and nothing else.
template <typename T>
std::optional<std::array<T, 3>> three(const std::string& text) {
  std::istringstream words(text);
  std::array<T, 3> numbers{};
  std::string rest;
  if (!(words >> numbers[0] >> numbers[1] >> numbers[2]) || (words >> rest)) return std::nullopt;
  return numbers;
}

}  // namespace

// [read_grid]
DensityGrid read_grid(const std::filesystem::path& file) {
  static_assert(std::endian::native == std::endian::little, "samples are copied as they are");
  const std::string shown = one_line(file.string());
  const std::string bytes = read_file(file, kMostBytes);
  const std::string text = bytes.substr(0, kTextBytes);
  const std::string first = text.substr(0, text.find('\n'));
  if (bytes.size() < kTextBytes || first.substr(0, first.find_last_not_of(" \r") + 1) != kMagic)
    fail("grid file {}: accepted is a file that begins with 256 bytes of text, the first line \"{}\"", shown, kMagic);
  const auto the_only = [&](const char* word) {
    const std::vector<std::string> lines = lines_of(text, word);
    if (lines.size() != 1)
      fail("grid file {}: {} lines \"{} …\" in its first 256 bytes; accepted is one", shown, lines.size(), word);
    return lines.front();
  };
  const std::string corners_line = the_only("corners"), box_line = the_only("box_km");
  const auto read = three<long>(corners_line);
  const auto good = [](long n) { return n >= 2 && n <= long{kMostCorners}; };
  if (!read || !std::all_of(read->begin(), read->end(), good))
    fail("grid file {}: corners {}; accepted is a line \"corners nx ny nz\" of 2 to {} a side", shown,
         one_line(corners_line), kMostCorners);
  const auto box = three<double>(box_line);
  if (!box || !std::all_of(box->begin(), box->end(), [](double side) { return side > 0.0 && side < 1e6; }))
    fail("grid file {}: box_km {}; accepted is a line \"box_km lx ly lz\" of lengths above 0", shown,
         one_line(box_line));
  const std::array<long, 3>& corners = *read;
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
