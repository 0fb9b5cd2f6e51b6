// Columns of air on straight paths: what sunlight crosses before it is scattered. Pure functions; km.
//
// A path is measured from its line's tangent point: s = r mu, altitude h(s) = h_p + s^2 / (b + sqrt(b^2 + s^2)). Near
// that point the density falls as exp(-y^2), y = s / sqrt(2 b H): its integral is an error function, and farther out it
// stays close to one. Ozone's tent is integrated piece by piece.
#ifndef WELKIN_LIGHT_PATH_GLSL
#define WELKIN_LIGHT_PATH_GLSL

#include "03_planet_and_rays/ray_sphere.glsl"
#include "04_air/medium.glsl"

// Gauss-Legendre nodes and weights of four points on [0, 1]. All four are evaluated at once: no loop, no array.
const vec4 kGauss4Node = vec4(0.069431844202973712, 0.330009478207571868, 0.669990521792428132, 0.930568155797026288);
const vec4 kGauss4Weight = vec4(0.173927422568726929, 0.326072577431273071, 0.326072577431273071, 0.173927422568726929);

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
float exponential_panels(Line line, float s_a, float s_b, float scale_height_km, float bend, int panels) {
  float span = s_b - s_a;
  float r_a = sqrt(line.b_km * line.b_km + s_a * s_a);
  float dz = 1.0 / float(panels);
  float sum = 0.0;
  for (int p = 0; p < panels; p++) {
    vec4 z = (kGauss4Node + float(p)) * dz;
    vec4 t = z * (z * (1.0 - bend) + bend) * span;
    vec4 rise = t * (t + 2.0 * s_a);
    vec4 above = rise / (sqrt(rise + r_a * r_a) + r_a);
    sum += dot(kGauss4Weight * (z * (2.0 - 2.0 * bend) + bend), exp(above * (-1.0 / scale_height_km)));
  }
  return sum * span * dz;
}

// [closed_form]
// sqrt(pi) exp(y^2) erfc(y) for y >= 0, relative error below 5e-6: t times a polynomial in t = 1 / (1 + 0.55 y), fitted
// by least squares at Chebyshev nodes. It tends to 1/y.
float scaled_erfc(float y) {
  float t = 1.0 / (1.0 + 0.55 * y);
  return t * (0.5500016937 + t * (0.5497359168 + t * (0.4732278677 + t * (0.2440005334 +
         t * (0.3169050620 + t * (-0.5373271221 + t * 0.1759175966))))));
}

// Integral of exp(-h/H) from the altitude h on the line outward to infinity, in closed form. s is the distance from the
// tangent point: y = s / sqrt(H (r + b)) keeps its digits close to that point, where (h - h_p) / H has none left.
//   With u = (h' - h_p) / H above the tangent point, ds = H G(u) u^(-1/2) du / sqrt(H),
//   G(u) = (b + H u) / sqrt(2 b + H u), and G hardly changes over the one scale height that matters:
//   G(u) = G(z) (1 + k (u - z)), z = (h - h_p) / H = y^2.
//   C = exp(-h/H) sqrt(H / (r + b)) r [ I_0 + k I_1 ],    k = H / r - H / (2 (r + b)),
//   I_0 = sqrt(pi) exp(z) erfc(y),   I_1 = y + (1/2 - z) I_0.            Error of the order (H/r)^2: 1e-5 on Earth.
float column_outward(Line line, float altitude_km, float s_km, float scale_height_km) {
  float r = line.ground_radius_km + altitude_km;
  float sum = r + line.b_km;
  float y = s_km / sqrt(scale_height_km * sum);
  float i_0 = scaled_erfc(y);
  float i_1 = y + (0.5 - y * y) * i_0;
  float k = scale_height_km * (1.0 / r - 0.5 / sum);
  return exp(-altitude_km / scale_height_km) * sqrt(scale_height_km / sum) * r * (i_0 + k * i_1);
}

// The same from a point at altitude h to the top. Where r_mu, r times the zenith cosine, is below 0, the path goes down
// to the tangent point first: twice the column from there, less the part behind the start.
float exponential_column_to_top(Line line, float altitude_km, float r_mu, float top_km, float scale_height_km) {
  float column = column_outward(line, altitude_km, abs(r_mu), scale_height_km);
  if (r_mu < 0.0) column = 2.0 * column_outward(line, line.tangent_km, 0.0, scale_height_km) - column;
  // Takes away what lies above the top, where the column has air. Below 12 scale heights that is not negligible.
  if (top_km < 12.0 * scale_height_km)
    column -= column_outward(line, max(top_km, altitude_km), chord_to(line, top_km), scale_height_km);
  return max(column, 0.0);
}
// [/closed_form]

// Integral of the ozone tent over the line's points between two altitudes, both on one side of the tangent point. Below
// and above the peak the tent is linear in altitude, altitude is nearly quadratic in s, and Simpson integrates cubics.
float ozone_column_between(Atmosphere atmosphere, Line line, float low_km, float high_km) {
  if (high_km <= atmosphere.ozone_peak_km - atmosphere.ozone_half_width_km ||
      low_km >= atmosphere.ozone_peak_km + atmosphere.ozone_half_width_km)
    return 0.0;
  float h_0 = clamp(atmosphere.ozone_peak_km - atmosphere.ozone_half_width_km, low_km, high_km);
  float h_1 = clamp(atmosphere.ozone_peak_km, low_km, high_km);
  float h_2 = clamp(atmosphere.ozone_peak_km + atmosphere.ozone_half_width_km, low_km, high_km);
  float s_0 = chord_to(line, h_0);
  float s_1 = chord_to(line, h_1);
  float s_2 = chord_to(line, h_2);
  float a = 0.5 * (s_0 + s_1);
  float b = 0.5 * (s_1 + s_2);
  float h_a = line.tangent_km + a * a / (line.b_km + sqrt(line.b_km * line.b_km + a * a) + 1.0e-20);
  float h_b = line.tangent_km + b * b / (line.b_km + sqrt(line.b_km * line.b_km + b * b) + 1.0e-20);
  float middle = ozone_density(atmosphere, h_1);
  return ((s_1 - s_0) * (ozone_density(atmosphere, h_0) + 4.0 * ozone_density(atmosphere, h_a) + middle) +
          (s_2 - s_1) * (middle + 4.0 * ozone_density(atmosphere, h_b) + ozone_density(atmosphere, h_2))) *
         0.16666666666666667;
}

float ozone_column_from_tangent(Atmosphere atmosphere, Line line, float altitude_km) {
  return ozone_column_between(atmosphere, line, line.tangent_km, max(altitude_km, line.tangent_km));
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
    column = exponential_panels(line, near_s, far_s, scale_height_km, 1.0 - 1.4 * near_s / (near_s + far_s), panels);
  } else {
    column = exponential_panels(line, 0.0, reach_a, scale_height_km, 1.0, panels) +
             exponential_panels(line, 0.0, reach_b, scale_height_km, 1.0, panels);
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
vec3 sun_columns(Atmosphere atmosphere, float altitude_km, float mu_sun) {
  float radius_km = atmosphere.ground_radius_km;
  float top_km = atmosphere.top_km;
  float r_mu = (radius_km + altitude_km) * mu_sun;
  Line line = line_through(radius_km, altitude_km, mu_sun, sqrt(max((1.0 - mu_sun) * (1.0 + mu_sun), 0.0)));
  if (mu_sun < 0.0 && line.tangent_km < 0.0) {
    line.tangent_km = 0.0;
    line.b_km = radius_km;
    r_mu = -chord_to(line, altitude_km);
  }
  vec3 column = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH)
    column.x = exponential_column_to_top(line, altitude_km, r_mu, top_km, atmosphere.rayleigh_scale_height_km);
  if (HAS_MIE) column.y = exponential_column_to_top(line, altitude_km, r_mu, top_km, atmosphere.mie_scale_height_km);
  if (HAS_OZONE) {
    column.z = ozone_column_between(atmosphere, line, altitude_km, max(top_km, altitude_km));
    if (r_mu < 0.0) column.z += 2.0 * ozone_column_from_tangent(atmosphere, line, altitude_km);
  }
  return max(column, vec3(0.0, 0.0, 0.0));
}

// Optical depth of `column` and of the way from there, a lit point at altitude h, to the sun. A later chapter looks the
// second part up in a table: it defines SUN_OPTICAL_DEPTH(atmosphere, altitude_km, mu_sun), a vec3.
vec3 optical_depth_and_to_sun(Atmosphere atmosphere, vec3 column, float altitude_km, float mu_sun) {
#ifdef SUN_OPTICAL_DEPTH
  return extinction(atmosphere, column) + SUN_OPTICAL_DEPTH(atmosphere, altitude_km, mu_sun);
#else
  return extinction(atmosphere, column + sun_columns(atmosphere, altitude_km, mu_sun));
#endif
}

// Columns (rayleigh, mie, ozone) in km between two points of a line at s_a <= s_b, where the altitudes are h_a and h_b.
vec3 columns_between(Atmosphere atmosphere, Line line, float s_a, float h_a, float s_b, float h_b, int panels) {
  vec3 column = vec3(0.0, 0.0, 0.0);
  if (HAS_RAYLEIGH) column.x = exponential_column_between(line, s_a, s_b, atmosphere.rayleigh_scale_height_km, panels);
  if (HAS_MIE) column.y = exponential_column_between(line, s_a, s_b, atmosphere.mie_scale_height_km, panels);
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
