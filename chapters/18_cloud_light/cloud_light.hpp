// Light in clouds: the march as an effect, and the probe that answers by march, by paths or by converged single
// scattering.
#pragma once

#include <span>
#include <vector>

#include "chapters/17_cloud_shapes/cloud_picture.hpp"

namespace welkin {

// cloud.method, .orders, .octaves, .octave_a, _b, _c, .powder, .view_steps, .light_samples, .escape_...; orders,
// probe.samples.
std::vector<Knob> cloud_light_knobs();

// Knobs as shaders/18_cloud_light/march_push.glsl reads them.
struct CloudLightPush {
  CloudMarchPush columns;
  int32_t view_steps, light_samples, escape_directions, escape_samples;
  int32_t method, octaves, ambient, unused;
  float octave_a, octave_b, octave_c, powder;
  glm::vec4 sun;  // unit, global frame; w: escape refresh
};
CloudLightPush cloud_light_push(const Settings& settings);

// What the bounds of collisions in grids are read from: the largest density of each coarse cell. A texel where no body
// is a grid.
struct CloudBounds {
  graph::Resource image;
};

app::Effect cloud_bounds();
// Pass "cloud light": clouds before the picture so far, lit by the sun.
app::Effect cloud_light();

// Radiance of clouds, sunlight of the scene's irradiance, and their transmittance; of the air behind them the light
// that comes through, where there is air. Air before and between clouds is chapter 19's.
std::vector<app::ProbeResult> probe_cloud_light(const app::Context& context, std::span<const app::ProbeRay> rays);

}  // namespace welkin
