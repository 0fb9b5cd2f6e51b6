// The air in front of the camera as froxels: boxes of a grid that follows the camera's frustum. Used with terrain only.
#pragma once

#include <vector>

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"
#include "chapters/11_aerial_perspective/relief.hpp"

namespace welkin {

std::vector<Knob> froxel_knobs();  // aerial.method, froxels.*

// On the board: in-scattered light and extinction per km, each the mean of the air up to a slice's end. Where the
// channels share an extinction, both are in one image.
struct Froxels {
  graph::Resource in_scattering, extinction;
};

// Push constants of block.glsl.
struct AerialPush {
  float extent_km, farthest_km;
};
AerialPush aerial_push(const app::Context& context);

// A step with the bindings and constants that all passes of this chapter share which march or look up the air.
graph::Step aerial_step(const app::Context& context, app::Board& board, const std::string& shader);

// Pass "aerial perspective": fills the froxels when camera, sun, air or shadows have changed.
app::Effect aerial_perspective();

}  // namespace welkin
