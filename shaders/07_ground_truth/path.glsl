// One path of light, followed backward from the eye. Pure functions; km. Radiance in units of the sun's irradiance.
//
// The path carries, per channel, F: what the medium did to the light along it (transmittance, scattering coefficients,
// phase functions, albedo), and P: the density with which that channel would have drawn this very path. One channel, the
// hero, draws; all three are weighted by F / mean(P), which is unbiased for each (the balance heuristic; Wilkie et al.
// 2014). With one channel a path, F and P of the others are 0: the same lines compute both.
//
// The including file gives HAS_* and MIE_PHASE; TRACKING; HERO (const bool); ENVIRONMENT (const bool): light of radiance 1 from
// outside in place of the sun; SPREAD (const bool): whether collisions are also put where no flight gets; SURFACES (const
// bool): whether a path may meet a surface before the smooth planet's.
#ifndef WELKIN_PATH_GLSL
#define WELKIN_PATH_GLSL

#include "07_ground_truth/sampling.glsl"
#include "07_ground_truth/sunlight.glsl"

// How many collisions are put anywhere on their course, from vertices that the sun reaches (first flight) and does not.
// Found by measuring: without, the dusk's standard error is ten times as large; with more, a thick haze's.
const float kSpreadLit = 0.1;
const float kSpreadDark = 0.4;
const float kSpreadLater = 0.2;

struct PathLight {
  vec3 radiance;
  bool finished;  // false: the driver ended a loop before the path was at its end
  int vertices;   // scatterings and reflections
};

// What a ray from the eye meets before anything else: a Lambert surface, of rock or whatever stands there.
struct FirstSurface {
  float distance_km;  // from the eye; 0: there is none
  vec3 normal;        // unit, in the eye's local frame, towards the eye
  vec3 albedo;
};

FirstSurface no_surface() {
  FirstSurface surface;
  surface.distance_km = 0.0;
  surface.normal = vec3(0.0, 0.0, 1.0);
  surface.albedo = vec3(0.0, 0.0, 0.0);
  return surface;
}

// Direction of flight and of the sun in the local frame of the point reached, z up.
struct Frame {
  vec3 direction;
  vec3 sun;
};

// [moved]
// The frame at the end of a flight of t km: the vertical has turned by an angle of sine t sin(zenith)/r', which is the only
// thing that happens. Nothing as large as a radius is subtracted.
Frame moved(Course course, Frame at, float t_km, float altitude_km) {
  float r = course.radius_km + course.altitude_km;
  float r_to = course.radius_km + altitude_km;
  float turn_sine = t_km * course.sine / r_to;
  float turn_cosine = (r + t_km * course.mu) / r_to;
  float across = max(course.sine, 1.0e-20);
  float x = course.sine > 0.0 ? at.direction.x / across : 1.0;
  float y = course.sine > 0.0 ? at.direction.y / across : 0.0;
  float mu = (r * course.mu + t_km) / r_to;
  float sine = r * course.sine / r_to;
  float along = at.sun.x * x + at.sun.y * y;
  float turned_along = turn_cosine * along - turn_sine * at.sun.z;
  Frame to;
  to.direction = vec3(sine * x, sine * y, mu);
  float gain = turned_along - along;
  to.sun = vec3(at.sun.x + gain * x, at.sun.y + gain * y, turn_cosine * at.sun.z + turn_sine * along);
  to.direction = to.direction / length(to.direction);
  to.sun = to.sun / length(to.sun);
  return to;
}
// [/moved]

// [flight]
struct Leg {
  bool collided;
  bool finished;
  float t_km;
  float altitude_km;
  vec3 meets;      // per channel: probability that the majorant is met at all, by nature
  vec3 wanted;     // and as it was made
  float spread;    // probability with which the collision was put anywhere on the course instead
  Random random;
};

// The hero's free flight. `force`: see to it that the majorant is met with probability `at_least`, where nature would have
// it less often: most rays to the zenith of a clear sky would leave without meeting anything.
//
// spread: probability with which the hero does not fly at all but collides at a uniformly drawn place. Where the sunlight is
// far away, behind air that no flight crosses, those paths find it; everywhere else the weights see to it that they agree.
Leg fly(Atmosphere atmosphere, Course course, vec3 channel, bool force, float at_least, float spread, Random random) {
  Leg leg;
  leg.spread = spread;
  leg.meets = vec3(1.0, 1.0, 1.0);
  leg.wanted = leg.meets;
  if (TRACKING == kTrackNaive || TRACKING == kTrackShells) {
    Flight flight = shell_flight(atmosphere, course, channel, TRACKING == kTrackNaive ? 1 : 24, random);
    leg.collided = flight.collided;
    leg.finished = flight.finished;
    leg.t_km = flight.t_km;
    leg.altitude_km = flight.altitude_km;
    leg.random = flight.random;
    return leg;
  }
  vec3 rayleigh_per_km = HAS_RAYLEIGH ? atmosphere.rayleigh_scattering : vec3(0.0, 0.0, 0.0);
  vec3 mie_per_km = HAS_MIE ? atmosphere.mie_extinction : vec3(0.0, 0.0, 0.0);
  float rayleigh = dot(rayleigh_per_km, channel);
  float mie = dot(mie_per_km, channel);
  random = draw(random);
  vec4 u = random.value;
  float rayleigh_all = 0.0;
  float mie_all = 0.0;
  if (force) {
    if (HAS_RAYLEIGH) rayleigh_all = majorant_column(course, atmosphere.rayleigh_scale_height_km);
    if (HAS_MIE) mie_all = majorant_column(course, atmosphere.mie_scale_height_km);
    vec3 tau = rayleigh_per_km * rayleigh_all + mie_per_km * mie_all;
    leg.meets = tau * vec3(mean_exponential(tau.x), mean_exponential(tau.y), mean_exponential(tau.z));
    leg.wanted = max(leg.meets, vec3(at_least, at_least, at_least));
  }
  if (u.x < spread) {
    leg.collided = true;
    leg.finished = true;
    leg.t_km = course.length_km * u.y;
    leg.altitude_km = max(altitude_along(course.radius_km, course.altitude_km, course.mu, leg.t_km), 0.0);
    leg.random = random;
    return leg;
  }
  u.x = (u.x - spread) / (1.0 - spread);
  // Two independent races: the constituents' collisions do not know of each other, and the first of either counts.
  float rayleigh_column = rayleigh > 0.0 ? minus_log_one_minus(u.x) / rayleigh : 3.0e38;
  float mie_column = mie > 0.0 ? minus_log_one_minus(u.y) / mie : 3.0e38;
  bool met = true;  // whether the majorant is met at all, where that was decided beforehand
  if (force) {
    met = u.z < dot(leg.wanted, channel);
    // Either Rayleigh's majorant is met, and Mie's may be; or Mie's alone.
    float rayleigh_meets = rayleigh * rayleigh_all * mean_exponential(rayleigh * rayleigh_all);
    if (u.w * dot(leg.meets, channel) < rayleigh_meets) {
      rayleigh_column = minus_log_one_minus(u.x * rayleigh_meets) / max(rayleigh, 1.0e-30);
    } else {
      rayleigh_column = 3.0e38;
      mie_column = minus_log_one_minus(u.y * mie * mie_all * mean_exponential(mie * mie_all)) / max(mie, 1.0e-30);
    }
  }
  leg.collided = false;
  leg.finished = true;
  leg.t_km = course.length_km;
  leg.altitude_km = course.altitude_km;
  if (met && HAS_RAYLEIGH && rayleigh_column < 1.0e38) {
    Flight flight = exponential_flight(course, atmosphere.rayleigh_scale_height_km, rayleigh, rayleigh_column, leg.t_km, random);
    random = flight.random;
    leg.finished = flight.finished;
    if (flight.collided) {
      leg.collided = true;
      leg.t_km = flight.t_km;
      leg.altitude_km = flight.altitude_km;
    }
  }
  if (met && HAS_MIE && mie_column < 1.0e38) {
    Flight flight = exponential_flight(course, atmosphere.mie_scale_height_km, mie, mie_column, leg.t_km, random);
    random = flight.random;
    leg.finished = leg.finished && flight.finished;
    if (flight.collided) {
      leg.collided = true;
      leg.t_km = flight.t_km;
      leg.altitude_km = flight.altitude_km;
    }
  }
  leg.random = random;
  return leg;
}
// [/flight]

float mean_of(vec3 v) { return (v.x + v.y + v.z) * 0.33333333333333333; }

// Probability of coming through to the end of a course of which a share `passes` comes through by nature, where meeting the
// majorant has probability `wanted` instead of `meets`: those that met it and collided with nothing, and those that did not.
float end_density(float passes, float meets, float wanted) {
  return wanted > meets ? max(passes - (1.0 - meets), 0.0) * (wanted / max(meets, 1.0e-30)) + (1.0 - wanted) : passes;
}

// The path's first frame: where its ray is in the air, or enters it.
Frame first_frame(AirRay ray, float altitude_km, float top_km, vec3 view, vec3 sun) {
  float sine = sqrt(view.x * view.x + view.y * view.y);
  float x = sine > 0.0 ? view.x / sine : 1.0;
  float y = sine > 0.0 ? view.y / sine : 0.0;
  Frame frame;
  frame.direction = vec3(ray.sine * x, ray.sine * y, ray.mu);
  frame.sun = sun;
  if (altitude_km > top_km) {
    float turn_cosine = view.z * ray.mu + sine * ray.sine;
    float turn_sine = max(sine * ray.mu - view.z * ray.sine, 0.0);
    float along = sun.x * x + sun.y * y;
    float turned_along = turn_cosine * along - turn_sine * sun.z;
    float gain = turned_along - along;
    frame.sun = vec3(sun.x + gain * x, sun.y + gain * y, turn_cosine * sun.z + turn_sine * along);
  }
  return frame;
}

// [surface]
// What a flight that goes down ends on: level ground, or for the first flight a surface of any slope.
struct Slope {
  float distance_km;  // from where the ray is in the air
  float altitude_km;
  vec3 normal;        // in the frame of the point where the flight began
  vec3 albedo;
};

Slope level_ground(Atmosphere atmosphere) {
  Slope slope;
  slope.distance_km = 0.0;
  slope.altitude_km = 0.0;
  slope.normal = vec3(0.0, 0.0, 1.0);
  slope.albedo = atmosphere.ground_albedo;
  return slope;
}

Slope first_slope(Atmosphere atmosphere, float altitude_km, AirRay ray, vec3 view, FirstSurface surface) {
  float radius_km = atmosphere.ground_radius_km;
  float top_km = atmosphere.top_km;
  float begins_km = 0.0;
  if (altitude_km > top_km) {
    float sine = min(sqrt(view.x * view.x + view.y * view.y), 1.0);
    begins_km = max(distance_to_shell_from_outside(radius_km, altitude_km, view.z, sine, top_km), 0.0);
  }
  Slope slope;
  slope.distance_km = max(surface.distance_km - begins_km, 1.0e-6);
  slope.altitude_km = clamp(altitude_along(radius_km, ray.altitude_km, ray.mu, slope.distance_km), 0.0, top_km);
  slope.normal = first_frame(ray, altitude_km, top_km, view, surface.normal).sun;  // it turns as the sun's direction does
  slope.albedo = surface.albedo;
  return slope;
}

Course course_to(Course course, float length_km) {
  course.length_km = length_km;
  course.lowest_km = clamp(-(course.radius_km + course.altitude_km) * course.mu, 0.0, length_km);
  return course;
}

// A unit vector at the end of a flight, in the frame there.
vec3 moved_along(Course course, Frame at, vec3 v, float t_km, float altitude_km) {
  Frame carried;
  carried.direction = at.direction;
  carried.sun = v;
  return moved(course, carried, t_km, altitude_km).sun;
}
// [/surface]

// [path]
// Radiance along one random path, for an eye at altitude_km that looks along `view`; both directions are unit vectors in
// the eye's local frame, z up. orders: scatterings and ground reflections at most; 0: all. Its mean over random paths is
// the radiance of the sky and the ground, without the sun's disc.
// `surface`, where there is one, ends the first flight; to all later ones it is not there: they meet the smooth planet.
PathLight trace_path(Atmosphere atmosphere, float altitude_km, vec3 view, vec3 sun, FirstSurface surface, int orders, Random random) {
  float radius_km = atmosphere.ground_radius_km;
  float top_km = atmosphere.top_km;
  const bool closed = TRACKING == kTrackExponential || TRACKING == kTrackClosedForm;
  PathLight light;
  light.radiance = vec3(0.0, 0.0, 0.0);
  light.finished = true;
  light.vertices = 0;
  AirRay ray = enter_air(atmosphere, altitude_km, view, sun);
  if (!ray.hits_air) {
    if (ENVIRONMENT) light.radiance = vec3(1.0, 1.0, 1.0);
    return light;
  }
  random = draw(random);
  int hero = min(int(random.value.x * 3.0), 2);
  vec3 channel = vec3(hero == 0 ? 1.0 : 0.0, hero == 1 ? 1.0 : 0.0, hero == 2 ? 1.0 : 0.0);
  vec3 f = HERO ? vec3(1.0, 1.0, 1.0) : channel;
  vec3 p = f;
  Frame at = first_frame(ray, altitude_km, top_km, view, sun);
  bool to_ground = ray.hits_ground;
  Course course = course_from(radius_km, top_km, ray.altitude_km, ray.mu, ray.sine, to_ground);
  Slope slope = level_ground(atmosphere);
  if (SURFACES && surface.distance_km > 0.0) {
    slope = first_slope(atmosphere, altitude_km, ray, view, surface);
    course = course_to(course, slope.distance_km);
    to_ground = true;
  }
  light.finished = false;
  float carried_first = 1.0;
  float spread = 0.0;
  vec3 lit = vec3(0.0, 0.0, 0.0);  // share of the sun that reaches the path's last vertex
  if (closed && SPREAD && !ENVIRONMENT) {
    if (sun_above_horizon(radius_km, ray.altitude_km, at.sun.z)) lit = exp(-extinction(atmosphere, sun_columns(atmosphere, ray.altitude_km, at.sun.z)));
    spread = kSpreadLit + kSpreadDark * (1.0 - min(min(lit.x, lit.y), lit.z));
  }
  for (int order = 1; order < 65000; order++) {
    Leg leg = fly(atmosphere, course, channel, closed && order == 1, to_ground || ENVIRONMENT ? 0.5 : 1.0, spread, random);
    random = leg.random;
    if (!leg.finished) break;
    float altitude = leg.collided ? leg.altitude_km : (to_ground ? slope.altitude_km : top_km);
    vec3 met = vec3(1.0, 1.0, 1.0);
    if (HERO || closed) {
      vec3 column = columns_along(atmosphere, course, leg.t_km, altitude);
      f *= exp(-extinction(atmosphere, column));
      if (closed) column.z = 0.0;  // these flights do not look at ozone: it is all weight
      vec3 passes = exp(-extinction(atmosphere, column));
      vec3 gain = leg.wanted / max(leg.meets, vec3(1.0e-30, 1.0e-30, 1.0e-30));
      if (leg.collided) met = passes * gain;
      else p *= vec3(end_density(passes.x, leg.meets.x, leg.wanted.x), end_density(passes.y, leg.meets.y, leg.wanted.y),
                     end_density(passes.z, leg.meets.z, leg.wanted.z)) * (1.0 - leg.spread);
    }
    if (!leg.collided && !to_ground) {
      if (ENVIRONMENT) light.radiance += f / mean_of(p);
      light.finished = true;
      break;
    }
    light.vertices = order;
    if (SURFACES && slope.distance_km > 0.0) slope.normal = moved_along(course, at, slope.normal, leg.t_km, altitude);
    at = moved(course, at, leg.t_km, altitude);
    random = draw(random);
    vec4 u = random.value;
    lit = vec3(0.0, 0.0, 0.0);
    if (leg.collided) {
      vec3 density = densities(atmosphere, altitude);
      vec3 by_rayleigh = atmosphere.rayleigh_scattering * density.x;
      vec3 by_mie = atmosphere.mie_extinction * density.y;
      vec3 by_ozone = closed ? vec3(0.0, 0.0, 0.0) : atmosphere.ozone_absorption * density.z;
      vec3 by_any = max(by_rayleigh + by_mie + by_ozone, vec3(1.0e-30, 1.0e-30, 1.0e-30));
      float spread_per_km = leg.spread / course.length_km;
      p *= met * by_any * (1.0 - leg.spread) + vec3(spread_per_km, spread_per_km, spread_per_km);
      if (!ENVIRONMENT && sun_above_horizon(radius_km, altitude, at.sun.z)) {
        Sunlight arriving = sunlight(atmosphere, altitude, at.sun.z, TRACKING, TRACKING == kTrackNaive ? 1 : 24, random);
        random = arriving.random;
        if (!arriving.finished) break;
        lit = arriving.transmittance;
        ScatteringTowardsEye towards = scattering_towards_eye(atmosphere, one_minus_cosine(at.direction, at.sun),
                                                              one_minus_cosine(at.direction, at.sun * -1.0));
        vec3 scattered = towards.rayleigh * density.x + towards.mie * density.y;
        light.radiance += f * scattered * arriving.transmittance / mean_of(p);
      }
      float rayleigh = dot(by_rayleigh, channel);
      float mie = dot(by_mie, channel);
      float absorbs = dot(by_ozone, channel);
      float which = u.x * (rayleigh + mie + absorbs);
      // Without an absorber nothing ends here, not even a number that rounding took to the end of its range.
      if (order == orders || (absorbs > 0.0 && which >= rayleigh + mie)) {
        light.finished = true;
        break;
      }
      Turn turn = rayleigh_turn(u.y, u.z);
      if (which >= rayleigh) {
        MieTurn drawn = kept_mie_turn(atmosphere, u.y, u.z, random);
        turn = drawn.turn;
        random = drawn.random;
      }
      at.direction = turned(at.direction, turn, u.w);
      ScatteringTowardsEye ahead = scattering_towards_eye(atmosphere, turn.one_minus_nu, turn.one_plus_nu);
      f *= ahead.rayleigh * density.x + ahead.mie * density.y;
      p /= by_any;
      p *= (HAS_RAYLEIGH ? by_rayleigh * rayleigh_phase(turn.one_minus_nu) : vec3(0.0, 0.0, 0.0)) +
           (HAS_MIE ? by_mie * mie_phase(atmosphere, turn.one_minus_nu, turn.one_plus_nu) : vec3(0.0, 0.0, 0.0));
    } else {
      f *= slope.albedo;
      float facing = SURFACES ? dot(at.sun, slope.normal) : at.sun.z;
      if (!ENVIRONMENT && facing > 0.0 && (!SURFACES || sun_above_horizon(radius_km, altitude, at.sun.z))) {
        Sunlight arriving = sunlight(atmosphere, altitude, at.sun.z, TRACKING, TRACKING == kTrackNaive ? 1 : 24, random);
        random = arriving.random;
        if (!arriving.finished) break;
        lit = arriving.transmittance;
        light.radiance += f * arriving.transmittance * (facing * 0.31830988618379067 / mean_of(p));
      }
      at.direction = cosine_hemisphere(u.y, u.z);
      if (SURFACES) at.direction = about(slope.normal, at.direction);
      if (order == orders) {
        light.finished = true;
        break;
      }
    }
    // Only the ratio of f and p matters: kept near one. Russian roulette ends paths that carry little.
    float scale = 1.0 / mean_of(p);
    f *= scale;
    p *= scale;
    // What a path carries is judged by what it carried after its first vertex: all of a thin ray's paths are thin.
    float carried = max(max(f.x, f.y), f.z);
    if (order == 1) carried_first = carried;
    random = draw(random);
    float survives = carried > 0.0 ? (order < 3 ? 1.0 : min(carried / carried_first, 1.0)) : 0.0;
    if (random.value.x >= survives) {
      light.finished = true;
      break;
    }
    f /= survives;
    float sine = min(sqrt(at.direction.x * at.direction.x + at.direction.y * at.direction.y), 1.0);
    to_ground = at.direction.z < 0.0 && tangent_altitude(radius_km, altitude, at.direction.z, sine) < 0.0;
    if (SURFACES) slope = level_ground(atmosphere);  // of the first flight only
    spread = closed && SPREAD && !ENVIRONMENT ? kSpreadLater * (1.0 - min(min(lit.x, lit.y), lit.z)) : 0.0;
    course = course_from(radius_km, top_km, altitude, at.direction.z, sine, to_ground);
  }
  light.radiance *= atmosphere.solar_irradiance;
  return light;
}
// [/path]

#endif
