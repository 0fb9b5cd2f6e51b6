// How far light gets before it meets something. Pure functions; lengths in km.
//
// Woodcock's trick (delta tracking): replace the density rho(t) along a ray by a larger one, the majorant, simple
// enough to invert; draw collisions with that; keep one with probability rho / majorant, else fly on. Collisions kept
// are distributed as exp(-tau) sigma_t exactly, whatever the majorant. What it costs is the number of collisions not
// kept.
//
// Here a constituent's density exp(-h/H) gets a majorant of the same kind. Along a straight line the altitude is
// convex, so a tangent to it lies below it: h(t) >= h_m + mu_m (t - t_m), and exp(-(h_m + mu_m (t - t_m))/H) >= rho(t):
// an exponential in t, whose integral and its inverse are closed forms. Straight up it touches the density all the way.
#ifndef WELKIN_FLIGHT_GLSL
#define WELKIN_FLIGHT_GLSL

#include "05_single_scattering/march.glsl"
#include "07_ground_truth/random.glsl"

// The knob `tracking`, in this order.
const int kTrackNaive = 0;        // one constant majorant; ratio tracking to the sun
const int kTrackShells = 1;       // constant majorants in shells; ratio tracking to the sun
const int kTrackExponential = 2;  // exponential majorants; ratio tracking to the sun
const int kTrackClosedForm = 3;   // exponential majorants; closed form to the sun

// [functions]
// -log(1 - y) and (1 - exp(-y)) / y, with series where 1 - y or the difference has lost the digits.
float minus_log_one_minus(float y) {
  float series = y * (1.0 + y * (0.5 + y * (0.33333333333333333 + y * (0.25 + y * 0.2))));
  return abs(y) < 0.03 ? series : -log(max(1.0 - y, 1.0e-30));
}
float mean_exponential(float y) {
  float series = 1.0 - y * (0.5 - y * (0.16666666666666667 - y * (0.041666666666666667 - y * 0.0083333333333333333)));
  return abs(y) < 0.05 ? series : (1.0 - exp(-y)) / y;
}
// [/functions]

// A straight piece of a path, in the frame of its first point.
struct PathSegment {
  float radius_km;    // of the ground
  float altitude_km;  // of the first point
  float mu;
  float sine;
  float length_km;
  float lowest_km;    // distance to the lowest point
};

struct Majorant {
  float end_km;       // valid up to here
  float density;      // at the start of the piece
  float falls_per_km; // it is density * exp(-falls_per_km * x)
};

// [majorant]
// The piece of majorant that begins at distance t. Pieces end one reach and three reaches on either side of the lowest
// point, a reach being the distance over which altitude bends away from a tangent by one scale height: sqrt(2 r H) /
// sine.
Majorant majorant_from(PathSegment segment, float scale_height_km, float t_km) {
  float r = segment.radius_km + segment.altitude_km;
  float reach = sqrt(2.0 * r * scale_height_km) / max(segment.sine, 1.0e-3);
  bool falling = t_km < segment.lowest_km;  // towards the ground
  float low = segment.lowest_km;
  float end = falling ? low : segment.length_km;
  if (falling && t_km < low - reach) end = low - reach;
  if (falling && t_km < low - 3.0 * reach) end = low - 3.0 * reach;
  if (!falling && low + 3.0 * reach > t_km) end = min(low + 3.0 * reach, end);
  if (!falling && low + reach > t_km) end = min(low + reach, end);
  float from_low_end = 0.45 * min(end - t_km, reach);
  float touch = falling ? end - from_low_end : t_km + from_low_end;
  float altitude = max(altitude_along(segment.radius_km, segment.altitude_km, segment.mu, touch), 0.0);
  float slope = (r * segment.mu + touch) / (segment.radius_km + altitude);
  Majorant piece;
  piece.end_km = end;
  piece.falls_per_km = slope / scale_height_km;
  piece.density = exp(-(altitude + slope * (t_km - touch)) / scale_height_km);
  return piece;
}
// [/majorant]

// Column of the whole majorant. At most six pieces.
float majorant_column(PathSegment segment, float scale_height_km) {
  float column = 0.0;
  float t = 0.0;
  for (int i = 0; i < 8 && t < segment.length_km; i++) {
    Majorant piece = majorant_from(segment, scale_height_km, t);
    float x = piece.end_km - t;
    column += piece.density * x * mean_exponential(piece.falls_per_km * x);
    t = piece.end_km;
  }
  return column;
}

struct Flight {
  bool collided;
  bool finished;   // false: the driver ended a loop
  float t_km;
  float altitude_km;
  Random random;
};

// [exponential_flight]
// First collision with one constituent before `limit_km`. first_column: the majorant column to the first tentative
// collision, in km, drawn by the caller; per_km: the coefficient at density 1, which scales those that follow.
Flight exponential_flight(PathSegment segment, float scale_height_km, float per_km, float first_column, float limit_km,
                          Random random) {
  Flight flight;
  flight.collided = false;
  flight.finished = false;
  flight.t_km = 0.0;
  flight.altitude_km = segment.altitude_km;
  float column = first_column;
  for (int i = 0; i < 4096; i++) {
    if (flight.t_km >= limit_km) { flight.finished = true; break; }
    Majorant piece = majorant_from(segment, scale_height_km, flight.t_km);
    float x = piece.end_km - flight.t_km;
    float available = piece.density * x * mean_exponential(piece.falls_per_km * x);
    if (available <= column) {
      column -= available;
      flight.t_km = piece.end_km;
      continue;
    }
    // density (1 - exp(-f x)) / f = column, solved for x.
    float scaled = column / piece.density;
    float y = piece.falls_per_km * scaled;
    x = min(abs(y) < 1.0e-6 ? scaled : minus_log_one_minus(y) / piece.falls_per_km, x);
    flight.t_km += x;
    if (flight.t_km >= limit_km) { flight.finished = true; break; }
    flight.altitude_km = max(altitude_along(segment.radius_km, segment.altitude_km, segment.mu, flight.t_km), 0.0);
    float majorant = piece.density * exp(-piece.falls_per_km * x);
    random = draw(random);
    if (random.value.x * majorant < exp(-flight.altitude_km / scale_height_km)) {
      flight.collided = true;
      flight.finished = true;
      break;
    }
    column = minus_log_one_minus(random.value.y) / per_km;
  }
  flight.random = random;
  return flight;
}
// [/exponential_flight]

// [shells]
// The majorant everybody writes first is a constant: the densest air there is, at the ground. Better: shells, each with
// the density of its lower edge. Shell j of n lies between top (j/n)^2 and top ((j+1)/n)^2.
float shell_bottom(float top_km, int shell, int shells) {
  float share = float(shell) / float(shells);
  return top_km * share * share;
}

int shell_at(float top_km, float altitude_km, int shells) {
  return clamp(int(sqrt(max(altitude_km, 0.0) / top_km) * float(shells)), 0, shells - 1);
}

// The densest of each constituent between two altitudes.
vec3 densest(Atmosphere atmosphere, float low_km, float high_km) {
  vec3 density = densities(atmosphere, low_km);
  if (HAS_OZONE) density.z = ozone_density(atmosphere, clamp(atmosphere.ozone_peak_km, low_km, high_km));
  return density;
}

// Where the segment leaves its shell: the distance, and the shell that it enters.
struct ShellEnd {
  float t_km;
  int shell;
};
ShellEnd shell_end(PathSegment segment, float top_km, float t_km, int shell, int shells) {
  ShellEnd end;
  if (t_km < segment.lowest_km && shell > 0) {
    float t = distance_to_shell_from_outside(segment.radius_km, segment.altitude_km, segment.mu, segment.sine,
                                             shell_bottom(top_km, shell, shells));
    if (t >= t_km) {
      end.t_km = min(t, segment.length_km);
      end.shell = shell - 1;
      return end;
    }
  }
  end.t_km = segment.length_km;
  end.shell = shell + 1;
  if (shell + 1 < shells && !(segment.lowest_km >= segment.length_km)) {
    float high = shell_bottom(top_km, shell + 1, shells);
    end.t_km = clamp(distance_to_shell_from_inside(segment.radius_km, segment.altitude_km, segment.mu, high), t_km,
                     segment.length_km);
  }
  return end;
}
// [/shells]

// [shell_flight]
// First collision with anything, ozone included, in one channel (a vector with one 1), under constant majorants.
Flight shell_flight(Atmosphere atmosphere, PathSegment segment, vec3 channel, int shells, Random random) {
  float top_km = atmosphere.top_km;
  Flight flight;
  flight.collided = false;
  flight.finished = false;
  flight.t_km = 0.0;
  flight.altitude_km = segment.altitude_km;
  int shell = shell_at(top_km, segment.altitude_km, shells);
  random = draw(random);
  float depth = minus_log_one_minus(random.value.y);
  for (int i = 0; i < 60000; i++) {
    if (flight.t_km >= segment.length_km) { flight.finished = true; break; }
    ShellEnd end = shell_end(segment, top_km, flight.t_km, shell, shells);
    float low = shell_bottom(top_km, shell, shells);
    float majorant =
        dot(extinction(atmosphere, densest(atmosphere, low, shell_bottom(top_km, shell + 1, shells))), channel);
    float available = majorant * (end.t_km - flight.t_km);
    if (available <= depth) {
      depth -= available;
      flight.t_km = end.t_km;
      shell = end.shell;
      if (shell < 0 || shell >= shells) flight.t_km = segment.length_km;
      continue;
    }
    flight.t_km += depth / majorant;
    flight.altitude_km = max(altitude_along(segment.radius_km, segment.altitude_km, segment.mu, flight.t_km), 0.0);
    random = draw(random);
    if (random.value.x * majorant < dot(extinction(atmosphere, densities(atmosphere, flight.altitude_km)), channel)) {
      flight.collided = true;
      flight.finished = true;
      break;
    }
    depth = minus_log_one_minus(random.value.y);
  }
  flight.random = random;
  return flight;
}
// [/shell_flight]

#endif
