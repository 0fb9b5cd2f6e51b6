// The multiple scattering table as an effect, for this chapter and those after it.
//
// A pass that looks it up binds the table and takes the constants from the board. Its shader declares the sampler,
// defines read_multiple_scattering_table(uv) with it, and includes 09_multiple_scattering_lut/variant.glsl.
#pragma once

#include <string>
#include <vector>

#include "chapters/04_air/air_block.hpp"

namespace welkin {

// The knobs orders, tables, and multiple_scattering.method, .iterations, .directions, .set, .steps, .view_steps, .size,
// .map, .format.
std::vector<Knob> multiple_scattering_knobs();

// Number of orders to gather before the rest of the series is extrapolated: 3 + 2 tau + 0.3 tau^2, at most 64. tau: the
// largest vertical scattering optical depth of the three channels.
int orders_needed(const interop::Atmosphere& air);

// On the board unless orders = 1: moments of the light scattered at least once, by altitude and mu_sun.
struct MultipleScatteringTable {
  graph::Resource image;
  gpu::Constants constants;  // MS_METHOD, MS_MAP, MS_SIZE
};

// Pass "multiple scattering": fills the table when the air has changed. Off with orders = 1.
app::Effect multiple_scattering_table();

}  // namespace welkin
