// Two pictures of the same view side by side, with their difference, errors, times and bytes, as PNG, Markdown and
// HTML.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

#include "common/image/image.hpp"
#include "common/measure/bench_json.hpp"

namespace welkin::measure {

struct Side {
  std::string name;  // "05_single_scattering"
  Image picture;     // linear radiance
  BenchResult bench;
};

// Exposure (1 / radiance) that shows the 99th percentile of the largest channel at 1 - exp(-2.3) = 0.9 of linear white.
// Values that are not finite are left out; 1 for a black picture.
float choose_exposure(const Image& picture);

// A perceptually ordered colour for 0..1 (dark violet to yellow; luminance rises throughout), sRGB 0..255.
std::array<uint8_t, 3> scale_colour(float value);

// A | B | difference: the largest channel difference of the display values times `gain`. Pixels that are not finite in
// either picture are magenta in the map.
Image8 side_by_side(const Image& a, const Image& b, float exposure, float gain);

// The largest of 1, 2, 5, 10, ... 1000 under which 99 % of the differences stay on the scale; 1000 for equal pictures.
float choose_gain(const Image& a, const Image& b, float exposure);

// Writes PREFIX.png, PREFIX.md and PREFIX.html (which needs no other file). The exposure comes from the truth if there
// is one, else from A. Error with Exit::mismatch if sizes differ.
void write_comparison(const std::filesystem::path& prefix, const std::string& title, const Side& a, const Side& b,
                      const std::optional<Image>& truth);

}  // namespace welkin::measure
