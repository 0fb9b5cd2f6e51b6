// Chapter 08's effect: chapter 05's march, with the optical depth towards the sun from the transmittance table.
#pragma once

#include "chapters/08_transmittance_lut/transmittance_lut.hpp"

namespace welkin {

// Pass "march", with the knobs view.steps and rule of chapter 05.
app::Effect table_march();

// Radiance and transmittance of single rays, by the same march without the sun's disc.
std::vector<app::ProbeResult> probe_table_march(const app::Context& context, std::span<const app::ProbeRay> rays);

}  // namespace welkin
