// What chapter 08's tests share: a planet's table filled on the device, and paths looked up in it by the shader's
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

struct LookedUp {
  reference::Rgb transmittance{};  // transmittance_to_top
  reference::Rgb optical_depth{};  // clear_optical_depth
};

using Choices = std::vector<std::pair<std::string, std::string>>;  // knobs set to other than their defaults

enum class Sampler { device, coarse };  // coarse: weights between texels rounded to 1/256

// scene: "earth" or "alien" of chapters/scenes.
std::vector<LookedUp> look_up(const std::string& scene, const Choices& choices, std::span<const Path> paths,
                              Sampler sampler = Sampler::device);

// A path and what it lets through.
struct TruePath {
  Path path;
  double lowest_km = 0.0;
  reference::Rgb optical_depth{}, transmittance{};
};

// The rows of tests/data/transmittance_*.csv; the columns are explained there.
std::vector<TruePath> path_rows(const std::string& file);

// Paths that miss the ground, by quadrature in double: a third anywhere, a third at the horizon's rays up to
// level, a third whose lowest point is 1 m to 30 km above the ground; altitudes from 0.5 m to the top,
// a fifth of them in the last 5 km.
std::vector<TruePath> random_paths(const reference::Planet& planet, uint64_t seed, int count);

// Largest relative error of the transmittances above 1e-4; NaN counts as 1e30.
double worst_error(const std::string& scene, const Choices& choices, std::span<const TruePath> truth,
                   Sampler sampler = Sampler::device);

}  // namespace welkin::test
