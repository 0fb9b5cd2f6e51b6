// camera_direction over arrays. Item: right (3), up (3), forward (3), size (2), pixel (2); result: direction (3).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "03_planet_and_rays/camera.glsl"
layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer Inputs { float inputs[]; };
layout(binding = 1) writeonly buffer Outputs { float outputs[]; };
layout(push_constant) uniform Push { uint count; };

vec3 vector(uint at) { return vec3(inputs[at], inputs[at + 1], inputs[at + 2]); }

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const uint at = 13 * item;
  CameraRays camera;
  camera.right = vector(at);
  camera.up = vector(at + 3);
  camera.forward = vector(at + 6);
  camera.sun = vec3(0.0);
  camera.size = ivec2(int(inputs[at + 9]), int(inputs[at + 10]));
  const vec3 direction = camera_direction(camera, ivec2(int(inputs[at + 11]), int(inputs[at + 12])));
  outputs[3 * item] = direction.x;
  outputs[3 * item + 1] = direction.y;
  outputs[3 * item + 2] = direction.z;
}
