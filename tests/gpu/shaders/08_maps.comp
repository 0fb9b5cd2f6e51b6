// Evaluates the texel maps of chapter 08 over arrays, and the naive forms that the hard cases show failing. Reads eight
// floats per item: function, ground radius, top, two arguments, width, height. Writes eight.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const int TABLE_MAPPING = 1;
const int TABLE_STORED = 2;
#include "08_transmittance_lut/table_map.glsl"

layout(binding = 0, std430) readonly buffer Inputs {
  float inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(push_constant) uniform Push {
  uint count;
};

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  float a[8], result[8];
  for (int i = 0; i < 8; ++i) {
    a[i] = inputs[8 * item + i];
    result[i] = 0.0;
  }
  Atmosphere air;
  air.ground_radius_km = a[1], air.top_km = a[2];
  const ivec2 size = ivec2(a[5], a[6]);
  if (a[0] == 0.0) {  // texture coordinates to a path, and back
    const TablePath path = transmittance_path(air, vec2(a[3], a[4]), size);
    const vec2 uv = transmittance_uv(air, path.altitude_km, path.mu, size);
    result[0] = path.altitude_km;
    result[1] = path.mu;
    result[2] = uv.x;
    result[3] = uv.y;
  }
  if (a[0] == 1.0) {  // a path to texture coordinates, and back
    const vec2 uv = transmittance_uv(air, a[3], a[4], size);
    const TablePath path = transmittance_path(air, uv, size);
    result[0] = uv.x;
    result[1] = uv.y;
    result[2] = path.altitude_km;
    result[3] = path.mu;
  }
  if (a[0] == 2.0) {  // unit to uv and back; then with the pair that is often copied
    const float n = float(size.x);
    result[0] = unit_from_uv(uv_from_unit(a[3], size.x), size.x);
    result[1] = (((a[3] + 0.5 / n) * n / (n + 1.0)) - 0.5 / n) * n / (n - 1.0);
    result[2] = uv_from_unit(a[3], size.x);
  }
  if (a[0] == 3.0) {  // distance to the horizon; then as the root of r^2 - R^2
    const float r = a[1] + a[3];
    result[0] = tangent_length(a[1], 0.0, a[3]);
    result[1] = sqrt(max(r * r - a[1] * a[1], 0.0));
  }
  for (int i = 0; i < 8; ++i) outputs[8 * item + i] = result[i];
}
