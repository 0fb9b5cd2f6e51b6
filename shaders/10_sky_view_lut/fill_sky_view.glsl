// Fills the sky view table with chapter 09's two marches per texel, for the camera's altitude and the sun's zenith
// angle. The including entry point declares the writeonly image `sky_view` and SKY_VIEW_UNIT, the radiance of a stored
// 1. With SINGLE_ORDER defined the march is chapter 05's, and there is no scattering table.
#ifndef WELKIN_FILL_SKY_VIEW_GLSL
#define WELKIN_FILL_SKY_VIEW_GLSL

#ifdef SINGLE_ORDER
#include "04_air/variant.glsl"
#include "05_single_scattering/single_scattering.glsl"
layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};
#else
layout(binding = 1) uniform sampler2D scattering_table;
vec3 read_multiple_scattering_table(vec2 uv) { return textureLod(scattering_table, uv, 0.0).rgb; }
#include "09_multiple_scattering_lut/variant.glsl"
#endif
#include "10_sky_view_lut/sky_view_map.glsl"

layout(push_constant) uniform Push {
  vec4 viewpoint;  // x: altitude in km; y, z: cosine and sine of the sun's zenith angle
  ivec4 steps;     // x: first order, y: table
};

// [fill]
// A workgroup fills 32 texels of one row: rays of one zenith angle, which take the same branches. Two invocations share
// a texel, one for the first order and one for the higher orders, so a texel takes as long as the longer march, not as
// both.
#ifdef SINGLE_ORDER
layout(local_size_x = 32) in;
#else
layout(local_size_x = 32, local_size_y = 2) in;
shared vec3 higher_orders[32];
#endif

void main() {
  const ivec2 size = imageSize(sky_view);
  const int x = int(gl_LocalInvocationID.x);
  // All invocations must reach the barrier: those beyond the end of the row repeat its last texel.
  const ivec2 texel = ivec2(min(int(gl_WorkGroupID.x) * 32 + x, size.x - 1), gl_WorkGroupID.y);
  const Atmosphere air = atmosphere;
  const SkyViewCoordinates coordinates = sky_view_of_texel(texel, size);
  const vec2 zenith = sky_view_zenith(horizon_at(air.ground_radius_km, viewpoint.x), coordinates.elevation_coordinate,
                                      coordinates.below_horizon);
  const vec3 view = vec3(sky_view_azimuth(coordinates.azimuth_coordinate) * zenith.y, zenith.x);
  const vec3 sun = vec3(viewpoint.z, 0.0, viewpoint.y);
#ifdef SINGLE_ORDER
  const vec3 light = scattered_light(air, viewpoint.x, view, sun, steps.x, 1, kRuleAdapted, false).radiance;
#else
  const MethodAir method = method_air(air, MS_METHOD);
  const AirRay ray = enter_air(air, viewpoint.x, view, sun);
  vec3 light = vec3(0.0);
  if (gl_LocalInvocationID.y == 1) {
    higher_orders[x] = ray.hits_air ? higher_orders_light(method, ray, steps.y) : light;
  } else if (ray.hits_air) {
    light = first_order_light(method, air, ray, view, sun, steps.x).radiance;
  }
  barrier();
  if (gl_LocalInvocationID.y == 1) return;
  light = (light + higher_orders[x]) * air.solar_irradiance;
#endif
  imageStore(sky_view, texel, vec4(min(light / SKY_VIEW_UNIT, vec3(65504.0)), 1.0));
}
// [/fill]

#endif
