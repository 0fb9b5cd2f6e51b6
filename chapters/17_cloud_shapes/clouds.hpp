// The clouds of a scene on the device, as an effect: the block of bodies, and the textures that their kinds need.
//
// A pass that asks for clouds includes 17_cloud_shapes/block.glsl and binds what this offers:
//   bind_clouds(step, board.get<CloudBodies>("clouds"));
#pragma once

#include <filesystem>
#include <vector>

#include "chapters/17_cloud_shapes/cloud_bodies.hpp"
#include "common/graph/effect.hpp"

namespace welkin {

std::vector<Knob> cloud_knobs();  // cloud.steps, .detail, .grid, .grid_steps

// On the board where the scene has cloud. What no body needs is a single texel.
struct CloudBodies {
  graph::Resource block, grids, weather, base, detail, curl;
  gpu::Constants constants;  // CLOUD_KINDS
  int kinds = 0;             // the same
  std::vector<Cloud> bodies;
  double ceiling_km = 0.0;
};
void bind_clouds(graph::Step& step, const CloudBodies& clouds);

// Knobs as block.glsl's CloudMarch reads them: part of push constants.
struct CloudMarchPush {
  int32_t steps, detail, grid_method, grid_steps;
};
CloudMarchPush cloud_march(const Settings& settings);

// A weather map of the user's: an 8-bit RGBA PNG, square, 2 to 4096 pixels a side: coverage, height, type, wetness.
// Throws Error, one line, for any other.
struct WeatherMap {
  int size = 0;
  std::vector<uint64_t> texels;  // rows from the north, four halves each
};
WeatherMap read_weather_map(const std::filesystem::path& file);

// Effect "clouds": no pass of its own. Stands behind noise_textures() and weather_texture() in a list.
app::Effect clouds();

}  // namespace welkin
