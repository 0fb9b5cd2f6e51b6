// The share of the sun's light that arrives at a point, in three ways of the same mean. Pure functions; km.
#ifndef WELKIN_SUNLIGHT_GLSL
#define WELKIN_SUNLIGHT_GLSL

#include "07_ground_truth/flight.glsl"

struct Sunlight {
  vec3 transmittance;
  bool finished;
  Random random;
};

// The straight segment from a point to where it leaves the air or meets the ground.
PathSegment segment_from(float radius_km, float top_km, float altitude_km, float mu, float sine, bool hits_ground) {
  PathSegment segment;
  segment.radius_km = radius_km;
  segment.altitude_km = altitude_km;
  segment.mu = mu;
  segment.sine = sine;
  segment.length_km = max(hits_ground ? distance_to_shell_from_outside(radius_km, altitude_km, mu, sine, 0.0)
                                     : distance_to_shell_from_inside(radius_km, altitude_km, mu, top_km), 0.0);
  segment.lowest_km = clamp(-(radius_km + altitude_km) * mu, 0.0, segment.length_km);
  return segment;
}

// [ratio_tracking]
// Ratio tracking (Novak, Selle, Jarosz 2014): fly through the majorant's collisions and multiply by the share of each
// that is not real. Its mean is the transmittance, exactly; no integral is evaluated. The majorant covers all three
// channels.
Sunlight ratio_tracked(Atmosphere atmosphere, PathSegment segment, int shells, Random random) {
  float top_km = atmosphere.top_km;
  Sunlight light;
  light.transmittance = vec3(1.0, 1.0, 1.0);
  light.finished = false;
  float t = 0.0;
  int shell = shell_at(top_km, segment.altitude_km, shells);
  random = draw(random);
  float depth = minus_log_one_minus(random.value.y);
  for (int i = 0; i < 60000; i++) {
    if (t >= segment.length_km) { light.finished = true; break; }
    ShellEnd end = shell_end(segment, top_km, t, shell, shells);
    float low = shell_bottom(top_km, shell, shells);
    vec3 dense = extinction(atmosphere, densest(atmosphere, low, shell_bottom(top_km, shell + 1, shells)));
    float majorant = max(max(dense.x, dense.y), dense.z);
    float available = majorant * (end.t_km - t);
    if (available <= depth) {
      depth -= available;
      t = end.t_km;
      shell = end.shell;
      if (shell < 0 || shell >= shells) t = segment.length_km;
      continue;
    }
    t += depth / majorant;
    float altitude = max(altitude_along(segment.radius_km, segment.altitude_km, segment.mu, t), 0.0);
    vec3 real = extinction(atmosphere, densities(atmosphere, altitude)) / majorant;
    light.transmittance *= max(vec3(1.0, 1.0, 1.0) - real, vec3(0.0, 0.0, 0.0));
    random = draw(random);
    depth = minus_log_one_minus(random.value.y);
  }
  light.random = random;
  return light;
}

// The same under the exponential majorants of one constituent, whose coefficients are `per_km`.
Sunlight exponential_ratio_tracked(PathSegment segment, float scale_height_km, vec3 per_km, Random random) {
  Sunlight light;
  light.transmittance = vec3(1.0, 1.0, 1.0);
  light.finished = false;
  float most = max(max(per_km.x, per_km.y), max(per_km.z, 1.0e-20));
  float t = 0.0;
  random = draw(random);
  float column = minus_log_one_minus(random.value.y) / most;
  for (int i = 0; i < 20000; i++) {
    if (t >= segment.length_km) { light.finished = true; break; }
    Majorant piece = majorant_from(segment, scale_height_km, t);
    float x = piece.end_km - t;
    float available = piece.density * x * mean_exponential(piece.falls_per_km * x);
    if (available <= column) {
      column -= available;
      t = piece.end_km;
      continue;
    }
    float scaled = column / piece.density;
    float y = piece.falls_per_km * scaled;
    x = min(abs(y) < 1.0e-6 ? scaled : minus_log_one_minus(y) / piece.falls_per_km, x);
    t += x;
    float altitude = max(altitude_along(segment.radius_km, segment.altitude_km, segment.mu, t), 0.0);
    float share = min(exp(-altitude / scale_height_km) / (piece.density * exp(-piece.falls_per_km * x)), 1.0);
    light.transmittance *= vec3(1.0, 1.0, 1.0) - per_km * (share / most);
    random = draw(random);
    column = minus_log_one_minus(random.value.y) / most;
  }
  light.random = random;
  return light;
}
// [/ratio_tracking]

// [columns]
// Columns (rayleigh, mie, ozone) in km over the first t_km of a segment, as differences of chapter 05's closed form.
// Their error is absolute, 1e-5 of a scale height's column: small enough for an exponent, too large for a quotient.
vec3 columns_along(Atmosphere atmosphere, PathSegment segment, float t_km, float altitude_km) {
  Line line = line_through(segment.radius_km, segment.altitude_km, segment.mu, segment.sine);
  float s_0 = (segment.radius_km + segment.altitude_km) * segment.mu;
  float s_1 = s_0 + t_km;
  bool dips = s_0 < 0.0 && s_1 > 0.0;
  vec3 column = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH) {
    float a = column_outward(line, segment.altitude_km, abs(s_0), atmosphere.rayleigh_scale_height_km);
    float b = column_outward(line, altitude_km, abs(s_1), atmosphere.rayleigh_scale_height_km);
    column.x = dips ? 2.0 * column_outward(line, line.tangent_km, 0.0, atmosphere.rayleigh_scale_height_km) - a - b
                    : abs(a - b);
  }
  if (HAS_MIE) {
    float a = column_outward(line, segment.altitude_km, abs(s_0), atmosphere.mie_scale_height_km);
    float b = column_outward(line, altitude_km, abs(s_1), atmosphere.mie_scale_height_km);
    column.y = dips ? 2.0 * column_outward(line, line.tangent_km, 0.0, atmosphere.mie_scale_height_km) - a - b
                    : abs(a - b);
  }
  if (HAS_OZONE) {
    float a = ozone_column_from_tangent(atmosphere, line, segment.altitude_km);
    float b = ozone_column_from_tangent(atmosphere, line, altitude_km);
    column.z = dips ? a + b : abs(a - b);
  }
  return max(column, vec3(0.0, 0.0, 0.0));
}

// Columns of a whole ray.
vec3 ray_columns(Atmosphere atmosphere, AirRay ray) {
  PathSegment segment = segment_from(atmosphere.ground_radius_km, atmosphere.top_km, ray.altitude_km, ray.mu, ray.sine,
                                     ray.hits_ground);
  return columns_along(atmosphere, segment, segment.length_km, ray.hits_ground ? 0.0 : atmosphere.top_km);
}
// [/columns]

// [sunlight]
// Share of the sun's light that arrives at a point that sees the sun, or a random number with that mean.
Sunlight sunlight(Atmosphere atmosphere, float altitude_km, float mu_sun, int tracking, int shells, Random random) {
  Sunlight light;
  light.finished = true;
  light.random = random;
  if (tracking == kTrackClosedForm) {
    light.transmittance = exp(-extinction(atmosphere, sun_columns(atmosphere, altitude_km, mu_sun)));
    return light;
  }
  float sine = sqrt(max((1.0 - mu_sun) * (1.0 + mu_sun), 0.0));
  PathSegment segment = segment_from(atmosphere.ground_radius_km, atmosphere.top_km, altitude_km, mu_sun, sine, false);
  if (tracking != kTrackExponential) return ratio_tracked(atmosphere, segment, shells, random);
  light.transmittance = vec3(1.0, 1.0, 1.0);
  if (HAS_RAYLEIGH)
    light = exponential_ratio_tracked(segment, atmosphere.rayleigh_scale_height_km, atmosphere.rayleigh_scattering,
                                      light.random);
  if (HAS_MIE) {
    Sunlight mie =
        exponential_ratio_tracked(segment, atmosphere.mie_scale_height_km, atmosphere.mie_extinction, light.random);
    light.transmittance *= mie.transmittance;
    light.finished = light.finished && mie.finished;
    light.random = mie.random;
  }
  if (HAS_OZONE) {
    Line line = line_through(segment.radius_km, altitude_km, segment.mu, segment.sine);
    float ozone = ozone_column_between(atmosphere, line, altitude_km, max(atmosphere.top_km, altitude_km));
    if (mu_sun < 0.0) ozone += 2.0 * ozone_column_from_tangent(atmosphere, line, altitude_km);
    light.transmittance *= exp(-atmosphere.ozone_absorption * ozone);
  }
  return light;
}
// [/sunlight]

#endif
