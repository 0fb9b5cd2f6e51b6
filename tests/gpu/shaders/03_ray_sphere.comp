// The scalar functions of ray_sphere.glsl over arrays. Item: ground radius, altitude, mu, sine, t, shell altitude;
// result: altitude along, tangent altitude, half chord, distance from inside, from outside, and the altitude along as
// length(p) - R, the way that loses it. Lengths in km.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "03_planet_and_rays/ray_sphere.glsl"
layout(local_size_x = 64) in;
layout(binding = 0) readonly buffer Inputs { float inputs[]; };
layout(binding = 1) writeonly buffer Outputs { float outputs[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const float R = inputs[6 * item], h = inputs[6 * item + 1], mu = inputs[6 * item + 2];
  const float sine = inputs[6 * item + 3], t = inputs[6 * item + 4], shell = inputs[6 * item + 5];
  const float tangent = tangent_altitude(R, h, mu, sine);
  outputs[6 * item] = altitude_along(R, h, mu, t);
  outputs[6 * item + 1] = tangent;
  outputs[6 * item + 2] = half_chord(R, tangent, h);
  outputs[6 * item + 3] = distance_to_shell_from_inside(R, h, mu, shell);
  outputs[6 * item + 4] = distance_to_shell_from_outside(R, h, mu, sine, shell);
  outputs[6 * item + 5] = length(vec3(t * sine, 0.0, R + h + t * mu)) - R;
}
