// How far away each pixel's ray first meets the terrain, km; 0 where it does not.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/camera.h"
#include "03_planet_and_rays/camera.glsl"
#include "11_aerial_perspective/height_maps.glsl"

layout(binding = 2, r32f) uniform writeonly image2D terrain_distance;
layout(push_constant) uniform Push {
  CameraRays camera;
  vec4 position;  // xyz: of the camera, global frame, km
  vec4 east;      // xyz: of the camera's local frame, in the global one
  vec4 north;     // xyz: likewise
};

// [terrain]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, camera.size))) return;
  const vec3 view = camera_direction(camera, pixel);
  const vec3 direction = east.xyz * view.x + north.xyz * view.y + cross(east.xyz, north.xyz) * view.z;
  // From above the highest peak the walk begins where the ray comes down to its height.
  float altitude = camera.altitude_km, mu = view.z, begins = 0.0;
  if (altitude > HIGHEST_KM) {
    const float sine = length(view.xy);
    begins = distance_to_shell_from_outside(GROUND_RADIUS_KM, altitude, mu, sine, HIGHEST_KM);
    const float sine_there = sine * (GROUND_RADIUS_KM + altitude) / (GROUND_RADIUS_KM + HIGHEST_KM);
    mu = -sqrt(max(1.0 - sine_there * sine_there, 0.0));
    altitude = HIGHEST_KM;
  }
  int visits = 0;
  float t = -1.0;
  if (begins >= 0.0) t = first_hit(height_field(), position.xyz + direction * begins, direction, altitude, mu, begins, visits);
  imageStore(terrain_distance, pixel, vec4(t >= 0.0 ? max(begins + t, 1.0e-6) : 0.0));
}
// [/terrain]
