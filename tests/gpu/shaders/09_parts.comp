// Evaluates functions of chapter 09, one per item. Reads 8 floats per item: function, air, then arguments. Writes 12.
//   0 direction   set, n, count, zenith cosine of the horizon  ->  view direction, weight
//   1 map         map, size, texel x, texel y  ->  mu_sun, altitude; uv from these; texel
//   2 transfer    altitude, mu_sun, directions, set, steps  ->  second order, f, Psi
//   3 furnace     altitude, mu, steps  ->  transfer of one ray in isotropic light of radiance 1, and its transmittance
//   4 close       L2, f  ->  Psi
//   5 moments     g, alpha  ->  chi 1, 2, 3
// Airs: 0 Earth, 1 the dense planet, 2 and 3 the same without any absorption.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
const bool HAS_RAYLEIGH = true, HAS_MIE = true, HAS_OZONE = true;
const int MIE_PHASE = 1, MS_METHOD = 0, MS_MAP = 1, MS_SIZE = 32;
vec3 read_multiple_scattering_table(vec2 uv) { return vec3(0.0); }
#include "09_multiple_scattering_lut/multiple_scattering.glsl"
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

Atmosphere air_of(int which) {
  const bool dense = (which & 1) == 1, conservative = which >= 2;
  const vec4 rayleigh = dense ? vec4(0.149, 0.142, 0.051, 18.416) : vec4(5.802e-3, 13.558e-3, 33.1e-3, 8.0);
  const vec4 mie_scattering = dense ? vec4(0.046, 0.047, 0.057, 13.143) : vec4(vec3(3.996e-3), 1.2);
  const vec4 mie_extinction = conservative ? mie_scattering
                              : dense      ? vec4(0.082, 0.071, 0.058, 0.8)
                                           : vec4(vec3(4.44e-3), 0.8);
  const vec4 ozone = vec4(conservative ? vec3(0.0) : vec3(0.65e-3, 1.881e-3, 0.085e-3), 25.0);
  return atmosphere_of(rayleigh, mie_scattering, mie_extinction, ozone, vec4(6360.0, 100.0, 15.0, 0.00465),
                       vec4(vec3(conservative ? 1.0 : 0.3), 0.0), vec4(vec3(1.0), 0.0));
}

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  float a[6];
  for (int i = 0; i < 6; ++i) a[i] = inputs[8 * item + 2 + i];
  const int kind = int(inputs[8 * item]);
  const Atmosphere air = air_of(int(inputs[8 * item + 1]));
  vec4 result[3] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0));
  if (kind == 0) {
    const WeightedDirection direction = direction_of_set(int(a[0]), int(a[1]), int(a[2]), a[3]);
    result[0] = vec4(direction.view, direction.weight);
  } else if (kind == 1) {
    const vec2 point = table_point(int(a[0]), air.top_km, table_unit_of_texel(vec2(a[2], a[3]), a[1]));
    const vec2 uv = table_uv(table_unit(int(a[0]), air.top_km, point.y, point.x), a[1]);
    result[0] = vec4(point, uv);
    result[1] = vec4(uv * a[1] - 0.5, 0.0, 0.0);
  } else if (kind == 2) {
    vec3 second = vec3(0.0), transfer = vec3(0.0);
    const int directions = int(a[2]);
    for (int n = 0; n < directions; ++n) {
      const WeightedDirection direction =
          direction_of_set(int(a[3]), n, directions, horizon_cosine(air.ground_radius_km, a[0]));
      const vec3 sun = sun_direction_from(a[1]);
      const float nu = dot(direction.view, sun);
      const SourceRay along = source_ray(air, enter_air(air, a[0], direction.view, sun));
      vec3 light = sunlight_reflected_at_end(air, ray_end(air, along), a[1], nu), share = vec3(0.0);
      const int panels = int(a[4]) / 4;
      for (int panel = 0; panel < panels; ++panel) {
        const NodePanel placed = panel_nodes(air, along, panel, panels);
        for (int i = 0; i < 4; ++i) {
          light += sunlight_scattered_at_node(air, placed.node[i], first_order_phases(vec2(0.0), nu), a[1], nu);
          share += transfer_at_node(placed.node[i]);
        }
      }
      second += light * direction.weight;
      transfer += share * direction.weight;
    }
    const vec3 psi = sum_geometric_series(second, transfer);
    result[0] = vec4(second, transfer.x);
    result[1] = vec4(transfer.yz, psi.xy);
    result[2].x = psi.z;
  } else if (kind == 3) {
    const AirRay ray = enter_air(air, a[0], vec3(sqrt(max(1.0 - a[1] * a[1], 0.0)), 0.0, a[1]), vec3(0.0, 0.0, 1.0));
    if (ray.hits_air) {
      const SourceRay along = source_ray(air, ray);
      const int panels = int(a[2]) / 4;
      for (int panel = 0; panel < panels; ++panel) {
        const NodePanel placed = panel_nodes(air, along, panel, panels);
        for (int i = 0; i < 4; ++i) result[0].xyz += transfer_at_node(placed.node[i]);
      }
      result[1].xyz = ray_transmittance(air, along);
    } else {
      result[1].xyz = vec3(1.0);
    }
  } else if (kind == 4) {
    result[0].xyz = sum_geometric_series(vec3(a[0]), vec3(a[1]));
  } else {
    result[0].xyz = draine_moments(a[0], a[1]);
  }
  for (int i = 0; i < 12; ++i) outputs[12 * item + i] = result[i / 4][i % 4];
}
