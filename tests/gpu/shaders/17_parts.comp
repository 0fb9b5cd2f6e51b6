// Functions of chapter 17 over arrays. Item: part, then 15 numbers; result: 8. Parts as ShapePart in 17_clouds.hpp.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
const int CLOUD_KINDS = 7;
float grid_texel(int i, int j, int k) { return 0.0; }
float grid_filtered(vec3 texel) { return 0.0; }
vec4 weather_texel(vec2 uv) { return vec4(uv, 0.0, 0.0); }
vec4 base_noise(vec3 uvw) { return vec4(0.0); }
vec4 detail_noise(vec3 uvw) { return vec4(0.0); }
vec4 curl_noise(vec2 uv) { return vec4(0.0); }
#include "17_cloud_shapes/optical_depth.glsl"
#include "03_planet_and_rays/ray_forms.glsl"

layout(binding = 0) readonly buffer Inputs { float inputs[]; };
layout(binding = 1) writeonly buffer Outputs { float outputs[]; };
layout(push_constant) uniform Push { uint count; };

float in_at(uint item, int k) { return inputs[16 * item + k]; }
vec3 three(uint item, int k) { return vec3(in_at(item, k), in_at(item, k + 1), in_at(item, k + 2)); }

vec4 of_spans(Spans spans) { return vec4(spans.first, spans.second); }

// As it is printed in one source: to a target range of (0, 0).
float misprinted(float x, float threshold) { return remap(x, threshold, 1.0, 0.0, 0.0); }

// A sphere's roots by the quadratic formula, from wherever the ray begins.
vec2 naive_sphere(vec3 from, vec3 d, float radius) {
  const float b = dot(from, d), c = dot(from, from) - radius * radius, discriminant = b * b - c;
  if (discriminant < 0.0) return vec2(0.0);
  return vec2(-b - sqrt(discriminant), -b + sqrt(discriminant));
}

// The disc's cone with positions from the planet's centre: (p a)^2 = cos^2 p^2.
vec2 naive_cone(vec3 from_centre, vec3 d, vec3 axis, float angle) {
  const float cosine2 = cos(angle) * cos(angle), pa = dot(from_centre, axis), da = dot(d, axis);
  const float a = da * da - cosine2, b = pa * da - cosine2 * dot(from_centre, d), c = pa * pa - cosine2 * dot(from_centre, from_centre);
  const float root = sqrt(max(b * b - a * c, 0.0));
  return vec2(min((-b - root) / a, (-b + root) / a), max((-b - root) / a, (-b + root) / a));
}

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const int part = int(in_at(item, 0));
  vec4 a = vec4(0.0), b = vec4(0.0);
  if (part == 0) {  // shell: R, altitude, mu, sine, base, top, end; robust and naive
    const float R = in_at(item, 1), h = in_at(item, 2), mu = in_at(item, 3), sine = in_at(item, 4), base = in_at(item, 5), top = in_at(item, 6);
    a = of_spans(shell_spans(R, h, mu, sine, base, top));
    const Chord outer = naive_chord(R, h, vec3(sine, 0.0, mu), top), inner = naive_chord(R, h, vec3(sine, 0.0, mu), base);
    if (outer.leave_km >= 0.0) b = inner.leave_km < 0.0 ? vec4(outer.enter_km, outer.leave_km, 0.0, 0.0) : vec4(outer.enter_km, inner.enter_km, inner.leave_km, outer.leave_km);
  } else if (part == 1) {  // sphere: from centre, direction, radius
    a.xy = sphere_span(three(item, 1), three(item, 4), in_at(item, 7));
    b.xy = naive_sphere(three(item, 1), three(item, 4), in_at(item, 7));
  } else if (part == 2) {  // cone: from foot, direction, axis, radius, slope; R + base and angle for the naive form
    a.xy = cone_span(three(item, 1), three(item, 4), three(item, 7), in_at(item, 10), in_at(item, 11));
    b.xy = naive_cone(three(item, 1) + three(item, 7) * in_at(item, 12), three(item, 4), three(item, 7), in_at(item, 13));
  } else if (part == 3) {  // box: from corner, direction, size
    a.xy = box_span(three(item, 1), three(item, 4), three(item, 7));
  } else if (part == 4) {  // remap: x, threshold; covered: coverage, solid; eroded: detail, height, strength
    const float x = in_at(item, 1);
    a = vec4(above(x, in_at(item, 2)), covered(x, in_at(item, 3), in_at(item, 4)), eroded(x, in_at(item, 5), in_at(item, 6), in_at(item, 7)), misprinted(x, in_at(item, 2)));
    b.x = remap(x, in_at(item, 2), 1.0, 0.0, 1.0);
    b.y = local_coverage(x, in_at(item, 3));
  } else if (part == 5) {  // ground way: R, point
    a.xy = ground_way(in_at(item, 1), three(item, 2));
    const vec3 p = three(item, 2);
    const float sine = length(p.xy) / length(vec3(p.xy, p.z + in_at(item, 1)));
    b.xy = p.xy / max(length(p.xy), 1.0e-9) * (asin(min(sine, 1.0)) * in_at(item, 1));  // the driver's asin
  } else if (part == 6) {  // profile: type, height, tops
    const CloudType type = cloud_type(in_at(item, 1));
    a = vec4(height_profile(type.profile, in_at(item, 2), in_at(item, 3)), type.solid, type.billows, type.anvil);
    b = type.profile;
  } else if (part == 7) {  // wrapped noise place: origin, offset, cell; and without wrapping
    CloudBody body;
    body.cell_km = in_at(item, 7);
    body.shift_x = body.shift_y = 0.0;
    a.xyz = noise_place(body, CloudPoint(three(item, 1), three(item, 4), 0.0));
    b.xyz = (three(item, 1) + three(item, 4)) / body.cell_km;
  } else if (part == 8) {  // below the ceiling: R, ceiling, altitude, mu, sine
    CloudRay ray = CloudRay(vec3(0.0, 0.0, in_at(item, 3)), vec3(0.0), vec3(in_at(item, 5), 0.0, in_at(item, 4)), in_at(item, 3), in_at(item, 4), in_at(item, 5), 0.0, kNoEnd_km);
    ray = below_ceiling(in_at(item, 1), in_at(item, 2), ray);
    a = vec4(ray.altitude_km, ray.mu, ray.sine, ray.begins_km);
    b = vec4(ray.origin_km.z + ray.rest_km.z, ray.rest_km.z, ray.end_km, ray.origin_km.x);
  } else if (part == 9) {  // ground: R, altitude, mu, sine
    a.x = ground_end(in_at(item, 1), in_at(item, 2), in_at(item, 3), in_at(item, 4));
  }
  for (int k = 0; k < 4; k++) outputs[8 * item + k] = a[k], outputs[8 * item + 4 + k] = b[k];
}
