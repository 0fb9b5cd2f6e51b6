// A volume as a body: a deck of the lumps in which a channel exceeds a level that rises with height, seen from above and lit
// by a low sun. No cloud yet (light stops at the surface), but what the noise will do to one. Unit: a side of the texture.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "16_noise/view.glsl"

layout(binding = 0) uniform sampler3D noise;

const float kTop = 0.75;        // nothing is above
const float kRise = 0.9;        // of the level, per height
const vec3 kEye = vec3(0.2, 0.1, 0.93);
const vec3 kSun = vec3(-0.80, 0.20, 0.5657);
const vec3 kSunlight = vec3(0.95, 0.80, 0.60);
const vec3 kSkylight = vec3(0.16, 0.25, 0.40);

// Above 0 in the body.
float inside(vec3 p, float mip) { return textureLod(noise, p, mip)[push.channel & 3] - push.slice - kRise * max(p.z, 0.0); }

float sunlit(vec3 p) {
  float most = 0.0;
  for (int i = 1; i <= 24; i++) {
    const float t = 0.006 * float(i) * (1.0 + 0.06 * float(i));
    most = max(most, inside(p + kSun * t, 0.0) / (0.03 + 0.3 * t));  // a soft edge, wider farther away
  }
  return clamp(1.0 - 1.5 * most, 0.0, 1.0);
}

vec3 sky(vec3 direction) {
  const float up = max(direction.z, 0.0);
  const float near_sun = pow(max(dot(direction, kSun), 0.0), 6.0);
  return mix(vec3(0.62, 0.66, 0.70), vec3(0.10, 0.24, 0.52), 1.0 - exp(-4.0 * up)) + 0.2 * near_sun * kSunlight;
}

// How far the body's surface is; below 0: it is not met.
float distance_to_body(vec3 direction, float pixel) {
  float t = (kTop - kEye.z) / direction.z;
  float step_length = 0.003;
  for (int i = 0; i < 320 && t < 10.0; i++) {
    if (inside(kEye + direction * t, log2(max(128.0 * pixel * t, 1.0))) > 0.0) {
      float outside_at = t - step_length;
      for (int j = 0; j < 8; j++) {
        const float middle = 0.5 * (outside_at + t);
        if (inside(kEye + direction * middle, log2(max(128.0 * pixel * middle, 1.0))) > 0.0) t = middle;
        else outside_at = middle;
      }
      return t;
    }
    step_length = 0.003 + 0.009 * t;
    t += step_length;
  }
  return -1.0;
}

vec3 lit(vec3 p, float t, float mip) {
  const float e = 0.5 / 128.0 * exp2(mip);
  const vec2 d = vec2(e, 0.0);
  const vec3 slope = vec3(inside(p + d.xyy, mip) - inside(p - d.xyy, mip), inside(p + d.yxy, mip) - inside(p - d.yxy, mip),
                          inside(p + d.yyx, mip) - inside(p - d.yyx, mip));
  const vec3 normal = -slope / max(length(slope), 1.0e-6);
  const float open = clamp(0.75 - 2.2 * inside(p + normal * 0.10, 3.0), 0.25, 1.0);  // of the sky: how much is left of the body ahead
  const float sun = max(0.8 * dot(normal, kSun) + 0.2, 0.0) * sunlit(p + normal * 0.006);
  return sun * kSunlight + open * (0.6 + 0.4 * normal.z) * kSkylight;
}

void main() {
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (outside(at)) return;
  const float pixel = 1.1 / float(push.rectangle.w);
  const vec2 plane = pixel * (vec2(at) + 0.5 - 0.5 * vec2(push.rectangle.zw));
  const vec3 direction = normalize(vec3(plane.x, 1.0, -0.33 - plane.y));
  vec3 color = sky(direction);
  if (direction.z < -1.0e-3) {
    const float t = distance_to_body(direction, pixel);
    const vec3 haze = sky(vec3(direction.xy, 0.0));
    if (t > 0.0) color = mix(haze, lit(kEye + direction * t, t, log2(max(128.0 * pixel * t, 1.0))), exp(-0.22 * t));
    else color = haze;
  }
  show(at, pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2)));
}
