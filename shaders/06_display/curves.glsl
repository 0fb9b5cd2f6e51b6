// Tone curves: from exposed scene light x >= 0 (1 = what a screen would show as white if nothing were done) to the
// share of a screen's white, 0..1, both linear. sRGB's own curve comes after. Pure functions, no units.
//
// Domain: every float. tone_input() turns what is not a positive number (negative, -0, NaN) into 0 and what is beyond
// the largest half float, infinity included, into 65504: no curve can then overflow or divide infinity by infinity.
// Every curve is monotonic, and every result lies in [0, 1].
#ifndef WELKIN_CURVES_GLSL
#define WELKIN_CURVES_GLSL

const int kCurveClamp = 0;
const int kCurveReinhard = 1;
const int kCurveNarkowicz = 2;
const int kCurveHill = 3;
const int kCurveLottes = 4;
const int kCurveUchimura = 5;
const int kCurveUncharted2 = 6;
const int kCurves = 7;

float tone_input(float x) { return x > 0.0 ? min(x, 65504.0) : 0.0; }

// [reinhard]
// Reinhard et al. 2002, eq. 4: x (1 + x/w^2) / (1 + x), which is 1 at the white point w. Their eq. 3 is w = infinity.
float reinhard(float x, float white) { return min(x * (1.0 + x / (white * white)) / (1.0 + x), 1.0); }
// [/reinhard]

// [aces]
// Narkowicz 2016: a rational fit to the ACES reference rendering for a 100 nit screen, scaled so that 1 comes out at
// 0.8 (the unscaled reference is this curve at 0.6 x).
float aces_narkowicz(float x) { return min(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 1.0); }

// Hill's fit of the same reference for one channel. Its numerator is negative below x = 0.0032: black there.
float aces_hill_channel(float x) {
  return clamp((x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081), 0.0, 1.0);
}

// The reference works in wider primaries, where bright saturated light mixes towards white: into them (with the
// reference's desaturation folded in), through the curve, and back. Rows of both matrices sum to 1: grey stays grey.
vec3 aces_hill(vec3 c) {
  vec3 wide = vec3(0.59719 * c.x + 0.35458 * c.y + 0.04823 * c.z,
                   0.07600 * c.x + 0.90834 * c.y + 0.01566 * c.z,
                   0.02840 * c.x + 0.13383 * c.y + 0.83777 * c.z);
  wide = vec3(aces_hill_channel(wide.x), aces_hill_channel(wide.y), aces_hill_channel(wide.z));
  vec3 back = vec3(1.60475 * wide.x - 0.53108 * wide.y - 0.07367 * wide.z,
                   -0.10208 * wide.x + 1.10813 * wide.y - 0.00605 * wide.z,
                   -0.00327 * wide.x - 0.07276 * wide.y + 1.07602 * wide.z);
  return clamp(back, vec3(0.0, 0.0, 0.0), vec3(1.0, 1.0, 1.0));
}
// [/aces]

// [lottes]
// Lottes 2016: x^a / (x^(a d) b + c), a the contrast, d the shoulder; b and c follow from two demands: middle grey
// mid_in comes out as mid_out, and the brightest light `peak` as 1.
float lottes(float x, float contrast, float shoulder, float peak, float mid_in, float mid_out) {
  float ad = contrast * shoulder;
  float mid_a = pow(mid_in, contrast);
  float mid_ad = pow(mid_in, ad);
  float peak_a = pow(peak, contrast);
  float peak_ad = pow(peak, ad);
  float b = (peak_a * mid_out - mid_a) / ((peak_ad - mid_ad) * mid_out);
  float c = (peak_ad * mid_a - peak_a * mid_ad * mid_out) / ((peak_ad - mid_ad) * mid_out);
  if (x <= 0.0) return 0.0;  // not every driver computes pow(0, y) right
  return min(pow(x, contrast) / (pow(x, ad) * b + c), 1.0);
}
// [/lottes]

// [uchimura]
// Uchimura 2017 ("GT"): a toe m (x/m)^c + b up to m, a straight line of slope a over the share l of the way from m to
// the peak p, then a shoulder that approaches p. At m = 0 there is no toe, at l = 1 no shoulder; as printed the first
// is 0/0 and the second a division by p - s1 = 0.
float uchimura(float x, float p, float a, float m, float l, float c, float b) {
  float line_end = m + (p - m) * l / a;     // x at which the shoulder begins
  float rest = (p - m) * (1.0 - l);         // p - s1: the height of the shoulder
  float toe = m > 0.0 ? m * pow(min(x / m, 1.0), c) + b : b;
  float line = m + a * (x - m);
  float shoulder = rest > 1.0e-6 * p ? p - rest * exp(-a * max(x - line_end, 0.0) / rest) : p;
  float s = m > 0.0 ? clamp(x / m, 0.0, 1.0) : 1.0;
  float blended = s < 1.0 ? toe + (line - toe) * s * s * (3.0 - 2.0 * s) : line;
  return clamp(x >= line_end ? shoulder : blended, 0.0, 1.0);
}
// [/uchimura]

// [uncharted2]
// Hable 2010, ((x (A x + C B) + D E) / (x (A x + B) + D F)) - E/F with A..F = 0.15, 0.50, 0.10, 0.20, 0.02, 0.30.
// Printed so it subtracts two numbers near 1/15 where x is small; over one fraction E/F cancels by hand:
//   x (A (F - E) x + B (C F - E)) / (F (x (A x + B) + D F)).
float hable(float x) { return x * (0.042 * x + 0.005) / (0.3 * (x * (0.15 * x + 0.50) + 0.06)); }

// The same as printed, to demonstrate what it loses.
float hable_naive(float x) { return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.50) + 0.06) - 0.02 / 0.30; }

// With the published exposure bias of 2, scaled so that the white point 11.2 comes out as 1.
float uncharted2(float x) { return min(hable(2.0 * x) / 0.72512938, 1.0); }
// [/uncharted2]

// [curve]
// One channel through a curve as published, with the published defaults; x from tone_input().
float published_curve(int curve, float x) {
  if (curve == kCurveReinhard) return reinhard(x, 4.0);
  if (curve == kCurveNarkowicz) return aces_narkowicz(x);
  if (curve == kCurveHill) return aces_hill_channel(x);
  if (curve == kCurveLottes) return lottes(x, 1.6, 0.977, 8.0, 0.18, 0.267);
  if (curve == kCurveUchimura) return uchimura(x, 1.0, 1.0, 0.22, 0.4, 1.33, 0.0);
  if (curve == kCurveUncharted2) return uncharted2(x);
  return min(x, 1.0);
}

// The factor before a curve that makes middle grey, 0.18, come out as 0.18: then the meter's middle grey holds with
// every curve, and a comparison shows the curves' shapes and not that one is brighter.
float grey_gain(int curve) {
  if (curve == kCurveReinhard) return 1.19976387;
  if (curve == kCurveNarkowicz) return 0.72317081;
  if (curve == kCurveHill) return 1.46192601;
  if (curve == kCurveLottes) return 0.72032238;
  if (curve == kCurveUchimura) return 1.00523444;
  if (curve == kCurveUncharted2) return 1.46376142;
  return 1.0;
}

float tone_channel(int curve, float light) { return published_curve(curve, tone_input(light * grey_gain(curve))); }

// All three channels. Hill's curve mixes them; the others take each by itself.
vec3 tone_rgb(int curve, vec3 light) {
  if (curve != kCurveHill)
    return vec3(tone_channel(curve, light.x), tone_channel(curve, light.y), tone_channel(curve, light.z));
  float gain = grey_gain(curve);
  return aces_hill(vec3(tone_input(light.x * gain), tone_input(light.y * gain), tone_input(light.z * gain)));
}
// [/curve]

#endif
