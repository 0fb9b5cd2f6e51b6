// The march along a ray: what each step adds, and the rules that fix where steps are. Pure functions; km.
//
//   L = E_sun * integral of  T(eye, t) [ beta_R rho_R P_R + beta_M rho_M P_M ] T(t, sun) V(t) dt
//
// V = 0 in the planet's shadow, a cylinder: the sun is a point. The ray is cut into segments that tile it exactly; a
// rule says where the cuts are and where in each segment the sample sits.
#ifndef WELKIN_MARCH_GLSL
#define WELKIN_MARCH_GLSL

#include "05_single_scattering/light_path.glsl"

// [rules]
const int kRuleLeft = 0;           // sample at the start of each of N equal segments
const int kRuleMidpoint = 1;       // in the middle
const int kRuleHillaire = 2;       // at 0.3 of the segment (Hillaire 2020)
const int kRuleNonuniform = 3;     // segments [(i/N)^2, ((i+1)/N)^2] L, sample in the middle
const int kRuleGaussLegendre = 4;  // panels of four Gauss-Legendre nodes; a segment's length is its weight
const int kRuleAdapted = 5;        // panels of four, where the light is, in a coordinate that counts scale heights
// [/rules]

struct RayLight {
  vec3 radiance;
  vec3 transmittance;
};

// [segment]
// Where a segment's sample sits and how long the segment is, as fractions of the path.
struct Segment {
  float sample_at;
  float width;
};

// Segment i of n. The widths of a rule sum to 1 (for Gauss-Legendre when n is a multiple of four).
Segment quadrature_segment(int rule, int i, int n) {
  Segment segment;
  segment.width = 1.0 / float(n);
  float begin = float(i) * segment.width;
  segment.sample_at = begin;
  if (rule == kRuleMidpoint) segment.sample_at = begin + 0.5 * segment.width;
  if (rule == kRuleHillaire) segment.sample_at = begin + 0.3 * segment.width;
  if (rule == kRuleNonuniform) {
    float end = float(i + 1) * segment.width;
    segment.width = (end - begin) * (end + begin);
    segment.sample_at = begin * begin + 0.5 * segment.width;
  }
  if (rule == kRuleGaussLegendre) {
    float panel = 4.0 / float(n);
    segment.width = panel * kGauss4Weight[i % 4];
    segment.sample_at = panel * (float(i / 4) + kGauss4Node[i % 4]);
  }
  return segment;
}
// [/segment]

// [mean_transmittance]
// (1 - exp(-tau)) / tau, the mean transmittance of a homogeneous segment; a series where the quotient would cancel.
float mean_transmittance(float tau) {
  float series = 1.0 - tau * (0.5 - tau * (0.16666666666666667 - tau * 0.041666666666666667));
  return tau < 0.05 ? series : (1.0 - exp(-tau)) / max(tau, 0.05);  // computes both: no branch
}
// [/mean_transmittance]

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

// [enter_air]
// Clips the ray to the atmosphere. From space the first point is the entry; its zenith angles follow from the turn of
// the zenith, theta_camera - theta_entry, whose cosine and sine are sums of products of order one: no digits are lost.
AirRay enter_air(Atmosphere atmosphere, float camera_altitude_km, vec3 view, vec3 sun) {
  float radius_km = atmosphere.ground_radius_km;
  float top_km = atmosphere.top_km;
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
// [/enter_air]

// [shadow]
// Zenith cosine of the sun at distance t, where the altitude is h.
float mu_sun_along(AirRay ray, float ground_radius_km, float t_km, float altitude_km) {
  float along_sun = (ground_radius_km + ray.altitude_km) * ray.mu_sun + t_km * ray.nu;
  return clamp(along_sun / (ground_radius_km + altitude_km), -1.0, 1.0);
}

bool sun_above_horizon(float ground_radius_km, float altitude_km, float mu_sun) {
  if (mu_sun >= 0.0) return true;
  return tangent_altitude(ground_radius_km, altitude_km, mu_sun, sqrt((1.0 - mu_sun) * (1.0 + mu_sun))) >= 0.0;
}
// [/shadow]

// [fixed_march]
// Optical depth from a lit point at altitude h to the sun, by the rule of the view (or looked up: see light_path.glsl).
vec3 marched_optical_depth_to_sun(Atmosphere atmosphere, float altitude_km, float mu_sun, int light_steps, int rule) {
#ifdef SUN_OPTICAL_DEPTH
  return SUN_OPTICAL_DEPTH(atmosphere, altitude_km, mu_sun);
#else
  float radius_km = atmosphere.ground_radius_km;
  float light_length = distance_to_shell_from_inside(radius_km, altitude_km, mu_sun, atmosphere.top_km);
  vec3 column = vec3(0.0, 0.0, 0.0);
  for (int j = 0; j < light_steps; j++) {
    Segment step = quadrature_segment(rule, j, light_steps);
    float h = altitude_along(radius_km, altitude_km, mu_sun, step.sample_at * light_length);
    column += densities(atmosphere, max(h, 0.0)) * (step.width * light_length);
  }
  return extinction(atmosphere, column);
#endif
}

// The march of the rules that fix their samples beforehand, on the ray and on the paths to the sun. Within a segment
// source and extinction are taken as constant: it adds S dt (1 - exp(-tau)) / tau.
RayLight fixed_march(Atmosphere atmosphere, AirRay ray, ScatteringTowardsEye scattering, int view_steps,
                     int light_steps, int rule) {
  float radius_km = atmosphere.ground_radius_km;
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
      vec3 tau_sun = marched_optical_depth_to_sun(atmosphere, altitude, mu_sun, light_steps, rule);
      vec3 source = (scattering.rayleigh * density.x + scattering.mie * density.y) * exp(-tau_sun);
      vec3 mean = vec3(mean_transmittance(tau.x), mean_transmittance(tau.y), mean_transmittance(tau.z));
      light.radiance += light.transmittance * source * mean * dt;
    }
    light.transmittance *= exp(-tau);
  }
  return light;
}
// [/fixed_march]

#endif
