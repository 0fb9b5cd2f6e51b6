// Single scattering along a ray: sunlight that is deflected once. Pure functions; lengths in km, radiance in units of the
// solar irradiance given in the atmosphere (per steradian).
//
//   L = E_sun * integral of  T(eye, t) [ beta_R rho_R P_R + beta_M rho_M P_M ] T(t, sun) V(t) dt  +  lit ground
//
// V = 0 in the planet's shadow, a cylinder: the sun is a point. The ray is cut into segments that tile it exactly; a
// rule says where the cuts are and where in each segment the sample sits.
#ifndef WELKIN_SINGLE_SCATTERING_GLSL
#define WELKIN_SINGLE_SCATTERING_GLSL

#include "05_single_scattering/light_path.glsl"

const int kRuleLeft = 0;           // sample at the start of each of N equal segments
const int kRuleMidpoint = 1;       // in the middle
const int kRuleHillaire = 2;       // at 0.3 of the segment (Hillaire 2020)
const int kRuleNonuniform = 3;     // segments [(i/N)^2, ((i+1)/N)^2] L, sample in the middle
const int kRuleGaussLegendre = 4;  // panels of four Gauss-Legendre nodes; a segment's length is its weight
const int kRuleAdapted = 5;        // panels of eight in a coordinate that counts scale heights, placed where the light is


struct RayLight {
  vec3 radiance;
  vec3 transmittance;
};

// Where a segment's sample sits and how long the segment is, as fractions of the path.
struct Segment {
  float sample_at;
  float width;
};

// Segment i of n. The widths of a rule sum to 1 (for Gauss-Legendre when n is a multiple of four).
Segment quadrature_segment(int rule, int i, int n) {
  Segment segment;
  float begin = float(i) / float(n);
  segment.width = 1.0 / float(n);
  segment.sample_at = begin;
  if (rule == kRuleMidpoint) segment.sample_at = begin + 0.5 * segment.width;
  if (rule == kRuleHillaire) segment.sample_at = begin + 0.3 * segment.width;
  if (rule == kRuleNonuniform) {
    float end = float(i + 1) / float(n);
    segment.width = (end - begin) * (end + begin);
    segment.sample_at = begin * begin + 0.5 * segment.width;
  }
  if (rule == kRuleGaussLegendre) {
    float panel = 4.0 / float(n);
    segment.width = panel * gauss4_weight(i % 4);
    segment.sample_at = panel * (float(i / 4) + gauss4_node(i % 4));
  }
  return segment;
}

// (1 - exp(-tau)) / tau, the mean transmittance of a homogeneous segment; a series where the quotient would cancel.
float mean_transmittance(float tau) {
  if (tau < 0.05) return 1.0 - tau * (0.5 - tau * (0.16666666666666667 - tau * 0.041666666666666667));
  return (1.0 - exp(-tau)) / tau;
}

// The part of a ray inside the atmosphere, in the frame of its first point: everything the march needs.
struct AirRay {
  bool hits_air;
  bool hits_ground;
  float altitude_km;   // of the first point
  float mu;            // zenith cosine of the ray there
  float sine;
  float mu_sun;        // zenith cosine of the sun there
  float nu;            // cosine between ray and sun
  float sine2_nu;      // 1 - nu^2, from the cross product
  float length_km;
};

// Clips the ray to the atmosphere. From space the first point is the entry; its zenith angles follow from the turn of
// the zenith, theta_camera - theta_entry, whose cosine and sine are sums of products of order one: no digits are lost.
AirRay enter_air(Atmosphere atmosphere, float camera_altitude_km, vec3 view, vec3 sun) {
  float radius_km = atmosphere.shape.x;
  float top_km = atmosphere.shape.y;
  AirRay ray;
  ray.altitude_km = max(camera_altitude_km, 0.0);
  ray.mu = clamp(view.z, -1.0, 1.0);
  ray.sine = min(sqrt(view.x * view.x + view.y * view.y), 1.0);
  ray.mu_sun = clamp(sun.z, -1.0, 1.0);
  ray.nu = clamp(dot(view, sun), -1.0, 1.0);
  vec3 across = cross(view, sun);
  ray.sine2_nu = dot(across, across);
  ray.hits_air = true;
  ray.hits_ground = false;
  ray.length_km = 0.0;
  float tangent_km = tangent_altitude(radius_km, ray.altitude_km, ray.mu, ray.sine);
  if (ray.altitude_km >= top_km) {
    // Depth of the tangent point below the top. Not top - tangent: a ray that skims the top from its edge dips by
    // r mu^2 / 2, which can be less than one ulp of the altitude.
    float r = radius_km + ray.altitude_km;
    float below_top = abs(ray.mu) < 0.5 ? r * ray.mu * ray.mu / (1.0 + ray.sine) - (ray.altitude_km - top_km)
                                        : radius_km + top_km - r * ray.sine;
    if (ray.mu >= 0.0 || below_top <= 0.0) {
      ray.hits_air = false;
      return ray;
    }
    if (ray.altitude_km > top_km) {
      float r_top = radius_km + top_km;
      float b = r_top - below_top;
      float sine_entry = b / r_top;
      float mu_entry = -sqrt(below_top * (r_top + b)) / r_top;
      float turn_cosine = ray.mu * mu_entry + ray.sine * sine_entry;
      float turn_sine = max(ray.sine * mu_entry - ray.mu * sine_entry, 0.0);
      // Horizontal part of the sun towards the view's azimuth; a vertical view has none and does not turn.
      float sun_towards_view = (view.x * sun.x + view.y * sun.y) / max(ray.sine, 1.0e-20);
      ray.mu_sun = clamp(turn_cosine * sun.z + turn_sine * sun_towards_view, -1.0, 1.0);
      ray.altitude_km = top_km;
      ray.mu = mu_entry;
      ray.sine = sine_entry;
    }
  }
  ray.hits_ground = ray.mu < 0.0 && tangent_km < 0.0;
  ray.length_km = ray.hits_ground ? distance_to_shell_from_outside(radius_km, ray.altitude_km, ray.mu, ray.sine, 0.0)
                                  : distance_to_shell_from_inside(radius_km, ray.altitude_km, ray.mu, top_km);
  ray.length_km = max(ray.length_km, 0.0);
  return ray;
}

// Zenith cosine of the sun at distance t, where the altitude is h.
float mu_sun_along(AirRay ray, float ground_radius_km, float t_km, float altitude_km) {
  float along_sun = (ground_radius_km + ray.altitude_km) * ray.mu_sun + t_km * ray.nu;
  return clamp(along_sun / (ground_radius_km + altitude_km), -1.0, 1.0);
}

bool sun_above_horizon(float ground_radius_km, float altitude_km, float mu_sun) {
  if (mu_sun >= 0.0) return true;
  return tangent_altitude(ground_radius_km, altitude_km, mu_sun, sqrt((1.0 - mu_sun) * (1.0 + mu_sun))) >= 0.0;
}

// The rules that sample the ray at places fixed beforehand, for the ray and for the path to the sun alike. Within a
// segment source and extinction are constant: it gives S dt (1 - exp(-tau)) / tau.
RayLight fixed_march(Atmosphere atmosphere, AirRay ray, ScatteringTowardsEye scattering, int view_steps, int light_steps,
                     int rule) {
  float radius_km = atmosphere.shape.x;
  float top_km = atmosphere.shape.y;
  RayLight light;
  light.radiance = vec3(0.0, 0.0, 0.0);
  light.transmittance = vec3(1.0, 1.0, 1.0);
  for (int i = 0; i < view_steps; i++) {
    Segment segment = quadrature_segment(rule, i, view_steps);
    float t = segment.sample_at * ray.length_km;
    float dt = segment.width * ray.length_km;
    float altitude = max(altitude_along(radius_km, ray.altitude_km, ray.mu, t), 0.0);
    vec3 density = densities(atmosphere, altitude);
    vec3 tau = extinction(atmosphere, density) * dt;
    float mu_sun = mu_sun_along(ray, radius_km, t, altitude);
    if (sun_above_horizon(radius_km, altitude, mu_sun)) {
      float light_length = distance_to_shell_from_inside(radius_km, altitude, mu_sun, top_km);
      vec3 column = vec3(0.0, 0.0, 0.0);
      for (int j = 0; j < light_steps; j++) {
        Segment step = quadrature_segment(rule, j, light_steps);
        float h = altitude_along(radius_km, altitude, mu_sun, step.sample_at * light_length);
        column += densities(atmosphere, max(h, 0.0)) * (step.width * light_length);
      }
      vec3 source = (scattering.rayleigh * density.x + scattering.mie * density.y) * exp(-extinction(atmosphere, column));
      vec3 mean = vec3(mean_transmittance(tau.x), mean_transmittance(tau.y), mean_transmittance(tau.z));
      light.radiance += light.transmittance * source * mean * dt;
    }
    light.transmittance *= exp(-tau);
  }
  return light;
}

// A coordinate x that counts scale heights along a line: nodes evenly spaced in x suit every factor of the integrand.
//   q(h) counts scale heights above the line's lowest point, 1/H_high each km, more of them near the ground where H_low
//   rules: dq/dh = 1/H_high + (1/H_low - 1/H_high) (4 H_low)^2 / (h + 4 H_low)^2;
//   x = +-sqrt(q (1 + q)): proportional to s at a tangent point (where h is quadratic in s), to q far from it.
// A ray that crosses almost none (half a metre down to the ground) would drown in the rounding of q; for it x is simply
// the distance t.
struct ScaleCount {
  bool straight;   // x is the distance from the ray's first point
  float floor_km;  // lowest altitude: the tangent point's, or the ground
  float depth_km;  // of the tangent point below the ground, or 0
  float q_floor;   // q at floor_km; capped, for a tangent point that deep no longer bends anything
  float per_km;    // 1/H_high
  float gain;
  float reach_km;
};

ScaleCount scale_count(Atmosphere atmosphere, Line line) {
  float scale_a = HAS_RAYLEIGH ? atmosphere.rayleigh.w : (HAS_MIE ? atmosphere.mie_scattering.w : 10.0);
  float scale_b = HAS_MIE ? atmosphere.mie_scattering.w : scale_a;
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

// What a stretch of the march hands to the next one.
struct Stretch {
  vec3 radiance;
  vec3 column;     // (rayleigh, mie, ozone) from the first point of the ray, km
};

// Eight Gauss-Legendre nodes on [0, 1], their weights, and row by row the integrals from 0 to each node of the
// polynomial that interpolates the eight values (the Butcher matrix of the Gauss method).
const float kGauss8Node[8] = {
    0.019855071751232, 0.101666761293187, 0.237233795041836, 0.408282678752175,
    0.591717321247825, 0.762766204958164, 0.898333238706813, 0.980144928248768};
const float kGauss8Weight[8] = {
    0.050614268145188, 0.111190517226687, 0.156853322938944, 0.181341891689181,
    0.181341891689181, 0.156853322938944, 0.111190517226687, 0.050614268145188};
const float kGauss8UpTo[64] = {
    0.025307134072594, -0.009105943305970, 0.006280831147030, -0.004483015613055,
    0.003078491368327, -0.001917675254637, 0.000972757664059, -0.000277508327117,
    0.054759321767554, 0.055595258613344, -0.013639796235782, 0.008149708858361,
    -0.005215352089147, 0.003139752985464, -0.001564934910949, 0.000442802304342,
    0.048587535998913, 0.120859524997173, 0.078426661469472, -0.015975103361878,
    0.008371732720226, -0.004643465862104, 0.002225714775285, -0.000618805695251,
    0.051865520970581, 0.106193490148348, 0.170671134274554, 0.090670945844590,
    -0.016021041321025, 0.007241206561222, -0.003197814310361, 0.000859236584265,
    0.049755031560923, 0.114388331537048, 0.149612116377721, 0.197362933010206,
    0.090670945844590, -0.013817811335610, 0.004997027078339, -0.001251252825393,
    0.051233073840439, 0.108964802451402, 0.161496788801048, 0.172970158968955,
    0.197316995051059, 0.078426661469472, -0.009669007770486, 0.002026732146275,
    0.050171465840846, 0.112755452137636, 0.153713569953480, 0.186557243778328,
    0.173192182830820, 0.170493119174725, 0.055595258613344, -0.004145053622366,
    0.050891776472305, 0.110217759562628, 0.158770998193581, 0.178263400320854,
    0.185824907302236, 0.150572491791913, 0.120296460532657, 0.025307134072594};

// One panel of eight Gauss nodes over counts [x_a, x_b]. Columns up to each node come from the panel's own densities, by
// the integrals of their interpolating polynomial, so that the whole panel has one order.
Stretch march_panel(Atmosphere atmosphere, AirRay ray, Line line, ScaleCount count, ScatteringTowardsEye scattering,
                    Stretch before, float x_a, float x_b, int light_steps) {
  float dx = x_b - x_a;
  float radius_km = atmosphere.shape.x;
  float s_start = (radius_km + ray.altitude_km) * ray.mu;
  vec3 air[8];  // columns per panel width at the nodes
  float altitude[8];
  float mu_sun[8];
  float ozone[8];
  float ozone_begin = ozone_from_tangent(atmosphere, line, ray.altitude_km, s_start);
  Stretch after = before;
  for (int i = 0; i < 8; i++) {
    CountedPoint point = point_at_count(count, ray, line, x_a + dx * kGauss8Node[i]);
    altitude[i] = point.altitude_km;
    mu_sun[i] = mu_sun_along(ray, radius_km, point.t_km, point.altitude_km);
    air[i] = densities(atmosphere, point.altitude_km) * (point.dt_dx * dx);
    ozone[i] = ozone_from_tangent(atmosphere, line, point.altitude_km, point.s_km) - ozone_begin;
    after.column += air[i] * kGauss8Weight[i];
  }
  vec3 passed = vec3(0.0, 0.0, 0.0);
  float passed_width = 0.0;
  for (int i = 0; i < 8; i++) {
    vec3 column = vec3(0.0, 0.0, 0.0);
    for (int j = 0; j < 8; j++) column += air[j] * kGauss8UpTo[8 * i + j];
    // A panel over many scale heights defeats the polynomial, which then dips below zero and would let light through:
    // half of what the weights alone say is a floor that a resolved panel never reaches.
    column = before.column + max(column, (passed + air[i] * (kGauss8Node[i] - passed_width)) * 0.5);
    column.z = ozone[i];
    passed += air[i] * kGauss8Weight[i];
    passed_width += kGauss8Weight[i];
    column += sun_columns(atmosphere, altitude[i], mu_sun[i], light_steps);
    vec3 source = scattering.rayleigh * air[i].x + scattering.mie * air[i].y;
    after.radiance += source * exp(-extinction(atmosphere, column)) * kGauss8Weight[i];
  }
  return after;
}

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
  // Only beyond the planet's centre is it dark: r mu_sun + t nu < 0.
  float crossing = -r * ray.mu_sun / (abs(ray.nu) > 1.0e-20 ? ray.nu : 1.0e-20);
  if (ray.nu > 0.0) leave = min(leave, crossing);
  if (ray.nu < 0.0) enter = max(enter, crossing);
  if (ray.nu == 0.0 && ray.mu_sun >= 0.0) leave = enter;
  return vec2(clamp(enter, 0.0, ray.length_km), clamp(leave, 0.0, ray.length_km));
}

// Count at distance t from the ray's first point.
float count_along(ScaleCount count, Line line, AirRay ray, float t_km) {
  if (count.straight) return t_km;
  float s = (line.ground_radius_km + ray.altitude_km) * ray.mu + t_km;
  float above = count.depth_km > 0.0 ? altitude_along(line.ground_radius_km, ray.altitude_km, ray.mu, t_km)
                                     : s * s / (line.b_km + sqrt(line.b_km * line.b_km + s * s));
  float x = count_at(count, max(above, 0.0));
  return s < 0.0 ? -x : x;
}

// Columns from the ray's first point to count x, by quadratures of their own (48 nodes at most).
vec3 columns_to_count(Atmosphere atmosphere, AirRay ray, Line line, ScaleCount count, float x) {
  CountedPoint point = point_at_count(count, ray, line, x);
  float s_start = (line.ground_radius_km + ray.altitude_km) * ray.mu;
  return columns_between(atmosphere, line, s_start, ray.altitude_km, max(point.s_km, s_start), point.altitude_km, 3);
}

// Estimated contribution to the radiance per count around x; column_to_eye is updated past the cell.
struct Glimpse {
  vec3 contribution;
  vec3 tau;
  vec3 column;
};

Glimpse glimpse(Atmosphere atmosphere, AirRay ray, Line line, ScaleCount count, ScatteringTowardsEye scattering, vec3 column,
                float x, float dx) {
  float radius_km = atmosphere.shape.x;
  CountedPoint point = point_at_count(count, ray, line, x);
  vec3 density = densities(atmosphere, point.altitude_km) * point.dt_dx;
  float mu_sun = mu_sun_along(ray, radius_km, point.t_km, point.altitude_km);
  Line light = line_through(radius_km, point.altitude_km, mu_sun, sqrt((1.0 - mu_sun) * (1.0 + mu_sun)));
  light.tangent_km = max(light.tangent_km, mu_sun < 0.0 ? 0.0 : light.tangent_km);
  vec3 sun = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH) sun.x = exponential_column_estimate(light, point.altitude_km, mu_sun, atmosphere.rayleigh.w);
  if (HAS_MIE) sun.y = exponential_column_estimate(light, point.altitude_km, mu_sun, atmosphere.mie_scattering.w);
  Glimpse result;
  vec3 tau = extinction(atmosphere, column + density * (0.5 * dx) + max(sun, vec3(0.0, 0.0, 0.0)));
  result.tau = tau;
  result.contribution = (scattering.rayleigh * density.x + scattering.mie * density.y) * exp(-tau);
  result.column = column + density * dx;
  return result;
}

#include "05_single_scattering/adapted_march.glsl"

#endif
