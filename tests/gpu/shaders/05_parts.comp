// Single functions of chapter 05 over arrays, each beside the naive form that the hard cases show failing. Reads eight
// floats an item: which function, then its arguments; writes eight.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
const bool HAS_RAYLEIGH = true;
const bool HAS_MIE = true;
const bool HAS_OZONE = true;
const int MIE_PHASE = 0;
#include "05_single_scattering/single_scattering.glsl"
#include "05_single_scattering/sun_disc.glsl"
#include "../tests/gpu/shaders/atmosphere_of.glsl"

layout(binding = 0, std430) readonly buffer Inputs {
  float inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(push_constant) uniform Push {
  uint count;
};

// The columns to the top from samples in the middle of n equal segments.
vec3 equal_step_columns(Atmosphere atmosphere, float altitude_km, float mu_sun, int n) {
  float length_km = distance_to_shell_from_inside(atmosphere.ground_radius_km, altitude_km, mu_sun, atmosphere.top_km);
  vec3 column = vec3(0.0);
  for (int i = 0; i < n; ++i) {
    float h = altitude_along(atmosphere.ground_radius_km, altitude_km, mu_sun, (float(i) + 0.5) / float(n) * length_km);
    column += densities(atmosphere, max(h, 0.0)) * (length_km / float(n));
  }
  return column;
}

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  float a[8], result[8];
  for (int i = 0; i < 8; ++i) {
    a[i] = inputs[8 * item + i];
    result[i] = 0.0;
  }
  Atmosphere earth = atmosphere_of(vec4(5.802e-3, 13.558e-3, 33.1e-3, 8.0), vec4(vec3(3.996e-3), 1.2), vec4(vec3(4.440e-3), 0.8),
                                   vec4(0.650e-3, 1.881e-3, 0.085e-3, 25.0), vec4(6360.0, 100.0, 15.0, 0.00465), vec4(0.0), vec4(1.0, 1.0, 1.0, 0.0));
  const int part = int(a[0]);
  if (part == 0) {  // rule, i, n: a segment; then sample and length of a march that steps from sample to sample
    const Segment segment = quadrature_segment(int(a[1]), int(a[2]), int(a[3]));
    result[0] = segment.sample_at;
    result[1] = segment.width;
    result[2] = (a[2] + 0.3) / a[3];
    result[3] = a[2] > 0.0 ? 1.0 / a[3] : result[2];
  } else if (part == 1) {  // tau: the mean transmittance, then as the quotient it is
    result[0] = mean_transmittance(a[1]);
    result[1] = (1.0 - exp(-a[1])) / a[1];
  } else if (part == 2) {  // altitude, mu_sun, steps: columns towards the sun in closed form, then by equal steps
    const vec3 held = sun_columns(earth, a[1], a[2]);
    const vec3 naive = equal_step_columns(earth, a[1], a[2], int(a[3]));
    for (int i = 0; i < 3; ++i) {
      result[i] = held[i];
      result[3 + i] = naive[i];
    }
  } else if (part == 3) {  // radius, altitude, mu_sun: is the sun up, then from 1 - (R/r)^2
    const float ratio = a[1] / (a[1] + a[2]);
    result[0] = sun_above_horizon(a[1], a[2], a[3]) ? 1.0 : 0.0;
    result[1] = a[3] >= -sqrt(max(1.0 - ratio * ratio, 0.0)) ? 1.0 : 0.0;
  } else if (part == 4) {  // altitude, sine, mu: the ray in the air, then whether its tangent point is below the top
    const AirRay ray = enter_air(earth, a[1], vec3(a[2], 0.0, a[3]), vec3(0.0, 0.0, 1.0));
    result[0] = ray.hits_air ? 1.0 : 0.0;
    result[1] = ray.length_km;
    result[2] = earth.top_km - tangent_altitude(earth.ground_radius_km, a[1], a[3], a[2]) > 0.0 ? 1.0 : 0.0;
  } else {  // angular radius, cosine at the sun's surface: the disc
    const vec3 disc = sun_disc_radiance(vec3(1.0), a[1], a[2]);
    for (int i = 0; i < 3; ++i) result[i] = disc[i];
  }
  for (int i = 0; i < 8; ++i) outputs[8 * item + i] = result[i];
}
