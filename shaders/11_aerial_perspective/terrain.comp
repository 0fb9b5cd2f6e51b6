// How far away each pixel's ray first meets the terrain, and which edge it passes before that; km, 0 where there is
// none.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
#include "03_planet_and_rays/camera.glsl"
#include "11_aerial_perspective/height_maps.glsl"
#include "11_aerial_perspective/detail.glsl"

layout(constant_id = 5) const bool HAS_RELIEF = true;

layout(binding = 2, rgba32f) uniform writeonly image2D terrain_distance;  // x: terrain, y: edge before it, z: its share

// [terrain]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const vec3 view = camera_direction(frame.camera, pixel);
  const vec3 direction = frame.east * view.x + frame.north * view.y + cross(frame.east, frame.north) * view.z;
  // A camera above the highest peak: the walk begins where the ray comes down to that height.
  float altitude = frame.camera.altitude_km, mu = view.z, begins = 0.0;
  if (altitude > HIGHEST_KM) {
    const float sine = length(view.xy);
    begins = distance_to_shell_from_outside(GROUND_RADIUS_KM, altitude, mu, sine, HIGHEST_KM);
    const float sine_there = sine * (GROUND_RADIUS_KM + altitude) / (GROUND_RADIUS_KM + HIGHEST_KM);
    mu = -sqrt(max(1.0 - sine_there * sine_there, 0.0));
    altitude = HIGHEST_KM;
  }
  Hit hit = Hit(-1.0, 1.0, -1.0, 0.0, 0);
  const float pixel_rad = 2.0 * length(frame.camera.up) / float(frame.camera.size.y);
  if (begins >= 0.0)
    hit = first_hit(height_field(), frame.position_km + direction * begins, direction, altitude, mu, begins, pixel_rad);
  float t = hit.t_km >= 0.0 ? max(begins + hit.t_km, 1.0e-6) : 0.0;
  if (HAS_RELIEF)
    t = meet_relief(place_below(GROUND_RADIUS_KM, frame.position_km + direction * t), direction.xy,
                    t > 0.0 ? t : 1.0e9, hit.approach);
  const float edge = hit.edge_share > 0.0 ? begins + hit.edge_km : 0.0;
  imageStore(terrain_distance, pixel, vec4(t < 1.0e8 ? t : 0.0, edge, hit.edge_share, 0.0));
}
// [/terrain]
