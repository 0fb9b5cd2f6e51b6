// Light of clouds along a ray by marching: single scattering, and what stands in for the orders above it. Pure functions; km.
// Radiance for the sun's irradiance 1.
//
// A step gives (extinction sigma, optical depth across tau, before it T):  S/sigma T (1 - e^-tau), whatever its length.
// Steps tile the ray's spans in all bodies together; bodies that overlap add up.
//
// The including file gives what cloud_scene.glsl wants.
#ifndef WELKIN_CLOUD_MARCH_GLSL
#define WELKIN_CLOUD_MARCH_GLSL

#include "18_cloud_light/cloud_scene.glsl"
#include "18_cloud_light/higher_orders.glsl"
#include "18_cloud_light/in_scatter.glsl"

// What stands in for higher orders: knob cloud.orders.
const int kOrdersNone = 0;
const int kOrdersOctaves = 1;
const int kOrdersEscape = 2;

// [settings]
struct CloudMarchSettings {
  vec3 sun;            // unit, global frame
  int steps;           // along the view, across a body's thickness; 8 times as many at most
  float offset;        // where in its step a sample lies: 0.5 unless a pixel moves it
  int light_samples;   // to the sun, of a grid or noise
  int escape_directions;  // 4: a tetrahedron; 2: up and down
  int escape_samples;     // in each
  float escape_refresh;   // how far the optical depth k tau may run on with what was found
  int method;          // kOrders...
  Octaves octaves;
  float powder;        // strength; 0: none
  float ambient;       // 1: light of sky and ground; 0: none
  int detail;          // of noise, along the view; light marches take its shape alone
  int grid_method;
};
// [/settings]

// [light_depth]
// Optical depth from a point in a direction. Of a homogeneous body exactly; of others by samples which thin out with the
// distance: sample i stands for the way from L (i/n)^2 to L ((i+1)/n)^2.
float light_depth(CloudPoint point, vec3 direction, int samples, CloudMarchSettings settings) {
  CloudRay ray = cloud_ray_from(point, clouds.ground_radius_km, direction);
  float tau = 0.0;
  for (int i = 0; i < clouds.count; i++) {
    Spans spans = body_spans(clouds.bodies[i], clouds.ground_radius_km, ray);
    float length_km = spans_length(spans);
    if (length_km <= 0.0) continue;
    if (is_homogeneous(clouds.bodies[i])) {
      tau += clouds.bodies[i].extinction_per_km * length_km;
      continue;
    }
    float first_km = span_length(spans.first);
    float sum = 0.0;
    for (int n = 0; n < samples; n++) {
      float low = float(n) / float(samples);
      float high = float(n + 1) / float(samples);
      float at = 0.5 * length_km * (low * low + high * high);
      float t = at < first_km ? spans.first.x + at : spans.second.x + (at - first_km);
      CloudPoint sample_point = point_along(ray, clouds.ground_radius_km, t);
      sum += cloud_density(clouds.bodies[i], clouds.ground_radius_km, sample_point, kShapeOnly, settings.grid_method) * (high * high - low * low);
    }
    tau += clouds.bodies[i].extinction_per_km * length_km * sum;
  }
  return tau;
}

// Escape chances upward and downward, whose sum is the mean over a few directions. The ground takes what it meets: that is a
// way out, too.
vec2 mean_escape(CloudPoint point, float apart, CloudMarchSettings settings) {
  vec2 sum = vec2(0.0, 0.0);
  for (int i = 0; i < settings.escape_directions; i++) {
    vec3 direction = escape_direction(i);
    if (settings.escape_directions == 2) direction = vec3(0.0, 0.0, i == 0 ? 1.0 : -1.0);
    float chance = escape_chance(light_depth(point, direction, settings.escape_samples, settings), apart);
    if (direction.z > 0.0) sum.x += chance;
    else sum.y += chance;
  }
  return sum / float(settings.escape_directions);
}
// [/light_depth]

// [hull]
// Where any body is: hulls of all first and of all second spans.
Spans hull_of_spans(CloudRay ray) {
  Spans hull;
  hull.first = vec2(kNoEnd_km, 0.0);
  hull.second = hull.first;
  for (int i = 0; i < clouds.count; i++) {
    Spans spans = body_spans(clouds.bodies[i], clouds.ground_radius_km, ray);
    if (span_length(spans.first) > 0.0) hull.first = vec2(min(hull.first.x, spans.first.x), max(hull.first.y, spans.first.y));
    if (span_length(spans.second) > 0.0) hull.second = vec2(min(hull.second.x, spans.second.x), max(hull.second.y, spans.second.y));
  }
  hull.second.x = max(hull.second.x, hull.first.y);
  return hull;
}
// [/hull]

// [cloud_light]
struct CloudLight {
  float radiance;       // sunlight of irradiance 1
  vec2 skylight;        // share of the radiance of the upper and of the lower half of the surroundings
  float blurred;        // share of what is behind, blurred
  float tau;            // of the ray
  float stopped_at_km;  // mean distance, weighted by where light stops
  float stopped;
};

// Number of steps of a march: as many across the thinnest body on the ray as are asked for.
int view_steps(CloudRay ray, float length_km, int steps) {
  float thin_km = length_km;
  for (int i = 0; i < clouds.count; i++) {
    if (is_homogeneous(clouds.bodies[i]) || spans_length(body_spans(clouds.bodies[i], clouds.ground_radius_km, ray)) <= 0.0) continue;
    vec3 size = clouds.bodies[i].axis;
    float across_km = clouds.bodies[i].kind == kCloudGrid ? min(min(size.x, size.y), size.z) : clouds.bodies[i].top_km - clouds.bodies[i].base_km;
    thin_km = min(thin_km, across_km);
  }
  return int(clamp(ceil(float(steps) * length_km / max(thin_km, 1.0e-6)), 1.0, 8.0 * float(steps)));
}

// Steps grow with their number where all bodies are homogeneous: the light of a thick one comes from its first optical depths.
float step_edge(int i, int steps, bool grows) {
  float share = float(i) / float(steps);
  return grows ? share * share : share;
}

CloudLight march_cloud_light(CloudRay ray, CloudMarchSettings settings) {
  CloudLight light = CloudLight(0.0, vec2(0.0, 0.0), 0.0, 0.0, 0.0, 0.0);
  Spans hull = hull_of_spans(ray);
  bool grows = (CLOUD_KINDS & (kCloudGrid + kCloudNoise)) == 0;
  float nu_minus = one_minus_cosine(ray.direction, settings.sun);
  float nu_plus = one_minus_cosine(ray.direction, settings.sun * -1.0);
  float total_km = spans_length(hull);
  if (total_km <= 0.0) return light;
  if (grows) total_km = min(total_km, 60.0 / clouds.bodies[0].extinction_per_km);
  float first_km = span_length(hull.first);
  // One phase function a ray: that of the first body met. What differs from it is a few percent of the light of overlaps.
  int last_body = -1;
  HigherOrders orders = higher_orders(body_phase(0), 1.0, nu_minus, nu_plus);
  CloudPhase phase = body_phase(0);
  int steps = view_steps(ray, total_km, settings.steps);
  vec2 escape = vec2(0.5, 0.5);
  float refreshed = -1.0e9;
  int stride = 1;
  for (int n = 0; n < steps; n += stride) {
    // Behind four optical depths only diffuse light is left, which changes slowly.
    stride = light.tau > 4.0 ? 4 : 1;
    float low = total_km * step_edge(n, steps, grows);
    float high = total_km * step_edge(min(n + stride, steps), steps, grows);
    float at = low + settings.offset * (high - low);
    float t = at < first_km ? hull.first.x + at : hull.second.x + (at - first_km);
    CloudPoint point = point_along(ray, clouds.ground_radius_km, t);
    float extinction = 0.0;
    float scattering = 0.0;
    int body = 0;
    float most = 0.0;
    for (int i = 0; i < clouds.count; i++) {
      float one = clouds.bodies[i].extinction_per_km * cloud_density(clouds.bodies[i], clouds.ground_radius_km, point, settings.detail, settings.grid_method);
      extinction += one;
      scattering += one * clouds.bodies[i].single_scattering_albedo;
      if (one > most) {
        most = one;
        body = i;
      }
    }
    float across = extinction * (high - low);
    if (across <= 0.0) continue;
    if (body != last_body) {
      phase = body_phase(body);
      orders = higher_orders(phase, scattering / extinction, nu_minus, nu_plus);
      last_body = body;
    }
    bool dark = cloud_ray_from(point, clouds.ground_radius_km, settings.sun).end_km < kNoEnd_km;
    float tau_sun = dark ? 1.0e4 : light_depth(point, settings.sun, light.tau > 4.0 ? (settings.light_samples + 1) / 2 : settings.light_samples, settings);
    float stops = step_weight(1.0, light.tau, across);
    float source = 0.0;
    if (settings.method == kOrdersOctaves) source = octave_sum(phase, settings.octaves, tau_sun, nu_minus, nu_plus);
    else source = cloud_phase(phase, nu_minus, nu_plus) * exp(-tau_sun);
    light.radiance += scattering / extinction * source * stops * powder(tau_sun, settings.powder);
    if (settings.method == kOrdersEscape) {
      if (orders.apart * (light.tau + across - refreshed) > settings.escape_refresh) {
        escape = mean_escape(point, orders.apart, settings);
        refreshed = light.tau;
      }
      if (!dark) light.radiance += higher_orders_of_step(orders, light.tau, across, tau_sun, escape.x + escape.y);
      light.skylight += skylight_of_step(orders, light.tau, across, escape) * settings.ambient;
    } else if (settings.ambient > 0.0) {
      float above = light_depth(point, vec3(0.0, 0.0, 1.0), settings.escape_samples, settings);
      float below = light_depth(point, vec3(0.0, 0.0, -1.0), settings.escape_samples, settings);
      light.skylight += vec2(ambient_from_sky(above), ambient_from_sky(below)) * (scattering / extinction * stops * settings.ambient);
    }
    light.tau += across;
    light.stopped += stops;
    light.stopped_at_km += stops * t;
    // Diffuse light of a thick cloud still comes from 1 / apart optical depths behind.
    float left = settings.method == kOrdersEscape ? orders.apart * light.tau : light.tau;
    if (left > 5.0) break;
  }
  if (settings.method == kOrdersEscape) light.blurred = blurred_behind(orders, light.tau) * settings.ambient;
  return light;
}
// [/cloud_light]

#endif
