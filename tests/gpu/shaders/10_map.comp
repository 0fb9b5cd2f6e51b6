// Evaluates the sky view map in both directions, for tests/gpu/10_map_test.cpp. In: altitude, radius, view xyz, sun
// xyz, width, height, texel x, y. Out: azimuth_coordinate, elevation_coordinate, below_horizon of the view; then the
// texel's direction (mu, sine, cos phi, sin phi) and the texture coordinates of this direction.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "10_sky_view_lut/sky_view_map.glsl"
layout(binding = 0, std430) readonly buffer In { float inputs[]; };
layout(binding = 1, std430) writeonly buffer Out { float outputs[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  const uint k = 12 * i;
  const vec2 horizon = horizon_at(inputs[k + 1], inputs[k]);
  const vec3 view = vec3(inputs[k + 2], inputs[k + 3], inputs[k + 4]);
  const vec3 sun = vec3(inputs[k + 5], inputs[k + 6], inputs[k + 7]);
  const SkyViewCoordinates coordinates = sky_view_coordinates(horizon, view, sun);
  outputs[9 * i] = coordinates.azimuth_coordinate;
  outputs[9 * i + 1] = coordinates.elevation_coordinate;
  outputs[9 * i + 2] = coordinates.below_horizon ? 1.0 : 0.0;
  const ivec2 size = ivec2(inputs[k + 8], inputs[k + 9]);
  const SkyViewCoordinates texel = sky_view_of_texel(ivec2(inputs[k + 10], inputs[k + 11]), size);
  const vec2 zenith = sky_view_zenith(horizon, texel.elevation_coordinate, texel.below_horizon);
  const vec2 azimuth = sky_view_azimuth(texel.azimuth_coordinate);
  const vec2 uv =
      sky_view_uv(sky_view_coordinates(horizon, vec3(azimuth * zenith.y, zenith.x), vec3(1.0, 0.0, 0.0)), size);
  outputs[9 * i + 3] = zenith.x;
  outputs[9 * i + 4] = zenith.y;
  outputs[9 * i + 5] = azimuth.x;
  outputs[9 * i + 6] = azimuth.y;
  outputs[9 * i + 7] = uv.x;
  outputs[9 * i + 8] = uv.y;
}
