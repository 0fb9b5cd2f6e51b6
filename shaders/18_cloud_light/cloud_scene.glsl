// Flights through all bodies of a scene: the nearest collision, what is left at the end, and a body's phase function.
//
// The including file gives the block `clouds` (interop/cloud.h) and what cloud_flight.glsl wants.
#ifndef WELKIN_CLOUD_SCENE_GLSL
#define WELKIN_CLOUD_SCENE_GLSL

#include "18_cloud_light/cloud_flight.glsl"
#include "18_cloud_light/cloud_phase.glsl"

// [body_phase]
// The block's first lobe has the weight lobe_weight; here the second one has what is left.
CloudPhase body_phase(int body) {
  CloudPhase phase;
  phase.first.one_minus_g = 1.0 - clouds.bodies[body].lobe_g;
  phase.first.alpha = clouds.bodies[body].lobe_alpha;
  phase.second.one_minus_g = 1.0 - clouds.bodies[body].second_g;
  phase.second.alpha = clouds.bodies[body].second_alpha;
  phase.second_weight = 1.0 - clouds.bodies[body].lobe_weight;
  return phase;
}
// [/body_phase]

// [next_collision]
CloudFlight flight_before(CloudRay ray, Random random) {
  CloudFlight flight;
  flight.collided = false;
  flight.finished = true;
  flight.t_km = ray.end_km;
  flight.body = -1;
  flight.met = 1.0;
  flight.random = random;
  return flight;
}

CloudFlight next_collision(CloudRay ray, int detail, Random random) {
  CloudFlight flight = flight_before(ray, random);
  for (int i = 0; i < clouds.count; i++) {
    Spans spans = body_spans(clouds.bodies[i], clouds.ground_radius_km, ray);
    if (spans_length(spans) <= 0.0) continue;
    flight.random = draw(flight.random);
    float depth = minus_log_one_minus(flight.random.value.x);
    flight = flight_in_body(clouds.bodies[i], i, ray, spans, clouds.ground_radius_km, depth, detail, flight);
  }
  return flight;
}
// [/next_collision]

// [forced_collision]
// Mean number of tentative collisions on a ray, of all bodies, and the probability that there is one at least.
float all_bounds(CloudRay ray) {
  float sum = 0.0;
  for (int i = 0; i < clouds.count; i++)
    sum += bound_column(clouds.bodies[i], ray, body_spans(clouds.bodies[i], clouds.ground_radius_km, ray));
  return sum;
}

float met_by_nature(CloudRay ray) {
  float bounds = all_bounds(ray);
  return bounds * mean_exponential(bounds);
}

// A flight that meets the bound of some body at least once. The probability of that by nature is flight.met, the weight of
// all that comes of it. In the order of the bodies each meets its bound with the probability it has given that those before it
// did not, and that one of all does.
CloudFlight forced_collision(CloudRay ray, int detail, Random random) {
  CloudFlight flight = flight_before(ray, random);
  float left = all_bounds(ray);
  flight.met = left * mean_exponential(left);
  if (flight.met <= 0.0) return flight;
  bool forced = true;
  for (int i = 0; i < clouds.count; i++) {
    Spans spans = body_spans(clouds.bodies[i], clouds.ground_radius_km, ray);
    if (spans_length(spans) <= 0.0) continue;
    float column = bound_column(clouds.bodies[i], ray, spans);
    float meets = column * mean_exponential(column);
    flight.random = draw(flight.random);
    float u = flight.random.value.x;
    if (forced) {
      float any = left * mean_exponential(left);
      left = max(left - column, 0.0);
      // The last of them is met for certain, whatever rounding left.
      if (flight.random.value.y * any >= meets && left > 0.0) continue;
      forced = false;
      u *= meets;
    }
    flight = flight_in_body(clouds.bodies[i], i, ray, spans, clouds.ground_radius_km, minus_log_one_minus(u), detail, flight);
  }
  return flight;
}
// [/forced_collision]

// [transmittance_to_end]
TrackedTransmittance transmittance_to_end(CloudRay ray, int detail, Random random) {
  TrackedTransmittance light;
  light.value = 1.0;
  light.finished = true;
  light.random = random;
  for (int i = 0; i < clouds.count && light.value > 0.0; i++) {
    Spans spans = body_spans(clouds.bodies[i], clouds.ground_radius_km, ray);
    if (spans_length(spans) > 0.0) light = through_body(clouds.bodies[i], ray, spans, clouds.ground_radius_km, detail, light);
  }
  return light;
}
// [/transmittance_to_end]

#endif
