// The free flight of a path: from its last vertex to the next collision, to the ground or out of the air. Pure
// functions; km.
//
// The including file gives HAS_* and TRACKING.
#ifndef WELKIN_FREE_FLIGHT_GLSL
#define WELKIN_FREE_FLIGHT_GLSL

#include "07_ground_truth/flight.glsl"

// [free_flight]
struct FreeFlight {
  bool collided;
  bool finished;        // false: the driver ended a loop
  float t_km;           // to the collision, or the segment's length
  float altitude_km;    // of the collision
  vec3 meets;           // per channel: the true probability that a flight meets the majorant at all
  vec3 meets_forced;    // the probability it was given
  float spread;         // probability that the collision was placed uniformly on the segment instead of flown to
  Random random;
};

// The constituents that these flights look at, per channel in 1/km; 0 for one that is not there.
struct Collisions {
  vec3 rayleigh_per_km;
  vec3 mie_per_km;
  float rayleigh_majorant_km;  // columns of the majorants over the whole segment; 0 where nothing is forced
  float mie_majorant_km;
};

Collisions collisions_on(Atmosphere atmosphere, PathSegment segment, bool force) {
  Collisions on;
  on.rayleigh_per_km = HAS_RAYLEIGH ? atmosphere.rayleigh_scattering : vec3(0.0, 0.0, 0.0);
  on.mie_per_km = HAS_MIE ? atmosphere.mie_extinction : vec3(0.0, 0.0, 0.0);
  on.rayleigh_majorant_km = 0.0;
  on.mie_majorant_km = 0.0;
  if (force && HAS_RAYLEIGH) on.rayleigh_majorant_km = majorant_column(segment, atmosphere.rayleigh_scale_height_km);
  if (force && HAS_MIE) on.mie_majorant_km = majorant_column(segment, atmosphere.mie_scale_height_km);
  return on;
}

// Majorant columns, in km, up to each constituent's first tentative collision.
struct FirstColumns {
  bool met;  // whether the majorant is met at all, where that was decided beforehand
  float rayleigh_km;
  float mie_km;
};

// The two constituents' collisions are independent of each other, and whichever comes first counts.
FirstColumns first_columns(Collisions on, vec3 channel, bool force, FreeFlight flight, vec4 u) {
  float rayleigh = dot(on.rayleigh_per_km, channel);
  float mie = dot(on.mie_per_km, channel);
  FirstColumns first;
  first.met = true;
  first.rayleigh_km = rayleigh > 0.0 ? minus_log_one_minus(u.x) / rayleigh : 3.0e38;
  first.mie_km = mie > 0.0 ? minus_log_one_minus(u.y) / mie : 3.0e38;
  if (!force) return first;
  first.met = u.z < dot(flight.meets_forced, channel);
  // One of the two is met: either Rayleigh's majorant, and then Mie's may be met too, or Mie's alone.
  float rayleigh_meets = rayleigh * on.rayleigh_majorant_km * mean_exponential(rayleigh * on.rayleigh_majorant_km);
  if (u.w * dot(flight.meets, channel) < rayleigh_meets) {
    first.rayleigh_km = minus_log_one_minus(u.x * rayleigh_meets) / max(rayleigh, 1.0e-30);
  } else {
    first.rayleigh_km = 3.0e38;
    first.mie_km = minus_log_one_minus(u.y * mie * on.mie_majorant_km * mean_exponential(mie * on.mie_majorant_km)) /
                   max(mie, 1.0e-30);
  }
  return first;
}

// The flight, cut short where one constituent collides earlier.
FreeFlight cut_short(FreeFlight flight, PathSegment segment, float scale_height_km, float per_km,
                     float first_column_km) {
  Flight one = exponential_flight(segment, scale_height_km, per_km, first_column_km, flight.t_km, flight.random);
  flight.random = one.random;
  flight.finished = flight.finished && one.finished;
  if (one.collided) {
    flight.collided = true;
    flight.t_km = one.t_km;
    flight.altitude_km = one.altitude_km;
  }
  return flight;
}

FreeFlight shell_free_flight(Atmosphere atmosphere, PathSegment segment, vec3 channel, FreeFlight flight) {
  Flight any = shell_flight(atmosphere, segment, channel, TRACKING == kTrackNaive ? 1 : 24, flight.random);
  flight.collided = any.collided;
  flight.finished = any.finished;
  flight.t_km = any.t_km;
  flight.altitude_km = any.altitude_km;
  flight.random = any.random;
  return flight;
}

// The hero's free flight. `force`: where the true probability of meeting the majorant is below `at_least`, it is raised
// to that: most rays to the zenith of a clear sky would otherwise leave without a collision.
//
// spread: probability of a collision at a uniformly drawn place instead of a flight. Such paths find sunlight that is
// far away, behind air that no flight crosses. The paths' weights take both into account, so that the mean stays right.
FreeFlight sample_free_flight(Atmosphere atmosphere, PathSegment segment, vec3 channel, bool force, float at_least,
                              float spread, Random random) {
  FreeFlight flight;
  flight.collided = false;
  flight.finished = true;
  flight.t_km = segment.length_km;
  flight.altitude_km = segment.altitude_km;
  flight.meets = vec3(1.0, 1.0, 1.0);
  flight.meets_forced = flight.meets;
  flight.spread = spread;
  flight.random = random;
  if (TRACKING == kTrackNaive || TRACKING == kTrackShells)
    return shell_free_flight(atmosphere, segment, channel, flight);
  flight.random = draw(flight.random);
  vec4 u = flight.random.value;
  Collisions on = collisions_on(atmosphere, segment, force);
  if (force) {
    vec3 tau = on.rayleigh_per_km * on.rayleigh_majorant_km + on.mie_per_km * on.mie_majorant_km;
    flight.meets = tau * vec3(mean_exponential(tau.x), mean_exponential(tau.y), mean_exponential(tau.z));
    flight.meets_forced = max(flight.meets, vec3(at_least, at_least, at_least));
  }
  // A collision anywhere on the segment, or one that is flown to.
  if (u.x < spread) {
    flight.collided = true;
    flight.t_km = segment.length_km * u.y;
    flight.altitude_km = max(altitude_along(segment.radius_km, segment.altitude_km, segment.mu, flight.t_km), 0.0);
    return flight;
  }
  u.x = (u.x - spread) / (1.0 - spread);
  FirstColumns first = first_columns(on, channel, force, flight, u);
  if (first.met && HAS_RAYLEIGH && first.rayleigh_km < 1.0e38)
    flight = cut_short(flight, segment, atmosphere.rayleigh_scale_height_km, dot(on.rayleigh_per_km, channel),
                       first.rayleigh_km);
  if (first.met && HAS_MIE && first.mie_km < 1.0e38)
    flight = cut_short(flight, segment, atmosphere.mie_scale_height_km, dot(on.mie_per_km, channel), first.mie_km);
  return flight;
}
// [/free_flight]

// Probability that a flight reaches the segment's end: passes without forcing; where the probability of meeting the
// majorant is `forced` instead of `meets`, the flights that met it and did not collide, plus those that did not meet
// it.
float end_pdf(float passes, float meets, float forced) {
  return forced > meets ? max(passes - (1.0 - meets), 0.0) * (forced / max(meets, 1.0e-30)) + (1.0 - forced) : passes;
}

#endif
