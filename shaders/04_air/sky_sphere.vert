// A vertex of the sky sphere: where its direction falls in the picture, and the colour the compute pass gave it.
//
// The camera's right and up carry tan(fov/2), so a direction d lies at x = d.right/|right|^2 and y = d.up/|up|^2 in
// units of d.forward. The sphere has no size: w = d.forward, and z is any depth in front of the eye.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "interop/camera.h"
layout(constant_id = 5) const bool PER_VERTEX = true;
layout(binding = 1) readonly buffer Directions { vec4 directions[]; };
layout(binding = 2) readonly buffer Colours { vec4 colours[]; };
layout(push_constant) uniform Push { CameraRays camera; };
layout(location = 0) out vec3 direction;
layout(location = 1) out vec3 colour;

void main() {
  direction = directions[gl_VertexIndex].xyz;
  colour = PER_VERTEX ? colours[gl_VertexIndex].xyz : vec3(0.0);
  const float w = dot(direction, camera.forward);
  const float x = dot(direction, camera.right) / dot(camera.right, camera.right);
  const float y = dot(direction, camera.up) / dot(camera.up, camera.up);
  gl_Position = vec4(x, -y, 0.5 * w, w);  // Vulkan's y points down
}
