// The multiple scattering table: its texel maps and its look-ups. Pure functions; km.
//
// The including file defines before this one: const int MS_METHOD (kMethod… below), MS_MAP (kMap…), MS_SIZE (texels per
// side), and vec3 read_multiple_scattering_table(vec2 uv), which returns the filtered texels.
// Texture axis x: mu_sun; y: altitude. table_layers() layers are stacked in y.
#ifndef WELKIN_MULTIPLE_SCATTERING_TABLE_GLSL
#define WELKIN_MULTIPLE_SCATTERING_TABLE_GLSL

#include "09_multiple_scattering_lut/moments.glsl"

const int kMethodPublished = 0;  // Psi = L2 / (1 - f): one layer
const int kMethodIsotropic = 1;  // orders gathered one by one, light taken as isotropic: reads mean, irradiance
const int kMethodMoments = 2;    // the same with the first moments and delta scaling: seven layers

const int kMapPublished = 0;  // linear in altitude and cosine, values stored as they are
const int kMapHorizon = 1;    // both denser where light changes fast, the mean stored as its logarithm

const int kLayers = 7;  // mean, z, x, zz, xz, xx_yy, irradiance
const float kMinMean = 1.0e-30;
const float kMuScale = 0.4;

int table_layers(int method) { return method == kMethodPublished ? 1 : kLayers; }

// [maps]
// The unit square from (mu_sun, altitude), and back. The horizon map, with c = kMuScale:
//   u = 1/2 + (1 + c) mu_sun / (2 (|mu_sun| + c)),   v = sqrt(h / top).
vec2 table_unit(int map, float top_km, float altitude_km, float mu_sun) {
  float height = clamp(altitude_km / top_km, 0.0, 1.0);
  if (map == kMapPublished) return vec2(0.5 + 0.5 * mu_sun, height);
  return vec2(0.5 + 0.5 * (1.0 + kMuScale) * mu_sun / (abs(mu_sun) + kMuScale), sqrt(height));
}

vec2 table_point(int map, float top_km, vec2 unit) {  // x: mu_sun, y: altitude
  if (map == kMapPublished) return vec2(2.0 * unit.x - 1.0, top_km * unit.y);
  float w = 2.0 * unit.x - 1.0;
  return vec2(kMuScale * w / (1.0 + kMuScale - abs(w)), top_km * unit.y * unit.y);
}

// From the unit square to texture coordinates, its edges at the centres of the outer texels, and from a texel to the
// unit square: exact inverses.
vec2 table_uv(vec2 unit, float size) { return unit * (1.0 - 1.0 / size) + vec2(0.5, 0.5) / size; }
vec2 table_unit_of_texel(vec2 texel, float size) { return texel / (size - 1.0); }
// [/maps]

// [read]
vec3 read_layer(vec2 uv, int layer) {
  return read_multiple_scattering_table(vec2(uv.x, (uv.y + float(layer)) / float(table_layers(MS_METHOD))));
}

vec3 decode_mean(vec3 stored) { return MS_MAP == kMapPublished ? stored : exp2(stored); }
vec3 encode_mean(vec3 mean) {
  return MS_MAP == kMapPublished ? mean : log2(max(mean, vec3(kMinMean, kMinMean, kMinMean)));
}

// Psi: mean over direction of the radiance that has been scattered or reflected at least once, per unit of solar
// irradiance. Its in-scattering, sigma_s Psi for an isotropic phase function, is the light of all orders from the
// second on.
vec3 multiple_scattering(Atmosphere atmosphere, float altitude_km, float mu_sun) {
  vec2 uv = table_uv(table_unit(MS_MAP, atmosphere.top_km, altitude_km, mu_sun), float(MS_SIZE));
  return decode_mean(read_layer(uv, 0));
}

Moments multiple_scattering_moments(Atmosphere atmosphere, float altitude_km, float mu_sun) {
  vec2 uv = table_uv(table_unit(MS_MAP, atmosphere.top_km, altitude_km, mu_sun), float(MS_SIZE));
  Moments light;
  light.mean = decode_mean(read_layer(uv, 0));
  light.z = vec3(0.0, 0.0, 0.0);
  light.x = vec3(0.0, 0.0, 0.0);
  light.zz = vec3(0.33333333333333333, 0.33333333333333333, 0.33333333333333333);
  light.xz = vec3(0.0, 0.0, 0.0);
  light.xx_yy = vec3(0.0, 0.0, 0.0);
  light.irradiance = vec3(1.0, 1.0, 1.0);
  if (MS_METHOD == kMethodMoments) {
    light.z = read_layer(uv, 1);
    light.x = read_layer(uv, 2);
    light.zz = read_layer(uv, 3);
    light.xz = read_layer(uv, 4);
    light.xx_yy = read_layer(uv, 5);
  }
  return light;
}

// Irradiance of a horizontal plane by the sky without the sun, per unit of solar irradiance. The published method
// stores none; pi Psi is that of an isotropic sky with the same mean.
vec3 sky_irradiance(Atmosphere atmosphere, float altitude_km, float mu_sun) {
  vec2 uv = table_uv(table_unit(MS_MAP, atmosphere.top_km, altitude_km, mu_sun), float(MS_SIZE));
  vec3 isotropic = decode_mean(read_layer(uv, 0)) * 3.14159265358979324;
  if (MS_METHOD == kMethodPublished) return isotropic;
  return isotropic * read_layer(uv, kLayers - 1);
}
// [/read]

#endif
