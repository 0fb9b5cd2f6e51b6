// Chords of a shell and the distance to the ground in the form FORM, for arrays of rays. Item: ground radius, altitude,
// direction (3), shell altitude; result: enter, leave, ground distance. Lengths in km.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "03_planet_and_rays/ray_forms.glsl"
layout(local_size_x = 64) in;
layout(constant_id = 0) const int FORM = FORM_ROBUST;
layout(binding = 0) readonly buffer Inputs { float inputs[]; };
layout(binding = 1) writeonly buffer Outputs { float outputs[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const float radius_km = inputs[6 * item];
  const float altitude_km = inputs[6 * item + 1];
  const vec3 direction = vec3(inputs[6 * item + 2], inputs[6 * item + 3], inputs[6 * item + 4]);
  const Chord chord = shell_chord(FORM, radius_km, altitude_km, direction, inputs[6 * item + 5]);
  outputs[3 * item] = chord.enter_km;
  outputs[3 * item + 1] = chord.leave_km;
  outputs[3 * item + 2] = ground_distance(FORM, radius_km, altitude_km, direction);
}
