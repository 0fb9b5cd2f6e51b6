// The adapted rule and the whole ray: panels of Gauss nodes where the light is. Included by single_scattering.glsl.

const int kMaxCells = 32;          // cells of the estimate that places the panels: four per panel, at least eight
const float kUnseen = 1.0e-4;      // light below this share of the peak, in every channel, is left out at the ends
const float kDim = 1.0e-2;         // share of the peak below which light asks for fewer nodes
const float kSlopeWeight = 0.5;    // nodes asked for per unit of optical depth, relative to those per count
const float kLeastWeight = 0.3;    // nodes that even darkness between two bright stretches asks for

// A lit piece of the ray: cells of equal count that an estimate looks at, and the panels it is given.
struct Piece {
  float begin;      // count at its first end
  float width;      // counts per cell
  int first_cell;   // into the arrays of cells
  int last_cell;    // inclusive; smaller than first_cell: no piece
  int first_seen;   // the cells that hold visible light
  int last_seen;
  float weight;     // sum over those cells
};

Piece piece_between(float begin, float end, int first_cell, int cells) {
  Piece piece;
  int used = end > begin ? cells : 0;
  piece.begin = begin;
  piece.width = (end - begin) / float(max(used, 1));
  piece.first_cell = first_cell;
  piece.last_cell = first_cell + used - 1;
  piece.first_seen = first_cell + used;
  piece.last_seen = first_cell - 1;
  piece.weight = 0.0;
  return piece;
}

// The march of the adapted rule.
// 1. The shadow cuts the ray into at most two lit pieces; the rest only absorbs.
// 2. A closed-form estimate looks at a few cells of each piece. Cells at the ends that hold less than 1e-4 of the peak
//    in every channel are left out.
// 3. Panels share the rest by weight: evenly in scale heights where there is light, denser where its optical depth
//    changes fast, thinner where it is below a hundredth of the peak.
// 4. Eight Gauss nodes integrate each panel; what lies before a piece enters by its columns alone.
RayLight adapted_march(Atmosphere atmosphere, AirRay ray, ScatteringTowardsEye scattering, int view_steps, int light_steps) {
  float radius_km = atmosphere.shape.x;
  Line line = line_through(radius_km, ray.altitude_km, ray.mu, ray.sine);
  ScaleCount count = scale_count(atmosphere, line);
  float x_begin = count_along(count, line, ray, 0.0);
  float x_end = max(count_along(count, line, ray, ray.length_km), x_begin);
  if (x_end - x_begin < 0.05) {
    count.straight = true;
    x_begin = 0.0;
    x_end = ray.length_km;
  }
  vec2 shadow = shadow_interval(ray, radius_km);
  bool has_shadow = shadow.y > shadow.x;
  float x_enter = has_shadow ? clamp(count_along(count, line, ray, shadow.x), x_begin, x_end) : x_end;
  float x_leave = has_shadow ? clamp(count_along(count, line, ray, shadow.y), x_enter, x_end) : x_end;

  bool both = x_enter > x_begin && x_end > x_leave;
  int panels = max((view_steps + 7) / 8, 1);
  int cells = clamp(4 * panels, 8, kMaxCells);
  Piece piece[2];
  piece[0] = piece_between(x_begin, x_enter, 0, both ? cells / 2 : cells);
  piece[1] = piece_between(x_leave, x_end, piece[0].last_cell + 1, both ? cells / 2 : cells);

  vec3 light[kMaxCells];
  vec3 slope[kMaxCells];
  vec3 peak = vec3(1.0e-37, 1.0e-37, 1.0e-37);
  vec3 column = vec3(0.0, 0.0, 0.0);
  for (int k = 0; k < 2; k++) {
    if (piece[k].last_cell >= piece[k].first_cell && piece[k].begin > x_begin) {
      column = columns_to_count(atmosphere, ray, line, count, piece[k].begin);
    }
    vec3 tau_before = vec3(0.0, 0.0, 0.0);
    for (int j = piece[k].first_cell; j <= piece[k].last_cell; j++) {
      float x = piece[k].begin + piece[k].width * (float(j - piece[k].first_cell) + 0.5);
      Glimpse seen = glimpse(atmosphere, ray, line, count, scattering, column, x, piece[k].width);
      column = seen.column;
      light[j] = seen.contribution;
      slope[j] = abs(seen.tau - (j == piece[k].first_cell ? seen.tau : tau_before)) / piece[k].width;
      if (j == piece[k].first_cell + 1) slope[j - 1] = slope[j];
      tau_before = seen.tau;
      peak = max(peak, light[j]);
    }
  }
  // With more panels the ends matter sooner: what is left out must shrink with the error.
  float unseen = kUnseen * min(1.0, 64.0 / float(panels * panels * panels));
  float weight[kMaxCells];
  for (int k = 0; k < 2; k++) {
    for (int j = piece[k].first_cell; j <= piece[k].last_cell; j++) {
      vec3 share = light[j] / peak;
      if (max(max(share.x, share.y), share.z) >= unseen) {
        piece[k].first_seen = min(piece[k].first_seen, j);
        piece[k].last_seen = j;
      }
      share = share / (share + kDim) * (vec3(1.0, 1.0, 1.0) + min(slope[j], vec3(10.0, 10.0, 10.0)) * kSlopeWeight);
      weight[j] = (kLeastWeight + share.x + share.y + share.z) * piece[k].width;
    }
    for (int j = piece[k].first_seen; j <= piece[k].last_seen; j++) piece[k].weight += weight[j];
  }

  RayLight result;
  result.radiance = vec3(0.0, 0.0, 0.0);
  int panels_left = panels;
  for (int k = 0; k < 2; k++) {
    if (piece[k].last_seen < piece[k].first_seen) continue;
    int piece_panels = panels_left;
    if (k == 0 && piece[1].weight > 0.0) {
      float share = piece[0].weight / (piece[0].weight + piece[1].weight);
      piece_panels = clamp(int(float(panels) * share + 0.5), 1, max(panels - 1, 1));
    }
    panels_left = max(panels_left - piece_panels, 1);
    int cell = piece[k].first_seen;
    float from = piece[k].begin + piece[k].width * float(cell - piece[k].first_cell);
    Stretch march;
    march.radiance = result.radiance;
    march.column = from > x_begin ? columns_to_count(atmosphere, ray, line, count, from) : vec3(0.0, 0.0, 0.0);
    float passed = 0.0;
    for (int n = 1; n <= piece_panels; n++) {
      float wanted = piece[k].weight * float(n) / float(piece_panels);
      while (cell < piece[k].last_seen && passed + weight[cell] < wanted) {
        passed += weight[cell];
        cell++;
      }
      bool last = n == piece_panels;
      if (last) cell = piece[k].last_seen;
      float into = last ? 1.0 : clamp((wanted - passed) / weight[cell], 0.0, 1.0);
      float to = piece[k].begin + piece[k].width * (float(cell - piece[k].first_cell) + into);
      march = march_panel(atmosphere, ray, line, count, scattering, march, from, min(to, x_end), light_steps);
      from = to;
    }
    result.radiance = march.radiance;
  }
  result.transmittance = exp(-extinction(atmosphere, columns_to_count(atmosphere, ray, line, count, x_end)));
  return result;
}

// Radiance of the Lambert ground of albedo 1 under the direct sun, before the view ray's transmittance:
// T(ground, sun) max(mu_sun, 0) / pi.
vec3 lit_ground(Atmosphere atmosphere, float mu_sun, int light_steps, int rule) {
  if (mu_sun <= 0.0) return vec3(0.0, 0.0, 0.0);
  vec3 column = vec3(0.0, 0.0, 0.0);
  if (rule == kRuleAdapted) {
    column = sun_columns(atmosphere, 0.0, mu_sun, light_steps);
  } else {
    float radius_km = atmosphere.shape.x;
    float light_length = distance_to_shell_from_inside(radius_km, 0.0, mu_sun, atmosphere.shape.y);
    for (int j = 0; j < light_steps; j++) {
      Segment step = quadrature_segment(rule, j, light_steps);
      float h = altitude_along(radius_km, 0.0, mu_sun, step.sample_at * light_length);
      column += densities(atmosphere, max(h, 0.0)) * (step.width * light_length);
    }
  }
  return exp(-extinction(atmosphere, column)) * (mu_sun * 0.31830988618379067);
}

// Radiance and transmittance of a ray: single scattering and the directly lit ground, without the sun's disc.
//   altitude_km     of the camera, any value; below ground counts as on it
//   view_direction  unit vector in the camera's local frame, z up; sun_direction likewise
//   view_steps, light_steps >= 1 samples. Gauss-Legendre rounds both up to a multiple of four; adapted rounds the view up
//                   to eight (and needs eight for each of two lit pieces), the light to four (eight where it dips)
//   rule            kRuleLeft ... kRuleAdapted
// A ray that misses the air gives radiance 0 and transmittance 1.
RayLight single_scattering(Atmosphere atmosphere, float altitude_km, vec3 view_direction, vec3 sun_direction, int view_steps,
                           int light_steps, int rule) {
  int view_count = max(view_steps, 1);
  int light_count = max(light_steps, 1);
  if (rule == kRuleGaussLegendre) {
    view_count = (view_count + 3) / 4 * 4;
    light_count = (light_count + 3) / 4 * 4;
  }
  RayLight result;
  result.radiance = vec3(0.0, 0.0, 0.0);
  result.transmittance = vec3(1.0, 1.0, 1.0);
  AirRay ray = enter_air(atmosphere, altitude_km, view_direction, sun_direction);
  if (!ray.hits_air) return result;
  ScatteringTowardsEye scattering = scattering_towards_eye(atmosphere, one_minus_cosine(view_direction, sun_direction));
  if (rule == kRuleAdapted) {
    result = adapted_march(atmosphere, ray, scattering, view_count, light_count);
  } else {
    result = fixed_march(atmosphere, ray, scattering, view_count, light_count, rule);
  }
  if (ray.hits_ground) {
    float mu_sun = mu_sun_along(ray, atmosphere.shape.x, ray.length_km, 0.0);
    result.radiance += result.transmittance * vec3(atmosphere.ground) * lit_ground(atmosphere, mu_sun, light_count, rule);
  }
  result.radiance *= vec3(atmosphere.sun);
  return result;
}
