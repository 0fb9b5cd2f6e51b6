// One path of light through bodies of cloud, followed backward from the eye, to any order of scattering. Pure functions; km.
// Radiance in units of the sun's irradiance; clouds are grey: one number for all channels. The sun is a point direction and is
// not seen itself.
//
// Every collision gives the sunlight that is scattered there (next-event estimation), with the phase function's value between
// the path's direction and the sun. Where that function is sharp, a rare path that flies nearly towards the sun brings a
// hundred times the mean. So a second way to the same next collision is drawn: a side ray from the lobe round the sun, which
// also meets a bound for certain. The balance heuristic (Veach 1997) weighs both. With p the density of the path's own turn, s
// that of the side ray's (the phase function towards the sun), q side rays a collision, and m the probability by nature that a
// bound is met in that direction, both ways give
//   p s / (p + q s / m)    where p alone gave s.
//
// The including file gives cloud_flight.glsl's functions and CLOUD_ENVIRONMENT (const bool): light of radiance 1 from outside
// in place of the sun, as in a white furnace.
#ifndef WELKIN_CLOUD_PATH_GLSL
#define WELKIN_CLOUD_PATH_GLSL

#include "18_cloud_light/cloud_phase.glsl"
#include "18_cloud_light/cloud_scene.glsl"

// [path_settings]
struct CloudPathSettings {
  int orders;         // 0: all
  int detail;         // of noise: kWithDetail, kWithCurledDetail
  float side_rays;    // mean number at a collision; 0: none
  float ground_albedo;
  vec3 sun;           // unit, global frame
};

struct CloudPathLight {
  float radiance;
  bool finished;
  int vertices;
};
// [/path_settings]

// [sunlight_at]
// Scattered at a point of a body out of the sun's rays into the direction the path came from: albedo P(nu) T, 1/sr.
struct SunAt {
  float value;
  bool finished;
  Random random;
};

SunAt sun_scattered_at(CloudPathSettings settings, int body, CloudPoint point, vec3 direction, Random random) {
  SunAt sun;
  sun.value = 0.0;
  sun.finished = true;
  sun.random = random;
  CloudRay ray = cloud_ray_from(point, clouds.ground_radius_km, settings.sun);
  if (ray.end_km < kNoEnd_km) return sun;  // the planet's shadow
  TrackedTransmittance light = transmittance_to_end(ray, settings.detail, random);
  sun.random = light.random;
  sun.finished = light.finished;
  float p = cloud_phase(body_phase(body), one_minus_cosine(direction, settings.sun), one_minus_cosine(direction, settings.sun * -1.0));
  sun.value = clouds.bodies[body].single_scattering_albedo * p * light.value;
  return sun;
}
// [/sunlight_at]

// [side_ray]
// The next collision, reached from a point of a body by a direction drawn from the lobe round the sun. `direction`: the path's.
SunAt side_ray(CloudPathSettings settings, int body, CloudPoint point, vec3 direction, Random random) {
  SunAt side;
  side.value = 0.0;
  side.finished = true;
  CloudPhase phase = body_phase(body);
  CloudTurn drawn = cloud_turn(phase, random);
  drawn.random = draw(drawn.random);
  vec3 to = turned(settings.sun, drawn.turn, drawn.random.value.x);
  CloudRay ray = cloud_ray_from(point, clouds.ground_radius_km, to);
  CloudFlight flight = forced_collision(ray, settings.detail, drawn.random);
  side.random = flight.random;
  side.finished = flight.finished;
  if (!flight.collided) return side;
  float p = cloud_phase(phase, one_minus_cosine(direction, to), one_minus_cosine(direction, to * -1.0));
  float s = cloud_phase(phase, drawn.turn.one_minus_nu, drawn.turn.one_plus_nu);
  SunAt sun = sun_scattered_at(settings, flight.body, point_along(ray, clouds.ground_radius_km, flight.t_km), to, flight.random);
  side.value = sun.value * p / (p + settings.side_rays * s / flight.met);
  side.finished = sun.finished;
  side.random = sun.random;
  return side;
}
// [/side_ray]

// [cloud_path]
struct CloudPath {
  CloudPathLight light;
  bool ended;
  float carried;   // throughput over density
  float at_first;  // the same after the first flight
  float own;       // weight of the path's own way to its next collision
  CloudRay ray;
  Random random;
};

// A collision: its sunlight, perhaps a side ray, and the next direction.
CloudPath at_cloud_collision(CloudPathSettings settings, CloudPath path, CloudFlight flight, bool last) {
  CloudPoint point = point_along(path.ray, clouds.ground_radius_km, flight.t_km);
  path.random = flight.random;
  if (!CLOUD_ENVIRONMENT) {
    SunAt sun = sun_scattered_at(settings, flight.body, point, path.ray.direction, path.random);
    path.random = sun.random;
    path.light.radiance += path.carried * path.own * sun.value;
    path.light.finished = path.light.finished && sun.finished;
  }
  path.ended = last;
  if (last) return path;
  path.carried *= clouds.bodies[flight.body].single_scattering_albedo;
  path.random = draw(path.random);
  bool side = !CLOUD_ENVIRONMENT && path.random.value.w < settings.side_rays;
  float around = path.random.value.x;
  if (side) {
    SunAt aside = side_ray(settings, flight.body, point, path.ray.direction, path.random);
    path.random = aside.random;
    path.light.radiance += path.carried * aside.value;
    path.light.finished = path.light.finished && aside.finished;
  }
  CloudPhase phase = body_phase(flight.body);
  CloudTurn drawn = cloud_turn(phase, path.random);
  path.random = drawn.random;
  vec3 to = turned(path.ray.direction, drawn.turn, around);
  path.ray = cloud_ray_from(point, clouds.ground_radius_km, to);
  path.own = 1.0;
  if (!CLOUD_ENVIRONMENT && settings.side_rays > 0.0) {
    float p = cloud_phase(phase, drawn.turn.one_minus_nu, drawn.turn.one_plus_nu);
    float s = cloud_phase(phase, one_minus_cosine(to, settings.sun), one_minus_cosine(to, settings.sun * -1.0));
    path.own = p / (p + settings.side_rays * s / max(met_by_nature(path.ray), 1.0e-30));
  }
  return path;
}

// The Lambert ground: its sunlight, and a direction about the vertical.
CloudPath at_cloud_ground(CloudPathSettings settings, CloudPath path, bool last) {
  CloudPoint point = point_along(path.ray, clouds.ground_radius_km, path.ray.end_km);
  point.altitude_km = 0.0;
  path.carried *= settings.ground_albedo;
  vec3 place = point.origin_km + point.offset_km;
  vec3 up = vec3(place.x, place.y, place.z + clouds.ground_radius_km);
  up = up / length(up);
  float mu_sun = dot(up, settings.sun);
  if (!CLOUD_ENVIRONMENT && mu_sun > 0.0) {
    TrackedTransmittance light = transmittance_to_end(cloud_ray_from(point, clouds.ground_radius_km, settings.sun), settings.detail, path.random);
    path.random = light.random;
    path.light.radiance += path.carried * light.value * mu_sun * 0.31830988618379067;
  }
  path.ended = last || path.carried <= 0.0;
  if (path.ended) return path;
  path.random = draw(path.random);
  path.ray = cloud_ray_from(point, clouds.ground_radius_km, about(up, cosine_hemisphere(path.random.value.x, path.random.value.y)));
  path.own = 1.0;
  return path;
}

// Light that has lost nine tenths to absorption goes on with the chance of what is left.
CloudPath after_cloud_roulette(CloudPath path) {
  float least = 0.1 * path.at_first;
  if (path.carried >= least) return path;
  path.random = draw(path.random);
  if (path.random.value.x * least >= path.carried) path.ended = true;
  path.carried = least;
  return path;
}

// All of one path. The ray begins below the ceiling of all clouds (chapter 17). Its first flight meets a bound for certain,
// where nature would have it less often.
CloudPathLight trace_cloud_path(CloudPathSettings settings, CloudRay ray, Random random) {
  CloudPath path;
  path.light.radiance = 0.0;
  path.light.finished = true;
  path.light.vertices = 0;
  path.ended = false;
  path.carried = 1.0;
  path.at_first = 1.0;
  path.own = 1.0;
  path.ray = ray;
  path.random = random;
  bool force = !CLOUD_ENVIRONMENT && (ray.end_km >= kNoEnd_km || settings.ground_albedo <= 0.0);
  for (int order = 1; order <= 100000; order++) {
    bool last = order == settings.orders;
    CloudFlight flight = order == 1 && force ? forced_collision(path.ray, settings.detail, path.random)
                                             : next_collision(path.ray, settings.detail, path.random);
    path.random = flight.random;
    path.light.finished = path.light.finished && flight.finished;
    if (order == 1 && force) path.carried = flight.met;
    if (order == 1) path.at_first = path.carried;
    if (flight.collided) {
      path = at_cloud_collision(settings, path, flight, last);
    } else if (path.ray.end_km < kNoEnd_km) {
      path = at_cloud_ground(settings, path, last);
    } else {
      if (CLOUD_ENVIRONMENT) path.light.radiance += path.carried;
      path.ended = true;
    }
    path.light.vertices = order;
    if (!path.ended) path = after_cloud_roulette(path);
    if (path.ended) return path.light;
  }
  path.light.finished = false;
  return path.light;
}
// [/cloud_path]

#endif
