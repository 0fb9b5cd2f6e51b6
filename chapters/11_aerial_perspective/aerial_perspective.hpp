// The air in front of the camera as froxels: boxes of a grid that follows the camera's frustum. Used with terrain only.
#pragma once

#include <vector>

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"
#include "chapters/11_aerial_perspective/relief.hpp"

namespace welkin {

std::vector<Knob> froxel_knobs();  // aerial.method, froxels.*

// On the board: in-scattered light and extinction per km, each the mean up to a slice's end; in one image where the
// channels share an extinction.
struct Froxels {
  graph::Resource in_scattering, extinction;
};

// Push constants of block.glsl.
struct AerialPush {
  float extent_km, farthest_km;
};
AerialPush aerial_push(const app::Context& context);

// What the passes of this chapter that march or look up the air read, and the constants they share.
graph::Step aerial_step(const app::Context& context, app::Board& board, const std::string& shader);

// Pass "aerial perspective": fills the froxels when camera, sun, air or shadows have changed.
app::Effect aerial_perspective();

}  // namespace welkin
