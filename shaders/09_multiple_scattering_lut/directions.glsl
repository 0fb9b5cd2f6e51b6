// Sets of directions over which the radiance arriving at a point is averaged. Pure functions, also valid C++.
// A direction is a view direction, a unit vector from the point: z up, x horizontal towards the sun. Weights sum to 1.
#ifndef WELKIN_DIRECTIONS_GLSL
#define WELKIN_DIRECTIONS_GLSL

#include "05_single_scattering/light_path.glsl"

const int kSetFibonacci = 0;  // equal weights, nearly equal distances
const int kSetHorizon = 1;    // Gauss nodes above and below the horizon, densest next to it

struct WeightedDirection {
  vec3 view;
  float weight;
};

// [fibonacci]
// Point n of N on the Fibonacci sphere: cos(theta) = 1 - (2n + 1)/N, phi = 2 pi n / golden ratio.
WeightedDirection fibonacci_direction(int n, int count) {
  float turns = float(n) * 0.61803398874989485;
  float phi = 6.28318530717958648 * (turns - floor(turns));
  float z = 1.0 - float(2 * n + 1) / float(count);
  float s = sqrt(max((1.0 - z) * (1.0 + z), 0.0));
  WeightedDirection direction;
  direction.view = vec3(s * cos(phi), s * sin(phi), z);
  direction.weight = 1.0 / float(count);
  return direction;
}
// [/fibonacci]

// Zenith cosine of the horizon, -sqrt(h (2R + h)) / (R + h).
float horizon_cosine(float ground_radius_km, float altitude_km) {
  return -sqrt(altitude_km * (2.0 * ground_radius_km + altitude_km)) / (ground_radius_km + altitude_km);
}

// [horizon_set]
// Light changes fastest across the horizon. Above it mu = mu_h + (1 - mu_h) x^2, below it mu = mu_h - (1 + mu_h) x^2,
// with x at Gauss nodes. Azimuths are midpoints of the half circle only, because the sky is symmetric about the sun's
// azimuth: 64 directions do the work of 128. `count` is a multiple of 16; from 128 on there are two panels of four
// nodes per side.
int horizon_rings(int count) { return count >= 128 ? 16 : 8; }

WeightedDirection horizon_direction(int n, int count, float mu_horizon) {
  int rings = horizon_rings(count);
  int panels = rings / 8;
  int azimuths = count / rings;
  int ring = n % rings;
  bool up = ring < rings / 2;
  int node = up ? ring : ring - rings / 2;
  float x = (float(node / 4) + kGauss4Node[node % 4]) / float(panels);
  float range = up ? 1.0 - mu_horizon : 1.0 + mu_horizon;
  float z = clamp(up ? mu_horizon + range * x * x : mu_horizon - range * x * x, -1.0, 1.0);
  float s = sqrt((1.0 - z) * (1.0 + z));
  float phi = 3.14159265358979324 * (float(n / rings) + 0.5) / float(azimuths);
  WeightedDirection direction;
  direction.view = vec3(s * cos(phi), s * sin(phi), z);
  direction.weight = kGauss4Weight[node % 4] * x * range / float(panels * azimuths);
  return direction;
}
// [/horizon_set]

WeightedDirection direction_of_set(int set, int n, int count, float mu_horizon) {
  if (set == kSetFibonacci) return fibonacci_direction(n, count);
  return horizon_direction(n, count, mu_horizon);
}

// Number of different zenith angles in a set, and the index of direction n's.
int zenith_angles_of_set(int set, int count) { return set == kSetFibonacci ? count : horizon_rings(count); }
int zenith_angle_index(int set, int n, int count) { return n % zenith_angles_of_set(set, count); }

#endif
