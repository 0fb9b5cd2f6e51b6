// One path of light, followed backward from the eye. Pure functions; km. Radiance in units of the sun's irradiance.
//
// The path carries, per channel, its throughput: what the medium did to the light along it (transmittance, scattering
// coefficients, phase functions, albedo), and its pdf: the density with which that channel would have drawn this very
// path. One channel, the hero, draws; all three are weighted by throughput / mean(pdf), which is unbiased for each (the
// balance heuristic; Wilkie et al. 2014). With one channel per path, both are 0 for the other channels: the same
// lines serve both ways.
//
// The including file gives HAS_* and MIE_PHASE; TRACKING; HERO (const bool); ENVIRONMENT (const bool): light of
// radiance 1 from outside in place of the sun; SPREAD (const bool): whether collisions are also put where no flight
// gets; SURFACES (const bool): whether a path may meet a surface before the smooth planet's.
#ifndef WELKIN_PATH_GLSL
#define WELKIN_PATH_GLSL

#include "07_ground_truth/free_flight.glsl"
#include "07_ground_truth/sampling.glsl"
#include "07_ground_truth/sunlight.glsl"

// Share of collisions placed uniformly on their segment: of the first flight where the sun reaches the eye, what is
// added where it does not, and of later flights from where it does not. Measured: without them the standard error is
// ten times as large at dusk; with more it grows in thick haze.
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
// The frame at the end of a flight of t km: only the vertical has turned, by an angle of sine t sin(zenith)/r'. No
// numbers as large as a radius are subtracted.
Frame moved(PathSegment segment, Frame at, float t_km, float altitude_km) {
  float r = segment.radius_km + segment.altitude_km;
  float r_to = segment.radius_km + altitude_km;
  float turn_sine = t_km * segment.sine / r_to;
  float turn_cosine = (r + t_km * segment.mu) / r_to;
  float across = max(segment.sine, 1.0e-20);
  float x = segment.sine > 0.0 ? at.direction.x / across : 1.0;
  float y = segment.sine > 0.0 ? at.direction.y / across : 0.0;
  float mu = (r * segment.mu + t_km) / r_to;
  float sine = r * segment.sine / r_to;
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

// The path's first frame: at the eye, or where the ray enters the air.
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

float mean_of(vec3 v) { return (v.x + v.y + v.z) * 0.33333333333333333; }

// [surface]
// What a segment that goes down ends on: level ground, or for the first flight a surface of any slope.
struct SurfaceHit {
  float distance_km;  // from where the ray is in the air
  float altitude_km;
  vec3 normal;        // in the frame of the point where the flight began
  vec3 albedo;
};

SurfaceHit level_ground(Atmosphere atmosphere) {
  SurfaceHit hit;
  hit.distance_km = 0.0;
  hit.altitude_km = 0.0;
  hit.normal = vec3(0.0, 0.0, 1.0);
  hit.albedo = atmosphere.ground_albedo;
  return hit;
}

SurfaceHit first_hit(Atmosphere atmosphere, float altitude_km, AirRay ray, vec3 view, FirstSurface surface) {
  float radius_km = atmosphere.ground_radius_km;
  float top_km = atmosphere.top_km;
  float begins_km = 0.0;
  if (altitude_km > top_km) {
    float sine = min(sqrt(view.x * view.x + view.y * view.y), 1.0);
    begins_km = max(distance_to_shell_from_outside(radius_km, altitude_km, view.z, sine, top_km), 0.0);
  }
  SurfaceHit hit;
  hit.distance_km = max(surface.distance_km - begins_km, 1.0e-6);
  hit.altitude_km = clamp(altitude_along(radius_km, ray.altitude_km, ray.mu, hit.distance_km), 0.0, top_km);
  hit.normal = first_frame(ray, altitude_km, top_km, view, surface.normal).sun;  // it turns as the sun's direction does
  hit.albedo = surface.albedo;
  return hit;
}

PathSegment shortened(PathSegment segment, float length_km) {
  segment.length_km = length_km;
  segment.lowest_km = clamp(-(segment.radius_km + segment.altitude_km) * segment.mu, 0.0, length_km);
  return segment;
}

// A unit vector at the end of a flight, in the frame there.
vec3 moved_along(PathSegment segment, Frame at, vec3 v, float t_km, float altitude_km) {
  Frame carried;
  carried.direction = at.direction;
  carried.sun = v;
  return moved(segment, carried, t_km, altitude_km).sun;
}
// [/surface]

// [path]
// A path at one of its vertices, and the segment that leaves it.
struct Path {
  PathLight light;
  bool ended;
  vec3 channel;            // the hero's 1
  vec3 throughput;
  vec3 pdf;
  float first_throughput;  // the largest channel's after the first vertex
  vec3 flight_pdf;         // of the collision flown to, over the extinction there
  vec3 to_sun;             // transmittance from the vertex to the sun; 0 where that is not seen
  float spread;
  Frame at;
  PathSegment segment;
  bool to_surface;         // where the segment ends: on `hit`, or at the top of the air
  SurfaceHit hit;
  Random random;
};

// Flights under exponential majorants leave ozone out: all of it goes into the throughput.
const bool CLOSED = TRACKING == kTrackExponential || TRACKING == kTrackClosedForm;

// The eye, as the path's first vertex. A ray that misses the air ends here.
Path path_from_eye(Atmosphere atmosphere, float altitude_km, vec3 view, vec3 sun, FirstSurface surface, Random random) {
  float radius_km = atmosphere.ground_radius_km;
  float top_km = atmosphere.top_km;
  Path path;
  path.light.radiance = vec3(0.0, 0.0, 0.0);
  path.light.finished = true;
  path.light.vertices = 0;
  AirRay ray = enter_air(atmosphere, altitude_km, view, sun);
  path.ended = !ray.hits_air;
  if (path.ended) {
    if (ENVIRONMENT) path.light.radiance = vec3(1.0, 1.0, 1.0);
    return path;
  }
  path.light.finished = false;
  // The hero.
  path.random = draw(random);
  int hero = min(int(path.random.value.x * 3.0), 2);
  path.channel = vec3(hero == 0 ? 1.0 : 0.0, hero == 1 ? 1.0 : 0.0, hero == 2 ? 1.0 : 0.0);
  path.throughput = HERO ? vec3(1.0, 1.0, 1.0) : path.channel;
  path.pdf = path.throughput;
  path.first_throughput = 1.0;
  // The segment: to the ground, to a surface before it, or through the air.
  path.at = first_frame(ray, altitude_km, top_km, view, sun);
  path.to_surface = ray.hits_ground;
  path.segment = segment_from(radius_km, top_km, ray.altitude_km, ray.mu, ray.sine, ray.hits_ground);
  path.hit = level_ground(atmosphere);
  if (SURFACES && surface.distance_km > 0.0) {
    path.hit = first_hit(atmosphere, altitude_km, ray, view, surface);
    path.segment = shortened(path.segment, path.hit.distance_km);
    path.to_surface = true;
  }
  // The less sunlight reaches the eye, the more collisions are placed uniformly.
  path.to_sun = vec3(0.0, 0.0, 0.0);
  path.spread = 0.0;
  if (CLOSED && SPREAD && !ENVIRONMENT) {
    if (sun_above_horizon(radius_km, ray.altitude_km, path.at.sun.z))
      path.to_sun = exp(-extinction(atmosphere, sun_columns(atmosphere, ray.altitude_km, path.at.sun.z)));
    path.spread = kSpreadLit + kSpreadDark * (1.0 - min(min(path.to_sun.x, path.to_sun.y), path.to_sun.z));
  }
  return path;
}

// The transmittance from the sun to the vertex; where the way is tracked, a random number with that mean.
Path with_sunlight(Atmosphere atmosphere, Path path, float altitude_km) {
  Sunlight arriving =
      sunlight(atmosphere, altitude_km, path.at.sun.z, TRACKING, TRACKING == kTrackNaive ? 1 : 24, path.random);
  path.random = arriving.random;
  path.ended = !arriving.finished;
  if (arriving.finished) path.to_sun = arriving.transmittance;
  return path;
}

// Weighs the flight to a collision or to the segment's end by its transmittance and its pdf. The pdf of a collision
// also needs the extinction there, which at_collision() multiplies in.
Path flown(Atmosphere atmosphere, Path path, FreeFlight flight, float altitude_km) {
  path.flight_pdf = vec3(1.0, 1.0, 1.0);
  if (!HERO && !CLOSED) return path;
  vec3 column = columns_along(atmosphere, path.segment, flight.t_km, altitude_km);
  path.throughput *= exp(-extinction(atmosphere, column));
  if (CLOSED) column.z = 0.0;
  vec3 passes = exp(-extinction(atmosphere, column));
  vec3 gain = flight.meets_forced / max(flight.meets, vec3(1.0e-30, 1.0e-30, 1.0e-30));
  if (flight.collided) path.flight_pdf = passes * gain;
  else path.pdf *= vec3(end_pdf(passes.x, flight.meets.x, flight.meets_forced.x),
                        end_pdf(passes.y, flight.meets.y, flight.meets_forced.y),
                        end_pdf(passes.z, flight.meets.z, flight.meets_forced.z)) * (1.0 - flight.spread);
  return path;
}
// [/path]

// [collision]
// Extinction per km at a collision, by what collides there.
struct Extinctions {
  vec3 rayleigh;
  vec3 mie;
  vec3 ozone;
  vec3 all;
};

Extinctions extinctions_at(Atmosphere atmosphere, vec3 density) {
  Extinctions by;
  by.rayleigh = atmosphere.rayleigh_scattering * density.x;
  by.mie = atmosphere.mie_extinction * density.y;
  by.ozone = CLOSED ? vec3(0.0, 0.0, 0.0) : atmosphere.ozone_absorption * density.z;
  by.all = max(by.rayleigh + by.mie + by.ozone, vec3(1.0e-30, 1.0e-30, 1.0e-30));
  return by;
}

// The next direction, drawn from the phase function of what was hit: molecules or aerosol.
Path scattered(Atmosphere atmosphere, Path path, vec3 density, Extinctions by, bool by_molecules, vec4 u) {
  Turn turn = rayleigh_turn(u.y, u.z);
  if (!by_molecules) {
    MieTurn drawn = kept_mie_turn(atmosphere, u.y, u.z, path.random);
    turn = drawn.turn;
    path.random = drawn.random;
  }
  path.at.direction = turned(path.at.direction, turn, u.w);
  ScatteringTowardsEye ahead = scattering_towards_eye(atmosphere, turn.one_minus_nu, turn.one_plus_nu);
  path.throughput *= ahead.rayleigh * density.x + ahead.mie * density.y;
  // pdf: the probability of what was hit times that of the turn.
  path.pdf /= by.all;
  path.pdf *= (HAS_RAYLEIGH ? by.rayleigh * rayleigh_phase(turn.one_minus_nu) : vec3(0.0, 0.0, 0.0)) +
              (HAS_MIE ? by.mie * mie_phase(atmosphere, turn.one_minus_nu, turn.one_plus_nu) : vec3(0.0, 0.0, 0.0));
  return path;
}

// A collision: sunlight scattered there into the path, then an absorption or a turn. u: random numbers.
Path at_collision(Atmosphere atmosphere, Path path, FreeFlight flight, bool last, vec4 u) {
  vec3 density = densities(atmosphere, flight.altitude_km);
  Extinctions by = extinctions_at(atmosphere, density);
  float spread_per_km = flight.spread / path.segment.length_km;
  path.pdf *= path.flight_pdf * by.all * (1.0 - flight.spread) + vec3(spread_per_km, spread_per_km, spread_per_km);
  if (!ENVIRONMENT && sun_above_horizon(atmosphere.ground_radius_km, flight.altitude_km, path.at.sun.z)) {
    path = with_sunlight(atmosphere, path, flight.altitude_km);
    if (path.ended) return path;
    ScatteringTowardsEye towards = scattering_towards_eye(atmosphere, one_minus_cosine(path.at.direction, path.at.sun),
                                                          one_minus_cosine(path.at.direction, path.at.sun * -1.0));
    vec3 in_scattering = towards.rayleigh * density.x + towards.mie * density.y;
    path.light.radiance += path.throughput * in_scattering * path.to_sun / mean_of(path.pdf);
  }
  float rayleigh = dot(by.rayleigh, path.channel);
  float mie = dot(by.mie, path.channel);
  float absorbs = dot(by.ozone, path.channel);
  float which = u.x * (rayleigh + mie + absorbs);
  // Without an absorber no path ends here, even where rounding puts `which` at the end of its range.
  path.light.finished = last || (absorbs > 0.0 && which >= rayleigh + mie);
  path.ended = path.light.finished;
  if (path.ended) return path;
  return scattered(atmosphere, path, density, by, which < rayleigh, u);
}
// [/collision]

// [reflection]
// A surface: sunlight reflected there into the path, then a direction about its normal. u: random numbers.
Path at_surface(Atmosphere atmosphere, Path path, float altitude_km, bool last, vec4 u) {
  path.throughput *= path.hit.albedo;
  float facing = SURFACES ? dot(path.at.sun, path.hit.normal) : path.at.sun.z;
  if (!ENVIRONMENT && facing > 0.0 &&
      (!SURFACES || sun_above_horizon(atmosphere.ground_radius_km, altitude_km, path.at.sun.z))) {
    path = with_sunlight(atmosphere, path, altitude_km);
    if (path.ended) return path;
    path.light.radiance += path.throughput * path.to_sun * (facing * 0.31830988618379067 / mean_of(path.pdf));
  }
  // Cosine / pi is both what the surface reflects and the direction's pdf: throughput and pdf stay.
  path.at.direction = cosine_hemisphere(u.y, u.z);
  if (SURFACES) path.at.direction = about(path.hit.normal, path.at.direction);
  path.light.finished = last;
  path.ended = last;
  return path;
}
// [/reflection]

// [trace_path]
// Russian roulette ends paths that carry little, compared with what they carried after their first vertex: in thin air
// all paths carry little.
Path after_roulette(Path path, int order) {
  // Only the ratio of throughput and pdf matters: both are kept near one.
  float scale = 1.0 / mean_of(path.pdf);
  path.throughput *= scale;
  path.pdf *= scale;
  float carried = max(max(path.throughput.x, path.throughput.y), path.throughput.z);
  if (order == 1) path.first_throughput = carried;
  path.random = draw(path.random);
  float survives = carried > 0.0 ? (order < 3 ? 1.0 : min(carried / path.first_throughput, 1.0)) : 0.0;
  path.light.finished = path.random.value.x >= survives;
  path.ended = path.light.finished;
  if (!path.ended) path.throughput /= survives;
  return path;
}

// The segment that leaves the vertex in its new direction.
Path with_next_segment(Atmosphere atmosphere, Path path, float altitude_km) {
  vec3 direction = path.at.direction;
  float sine = min(sqrt(direction.x * direction.x + direction.y * direction.y), 1.0);
  path.to_surface =
      direction.z < 0.0 && tangent_altitude(atmosphere.ground_radius_km, altitude_km, direction.z, sine) < 0.0;
  if (SURFACES) path.hit = level_ground(atmosphere);  // a surface of another slope was the first flight's only
  path.spread = CLOSED && SPREAD && !ENVIRONMENT
                    ? kSpreadLater * (1.0 - min(min(path.to_sun.x, path.to_sun.y), path.to_sun.z)) : 0.0;
  path.segment = segment_from(atmosphere.ground_radius_km, atmosphere.top_km, altitude_km, direction.z, sine,
                              path.to_surface);
  return path;
}

// Radiance along one random path, for an eye at altitude_km that looks along `view`; both directions are unit vectors
// in the eye's local frame, z up. orders: scatterings and ground reflections at most; 0: all. Its mean over random
// paths is the radiance of the sky and the ground, without the sun's disc. `surface`, where there is one, ends the
// first flight; later flights ignore it and meet the smooth planet.
PathLight trace_path(Atmosphere atmosphere, float altitude_km, vec3 view, vec3 sun, FirstSurface surface, int orders,
                     Random random) {
  Path path = path_from_eye(atmosphere, altitude_km, view, sun, surface, random);
  if (path.ended) return path.light;
  for (int order = 1; order < 65000; order++) {
    // Fly: to a collision, to the surface or out of the air.
    FreeFlight flight = sample_free_flight(atmosphere, path.segment, path.channel, CLOSED && order == 1,
                                           path.to_surface || ENVIRONMENT ? 0.5 : 1.0, path.spread, path.random);
    path.random = flight.random;
    if (!flight.finished) break;
    float altitude =
        flight.collided ? flight.altitude_km : (path.to_surface ? path.hit.altitude_km : atmosphere.top_km);
    path = flown(atmosphere, path, flight, altitude);
    // Out of the air. The sun's disc is not counted; the only other light out there is a test's uniform one.
    if (!flight.collided && !path.to_surface) {
      if (ENVIRONMENT) path.light.radiance += path.throughput / mean_of(path.pdf);
      path.light.finished = true;
      break;
    }
    // From here on directions are in the frame of the vertex.
    path.light.vertices = order;
    if (SURFACES && path.hit.distance_km > 0.0)
      path.hit.normal = moved_along(path.segment, path.at, path.hit.normal, flight.t_km, altitude);
    path.at = moved(path.segment, path.at, flight.t_km, altitude);
    // Light that is scattered or reflected there into the path, and the path's next direction.
    path.random = draw(path.random);
    vec4 u = path.random.value;
    path.to_sun = vec3(0.0, 0.0, 0.0);
    if (flight.collided) path = at_collision(atmosphere, path, flight, order == orders, u);
    else path = at_surface(atmosphere, path, altitude, order == orders, u);
    if (path.ended) break;
    path = after_roulette(path, order);
    if (path.ended) break;
    path = with_next_segment(atmosphere, path, altitude);
  }
  path.light.radiance *= atmosphere.solar_irradiance;
  return path.light;
}
// [/trace_path]

#endif
