// Single scattering of sunlight in clouds, converged: what `orders=1` means, whatever the method. Pure functions; km.
//
//   L1 = sum over bodies of  albedo P(nu)  integral of  sigma(t) exp(-tau(t) - tau_sun(t)) dt
// Two Gauss nodes a step, the body's own optical depth by the line through its extinction at them, that to the sun as chapter
// 17 has it: closed forms, exact cells of a grid, a fine march through noise. No octaves, powder or ambient light.
//
// The including file gives what cloud_scene.glsl wants.
#ifndef WELKIN_CLOUD_FIRST_ORDER_GLSL
#define WELKIN_CLOUD_FIRST_ORDER_GLSL

#include "18_cloud_light/cloud_scene.glsl"

const float kFirstOrderDepth = 0.25;  // largest optical depth of a step
const float kFirstOrderEnd = 25.0;    // what lies deeper is below 1e-11

// [first_order]
// A part of a ray: the work for one is spread over several invocations, because a software driver ends every loop of an
// invocation after 65,535 turns of all of them. What lies before a part is an optical depth.
struct RayPart {
  int number;
  int of;
};

// Steps over a part of a span: of an optical depth at most as above where the body is densest, and in a grid a cell long.
int first_order_steps(CloudBody body, float length_km, int noise_steps, int parts) {
  float steps = length_km * body.extinction_per_km * body.largest_density / kFirstOrderDepth;
  if (body.kind == kCloudGrid) {
    vec3 cells = vec3(float(body.samples_x - 1) / body.axis.x, float(body.samples_y - 1) / body.axis.y, float(body.samples_z - 1) / body.axis.z);
    steps = max(steps, length_km * max(max(cells.x, cells.y), cells.z));
  }
  if (body.kind == kCloudNoise) steps = max(steps, float(noise_steps) * length_km / (body.top_km - body.base_km));
  return int(clamp(ceil(steps / float(parts)), 16.0, 30000.0));
}

// Optical depth of the other bodies up to a distance.
float depth_of_others(CloudRay ray, int body, float t_km, CloudMarch march) {
  if (clouds.count == 1) return 0.0;
  CloudRay to = ray;
  to.end_km = min(t_km, ray.end_km);
  float sum = 0.0;
  for (int i = 0; i < clouds.count; i++)
    if (i != body) sum += body_optical_depth(clouds.bodies[i], clouds.ground_radius_km, to, march);
  return sum;
}

// Sunlight that reaches a point, at this optical depth of the body from the eye.
float sun_through(CloudRay ray, int number, float t_km, float depth, vec3 sun, CloudMarch march) {
  CloudRay to_sun = cloud_ray_from(point_along(ray, clouds.ground_radius_km, t_km), clouds.ground_radius_km, sun);
  if (to_sun.end_km < kNoEnd_km) return 0.0;
  return exp(-depth - depth_of_others(ray, number, t_km, march) - cloud_optical_depth(to_sun, march));
}

// Of one span of one body: radiance before phase function and albedo. A homogeneous body's steps grow from where it begins:
// with a low sun all of its light comes from a small optical depth.
float first_order_of_span(CloudRay ray, int number, vec2 span, vec3 sun, CloudMarch march, RayPart part) {
  CloudBody body = clouds.bodies[number];
  float length_km = span_length(span);
  if (length_km <= 0.0) return 0.0;
  bool grows = is_homogeneous(body);
  if (grows) length_km = min(length_km, kFirstOrderEnd / body.extinction_per_km);
  int steps = first_order_steps(body, length_km, march.steps, part.of);
  float begin = float(part.number) / float(part.of);
  float share = 1.0 / float(part.of * steps);
  CloudRay to_part = ray;
  to_part.end_km = span.x + length_km * (grows ? begin * begin : begin);
  float depth = body_optical_depth(body, clouds.ground_radius_km, to_part, march);
  float sum = 0.0;
  for (int n = 0; n < steps && depth < kFirstOrderEnd; n++) {
    float at = begin + share * float(n);
    float low = at + 0.21132486540518713 * share;
    float high = at + 0.78867513459481287 * share;
    float t_low = span.x + length_km * (grows ? low * low : low);
    float t_high = span.x + length_km * (grows ? high * high : high);
    float a = length_km * share * body.extinction_per_km * (grows ? 2.0 * low : 1.0);
    float b = length_km * share * body.extinction_per_km * (grows ? 2.0 * high : 1.0);
    if (!grows) {
      a *= cloud_density(body, clouds.ground_radius_km, point_along(ray, clouds.ground_radius_km, t_low), march.detail, kGridExact);
      b *= cloud_density(body, clouds.ground_radius_km, point_along(ray, clouds.ground_radius_km, t_high), march.detail, kGridExact);
    }
    if (a + b <= 0.0) continue;
    // The line through a and b, integrated up to each node.
    float slope = (b - a) * 1.7320508075688772;
    float base = a - 0.21132486540518713 * slope;
    float depth_low = depth + 0.21132486540518713 * (base + 0.5 * 0.21132486540518713 * slope);
    float depth_high = depth + 0.78867513459481287 * (base + 0.5 * 0.78867513459481287 * slope);
    if (a > 0.0) sum += 0.5 * a * sun_through(ray, number, t_low, depth_low, sun, march);
    if (b > 0.0) sum += 0.5 * b * sun_through(ray, number, t_high, depth_high, sun, march);
    depth += 0.5 * (a + b);
  }
  return sum;
}

float first_order_of_clouds(CloudRay ray, vec3 sun, CloudMarch march, RayPart part) {
  float radiance = 0.0;
  for (int i = 0; i < clouds.count; i++) {
    Spans spans = body_spans(clouds.bodies[i], clouds.ground_radius_km, ray);
    float light = first_order_of_span(ray, i, spans.first, sun, march, part) + first_order_of_span(ray, i, spans.second, sun, march, part);
    if (light > 0.0)
      radiance += light * clouds.bodies[i].single_scattering_albedo *
                  cloud_phase(body_phase(i), one_minus_cosine(ray.direction, sun), one_minus_cosine(ray.direction, sun * -1.0));
  }
  return radiance;
}
// [/first_order]

#endif
