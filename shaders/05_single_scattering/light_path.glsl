// Columns of air on straight paths: what sunlight crosses before it is scattered. Pure functions; km.
//
// A path is measured from its line's tangent point: s = r mu, altitude h(s) = h_p + s^2 / (b + sqrt(b^2 + s^2)).
// In units of sqrt(2 b H) the density near that point is exp(-y^2): every scale height H asks for nodes at other
// places, so each exponential constituent gets its own; ozone's tent is integrated piece by piece.
#ifndef WELKIN_LIGHT_PATH_GLSL
#define WELKIN_LIGHT_PATH_GLSL

#include "03_planet_and_rays/ray_sphere.glsl"
#include "04_air/medium.glsl"

// Gauss-Legendre nodes and weights of four points on [0, 1].
const float kGauss4Outer = 0.069431844202973712;
const float kGauss4Inner = 0.330009478207571868;
const float kGauss4WeightOuter = 0.173927422568726929;
const float kGauss4WeightInner = 0.326072577431273071;

float gauss4_node(int i) {
  float node = i == 0 || i == 3 ? kGauss4Outer : kGauss4Inner;
  return i < 2 ? node : 1.0 - node;
}

float gauss4_weight(int i) {
  return i == 0 || i == 3 ? kGauss4WeightOuter : kGauss4WeightInner;
}

struct Line {
  float ground_radius_km;
  float tangent_km;  // altitude of the point closest to the centre; negative below ground
  float b_km;        // its distance to the centre
};

// Line through altitude h with zenith cosine mu and sine.
Line line_through(float ground_radius_km, float altitude_km, float mu, float sine) {
  Line line;
  line.ground_radius_km = ground_radius_km;
  line.tangent_km = tangent_altitude(ground_radius_km, altitude_km, mu, sine);
  line.b_km = ground_radius_km + line.tangent_km;
  return line;
}

float chord_to(Line line, float altitude_km) {
  return half_chord(line.ground_radius_km, line.tangent_km, altitude_km);
}

// Integral of exp(-(h - h_a)/H) ds over s in [s_a, s_b], 0 <= s_a, h_a = h(s_a); `panels` of four Gauss nodes. On the
// map s = s_a + D z (bend + (1 - bend) z) nodes gather at s_a; bend = 1 where the line is horizontal at s_a.
float exponential_leg(Line line, float s_a, float s_b, float scale_height_km, float bend, int panels) {
  float length = s_b - s_a;
  float r_a = sqrt(line.b_km * line.b_km + s_a * s_a);
  float panel = 1.0 / float(panels);
  float sum = 0.0;
  for (int i = 0; i < 4 * panels; i++) {
    float z = (float(i / 4) + gauss4_node(i % 4)) * panel;
    float t = length * z * (bend + (1.0 - bend) * z);
    float rise = t * (2.0 * s_a + t);
    float above = rise / (r_a + sqrt(r_a * r_a + rise));
    sum += gauss4_weight(i % 4) * (bend + 2.0 * (1.0 - bend) * z) * exp(-above / scale_height_km);
  }
  return sum * length * panel;
}

// Integral of exp(-h/H) from a point at altitude h to the top, with about `steps` nodes. mu is the zenith cosine there.
// Paths are cut ten scale heights above their lowest point, where 5e-5 of the column is left.
float exponential_column(Line line, float altitude_km, float r_mu, float top_km, float scale_height_km, int steps) {
  float lowest_km = r_mu < 0.0 ? line.tangent_km : altitude_km;
  float s_start = abs(r_mu);
  float s_end = chord_to(line, min(top_km, lowest_km + 10.0 * scale_height_km));
  float ground_density = exp(-lowest_km / scale_height_km);
  int panels = max((steps + 3) / 4, 1);
  if (r_mu >= 0.0) {
    float bend = 1.0 - 1.4 * s_start / max(s_start + s_end, 1.0e-20);
    return ground_density * exponential_leg(line, s_start, max(s_end, s_start), scale_height_km, bend, panels);
  }
  // The path dips to the tangent point: fold it there. Both halves are equal up to s_start.
  int half_panels = max(panels / 2, 1);
  float fold = min(s_start, s_end);
  float middle = chord_to(line, lowest_km + 6.0 * scale_height_km);
  float folded;
  if (fold < chord_to(line, lowest_km + 0.56 * scale_height_km)) {
    // Too shallow a dip to be worth a panel of its own: straight across it.
    float start_density = exp(-(altitude_km - lowest_km) / scale_height_km);
    folded = start_density * exponential_leg(line, -fold, s_end, scale_height_km, 1.0, panels);
  } else if (fold < middle) {
    folded = 2.0 * exponential_leg(line, 0.0, fold, scale_height_km, 1.0, half_panels);
    if (fold < s_end) {
      float bend = 1.0 - 1.4 * fold / (fold + s_end);
      float h_fold_density = exp(-(altitude_km - lowest_km) / scale_height_km);
      folded += h_fold_density * exponential_leg(line, fold, s_end, scale_height_km, bend, half_panels);
    }
  } else {
    folded = 2.0 * exponential_leg(line, 0.0, fold, scale_height_km, 1.0, 2 * half_panels);
  }
  return ground_density * folded;
}

// Integral of the ozone tent from the tangent point to the altitude h on the line. On either side of the peak the
// tent is linear in altitude, altitude is nearly quadratic in s, and two Gauss nodes integrate cubics exactly.
float ozone_column_from_tangent(Atmosphere atmosphere, Line line, float altitude_km) {
  float column = 0.0;
  for (int side = 0; side < 2; side++) {
    float low = atmosphere.ozone.w - (side == 0 ? atmosphere.shape.z : 0.0);
    float h_a = max(low, line.tangent_km);
    float h_b = min(low + atmosphere.shape.z, altitude_km);
    if (h_b > h_a) {
      float s_a = chord_to(line, h_a);
      float length = chord_to(line, h_b) - s_a;
      for (int i = 0; i < 2; i++) {
        float t = length * (i == 0 ? 0.211324865405187118 : 0.788675134594812882);
        float rise = t * (2.0 * s_a + t);
        float r_a = line.ground_radius_km + h_a;
        float above = rise / (r_a + sqrt(r_a * r_a + rise));
        column += 0.5 * length * ozone_density(atmosphere, h_a + above);
      }
    }
  }
  return column;
}

// Integral of exp(-h/H) between two points of a line, s_a < s_b, either side of the tangent point or both.
float exponential_column_between(Line line, float s_a, float s_b, float scale_height_km, int panels) {
  float near_s = s_a < 0.0 && s_b > 0.0 ? 0.0 : min(abs(s_a), abs(s_b));
  float r_near = sqrt(line.b_km * line.b_km + near_s * near_s);
  float lowest_km = near_s > 0.0 ? line.tangent_km + near_s * near_s / (line.b_km + r_near) : line.tangent_km;
  float limit = chord_to(line, lowest_km + 12.0 * scale_height_km);
  float reach_a = min(abs(s_a), limit);
  float reach_b = min(abs(s_b), limit);
  float column = 0.0;
  if (near_s > 0.0 || s_a >= 0.0 || s_b <= 0.0) {
    float far_s = max(max(reach_a, reach_b), near_s);
    column = exponential_leg(line, near_s, far_s, scale_height_km, 1.0 - 1.4 * near_s / (near_s + far_s), panels);
  } else {
    column = exponential_leg(line, 0.0, reach_a, scale_height_km, 1.0, panels) +
             exponential_leg(line, 0.0, reach_b, scale_height_km, 1.0, panels);
  }
  return exp(-lowest_km / scale_height_km) * column;
}

// The same with the sign of s, so that the column between two points of a line is a difference. 0 if there is no ozone.
float ozone_from_tangent(Atmosphere atmosphere, Line line, float altitude_km, float s_km) {
  if (!HAS_OZONE) return 0.0;
  float column = ozone_column_from_tangent(atmosphere, line, altitude_km);
  return s_km < 0.0 ? -column : column;
}

// Columns (rayleigh, mie, ozone) in km from a lit point at altitude h to the top, towards the zenith cosine mu_sun.
// The planet is never in the way: a tangent point below the ground is rounding and counts as touching it.
vec3 sun_columns(Atmosphere atmosphere, float altitude_km, float mu_sun, int steps) {
  float radius_km = atmosphere.shape.x;
  float top_km = atmosphere.shape.y;
  float r_mu = (radius_km + altitude_km) * mu_sun;
  Line line = line_through(radius_km, altitude_km, mu_sun, sqrt(max((1.0 - mu_sun) * (1.0 + mu_sun), 0.0)));
  if (mu_sun < 0.0 && line.tangent_km < 0.0) {
    line.tangent_km = 0.0;
    line.b_km = radius_km;
    r_mu = -chord_to(line, altitude_km);
  }
  vec3 column = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH) column.x = exponential_column(line, altitude_km, r_mu, top_km, atmosphere.rayleigh.w, steps);
  if (HAS_MIE) column.y = exponential_column(line, altitude_km, r_mu, top_km, atmosphere.mie_scattering.w, steps);
  if (HAS_OZONE) {
    float here = ozone_column_from_tangent(atmosphere, line, altitude_km);
    column.z = ozone_column_from_tangent(atmosphere, line, top_km) + (r_mu < 0.0 ? here : -here);
  }
  return max(column, vec3(0.0, 0.0, 0.0));
}

// Columns (rayleigh, mie, ozone) in km between two points of a line at s_a <= s_b, where the altitudes are h_a and h_b.
vec3 columns_between(Atmosphere atmosphere, Line line, float s_a, float h_a, float s_b, float h_b, int panels) {
  vec3 column = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH) column.x = exponential_column_between(line, s_a, s_b, atmosphere.rayleigh.w, panels);
  if (HAS_MIE) column.y = exponential_column_between(line, s_a, s_b, atmosphere.mie_scattering.w, panels);
  if (HAS_OZONE) {
    float from_a = ozone_column_from_tangent(atmosphere, line, h_a);
    float from_b = ozone_column_from_tangent(atmosphere, line, h_b);
    column.z = (s_b < 0.0 ? -from_b : from_b) - (s_a < 0.0 ? -from_a : from_a);
  }
  return max(column, vec3(0.0, 0.0, 0.0));
}

// The same columns in closed form to about 10 %: enough to say where the light is, not how much.
// H rho(h) c / ((c - 1) mu + 1), c = sqrt(pi r / 2 H) (Schueler 2012), folded at the tangent point for mu < 0.
float exponential_column_estimate(Line line, float altitude_km, float mu, float scale_height_km) {
  float r = line.ground_radius_km + altitude_km;
  float c = sqrt(1.5707963267948966 * r / scale_height_km);
  float upward = scale_height_km * exp(-altitude_km / scale_height_km) * c / ((c - 1.0) * abs(mu) + 1.0);
  if (mu >= 0.0) return upward;
  float c_tangent = sqrt(1.5707963267948966 * line.b_km / scale_height_km);
  return 2.0 * scale_height_km * exp(-line.tangent_km / scale_height_km) * c_tangent - upward;
}

#endif
