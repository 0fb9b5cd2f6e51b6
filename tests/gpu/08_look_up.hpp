// Shared by chapter 08's tests: fills a planet's table on the device and looks paths up in it with the shader's
// functions. Units: km.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/reference/quadrature.hpp"

namespace welkin::test {

struct Path {
  float altitude_km = 0.0f;
  float mu = 1.0f;
};

struct TableLookup {
  reference::Rgb transmittance{};  // transmittance_to_top
  reference::Rgb optical_depth{};  // optical_depth_to_top
};

using Choices = std::vector<std::pair<std::string, std::string>>;  // knobs that differ from their defaults

enum class Sampler { device, coarse };  // coarse: weights between texels rounded to 1/256

// scene: "earth" or "alien" of chapters/scenes.
std::vector<TableLookup> look_up(const std::string& scene, const Choices& choices, std::span<const Path> paths,
                                 Sampler sampler = Sampler::device);

// A path and its true optical depth and transmittance.
struct ReferencePath {
  Path path;
  double lowest_km = 0.0;
  reference::Rgb optical_depth{}, transmittance{};
};

// The rows of tests/data/transmittance_*.csv; the columns are explained there.
std::vector<ReferencePath> path_rows(const std::string& file);

// Random paths that miss the ground, with their truth by quadrature in double: a third anywhere, a third between the
// horizon and the horizontal, a third with a lowest point 1 m to 30 km above the ground. Altitudes from 0.5 m to the
// top, a fifth of them in the last 5 km.
std::vector<ReferencePath> random_paths(const reference::Planet& planet, uint64_t seed, int count);

// Largest relative error of the transmittances above 1e-4; NaN counts as 1e30.
double worst_error(const std::string& scene, const Choices& choices, std::span<const ReferencePath> truth,
                   Sampler sampler = Sampler::device);

}  // namespace welkin::test
