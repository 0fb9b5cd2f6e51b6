// Marches the higher orders: integrates the table's in-scattering along the whole ray, sunlit or in the planet's
// shadow. Pure functions; km.
//   L = integral of T(eye, t) S(h, mu_sun, direction) dt,     S: in-scattered radiance per km
#ifndef WELKIN_SOURCE_MARCH_GLSL
#define WELKIN_SOURCE_MARCH_GLSL

#include "05_single_scattering/adapted_march.glsl"
#include "09_multiple_scattering_lut/table.glsl"

// A ray with its count of scale heights (ScaleCount of chapter 05), the variable of the march, from x_begin to x_end.
struct SourceRay {
  AirRay ray;
  Line line;
  ScaleCount count;
  float x_begin;
  float x_end;
};

SourceRay source_ray(Atmosphere atmosphere, AirRay ray) {
  SourceRay along;
  along.ray = ray;
  along.line = line_through(atmosphere.ground_radius_km, ray.altitude_km, ray.mu, ray.sine);
  along.count = scale_count(atmosphere, along.line);
  along.x_begin = count_along(along.count, along.line, ray, 0.0);
  along.x_end = max(count_along(along.count, along.line, ray, ray.length_km), along.x_begin);
  if (along.x_end - along.x_begin < 0.05) {
    along.count.straight = true;
    along.x_begin = 0.0;
    along.x_end = ray.length_km;
  }
  return along;
}

// Transmittance of a whole ray.
vec3 ray_transmittance(Atmosphere atmosphere, SourceRay along) {
  if (along.x_end <= along.x_begin) return vec3(1.0, 1.0, 1.0);
  return exp(-extinction(atmosphere, columns_to_count(atmosphere, along.ray, along.line, along.count, along.x_end)));
}

// S per count at a point. `air`: densities per count.
vec3 source_at(Atmosphere atmosphere, AirRay ray, CountedPoint point, vec3 air, vec2 chi) {
  float mu_sun = mu_sun_along(ray, atmosphere.ground_radius_km, point.t_km, point.altitude_km);
  vec3 rayleigh_scattering = atmosphere.rayleigh_scattering * air.x;
  vec3 mie_scattering = atmosphere.mie_scattering * air.y;
  if (MS_METHOD != kMethodMoments)
    return multiple_scattering(atmosphere, point.altitude_km, mu_sun) * (rayleigh_scattering + mie_scattering);
  float mu = clamp(point.s_km / (atmosphere.ground_radius_km + point.altitude_km), -1.0, 1.0);
  return scattered_towards_eye(rayleigh_scattering, mie_scattering,
                               multiple_scattering_moments(atmosphere, point.altitude_km, mu_sun), chi,
                               view_x_from(ray.nu, mu_sun, mu), mu);
}

// [source_panel]
// Four Gauss nodes, with columns up to each from the panel's own densities: chapter 05's panel with another source.
MarchState source_panel(Atmosphere atmosphere, SourceRay along, vec2 chi, float ozone_begin, MarchState before,
                        float x_a, float x_b) {
  float dx = x_b - x_a;
  vec4 rayleigh;
  vec4 mie;
  vec4 ozone;
  vec4 red;  // source at the four nodes, by channel; in registers, unlike an array
  vec4 green;
  vec4 blue;
  for (int i = 0; i < 4; i++) {
    CountedPoint point = point_at_count(along.count, along.ray, along.line, x_a + dx * kGauss4Node[i]);
    vec3 air = densities(atmosphere, point.altitude_km) * (point.dt_dx * dx);
    rayleigh[i] = air.x;
    mie[i] = air.y;
    ozone[i] = ozone_from_tangent(atmosphere, along.line, point.altitude_km, point.s_km);
    vec3 source = source_at(atmosphere, along.ray, point, air, chi);
    red[i] = source.x;
    green[i] = source.y;
    blue[i] = source.z;
  }
  MarchState after = before;
  vec2 summed = vec2(0.0, 0.0);
  float summed_width = 0.0;
  for (int i = 0; i < 4; i++) {
    vec2 air = vec2(rayleigh[i], mie[i]);
    vec2 inside = column_inside(rayleigh, mie, i, (summed + air * (kGauss4Node[i] - summed_width)) * 0.5);
    summed += air * kGauss4Weight[i];
    summed_width += kGauss4Weight[i];
    vec3 column = vec3(before.column.x + inside.x, before.column.y + inside.y, ozone[i] - ozone_begin);
    after.radiance += vec3(red[i], green[i], blue[i]) * exp(-extinction(atmosphere, column)) * kGauss4Weight[i];
  }
  after.column.x += summed.x;
  after.column.y += summed.y;
  return after;
}
// [/source_panel]

const int kSourceCells = 16;

// [source_march]
// Like chapter 05's adapted march, on one interval: the light of cells of equal count is estimated, panels are
// distributed over the cells by weight, and cells without light at both ends are skipped.
vec3 source_march(Atmosphere atmosphere, SourceRay along, int steps, vec2 chi) {
  vec3 radiance = vec3(0.0, 0.0, 0.0);
  if (along.x_end <= along.x_begin) return radiance;
  int panels = max((steps + 3) / 4, 1);
  int cells = clamp(2 * panels, 8, kSourceCells);
  float width = (along.x_end - along.x_begin) / float(cells);
  vec4 estimate[kSourceCells];  // xyz: light; w: change of the largest optical depth per count
  vec3 peak = vec3(1.0e-37, 1.0e-37, 1.0e-37);
  vec3 column = vec3(0.0, 0.0, 0.0);
  float tau_before = 0.0;
  for (int j = 0; j < cells; j++) {
    CountedPoint point =
        point_at_count(along.count, along.ray, along.line, along.x_begin + width * (float(j) + 0.5));
    vec3 air = densities(atmosphere, point.altitude_km) * point.dt_dx;
    vec3 depth = extinction(atmosphere, column + air * (0.5 * width));
    vec3 light = (atmosphere.rayleigh_scattering * air.x + atmosphere.mie_scattering * air.y) * exp(-depth);
    light *= multiple_scattering(atmosphere, point.altitude_km,
                                 mu_sun_along(along.ray, atmosphere.ground_radius_km, point.t_km, point.altitude_km));
    column += air * width;
    float tau = max(max(depth.x, depth.y), depth.z);
    float tau_per_count = abs(tau - (j == 0 ? tau : tau_before)) / width;
    estimate[j] = vec4(light, tau_per_count);
    if (j == 1) estimate[0].w = tau_per_count;
    tau_before = tau;
    peak = max(peak, light);
  }
  int first = cells;
  int last = -1;
  float weight[kSourceCells];
  for (int j = 0; j < cells; j++) {
    vec3 share = vec3(estimate[j]) / peak;
    if (max(max(share.x, share.y), share.z) >= kUnseen) {
      first = min(first, j);
      last = j;
    }
    weight[j] = cell_weight(share, estimate[j].w, width);
  }
  if (last < first) return radiance;
  float total = 0.0;
  for (int j = first; j <= last; j++) total += weight[j];

  float ozone_begin = ozone_from_tangent(atmosphere, along.line, along.ray.altitude_km,
                                         (atmosphere.ground_radius_km + along.ray.altitude_km) * along.ray.mu);
  float from = along.x_begin + width * float(first);
  MarchState march;
  march.radiance = radiance;
  march.column =
      first > 0 ? columns_to_count(atmosphere, along.ray, along.line, along.count, from) : vec3(0.0, 0.0, 0.0);
  int cell = first;
  float summed = 0.0;
  for (int n = 1; n <= panels; n++) {
    float target = total * float(n) / float(panels);
    while (cell < last && summed + weight[cell] < target) {
      summed += weight[cell];
      cell++;
    }
    bool at_end = n == panels;
    if (at_end) cell = last;
    float fraction = at_end ? 1.0 : clamp((target - summed) / weight[cell], 0.0, 1.0);
    float to = min(along.x_begin + width * (float(cell) + fraction), along.x_end);
    march = source_panel(atmosphere, along, chi, ozone_begin, march, from, to);
    from = to;
  }
  return march.radiance;
}
// [/source_march]

#endif
