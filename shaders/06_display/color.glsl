// Colour: luminance, xyY, and the screen's own curve. Linear RGB with the primaries and white of Rec. 709 / sRGB (IEC
// 61966-2-1); the book's channels (680, 550, 440 nm) are shown as if they were these primaries.
#ifndef WELKIN_COLOR_GLSL
#define WELKIN_COLOR_GLSL

// [luminance]
// Y of linear Rec. 709 light.
float luminance(vec3 rgb) { return 0.2126729 * rgb.x + 0.7151522 * rgb.y + 0.0721750 * rgb.z; }
// [/luminance]

// [xyY]
// x = X/(X+Y+Z), y = Y/(X+Y+Z), Y. Of black that is 0/0: black gets the chromaticity of the white point (D65), so that
// the way there and back is black again.
vec3 xyY_from_rgb(vec3 rgb) {
  float X = 0.4124564 * rgb.x + 0.3575761 * rgb.y + 0.1804375 * rgb.z;
  float Y = luminance(rgb);
  float Z = 0.0193339 * rgb.x + 0.1191920 * rgb.y + 0.9503041 * rgb.z;
  float sum = X + Y + Z;
  if (!(sum > 1.0e-30)) return vec3(0.3127, 0.3290, 0.0);
  return vec3(X / sum, Y / sum, Y);
}

// Y = 0 is black whatever x and y are; y = 0 is no colour that light can have, and gives black too.
vec3 rgb_from_xyY(vec3 xyY) {
  if (!(xyY.z > 0.0) || !(xyY.y > 0.0)) return vec3(0.0, 0.0, 0.0);
  float X = xyY.x * (xyY.z / xyY.y);
  float Y = xyY.z;
  float Z = max(1.0 - xyY.x - xyY.y, 0.0) * (xyY.z / xyY.y);
  return vec3(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, -0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z,
              0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z);
}
// [/xyY]

// [gamut]
// Light of luminance Y <= 1 as channels that a screen can show: where one passes 1, the colour moves towards the grey
// of the same luminance just as far as it must. Where Y = 1 it becomes white; cutting the channel instead would lose
// light.
vec3 fit_gamut(vec3 rgb, float Y) {
  float largest = max(rgb.x, max(rgb.y, rgb.z));
  float share = largest > 1.0 ? max(1.0 - Y, 0.0) / (largest - min(Y, 1.0)) : 1.0;
  return vec3(Y + (rgb.x - Y) * share, Y + (rgb.y - Y) * share, Y + (rgb.z - Y) * share);
}
// [/gamut]

// [srgb]
// Linear 0..1 to what an sRGB screen is sent, 0..1.
float srgb_encode(float linear) {
  float x = clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(max(x, 0.0031308), 0.41666666666666667) - 0.055;
}
// [/srgb]

#endif
