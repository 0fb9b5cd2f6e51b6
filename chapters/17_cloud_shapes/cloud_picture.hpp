// What chapter 17 shows of the clouds, and its probe.
#pragma once

#include <span>
#include <vector>

#include "chapters/17_cloud_shapes/clouds.hpp"

namespace welkin {

// Pass "cloud picture": clouds before the picture so far, or a cut through them. Knobs cloud.show, .jitter,
// .section_km, .slice_km.
app::Effect cloud_picture();

// A ray of --probe as shaders read it, in split precision, from where it comes down to the clouds: found in double. The
// fourth components: altitude, cosine and sine to the vertical.
struct CloudRayItem {
  glm::vec4 origin, rest, direction, end;
};
CloudRayItem cloud_ray_item(const app::ProbeRay& ray, double ground_radius_km, double ceiling_km);

// Optical depth of all clouds along rays, as the scene's place sees them: from position_km in the direction of each.
std::vector<double> cloud_optical_depths(const app::Context& context, std::span<const app::ProbeRay> rays);

// Transmittance of clouds and air together; radiance 0, until chapter 18.
std::vector<app::ProbeResult> probe_clouds(const app::Context& context, std::span<const app::ProbeRay> rays);

}  // namespace welkin
