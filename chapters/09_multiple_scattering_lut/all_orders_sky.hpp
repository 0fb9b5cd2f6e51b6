// Chapter 09's effect: the first order is marched as in chapter 05, the higher orders are marched through the table.
#pragma once

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

namespace welkin {

// The march of all orders, or of the first order where there is no table: shader, constants and bindings except for the
// output. Later chapters fall back on it. shader: "image" or "probe".
graph::Step all_orders_step(const app::Context& context, app::Board& board, const std::string& shader);
// Its push constants where there is a table: steps of both marches, and the number of rays of a probe.
struct MarchSteps {
  int32_t view_steps, table_steps, count, unused;
};
// Pushes the steps, and the camera where chapter 05's shader needs it, and dispatches over the picture.
void record_all_orders(const app::Context& context, const graph::Recorder& r, bool has_table, VkExtent2D size);

// Pass "march", with the knob view.steps.
app::Effect all_orders_march();

// Radiance and transmittance of single rays, by the same march without the sun's disc.
std::vector<app::ProbeResult> probe_all_orders(const app::Context& context, std::span<const app::ProbeRay> rays);

}  // namespace welkin
