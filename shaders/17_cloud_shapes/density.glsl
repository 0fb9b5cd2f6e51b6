// The density of a body of cloud at a point: one function, which every later chapter uses. Pure, also valid C++.
//
// 0 ... body.largest_density; times body.extinction_per_km it is the extinction, 1/km. Extinctions of overlapping
// bodies add. The including file gives the textures:
//   float grid_texel(int i, int j, int k)   a corner's sample            float grid_filtered(vec3 texel)   the hardware's filter
//   vec4 weather_texel(vec2 uv)             vec4 base_noise(vec3 uvw)    vec4 detail_noise(vec3 uvw)        vec4 curl_noise(vec2 uv)
//
//   noise:  shape    s = above(perlin-worley, 1 - fBm of worley),  times the type's profile over the height
//           cover    d = above(s, threshold of the coverage there)
//           erosion  above(d, a part of the detail): wisps at the base, billows above
#ifndef WELKIN_CLOUD_DENSITY_GLSL
#define WELKIN_CLOUD_DENSITY_GLSL

#include "17_cloud_shapes/types.glsl"
#include "interop/cloud.h"

// How much of a noise body is worked out, from cheap to full.
const int kShapeOnly = 0;       // a bound from above for the two others: where it is 0 so are they
const int kWithDetail = 1;      // eroded at the edges
const int kWithCurledDetail = 2;

const int kGridExact = 0;     // eight corners, mixed in float32
const int kGridFiltered = 1;  // by the sampler

// [point]
struct CloudPoint {
  vec3 origin_km;     // any point of the global frame, the same for all points of a ray,
  vec3 offset_km;     // and the way from there: what float32 takes from their sum is never missed
  float altitude_km;
};
// [/point]

// [arcs]
// asin(x) / x: the series where it is short, the half angle beyond. Drivers' asin errs by 1e-4.
float asin_over(float x) {
  float square = x * x;
  return 1.0 + square * (1.0 / 6.0 + square * (3.0 / 40.0 + square * (15.0 / 336.0 + square * (105.0 / 3456.0 +
         square * (945.0 / 42240.0 + square * (10395.0 / 599040.0 + square * 0.0139648))))));
}

// Way along the ground to the place below a point, east and north: along the great circle from the scene's place.
vec2 ground_way(float ground_radius_km, vec3 point_km) {
  float up = point_km.z + ground_radius_km;
  float r = sqrt(point_km.x * point_km.x + point_km.y * point_km.y + up * up);
  float sine = min(sqrt(point_km.x * point_km.x + point_km.y * point_km.y) / r, 1.0);
  float scale = asin_over(sine);
  if (up < 0.0 || sine > 0.5) {  // by the sine of a quarter of the angle, found without a difference of near numbers
    float half_sine = up >= 0.0 ? sine / sqrt(2.0 + 2.0 * up / r) : sqrt(0.5 - 0.5 * up / r);
    float quarter_sine = half_sine / sqrt(2.0 + 2.0 * sqrt(max(1.0 - half_sine * half_sine, 0.0)));
    scale = 4.0 * quarter_sine * asin_over(quarter_sine) / max(sine, 1.0e-7);
  }
  float from_ground = ground_radius_km / r * scale;
  return vec2(point_km.x * from_ground, point_km.y * from_ground);
}
// [/arcs]

// [weather]
// Coverage, height of the tops, type and wetness at a place. A user's map is taken as it is. The procedural one repeats
// after extent_km: its coverage is varied by a second look-up, 2.6 times as wide and turned.
vec4 weather_at(CloudBody body, vec2 way_km) {
  vec2 place = vec2(way_km.x * body.turn_x - way_km.y * body.turn_y, way_km.x * body.turn_y + way_km.y * body.turn_x);
  vec2 uv = vec2(place.x / body.extent_km + 0.5 + body.shift_x, 0.5 - place.y / body.extent_km + body.shift_y);
  vec4 weather = weather_texel(uv);
  if (body.painted > 0.5) return weather;
  weather.x = above(weather.x, 0.6) * 1.1;  // half of the map lies above 0.8: spread out
  vec2 wide = vec2(0.8 * uv.x - 0.6 * uv.y, 0.6 * uv.x + 0.8 * uv.y) * 0.381966;
  weather.x = clamp(weather.x + 0.5 * (above(weather_texel(wide).x, 0.6) - 0.5), 0.0, 1.0);
  return weather;
}

// The coverage of a body there: its own number shifts the map's, so that 0 is a clear sky everywhere and 1 a full one.
float local_coverage(float map_coverage, float coverage) {
  if (coverage <= 0.0) return 0.0;
  return clamp(map_coverage + 2.0 * coverage - 1.0, 0.0, 1.0);
}
// [/weather]

// [noise_space]
// Noise is looked up in a frame turned against the planet's by a matrix of whole numbers over 49: a horizontal cut
// through the texture's lattice then repeats after six periods only, not after one. Whole numbers, because a position
// may then be wrapped around after 49 periods, exactly, before anything else is done: 10,000 km from the origin a float
// knows a place to 1 m, its rest within the wrap to 0.03 m.
const float kWrap = 49.0;

vec3 wrapped(vec3 origin_km, float wrap_km) {
  return vec3(origin_km.x - wrap_km * floor(origin_km.x / wrap_km), origin_km.y - wrap_km * floor(origin_km.y / wrap_km),
              origin_km.z - wrap_km * floor(origin_km.z / wrap_km));
}

vec3 noise_place(CloudBody body, CloudPoint point) {
  vec3 p = wrapped(point.origin_km, kWrap * body.cell_km) + point.offset_km;
  float scale = 1.0 / (kWrap * body.cell_km);
  return vec3((24.0 * p.y + 40.0 * p.z - 15.0 * p.x) * scale + body.shift_x,
              (40.0 * p.x + 24.0 * p.z - 15.0 * p.y) * scale + body.shift_y,
              (24.0 * p.x + 40.0 * p.y - 15.0 * p.z) * scale);
}
// [/noise_space]

// [shape]
// 0 ... 1: lumps of the base texture, with what its finer octaves cut out of their sides. Nine tenths of the texture lie
// between 0.45 and 0.88: spread out, so that a threshold of one half leaves about half.
float base_shape(vec4 base) {
  float octaves = 0.625 * base.y + 0.25 * base.z + 0.125 * base.w;
  return above(above(base.x, 0.4) * 1.25, clamp(1.3 * (0.92 - octaves), 0.0, 0.9));
}

// Of the shape, what the coverage leaves. The threshold falls from 1, where nothing is left, and of solid sheets below 0.
float covered(float shape, float coverage, float solid) {
  float threshold = 1.0 - coverage * (1.0 + solid * coverage);
  return above(shape, threshold);
}

// At the layer's base the density is cut where the detail is high, which leaves wisps; above a tenth of the layer where it
// is low, which leaves billows.
float eroded(float density, float detail, float height, float strength) {
  float cut = clamp(mix(detail, 1.0 - detail, clamp(height * 10.0, 0.0, 1.0)) * 1.6 - 0.16, 0.0, 1.0);
  return above(density, strength * cut);
}
// [/shape]

// [noise_density]
float noise_density(CloudBody body, float ground_radius_km, CloudPoint point, int detail) {
  float height = (point.altitude_km - body.base_km) / (body.top_km - body.base_km);
  if (height <= 0.0 || height >= 1.0) return 0.0;
  vec4 weather = weather_at(body, ground_way(ground_radius_km, point.origin_km + point.offset_km));
  CloudType type = cloud_type(body.type >= 0.0 ? body.type : weather.z);
  float profile = height_profile(type.profile, height, weather.y);
  float coverage = local_coverage(weather.x, body.coverage);
  // The anvil: towards the top, what is covered in part is covered more.
  coverage = mix(coverage, sqrt(coverage), type.anvil * clamp((height - 0.7) * 5.0, 0.0, 1.0));
  if (profile <= 0.0 || coverage <= 0.0) return 0.0;
  vec3 place = noise_place(body, point);
  float density = covered(base_shape(base_noise(place)) * profile, coverage, type.solid * profile);
  if (detail != kShapeOnly && density > 0.0) {
    vec3 fine = place * 12.0;
    if (detail == kWithCurledDetail) {
      vec4 curl = curl_noise(vec2(place.x * 4.0, place.y * 4.0));
      fine += vec3(curl.x, curl.y, curl.z) * (0.4 * (1.0 - height));  // turbulence, strongest below
    }
    density = eroded(density, detail_noise(fine).w, height, 0.6 * type.billows);
  }
  // Droplets grow as air rises: less water at the layer's base (clouds that begin higher up are not thinned); and rain
  // clouds hold more.
  return density * mix(0.5, 1.0, clamp(4.0 * height, 0.0, 1.0)) * (0.7 + 0.3 * weather.w);
}
// [/noise_density]

// [grid_density]
// Trilinear between corners, 0 outside of the box. Corner i lies at i / (n - 1) of the side: its texel's centre is half a
// texel further, u = (x / l (n - 1) + 0.5) / n. way: 0 ... 1 through the box.
float grid_density(CloudBody body, vec3 way, int method) {
  if (min(min(way.x, way.y), way.z) < 0.0 || max(max(way.x, way.y), way.z) > 1.0) return 0.0;
  vec3 last = vec3(float(body.samples_x - 1), float(body.samples_y - 1), float(body.samples_z - 1));
  vec3 texel = vec3(way.x * last.x, way.y * last.y, way.z * last.z);
  if (method == kGridFiltered) return grid_filtered(texel + vec3(0.5, 0.5, float(body.first_slice) + 0.5));
  int i = min(int(texel.x), body.samples_x - 2), j = min(int(texel.y), body.samples_y - 2), k = min(int(texel.z), body.samples_z - 2);
  vec3 share = texel - vec3(float(i), float(j), float(k));
  k += body.first_slice;
  float low = mix(mix(grid_texel(i, j, k), grid_texel(i + 1, j, k), share.x), mix(grid_texel(i, j + 1, k), grid_texel(i + 1, j + 1, k), share.x), share.y);
  float high = mix(mix(grid_texel(i, j, k + 1), grid_texel(i + 1, j, k + 1), share.x),
                   mix(grid_texel(i, j + 1, k + 1), grid_texel(i + 1, j + 1, k + 1), share.x), share.y);
  return mix(low, high, share.z);
}
// [/grid_density]

// [density]
// Where a body is homogeneous its hull is all there is: density is 1 on its boundaries and inside.
float cloud_density(CloudBody body, float ground_radius_km, CloudPoint point, int detail, int grid_method) {
  if ((CLOUD_KINDS & kCloudNoise) != 0 && body.kind == kCloudNoise) return noise_density(body, ground_radius_km, point, detail);
  vec3 from = (point.origin_km - body.place_km) + point.offset_km;
  if ((CLOUD_KINDS & kCloudGrid) != 0 && body.kind == kCloudGrid)
    return grid_density(body, vec3(from.x / body.axis.x, from.y / body.axis.y, from.z / body.axis.z), grid_method);
  if ((CLOUD_KINDS & kCloudSphere) != 0 && body.kind == kCloudSphere) return length(from) <= body.radius_km ? 1.0 : 0.0;
  if (point.altitude_km < body.base_km || point.altitude_km > body.top_km) return 0.0;
  if (body.kind == kCloudLayer) return 1.0;
  float up = dot(from, body.axis), wide = body.radius_km + body.cone_slope * up;
  return wide > 0.0 && length(from - body.axis * up) <= wide ? 1.0 : 0.0;
}
// [/density]

#endif
