// Chapter 10's effect: the sky is looked up in the sky view table, or marched where the table is not accurate enough.
#pragma once

#include <vector>

#include "chapters/10_sky_view_lut/sky_view_lut.hpp"

namespace welkin {

// Pass "sky": draws the sky from the table or by the direct march, and the sun's disc seen through the air.
app::Effect sky();

// Rays that share an altitude and a sun zenith angle are looked up together in one table; rays from altitudes where the
// table is not used are marched.
std::vector<app::ProbeResult> probe_sky(const app::Context& context, std::span<const app::ProbeRay> rays);

}  // namespace welkin
