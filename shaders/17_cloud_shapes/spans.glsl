// Where a ray is inside the hull of a body of cloud. Pure functions, also valid C++; km, cosines, global frame of
// interop/cloud.h.
//
// A ray has up to two spans in a shell: down through it and up again. A span is (enter, leave), distances from the
// ray's start; it is empty where leave <= enter. Domain: altitudes of -R and more, lengths below 1e6 km, any unit
// direction, camera below, inside, above and exactly on any boundary. No input in it gives NaN.
#ifndef WELKIN_CLOUD_SPANS_GLSL
#define WELKIN_CLOUD_SPANS_GLSL

#include "03_planet_and_rays/double_float.glsl"
#include "03_planet_and_rays/ray_sphere.glsl"
#include "interop/cloud.h"

const float kNoEnd_km = 1.0e9;

// [ray]
struct CloudRay {
  vec3 origin_km;     // the start in split precision: origin + rest; the origin is the same for all points of the ray
  vec3 rest_km;
  vec3 direction;     // unit
  float altitude_km;  // of the start, its cosine and sine to the vertical: never found again from the position
  float mu;
  float sine;
  float begins_km;    // how far the start was moved along the ray
  float end_km;       // where something solid ends the ray; from the start
};
// [/ray]

// Two spans; a shell may have both.
struct Spans {
  vec2 first;
  vec2 second;
};

Spans no_spans() { return Spans(vec2(0.0, 0.0), vec2(0.0, 0.0)); }

float span_length(vec2 span) { return max(span.y - span.x, 0.0); }
float spans_length(Spans spans) { return span_length(spans.first) + span_length(spans.second); }

vec2 common_part(vec2 a, vec2 b) { return vec2(max(a.x, b.x), min(a.y, b.y)); }

// Distance to the ground, or kNoEnd_km. A camera on or below the ground that looks up or level does not meet it.
float ground_end(float ground_radius_km, float altitude_km, float mu, float sine) {
  float altitude = max(altitude_km, 0.0);
  if (altitude == 0.0 && mu >= 0.0) return kNoEnd_km;
  float enter = robust_chord(ground_radius_km, altitude, mu, sine, 0.0).enter_km;
  return enter < 0.0 ? kNoEnd_km : enter;
}

// [ceiling]
// The ray from where it comes down to the ceiling, below which all clouds are; one that starts below stays as it is,
// one that never comes down ends at once. From 36,000 km a float knows a distance to 4 m only: lengths inside clouds
// are then counted from their top. Position and rest are put together again, so that the points behind are exact.
CloudRay below_ceiling(float ground_radius_km, float ceiling_km, CloudRay ray) {
  CloudRay moved = ray;
  if (ray.altitude_km <= ceiling_km) return moved;
  float t = distance_to_shell_from_outside(ground_radius_km, ray.altitude_km, ray.mu, ray.sine, ceiling_km);
  moved.end_km = t < 0.0 ? 0.0 : max(ray.end_km - t, 0.0);
  if (t < 0.0) return moved;
  vec3 rest = ray.rest_km + ray.direction * t;
  vec2 x = two_sum(ray.origin_km.x, rest.x);
  vec2 y = two_sum(ray.origin_km.y, rest.y);
  vec2 z = two_sum(ray.origin_km.z, rest.z);
  moved.origin_km = vec3(x.x, y.x, z.x);
  moved.rest_km = vec3(x.y, y.y, z.y);
  float lowest = tangent_altitude(ground_radius_km, ray.altitude_km, ray.mu, ray.sine);
  float radius = ground_radius_km + ceiling_km;
  moved.altitude_km = ceiling_km;
  moved.mu = -half_chord(ground_radius_km, lowest, ceiling_km) / radius;
  moved.sine = (ground_radius_km + lowest) / radius;
  moved.begins_km = ray.begins_km + t;
  return moved;
}
// [/ceiling]

// [shell]
// Inside the sphere of the top, outside that of the base.
Spans shell_spans(float ground_radius_km, float altitude_km, float mu, float sine, float base_km, float top_km) {
  Spans spans = no_spans();
  Chord outer = robust_chord(ground_radius_km, altitude_km, mu, sine, top_km);
  if (outer.leave_km < 0.0) return spans;
  Chord inner = robust_chord(ground_radius_km, altitude_km, mu, sine, base_km);
  if (inner.leave_km < 0.0) {
    spans.first = vec2(outer.enter_km, outer.leave_km);
    return spans;
  }
  spans.first = vec2(outer.enter_km, inner.enter_km);
  spans.second = vec2(inner.leave_km, outer.leave_km);
  return spans;
}
// [/shell]

// [sphere]
// From the point closest to the centre: nothing large is squared. `from_centre_km`: the ray's start.
vec2 sphere_span(vec3 from_centre_km, vec3 direction, float radius_km) {
  float closest = -dot(from_centre_km, direction);
  float distance = length(from_centre_km + direction * closest);
  if (distance >= radius_km) return vec2(0.0, 0.0);
  float half_length = sqrt((radius_km - distance) * (radius_km + distance));
  return vec2(closest - half_length, closest + half_length);
}
// [/sphere]

// A box from (0, 0, 0) to `size_km`. An axis along which the ray does not go keeps all of it or nothing.
vec2 box_span(vec3 from_corner_km, vec3 direction, vec3 size_km) {
  vec2 span = vec2(-kNoEnd_km, kNoEnd_km);
  for (int axis = 0; axis < 3; axis++) {
    float x = from_corner_km[axis], d = direction[axis], size = size_km[axis];
    if (abs(d) < 1.0e-12) {
      if (x < 0.0 || x > size) return vec2(0.0, 0.0);
    } else {
      float a = -x / d, b = (size - x) / d;
      span = common_part(span, vec2(min(a, b), max(a, b)));
    }
  }
  return span;
}

// [cone]
// The cone about a vertical axis that cuts a disc out of a shell: at height z above the base it is radius + slope z
// wide. Everything is counted from the point of the ray closest to the axis' foot, so no number is as large as R.
//   (x + t d)_across^2 < (radius + slope (x + t d)_up)^2
vec2 cone_span(vec3 from_foot_km, vec3 direction, vec3 axis, float radius_km, float slope) {
  float closest = -dot(from_foot_km, direction);
  vec3 x = from_foot_km + direction * closest;
  float up = dot(x, axis), d_up = dot(direction, axis);
  vec3 across = x - axis * up, d_across = direction - axis * d_up;
  float wide = radius_km + slope * up, d_wide = slope * d_up;
  float a = dot(d_across, d_across) - d_wide * d_wide;
  float b = dot(across, d_across) - wide * d_wide;
  float c = dot(across, across) - wide * wide;
  float discriminant = b * b - a * c;
  if (abs(a) < 1.0e-9) {  // parallel to the cone's side: one end only
    if (abs(b) < 1.0e-9) return c < 0.0 ? vec2(-kNoEnd_km, kNoEnd_km) : vec2(0.0, 0.0);
    float end = closest - 0.5 * c / b;
    return b > 0.0 ? vec2(-kNoEnd_km, end) : vec2(end, kNoEnd_km);
  }
  if (a > 0.0 && discriminant <= 0.0) return vec2(0.0, 0.0);
  float q = -(b + (b >= 0.0 ? 1.0 : -1.0) * sqrt(max(discriminant, 0.0)));
  float one = q / a, other = q != 0.0 ? c / q : one;
  vec2 roots = vec2(min(one, other), max(one, other));
  if (a < 0.0)  // steeper than the side: from one root on, in the half of the double cone that is the disc's
    return d_wide > 0.0 ? vec2(closest + roots.y, kNoEnd_km) : vec2(-kNoEnd_km, closest + roots.x);
  if (wide + d_wide * 0.5 * (roots.x + roots.y) <= 0.0) return vec2(0.0, 0.0);  // in the other half
  return vec2(closest + roots.x, closest + roots.y);
}
// [/cone]

// [body_spans]
// The ray's start from a point: exact where both are far from the origin of the frame and close to each other.
vec3 start_from(CloudRay ray, vec3 point_km) { return (ray.origin_km - point_km) + ray.rest_km; }

Spans body_spans(CloudBody body, float ground_radius_km, CloudRay ray) {
  Spans spans = no_spans();
  if (body.kind == kCloudSphere) {
    spans.first = sphere_span(start_from(ray, body.place_km), ray.direction, body.radius_km);
  } else if (body.kind == kCloudGrid) {
    spans.first = box_span(start_from(ray, body.place_km), ray.direction, body.axis);
  } else {
    spans = shell_spans(ground_radius_km, ray.altitude_km, ray.mu, ray.sine, body.base_km, body.top_km);
    if (body.kind == kCloudDisc) {
      vec2 cone = cone_span(start_from(ray, body.place_km), ray.direction, body.axis, body.radius_km, body.cone_slope);
      spans.first = common_part(spans.first, cone);
      spans.second = common_part(spans.second, cone);
    }
  }
  vec2 whole = vec2(0.0, ray.end_km);
  spans.first = common_part(spans.first, whole);
  spans.second = common_part(spans.second, whole);
  return spans;
}
// [/body_spans]

#endif
