// As 08_look_up.comp, with a sampler that rounds its weights to 1/256, as many GPUs do.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "04_air/variant.glsl"
layout(constant_id = 4) const int TABLE_MAPPING = 1;
layout(constant_id = 5) const int TABLE_STORED = 2;
layout(binding = 1) uniform sampler2D transmittance_table;

ivec2 transmittance_table_size() { return textureSize(transmittance_table, 0); }
vec3 read_transmittance_table(vec2 uv) {
  const vec2 size = vec2(transmittance_table_size());
  const vec2 coarse = round((uv * size - 0.5) * 256.0) / 256.0;
  return textureLod(transmittance_table, (coarse + 0.5) / size, 0.0).rgb;
}
#include "08_transmittance_lut/transmittance_lut.glsl"

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};
layout(binding = 2, std430) readonly buffer Inputs {
  vec4 paths[];
};
layout(binding = 3, std430) writeonly buffer Outputs {
  vec4 results[];
};
layout(push_constant) uniform Push {
  uint count;
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  results[2 * i] = vec4(transmittance_to_top(atmosphere, paths[i].x, paths[i].y), 0.0);
  results[2 * i + 1] = vec4(optical_depth_to_top(atmosphere, paths[i].x, paths[i].y), 0.0);
}
