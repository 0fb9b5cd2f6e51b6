// For every place of the map: from which altitude on the column of air above it sees the sun past the terrain, and how wide
// the half shadow is there. A march over the height map towards the sun, its step growing by a fixed share.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "11_aerial_perspective/terrain.glsl"

layout(constant_id = 0) const int STEPS = 96;
layout(binding = 0) uniform sampler2D height_map;
layout(binding = 1, rg32f) uniform writeonly image2D shadows;
layout(push_constant) uniform Push {
  vec4 sun;    // xyz: unit vector in the global frame; w: angular radius, rad
  vec4 map;    // x: extent, km; y: ground radius, km; z: texel of the height map, km; w: growth of the step
  ivec4 size;  // x: of this map
};

// [shadow]
void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size.xx))) return;
  const vec2 uv = (vec2(texel) + 0.5) / float(size.x);
  const vec2 place = vec2(uv.x - 0.5, 0.5 - uv.y) * map.x;
  const vec3 up = up_at(map.y, place);
  const float mu = dot(sun.xyz, up);
  const vec3 level = sun.xyz - up * mu;
  const float sine = length(level);
  const vec2 towards = sine > 1.0e-4 ? level.xy / sine : vec2(0.0);
  const float tan_elevation = mu / max(sine, 1.0e-4);
  float highest = -1.0e3, width = 1.0e-3;
  float s = 0.75 * map.z;
  for (int i = 0; i < STEPS; i++) {
    const vec2 at = map_uv(place + towards * s, map.x);
    const bool inside = all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
    const float height = inside ? textureLod(height_map, at, 0.0).r : 0.0;
    const float altitude = shadow_altitude(map.y, height, s, tan_elevation);
    if (altitude > highest) {
      highest = altitude;
      width = s * sun.w;
    }
    s += max(0.5 * map.z, s * map.w);
  }
  imageStore(shadows, texel, vec4(highest, max(width, 1.0e-3), 0.0, 0.0));
}
// [/shadow]
