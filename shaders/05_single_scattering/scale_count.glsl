// A coordinate that counts scale heights along a line, for the adapted rule. Pure functions; km.
#ifndef WELKIN_SCALE_COUNT_GLSL
#define WELKIN_SCALE_COUNT_GLSL

#include "05_single_scattering/march.glsl"

// [scale_count]
// A coordinate x that counts scale heights along a line: nodes evenly spaced in x suit every factor of the integrand.
//   q(h) counts scale heights above the line's lowest point: 1/H_high per km, and more near the ground, where H_low
//   matters: dq/dh = 1/H_high + (1/H_low - 1/H_high) (4 H_low)^2 / (h + 4 H_low)^2;
//   x = +-sqrt(q (1 + q)): proportional to s at a tangent point (where h is quadratic in s), to q far from it.
// On a ray that crosses almost none (half a metre down to the ground) the rounding of q would be too coarse; there x is
// simply the distance t.
struct ScaleCount {
  bool straight;   // x is the distance from the ray's first point
  float floor_km;  // lowest altitude: the tangent point's, or the ground
  float depth_km;  // of the tangent point below the ground, or 0
  float q_floor;   // q at floor_km; capped: a tangent point deeper than that changes nothing
  float per_km;    // 1/H_high
  float gain;
  float reach_km;
};

ScaleCount scale_count(Atmosphere atmosphere, Line line) {
  float scale_a =
      HAS_RAYLEIGH ? atmosphere.rayleigh_scale_height_km : (HAS_MIE ? atmosphere.mie_scale_height_km : 10.0);
  float scale_b = HAS_MIE ? atmosphere.mie_scale_height_km : scale_a;
  float high = max(scale_a, scale_b);
  float low = min(scale_a, scale_b);
  ScaleCount count;
  count.straight = false;
  count.floor_km = max(line.tangent_km, 0.0);
  count.depth_km = max(-line.tangent_km, 0.0);
  count.per_km = 1.0 / high;
  count.reach_km = count.floor_km + 4.0 * low;
  count.gain = 16.0 * low * (1.0 - low / high) / count.reach_km;
  count.q_floor = min((count.per_km + count.gain / count.reach_km) * count.depth_km, 30.0);
  return count;
}

float count_at(ScaleCount count, float above_floor_km) {
  float q = count.q_floor + (count.per_km + count.gain / (count.reach_km + above_floor_km)) * above_floor_km;
  return sqrt(q * (1.0 + q));
}
// [/scale_count]

// [counted_point]
struct CountedPoint {
  float altitude_km;
  float t_km;      // distance from the ray's first point
  float s_km;      // signed distance from the tangent point
  float dt_dx;     // km per count
};

CountedPoint point_at_count(ScaleCount count, AirRay ray, Line line, float x) {
  CountedPoint point;
  float s_start = (line.ground_radius_km + ray.altitude_km) * ray.mu;
  if (count.straight) {
    point.altitude_km = max(altitude_along(line.ground_radius_km, ray.altitude_km, ray.mu, x), 0.0);
    point.t_km = x;
    point.s_km = s_start + x;
    point.dt_dx = 1.0;
    return point;
  }
  float q = 2.0 * x * x / (1.0 + sqrt(1.0 + 4.0 * x * x));
  float p = max(q - count.q_floor, 0.0);
  float half_b = count.reach_km * count.per_km + count.gain - p;
  float root = sqrt(half_b * half_b + 4.0 * p * count.reach_km * count.per_km);
  float above = half_b > 0.0 ? 2.0 * p * count.reach_km / (half_b + root) : 0.5 * (root - half_b) / count.per_km;
  float reach = count.reach_km + above;
  float dq_dh = count.per_km + count.gain * count.reach_km / (reach * reach);
  float at_floor = count.per_km + count.gain / count.reach_km;
  point.altitude_km = count.floor_km + above;
  // s / x is finite at the tangent point, where both vanish.
  float km_per_q = (above + count.depth_km + 1.0e-9) / (q + at_floor * 1.0e-9);
  float s_per_x = sqrt(km_per_q * (2.0 * line.ground_radius_km + point.altitude_km + line.tangent_km) / (1.0 + q));
  point.s_km = x * s_per_x;
  point.t_km = point.s_km - s_start;
  point.dt_dx = 2.0 * (line.ground_radius_km + point.altitude_km) / ((1.0 + 2.0 * q) * dq_dh * s_per_x);
  return point;
}
// [/counted_point]

// Count at distance t from the ray's first point.
float count_along(ScaleCount count, Line line, AirRay ray, float t_km) {
  if (count.straight) return t_km;
  float s = (line.ground_radius_km + ray.altitude_km) * ray.mu + t_km;
  float above = count.depth_km > 0.0 ? altitude_along(line.ground_radius_km, ray.altitude_km, ray.mu, t_km)
                                     : s * s / (line.b_km + sqrt(line.b_km * line.b_km + s * s));
  float x = count_at(count, max(above, 0.0));
  return s < 0.0 ? -x : x;
}

#endif
