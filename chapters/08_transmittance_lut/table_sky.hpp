// Chapter 08's effect: chapter 05's march, with the air on the way to the sun from the transmittance table.
#pragma once

#include "chapters/08_transmittance_lut/transmittance_lut.hpp"

namespace welkin {

// Pass "march": view.steps and rule of chapter 05.
app::Effect table_march();

std::vector<app::ProbeResult> probe_table_march(const app::Context& context, std::span<const app::ProbeRay> rays);

}  // namespace welkin
