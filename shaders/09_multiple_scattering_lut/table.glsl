// The table of light scattered before: its texel maps and how it is read. Pure functions; km.
//
// The including file defines, before this one: const int MS_METHOD (kMethod… below), MS_MAP (kMap…), MS_SIZE (texels a
// side), and vec3 read_multiple_scattering_table(vec2 uv), which filters what the table stores.
// x: sun's zenith cosine. y: altitude; the layers stand above each other, table_layers() of them.
#ifndef WELKIN_MULTIPLE_SCATTERING_TABLE_GLSL
#define WELKIN_MULTIPLE_SCATTERING_TABLE_GLSL

#include "09_multiple_scattering_lut/moments.glsl"

const int kMethodPublished = 0;  // Psi = L2 / (1 - f): one layer
const int kMethodIsotropic = 1;  // orders gathered one after the other, light taken as isotropic: layers mean and irradiance count
const int kMethodMoments = 2;    // the same with the first moments and the forward peak taken out: seven layers

const int kMapPublished = 0;  // altitude and cosine evenly, values as they are
const int kMapHorizon = 1;    // both denser where light changes fast, the mean by its logarithm

const int kLayers = 7;  // mean, z, x, zz, xz, xx_yy, irradiance
const float kLeastMean = 1.0e-30;
const float kMuScale = 0.4;

int table_layers(int method) { return method == kMethodPublished ? 1 : kLayers; }

// [maps]
// (0 … 1)^2 from (cosine, altitude), and back. The horizon map: u = 1/2 + (1 + c) mu / (2 (|mu| + c)), v = sqrt(h / top).
vec2 table_unit(int map, float top_km, float altitude_km, float mu_sun) {
  float height = clamp(altitude_km / top_km, 0.0, 1.0);
  if (map == kMapPublished) return vec2(0.5 + 0.5 * mu_sun, height);
  return vec2(0.5 + 0.5 * (1.0 + kMuScale) * mu_sun / (abs(mu_sun) + kMuScale), sqrt(height));
}

vec2 table_point(int map, float top_km, vec2 unit) {  // x: cosine, y: altitude
  if (map == kMapPublished) return vec2(2.0 * unit.x - 1.0, top_km * unit.y);
  float w = 2.0 * unit.x - 1.0;
  return vec2(kMuScale * w / (1.0 + kMuScale - abs(w)), top_km * unit.y * unit.y);
}

// Unit square to the centres of the outer texels, and back: exact inverses of each other.
vec2 table_uv(vec2 unit, float size) { return unit * (1.0 - 1.0 / size) + vec2(0.5, 0.5) / size; }
vec2 table_unit_of_texel(vec2 texel, float size) { return texel / (size - 1.0); }
// [/maps]

// [read]
vec3 read_layer(vec2 uv, int layer) {
  return read_multiple_scattering_table(vec2(uv.x, (uv.y + float(layer)) / float(table_layers(MS_METHOD))));
}

vec3 decode_mean(vec3 stored) { return MS_MAP == kMapPublished ? stored : exp2(stored); }
vec3 encode_mean(vec3 mean) { return MS_MAP == kMapPublished ? mean : log2(max(mean, vec3(kLeastMean, kLeastMean, kLeastMean))); }

// Mean radiance of the light that arrives having been scattered at least once (or reflected by the ground), per unit of
// solar irradiance: Psi. What the air scatters of it, sigma_s Psi for an isotropic phase function, is all orders from the second on.
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

// Irradiance of a horizontal plane by the sky (not the sun), per unit of solar irradiance. The published method has none:
// pi times Psi is what an isotropic sky of that mean would give.
vec3 sky_irradiance(Atmosphere atmosphere, float altitude_km, float mu_sun) {
  vec2 uv = table_uv(table_unit(MS_MAP, atmosphere.top_km, altitude_km, mu_sun), float(MS_SIZE));
  vec3 isotropic = decode_mean(read_layer(uv, 0)) * 3.14159265358979324;
  if (MS_METHOD == kMethodPublished) return isotropic;
  return isotropic * read_layer(uv, kLayers - 1);
}
// [/read]

#endif
