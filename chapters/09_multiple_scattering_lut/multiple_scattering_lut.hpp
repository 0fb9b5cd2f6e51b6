// The table of light scattered before as an effect, for this chapter and those after it.
//
// A pass that looks it up binds the table and takes the constants from the board; its shader declares the sampler,
// defines read_multiple_scattering_table(uv) by it, and includes 09_multiple_scattering_lut/variant.glsl.
#pragma once

#include <string>
#include <vector>

#include "chapters/04_air/air_block.hpp"

namespace welkin {

// orders, tables, and multiple_scattering.method, .iterations, .directions, .set, .steps, .view_steps, .size, .map,
// .format.
std::vector<Knob> multiple_scattering_knobs();

// Orders to gather before the series of this air can be closed: 3 + 2 tau + 0.3 tau^2, tau its scattering optical depth
// straight up in the channel where it is deepest; 64 at most.
int orders_of(const interop::Atmosphere& air);

// On the board where more than one order is asked for.
struct MultipleScatteringTable {
  graph::Resource image;
  gpu::Constants constants;  // MS_METHOD, MS_MAP, MS_SIZE
};

// Pass "multiple scattering": fills the table, when the air has changed. Not wanted with orders = 1.
app::Effect multiple_scattering_table();

}  // namespace welkin
