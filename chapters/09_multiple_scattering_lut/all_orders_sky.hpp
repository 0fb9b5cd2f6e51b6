// Chapter 09's effect: the first order marched as in chapter 05, all others by marching through the table.
#pragma once

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

namespace welkin {

// The march of all orders, or of the first where there is no table: shader, constants and bindings but for what it
// writes. Later chapters fall back on it. shader: "image" or "probe".
graph::Step all_orders_step(const app::Context& context, app::Board& board, const std::string& shader);
// Its push constants behind the camera: steps of both marches.
struct MarchSteps {
  int32_t view_steps, table_steps, count, unused;
};
// Pushes camera (where the shader takes it so) and steps, and covers the picture.
void record_all_orders(const app::Context& context, const graph::Recorder& r, bool has_table, VkExtent2D size);

// Pass "march": view.steps.
app::Effect all_orders_march();

std::vector<app::ProbeResult> probe_all_orders(const app::Context& context, std::span<const app::ProbeRay> rays);

}  // namespace welkin
