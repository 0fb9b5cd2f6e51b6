// The adapted rule: panels of Gauss nodes where the light is. Pure functions; km. Read march.glsl first.
#ifndef WELKIN_ADAPTED_MARCH_GLSL
#define WELKIN_ADAPTED_MARCH_GLSL

#include "05_single_scattering/scale_count.glsl"

// What one panel of the march hands to the next.
struct MarchState {
  vec3 radiance;
  vec3 column;     // xy: (rayleigh, mie) from the first point of the ray, km; z: ozone from the tangent to that point
};

// [gauss4_up_to]
// Row i: weights of the integral, from 0 to Gauss node i, of the cubic through four values at the nodes (the Butcher
// matrix of the Gauss method of order eight).
const vec4 kGauss4UpTo[4] = {
    vec4(0.086963711284363, -0.026604180084999, 0.012627462689405, -0.003555149685796),
    vec4(0.188118117499868, 0.163036288715637, -0.027880428602471, 0.006735500594538),
    vec4(0.167191921974188, 0.353953006033745, 0.163036288715636, -0.014190694931141),
    vec4(0.177482572254523, 0.313445114741868, 0.352676757516272, 0.086963711284364)};
// [/gauss4_up_to]

// [panel]
// Columns (rayleigh, mie) from a panel's begin to its node i, from the densities at its four nodes. On a panel of many
// scale heights the cubic dips below zero, and light would come through; `floor_of`, half of what the weights alone
// give, prevents that. A panel that resolves the air stays above it.
vec2 column_inside(vec4 rayleigh, vec4 mie, int i, vec2 floor_of) {
  return max(vec2(dot(rayleigh, kGauss4UpTo[i]), dot(mie, kGauss4UpTo[i])), floor_of);
}

// One panel of four Gauss nodes over counts [x_a, x_b]. Columns up to each node are integrals of the polynomial through
// the panel's own densities, so that they are of the same order as the panel. The nodes are components of a vec4 and
// not elements of an array, so that they stay in registers.
MarchState march_panel(Atmosphere atmosphere, AirRay ray, Line line, ScaleCount count, ScatteringTowardsEye scattering,
                    MarchState before, float x_a, float x_b) {
  float dx = x_b - x_a;
  float radius_km = atmosphere.ground_radius_km;
  vec4 altitude;
  vec4 mu_sun;
  vec4 rayleigh;  // columns per panel width at the nodes
  vec4 mie;
  vec4 ozone;
  for (int i = 0; i < 4; i++) {
    CountedPoint point = point_at_count(count, ray, line, x_a + dx * kGauss4Node[i]);
    vec3 air = densities(atmosphere, point.altitude_km) * (point.dt_dx * dx);
    altitude[i] = point.altitude_km;
    mu_sun[i] = mu_sun_along(ray, radius_km, point.t_km, point.altitude_km);
    rayleigh[i] = air.x;
    mie[i] = air.y;
    ozone[i] = ozone_from_tangent(atmosphere, line, point.altitude_km, point.s_km);
  }
  MarchState after = before;
  vec2 passed = vec2(0.0, 0.0);
  float passed_width = 0.0;
  for (int i = 0; i < 4; i++) {
    vec2 air = vec2(rayleigh[i], mie[i]);
    vec2 inside = column_inside(rayleigh, mie, i, (passed + air * (kGauss4Node[i] - passed_width)) * 0.5);
    passed += air * kGauss4Weight[i];
    passed_width += kGauss4Weight[i];
    vec3 column = vec3(before.column.x + inside.x, before.column.y + inside.y, ozone[i] - before.column.z);
    vec3 tau = optical_depth_and_to_sun(atmosphere, column, altitude[i], mu_sun[i]);
    vec3 source = scattering.rayleigh * air.x + scattering.mie * air.y;
    after.radiance += source * exp(-tau) * kGauss4Weight[i];
  }
  after.column.x += passed.x;
  after.column.y += passed.y;
  return after;
}
// [/panel]

// [shadow_interval]
// Interval [x, y] of the ray's length in the planet's shadow, empty when x >= y. Distance to the shadow's axis squared:
// a t^2 + 2 b t + c + R^2 with a = 1 - nu^2, b = r (mu - mu_sun nu), c = h (2R + h) - (r mu_sun)^2.
vec2 shadow_interval(AirRay ray, float ground_radius_km) {
  float r = ground_radius_km + ray.altitude_km;
  float a = max(ray.sine2_nu, 1.0e-14);
  float b = r * (ray.mu - ray.mu_sun * ray.nu);
  float c = ray.altitude_km * (2.0 * ground_radius_km + ray.altitude_km) - r * ray.mu_sun * r * ray.mu_sun;
  float discriminant = b * b - a * c;
  if (discriminant <= 0.0) return vec2(0.0, 0.0);
  float q = -(b + (b < 0.0 ? -sqrt(discriminant) : sqrt(discriminant)));
  float root_1 = q / a;
  float root_2 = abs(q) > 0.0 ? c / q : root_1;
  float enter = min(root_1, root_2);
  float leave = max(root_1, root_2);
  // It is dark only on the far side of the planet's centre, seen from the sun: r mu_sun + t nu < 0.
  float crossing = -r * ray.mu_sun / (abs(ray.nu) > 1.0e-20 ? ray.nu : 1.0e-20);
  if (ray.nu > 0.0) leave = min(leave, crossing);
  if (ray.nu < 0.0) enter = max(enter, crossing);
  if (ray.nu == 0.0 && ray.mu_sun >= 0.0) leave = enter;
  return vec2(clamp(enter, 0.0, ray.length_km), clamp(leave, 0.0, ray.length_km));
}
// [/shadow_interval]

// Columns from the ray's first point to count x, by quadratures of their own (48 nodes at most).
vec3 columns_to_count(Atmosphere atmosphere, AirRay ray, Line line, ScaleCount count, float x) {
  CountedPoint point = point_at_count(count, ray, line, x);
  float s_start = (line.ground_radius_km + ray.altitude_km) * ray.mu;
  return columns_between(atmosphere, line, s_start, ray.altitude_km, max(point.s_km, s_start), point.altitude_km, 3);
}

// [source_estimate]
// Estimate of what a cell of width dx around the count x adds to the radiance. column: from the eye to the cell.
struct SourceEstimate {
  vec3 radiance;      // per count
  vec3 optical_depth; // from the eye by way of the cell's middle to the sun
  vec3 column;        // from the eye to the cell's end
};

SourceEstimate source_estimate(Atmosphere atmosphere, AirRay ray, Line line, ScaleCount count,
                               ScatteringTowardsEye scattering, vec3 column, float x, float dx) {
  float radius_km = atmosphere.ground_radius_km;
  CountedPoint point = point_at_count(count, ray, line, x);
  vec3 density = densities(atmosphere, point.altitude_km) * point.dt_dx;
  float mu_sun = mu_sun_along(ray, radius_km, point.t_km, point.altitude_km);
  Line light = line_through(radius_km, point.altitude_km, mu_sun, sqrt((1.0 - mu_sun) * (1.0 + mu_sun)));
  light.tangent_km = max(light.tangent_km, mu_sun < 0.0 ? 0.0 : light.tangent_km);
  vec3 sun = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH)
    sun.x = exponential_column_estimate(light, point.altitude_km, mu_sun, atmosphere.rayleigh_scale_height_km);
  if (HAS_MIE) sun.y = exponential_column_estimate(light, point.altitude_km, mu_sun, atmosphere.mie_scale_height_km);
  SourceEstimate result;
  vec3 tau = extinction(atmosphere, column + density * (0.5 * dx) + max(sun, vec3(0.0, 0.0, 0.0)));
  result.optical_depth = tau;
  result.radiance = (scattering.rayleigh * density.x + scattering.mie * density.y) * exp(-tau);
  result.column = column + density * dx;
  return result;
}
// [/source_estimate]

const int kMaxCells = 32;          // cells of the estimate that places the panels: two per panel, at least eight
const float kUnseen = 1.0e-4;      // light below this share of the peak, in every channel, is left out at the ends
const float kDim = 3.0e-3;         // share of the peak below which light asks for fewer nodes
const float kSlopeWeight = 0.4;    // nodes asked for per unit of optical depth, relative to those per count
const float kLeastWeight = 0.6;    // nodes that even a dark stretch between two bright ones asks for

// Nodes that a cell asks for. share: its light over the peak's; slope: change of the largest optical depth per count.
float cell_weight(vec3 share, float slope, float width) {
  vec3 bent = share / (share + kDim) * (1.0 + min(slope, 10.0) * kSlopeWeight);
  return (kLeastWeight + bent.x + bent.y + bent.z) * width;
}

// A lit interval of the ray: cells of equal count that an estimate looks at.
struct LitInterval {
  float begin;      // count at its first end
  float width;      // counts per cell
  int first_cell;   // into the array of cells
  int last_cell;    // inclusive; smaller than first_cell: no interval
  int first_seen;   // the cells that hold visible light
  int last_seen;
  float weight;     // sum over those cells
};

LitInterval lit_between(float begin, float end, int first_cell, int cells) {
  LitInterval lit;
  int used = end > begin ? cells : 0;
  lit.begin = begin;
  lit.width = (end - begin) / float(max(used, 1));
  lit.first_cell = first_cell;
  lit.last_cell = first_cell + used - 1;
  lit.first_seen = first_cell + used;
  lit.last_seen = first_cell - 1;
  lit.weight = 0.0;
  return lit;
}

// [lit_cells]
// The ray's ends as counts, and the intervals of it that the sun reaches: before the planet's shadow, and behind it.
struct LitCells {
  ScaleCount count;
  float x_begin;
  float x_end;
  LitInterval lit[2];
  float weight[kMaxCells];  // nodes that each cell asks for
};

// The shadow cuts the ray into at most two lit intervals; the rest only absorbs.
LitCells lit_cells(Atmosphere atmosphere, AirRay ray, Line line, int cells) {
  float radius_km = atmosphere.ground_radius_km;
  LitCells along;
  along.count = scale_count(atmosphere, line);
  along.x_begin = count_along(along.count, line, ray, 0.0);
  along.x_end = max(count_along(along.count, line, ray, ray.length_km), along.x_begin);
  if (along.x_end - along.x_begin < 0.05) {
    along.count.straight = true;
    along.x_begin = 0.0;
    along.x_end = ray.length_km;
  }
  vec2 shadow = shadow_interval(ray, radius_km);
  bool has_shadow = shadow.y > shadow.x;
  float x_enter =
      has_shadow ? clamp(count_along(along.count, line, ray, shadow.x), along.x_begin, along.x_end) : along.x_end;
  float x_leave = has_shadow ? clamp(count_along(along.count, line, ray, shadow.y), x_enter, along.x_end) : along.x_end;
  bool both = x_enter > along.x_begin && along.x_end > x_leave;
  along.lit[0] = lit_between(along.x_begin, x_enter, 0, both ? cells / 2 : cells);
  along.lit[1] = lit_between(x_leave, along.x_end, along.lit[0].last_cell + 1, both ? cells / 2 : cells);
  return along;
}

// Estimates the light of each cell in closed form. Cells at the ends of an interval that hold less than `unseen` of the
// peak in every channel are left out; the others ask for nodes: evenly in scale heights where there is light, more
// where its optical depth changes fast, fewer where it is below a few thousandths of the peak.
LitCells weighted_cells(Atmosphere atmosphere, AirRay ray, Line line, ScatteringTowardsEye scattering, LitCells along,
                        float unseen) {
  vec4 seen[kMaxCells];  // xyz: light per count; w: change of the largest optical depth per count
  vec3 peak = vec3(1.0e-37, 1.0e-37, 1.0e-37);
  vec3 column = vec3(0.0, 0.0, 0.0);
  for (int k = 0; k < 2; k++) {
    LitInterval lit = along.lit[k];
    if (lit.last_cell >= lit.first_cell && lit.begin > along.x_begin)
      column = columns_to_count(atmosphere, ray, line, along.count, lit.begin);
    float tau_before = 0.0;
    for (int j = lit.first_cell; j <= lit.last_cell; j++) {
      float x = lit.begin + lit.width * (float(j - lit.first_cell) + 0.5);
      SourceEstimate cell = source_estimate(atmosphere, ray, line, along.count, scattering, column, x, lit.width);
      column = cell.column;
      float tau = max(max(cell.optical_depth.x, cell.optical_depth.y), cell.optical_depth.z);
      float slope = abs(tau - (j == lit.first_cell ? tau : tau_before)) / lit.width;
      seen[j] = vec4(cell.radiance, slope);
      if (j == lit.first_cell + 1) seen[j - 1].w = slope;
      tau_before = tau;
      peak = max(peak, cell.radiance);
    }
  }
  for (int k = 0; k < 2; k++) {
    for (int j = along.lit[k].first_cell; j <= along.lit[k].last_cell; j++) {
      vec3 share = vec3(seen[j]) / peak;
      if (max(max(share.x, share.y), share.z) >= unseen) {
        along.lit[k].first_seen = min(along.lit[k].first_seen, j);
        along.lit[k].last_seen = j;
      }
      along.weight[j] = cell_weight(share, seen[j].w, along.lit[k].width);
    }
    for (int j = along.lit[k].first_seen; j <= along.lit[k].last_seen; j++) along.lit[k].weight += along.weight[j];
  }
  return along;
}
// [/lit_cells]

// [adapted_march]
// The march of the adapted rule: panels divide the lit cells so that each gets the same number of the nodes asked for,
// and four Gauss nodes integrate each panel. What lies before an interval counts by its columns alone. The whole ray's
// transmittance is a quadrature of its own, done only if wanted (1 otherwise).
RayLight adapted_march(Atmosphere atmosphere, AirRay ray, ScatteringTowardsEye scattering, int view_steps,
                       bool with_transmittance) {
  Line line = line_through(atmosphere.ground_radius_km, ray.altitude_km, ray.mu, ray.sine);
  int panels = max((view_steps + 3) / 4, 1);
  LitCells along = lit_cells(atmosphere, ray, line, clamp(2 * panels, 8, kMaxCells));
  // More panels make a smaller error, and what is left out at the ends must shrink with it.
  along = weighted_cells(atmosphere, ray, line, scattering, along,
                         kUnseen * min(1.0, 512.0 / float(panels * panels * panels)));

  float ozone_begin = ozone_from_tangent(atmosphere, line, ray.altitude_km,
                                         (atmosphere.ground_radius_km + ray.altitude_km) * ray.mu);
  RayLight result;
  result.radiance = vec3(0.0, 0.0, 0.0);
  int panels_left = panels;
  for (int k = 0; k < 2; k++) {
    LitInterval lit = along.lit[k];
    if (lit.last_seen < lit.first_seen) continue;
    // The interval's share of the panels, by its weight.
    int lit_panels = panels_left;
    if (k == 0 && along.lit[1].weight > 0.0) {
      float share = along.lit[0].weight / (along.lit[0].weight + along.lit[1].weight);
      lit_panels = clamp(int(float(panels) * share + 0.5), 1, max(panels - 1, 1));
    }
    panels_left = max(panels_left - lit_panels, 1);
    int cell = lit.first_seen;
    float from = lit.begin + lit.width * float(cell - lit.first_cell);
    MarchState march;
    march.radiance = result.radiance;
    march.column =
        from > along.x_begin ? columns_to_count(atmosphere, ray, line, along.count, from) : vec3(0.0, 0.0, 0.0);
    march.column.z = ozone_begin;
    float passed = 0.0;  // nodes asked for by the cells before this one
    for (int n = 1; n <= lit_panels; n++) {
      // Panel n ends inside the cell where n panels' share of the nodes is reached.
      float wanted = lit.weight * float(n) / float(lit_panels);
      while (cell < lit.last_seen && passed + along.weight[cell] < wanted) {
        passed += along.weight[cell];
        cell++;
      }
      bool last = n == lit_panels;
      if (last) cell = lit.last_seen;
      float into = last ? 1.0 : clamp((wanted - passed) / along.weight[cell], 0.0, 1.0);
      float to = lit.begin + lit.width * (float(cell - lit.first_cell) + into);
      march = march_panel(atmosphere, ray, line, along.count, scattering, march, from, min(to, along.x_end));
      from = to;
    }
    result.radiance = march.radiance;
  }
  result.transmittance = vec3(1.0, 1.0, 1.0);
  if (with_transmittance) {
    result.transmittance =
        exp(-extinction(atmosphere, columns_to_count(atmosphere, ray, line, along.count, along.x_end)));
  }
  return result;
}
// [/adapted_march]

#endif
