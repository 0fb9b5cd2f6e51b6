// The light meter: a histogram of log2 luminance, and the exposure it asks for.
//
// Bin 0 holds what has no logarithm: black, negative, NaN. Bins 1..255 divide 50 stops evenly, 0.196 stops each; what
// is darker or brighter, infinity included, goes to the outermost. So every pixel is in exactly one bin.
#ifndef WELKIN_METER_GLSL
#define WELKIN_METER_GLSL

#include "06_display/color.glsl"
#include "06_display/noise.glsl"

const uint kMeterBins = 256u;
const float kMeterDarkest = -30.0;    // log2 of radiance per unit solar irradiance: a sky lit by stars alone
const float kMeterBrightest = 20.0;   // the sun's disc is 2^14; the rest is room for brighter suns
const float kMeterStops = 50.0;       // brightest - darkest: log2(max) - log2(min)

// [bin]
// noise in [0, 1) chooses between the two nearest bins, the nearer one more often: the mean over a picture then changes
// smoothly, although bins are steps. With noise = 0.5 it is the bin the value lies in.
uint meter_bin(float luminance, float noise) {
  if (!(luminance > 0.0)) return 0u;
  float position = (log2(min(luminance, 1.0e38)) - kMeterDarkest) * (255.0 / kMeterStops);
  return 1u + uint(clamp(floor(position + noise - 0.5), 0.0, 254.0));
}

// log2 luminance in the middle of bins 1..255.
float meter_value(uint bin) { return kMeterDarkest + (float(bin) - 0.5) * (kMeterStops / 255.0); }
// [/bin]

// [share]
// Of the pixels of a bin, how many are counted: those whose rank, darkest first, lies between two limits. A bin that a
// limit cuts counts in part, so the mean moves smoothly when a limit passes from one bin into the next.
float counted_share(float before, float here, float low, float high) {
  return max(min(before + here, high) - max(before, low), 0.0);
}
// [/share]

// [target]
// log2 of the exposure factor for a mean of log2 luminance. adaptation = 1: the mean always comes out at middle grey.
// Below 1 only a scene at the pivot does: a brighter one comes out brighter and a darker one darker, by (1 -
// adaptation) of its distance from the pivot, as for an eye.
const float kMiddleGrey = -2.4739312;  // log2(0.18)
const float kPivot = -13.0;            // mean log2 luminance of a sky in deep twilight

float meter_target(float mean_log2, float adaptation) {
  return kMiddleGrey - kPivot - adaptation * (mean_log2 - kPivot);
}

// One step of the adaptation: the way to the target shrinks by the factor exp(-dt/tau), whatever dt. The shares gone,
// 1 - exp(-dt/tau), come from outside; a falling exposure means that it got brighter.
float adapt(float exposure, float target, float to_bright, float to_dark) {
  float way = target - exposure;
  return exposure + way * (way < 0.0 ? to_bright : to_dark);
}
// [/target]

#endif
