// Fills the transmittance table, one texel per invocation. The including entry point defines TABLE_FORMAT, the image's
// format.
layout(local_size_x = 8, local_size_y = 8) in;
#include "04_air/variant.glsl"
layout(constant_id = 4) const int TABLE_MAPPING = 1;
layout(constant_id = 5) const int TABLE_STORED = 1;
layout(constant_id = 6) const int STEPS = 0;  // a constant, so that the compiler can unroll the loop
#include "08_transmittance_lut/table_texel.glsl"

layout(binding = 0, std140) uniform Air {
  Atmosphere atmosphere;
};
layout(binding = 1, TABLE_FORMAT) uniform writeonly image2D table;
layout(push_constant) uniform Push {
  ivec4 size;  // xy: texels
};

// [fill]
void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size.xy))) return;
  const Atmosphere air = atmosphere;
  const vec2 uv = (vec2(texel) + 0.5) / vec2(size.xy);
  imageStore(table, texel, vec4(table_texel(air, uv, size.xy, STEPS), 1.0));
}
// [/fill]
