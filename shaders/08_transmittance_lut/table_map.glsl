// Maps paths to texture coordinates of the transmittance table, and back. Pure functions; km.
//
// A texel holds one path, from altitude h along the zenith cosine mu to the top of the air. The including file defines
// the mapping and what a texel holds (TABLE_MAPPING, TABLE_STORED: const int). R is the ground's radius, top the
// altitude of the top of the air:
//   rho = sqrt(h (2R + h))            distance to the horizon;        H = rho at the top (rho_top)
//   d   = distance to the top along mu, at least d_min = top - h, reached straight up
//   y   = rho / H                                                       both mappings
//   x   = (d - d_min) / (rho + H - d_min)     published: mu from 1 down to the ray that touches the ground
//   x   = (d - d_min) / (d_0 - d_min)         folded: mu from 1 down to 0 only, d_0 = sqrt((top - h)(2R + top + h))
#ifndef WELKIN_TABLE_MAP_GLSL
#define WELKIN_TABLE_MAP_GLSL

#include "03_planet_and_rays/ray_sphere.glsl"
#include "interop/atmosphere.h"

const int kMappingPublished = 0;
const int kMappingFolded = 1;
const int kStoredTransmittance = 0;
const int kStoredOpticalDepth = 1;
const int kStoredMeanExtinction = 2;

// [texel_maps]
// From 0 ... 1 over the table's domain to a texture coordinate, and back. The domain's ends are the centres of the
// first and the last texel, not the texture's edges: both ends are stored, none is extrapolated.
float uv_from_unit(float unit, int texels) { return 0.5 / float(texels) + unit * (1.0 - 1.0 / float(texels)); }
float unit_from_uv(float uv, int texels) { return (uv - 0.5 / float(texels)) / (1.0 - 1.0 / float(texels)); }
// [/texel_maps]

// sqrt((b - a)(2R + b + a)): length of the tangent from a point at altitude b to the sphere of altitude a <= b.
float tangent_length(float ground_radius_km, float a_km, float b_km) {
  return sqrt(max((b_km - a_km) * (2.0 * ground_radius_km + b_km + a_km), 0.0));
}

// [transmittance_uv]
// Domain: 0 <= altitude_km <= top, mu down to the horizon's (published) or to 0 (folded). Arguments outside of it are
// clamped.
vec2 transmittance_uv(Atmosphere atmosphere, float altitude_km, float mu, ivec2 size) {
  float radius_km = atmosphere.ground_radius_km;
  float top_km = atmosphere.top_km;
  float h = clamp(altitude_km, 0.0, top_km);
  float rho = tangent_length(radius_km, 0.0, h);
  float rho_top = tangent_length(radius_km, 0.0, top_km);
  float d_min = top_km - h;
  float d_max = TABLE_MAPPING == kMappingFolded ? tangent_length(radius_km, h, top_km) : rho + rho_top;
  float d = distance_to_shell_from_inside(radius_km, h, mu, top_km);
  float x = clamp((d - d_min) / max(d_max - d_min, 1.0e-20), 0.0, 1.0);
  return vec2(uv_from_unit(x, size.x), uv_from_unit(clamp(rho / rho_top, 0.0, 1.0), size.y));
}
// [/transmittance_uv]

struct TablePath {
  float altitude_km;
  float mu;
};

// [transmittance_path]
// The inverse: the path stored at uv.
//   h = rho^2 / (R + sqrt(R^2 + rho^2)),  which does not cancel;
//   mu = (d_0^2 - d^2) / (2 r d),  d_0^2 = (top - h)(2R + top + h).
TablePath transmittance_path(Atmosphere atmosphere, vec2 uv, ivec2 size) {
  float radius_km = atmosphere.ground_radius_km;
  float top_km = atmosphere.top_km;
  float x = clamp(unit_from_uv(uv.x, size.x), 0.0, 1.0);
  float y = clamp(unit_from_uv(uv.y, size.y), 0.0, 1.0);
  float rho_top = tangent_length(radius_km, 0.0, top_km);
  float rho = y * rho_top;
  TablePath path;
  path.altitude_km = min(rho * rho / (radius_km + sqrt(radius_km * radius_km + rho * rho)), top_km);
  float d_min = top_km - path.altitude_km;
  float d_0 = tangent_length(radius_km, path.altitude_km, top_km);
  float d_max = TABLE_MAPPING == kMappingFolded ? d_0 : rho + rho_top;
  float d = d_min + x * (d_max - d_min);
  float r = radius_km + path.altitude_km;
  path.mu = d > 0.0 ? clamp((d_0 - d) * (d_0 + d) / (2.0 * r * d), -1.0, 1.0) : 1.0;
  return path;
}
// [/transmittance_path]

#endif
