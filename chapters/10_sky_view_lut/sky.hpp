// Chapter 10's effect: the sky looked up in the sky view table, or marched where the table is not good enough.
#pragma once

#include <vector>

#include "chapters/10_sky_view_lut/sky_view_lut.hpp"

namespace welkin {

// Pass "sky": a picture of the sky, from the table or by the direct march; the sun's disc behind the air.
app::Effect sky();

// Rays that share an altitude and a height of the sun are looked up together, the rest are marched.
std::vector<app::ProbeResult> probe_sky(const app::Context& context, std::span<const app::ProbeRay> rays);

}  // namespace welkin
