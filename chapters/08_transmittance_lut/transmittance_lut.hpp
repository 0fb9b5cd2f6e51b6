// The transmittance table as an effect, for this chapter and those after it.
//
// A pass that looks up transmittance binds "transmittance_table" and takes the constants from the board. Its shader
// includes 04_air/variant.glsl, defines TRANSMITTANCE_BINDING and includes 08_transmittance_lut/table.glsl.
#pragma once

#include <vector>

#include "chapters/04_air/air_block.hpp"

namespace welkin {

// The knobs transmittance.width, .height, .steps, .mapping, .stored, .format.
std::vector<Knob> transmittance_knobs();

// On the board: transmittance from every altitude to the top of the air, by the cosine of the zenith angle.
struct TransmittanceTable {
  graph::Resource image;
  gpu::Constants constants;  // TABLE_MAPPING, TABLE_STORED: how it is mapped and what it holds
};

// Pass "transmittance": fills the table when the air has changed.
app::Effect transmittance_table();

}  // namespace welkin
