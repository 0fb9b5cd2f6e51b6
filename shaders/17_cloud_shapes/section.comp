// Cuts through the clouds: a vertical one along the look (knob cloud.show=side) and a level one (slice). Ink is extinction;
// a line is drawn at every km. The picture is as wide as cloud.section_km says, and as high to the same scale.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#define CLOUD_BINDING 0
#include "17_cloud_shapes/block.glsl"

layout(binding = 6, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  int steps, detail, grid_method, grid_steps;
  float section_km, slice_km;
  int level;
};

// [section]
// The point above the end of an arc on the ground that begins below the camera; z of it without a difference of radii.
CloudPoint point_at(vec2 way_km, float altitude_km) {
  const float radius = clouds.ground_radius_km, arc = length(way_km), angle = arc / radius, lowered = sin(0.5 * angle);
  const float across = arc > 0.0 ? (radius + altitude_km) * sin(angle) / arc : 0.0;
  const vec3 local = vec3(way_km * across, altitude_km * cos(angle) - 2.0 * radius * lowered * lowered - frame.camera.altitude_km);
  return CloudPoint(frame.position_km, frame.position_rest_km + frame.east * local.x + frame.north * local.y + cross(frame.east, frame.north) * local.z, altitude_km);
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = frame.camera.size;
  if (any(greaterThanEqual(pixel, size))) return;
  const float scale = section_km / float(size.x);
  const vec2 look = frame.camera.forward.xy, ahead = length(look) > 1.0e-6 ? normalize(look) : vec2(0.0, 1.0), right = vec2(ahead.y, -ahead.x);
  const vec2 place = (vec2(pixel) + 0.5) * scale;
  const float up = float(size.y) * scale - place.y;
  const CloudPoint point = level == 1 ? point_at(right * (place.x - 0.5 * section_km) + ahead * (up - 0.5 * float(size.y) * scale), slice_km)
                                      : point_at(ahead * place.x, up);
  const float extinction = cloud_extinction(point, detail, grid_method);
  const float line = level == 1 ? 0.0 : step(abs(up - round(up)), 0.6 * scale) * 0.15;
  const vec3 paper = vec3(0.42, 0.56, 0.75) * (1.0 - line);
  imageStore(target, pixel, vec4(mix(paper, vec3(0.97), 1.0 - exp(-0.12 * extinction)), 1.0));
}
// [/section]
