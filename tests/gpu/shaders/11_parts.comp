// Functions of chapter 11 over arrays. Reads 40 floats an item: the seven vec4 of Atmosphere, then a, b, c; c.w says which
// function. Writes 6 floats.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool HAS_RAYLEIGH = true;
layout(constant_id = 1) const bool HAS_MIE = true;
layout(constant_id = 2) const bool HAS_OZONE = true;
layout(constant_id = 3) const int MIE_PHASE = 0;
layout(constant_id = 4) const int MS_METHOD = 2;
layout(constant_id = 5) const int MS_MAP = 1;
layout(constant_id = 6) const int MS_SIZE = 32;
layout(constant_id = 7) const bool HIGHER_ORDERS = false;

// A table that never was, smooth and not too far from a true one: what is tested is the march, not the table.
vec3 read_multiple_scattering_table(vec2 uv) {
  const int layer = MS_METHOD == 0 ? 0 : int(uv.y * 7.0);
  if (layer == 0) return vec3(-6.0, -5.5, -5.0) + 3.0 * (uv.x - 0.5);
  return layer == 3 ? vec3(0.35) : (layer == 6 ? vec3(0.9) : vec3(0.05));
}
float seen_sun = 1.0;
float sun_behind_terrain(float t_km, float altitude_km) { return seen_sun; }
#include "11_aerial_perspective/aerial.glsl"
#include "11_aerial_perspective/ground.glsl"
#include "11_aerial_perspective/signs.glsl"

// Height maps of any side, written down instead of stored: 0, one sample of 2 km, three quarters to the east and half way down;
// 1, a ridge from north to south, 3 km high, between 49 and 51 km west of the middle.
int field_kind = 0;
int field_size = 64;
float field_extent_km() { return field_kind == 0 ? 64.0 : 128.0; }
vec2 ridge_samples() {
  return vec2(ceil((-51.0 / 128.0 + 0.5) * float(field_size) - 0.5), floor((-49.0 / 128.0 + 0.5) * float(field_size) - 0.5));
}
float field_height(ivec2 at) {
  const ivec2 inside = clamp(at, 0, field_size - 1);
  if (field_kind == 0) return inside == ivec2(3 * field_size / 4, field_size / 2) ? 2.0 : 0.0;
  const vec2 ridge = ridge_samples();
  return float(inside.x) >= ridge.x && float(inside.x) <= ridge.y ? 3.0 : 0.0;
}
vec4 patch_corners(ivec2 cell) {
  return vec4(field_height(cell - 1), field_height(ivec2(cell.x, cell.y - 1)), field_height(ivec2(cell.x - 1, cell.y)), field_height(cell));
}
float highest_in(ivec2 node, int level) {
  const ivec2 low = (node << level) - 1, high = (node + 1) << level;  // samples at its corners
  const ivec2 spike = ivec2(3 * field_size / 4, field_size / 2);
  if (field_kind == 0) return all(greaterThanEqual(spike, low)) && all(lessThan(spike, high)) ? 2.0 : 0.0;
  const vec2 ridge = ridge_samples();
  return float(low.x) <= ridge.y && float(high.x - 1) >= ridge.x ? 3.0 : 0.0;
}
#include "11_aerial_perspective/height_field.glsl"
HeightField field_of(Atmosphere air, vec4 c) {
  field_size = int(c.x), field_kind = int(c.y);
  int levels = 1;
  while ((8 << levels) < field_size + 1) levels++;
  return HeightField(air.ground_radius_km, field_extent_km(), field_kind == 0 ? 2.0 : 3.0, field_size, levels);
}
#include "../tests/gpu/shaders/atmosphere_of.glsl"

layout(binding = 0, std430) readonly buffer Inputs {
  vec4 inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(push_constant) uniform Push {
  uint count;
};

RayLight run(Atmosphere air, vec4 a, vec4 b, vec4 c) {
  const int kind = int(c.w);
  const MethodAir method = method_air(air, MS_METHOD);
  const AirRay ray = enter_air(air, a.w, a.xyz, b.xyz);
  const ScatteringTowardsEye scattering = scattering_along(air, a.xyz, b.xyz);
  RayLight light = RayLight(vec3(0.0), vec3(1.0));
  if (kind == 0) return march_to(method, ray, scattering, c.x, int(c.y), int(c.z), b.w);  // d, slices, samples, power
  if (kind == 1) {  // c.x of a first slice c.y long; c.z: taken as linear instead, as a sampler would
    const AirSegment whole = append_segment(method, ray, scattering, no_air(), 0.0, c.y, 2);
    if (c.z == 0.0) return light_before(froxel_of(whole, c.y), c.x * c.y);
    light.radiance = whole.radiance;  // what the nearest texel holds
    light.transmittance = exp(-whole.depth);
    return light;
  }
  if (kind == 2) {
    light = all_orders_light(air, a.w, a.xyz, b.xyz, 64, 64, true);
    if (MS_METHOD == 2) light.transmittance = ray_transmittance(method.air, source_ray(method.air, ray));
    return light;
  }
  if (kind == 3) {  // to the end of the ray, in shadow by b.w
    seen_sun = b.w;
    return march_to(method, ray, scattering, ray.length_km, int(c.y), int(c.z), 2.0);
  }
  if (kind == 4) {  // place a.xy, altitude a.z: the point, and back
    light.radiance = on_planet(air.ground_radius_km, a.xy, a.z);
    light.transmittance = vec3(place_below(air.ground_radius_km, light.radiance), altitude_of(air.ground_radius_km, light.radiance));
    return light;
  }
  if (kind == 5) {  // start a.xyz, its altitude a.w; direction b.xyz, mu b.w; side c.x, map c.y
    const HeightField field = field_of(air, c);
    const Hit hit = first_hit(field, a.xyz, b.xyz, a.w, b.w, 0.0, 0.0);
    light.radiance.xy = vec2(hit.t_km, hit.visits);
    return light;
  }
  if (kind == 10) {  // place a.xy, tangent of the sun's elevation a.z; towards the sun b.xy; side c.x, map c.y
    int visits = 0;
    const HeightField field = field_of(air, c);
    light.radiance.xy = shadow_over(field, a.xy, b.xy, a.z, 0.1, visits);
    light.radiance.z = float(visits);
    return light;
  }
  if (kind == 6) {
    light.radiance = vec3(disc_above(a.x), 0.0, shadow_altitude(air.ground_radius_km, b.x, b.y, b.z));
    light.transmittance.x = slices_before(slice_end(c.x, c.y, 128.0, c.z), c.y, 128.0, c.z);
    return light;
  }
  if (kind == 7) {
    light.radiance = surface_light(vec3(1.0), vec3(0.5), a.xyz, vec3(0.0, 0.0, 1.0), b.xyz, vec3(a.w), vec3(b.w));
    return light;
  }
  if (kind == 8) {
    const Ground ground = ground_at(a.xy, b, vec3(0.3), c.xy, normalize(vec3(c.xy, 6360.0)), c.z);
    light.radiance = ground.albedo;
    light.transmittance = ground.normal;
    return light;
  }
  // The sign whose foot is at c.xyz, b.w away.
  const SignBoard sign = sign_board(vec4(c.xyz, b.w), air.ground_radius_km);
  const SignHit hit = meet_sign(sign, 0, air.ground_radius_km, a.xyz, b.xyz, 1.0e-4);
  light.radiance = vec3(hit.t_km, hit.paint, 0.0);
  light.transmittance = hit.normal;
  return light;
}

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const uint first = 10 * item;
  const Atmosphere air = atmosphere_of(inputs[first], inputs[first + 1], inputs[first + 2], inputs[first + 3], inputs[first + 4], inputs[first + 5], inputs[first + 6]);
  const RayLight light = run(air, inputs[first + 7], inputs[first + 8], inputs[first + 9]);
  for (int i = 0; i < 3; ++i) {
    outputs[6 * item + i] = light.radiance[i];
    outputs[6 * item + 3 + i] = light.transmittance[i];
  }
}
