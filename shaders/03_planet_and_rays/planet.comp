// Chapter 03: a planet seen from half a metre to the Moon's distance, one ray per pixel; rays.form says how it is met.
//
// Views (debug.view): shaded; distance to the ground; error of that distance against double-float; the normal; the
// altitude of the point that was hit, which should be 0. Strips at the bottom are the colour scales. Lengths in km.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "03_planet_and_rays/camera.glsl"
#include "03_planet_and_rays/picture.glsl"
#include "03_planet_and_rays/ray_forms.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 0) const int RAYS_FORM = FORM_ROBUST;
layout(constant_id = 1) const int DEBUG_VIEW = 0;
layout(binding = 0, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  CameraRays camera;
  vec4 planet;  // x: ground radius; y: altitude of the top of the atmosphere; z: angle of a pixel, rad
  vec4 albedo;
} push;

const int VIEW_SHADED = 0;
const int VIEW_DISTANCE = 1;
const int VIEW_DISTANCE_ERROR = 2;
const int VIEW_NORMAL = 3;
const int VIEW_ALTITUDE_OF_HIT = 4;

const float ERROR_FIRST_KM = 1.0e-7;  // the error's scale: 0.1 mm … 10 km
const float ERROR_DECADES = 8.0;
const float DISTANCE_FIRST_KM = 1.0e-4;  // the distance's scale: 10 cm … 1 000 000 km
const float DISTANCE_DECADES = 10.0;
const vec3 SPACE = vec3(0.010, 0.012, 0.020);
const vec3 MISS_DIFFERS = vec3(1.0, 0.0, 1.0);  // one form hits and the other does not

struct Surface {
  vec3 from_foot_km;  // of the point that was hit, from the ground under the camera
  vec3 normal;
};

Surface surface_at(float radius_km, float altitude_km, vec3 direction, float distance_km) {
  Surface surface;
  surface.from_foot_km = vec3(direction.xy * distance_km, altitude_km + direction.z * distance_km);
  vec3 from_centre = vec3(surface.from_foot_km.xy, radius_km + surface.from_foot_km.z);
  surface.normal = from_centre / max(length(from_centre), 1.0e-20);
  return surface;
}

// [hit_altitude]
// Altitude of o + t d in double-float: how far from the ground a form's answer really lies.
float hit_altitude(float radius_km, float altitude_km, vec3 direction, float distance_km) {
  vec2 r = two_sum(radius_km, altitude_km);
  vec2 z = df_add(r, two_product(direction.z, distance_km));
  vec2 x = two_product(direction.x, distance_km);
  vec2 y = two_product(direction.y, distance_km);
  vec2 squared = df_add(df_multiply(z, z), df_add(df_multiply(x, x), df_multiply(y, y)));
  return df_subtract(df_sqrt(squared), df(radius_km)).x;
}
// [/hit_altitude]

vec3 shaded(float radius_km, float top_km, float altitude_km, vec3 direction, vec3 sun, float distance_km) {
  vec3 colour = SPACE;
  if (distance_km >= 0.0) {
    Surface surface = surface_at(radius_km, altitude_km, direction, distance_km);
    float slope = max(-dot(surface.normal, direction), 0.02);
    float pattern = ground_pattern(ground_arcs(radius_km, surface.from_foot_km), distance_km * push.planet.z / slope);
    float light = 0.08 + 0.92 * max(dot(surface.normal, sun), 0.0);  // Lambert; a little light at night, to see by
    colour = push.albedo.rgb * mix(vec3(0.5, 0.9, 0.6), vec3(3.9, 3.5, 2.9), pattern) * light;
  }
  // The air as a tint: the longer the way through the shell, the bluer. What light really does there is chapter 05.
  Chord air = shell_chord(RAYS_FORM, radius_km, altitude_km, direction, top_km);
  if (air.enter_km < 0.0) return colour;
  float leave_km = distance_km >= 0.0 ? distance_km : air.leave_km;
  float way_km = max(leave_km - air.enter_km, 0.0);
  vec3 middle = surface_at(radius_km, altitude_km, direction, 0.5 * (air.enter_km + leave_km)).normal;
  vec3 tint = vec3(0.32, 0.55, 0.95) * (0.02 + 0.98 * smoothstep(-0.15, 0.4, dot(middle, sun)));
  return mix(colour, tint, 1.0 - exp(-way_km / 500.0));
}

// [views]
vec3 debug_colour(float radius_km, float altitude_km, vec3 direction, float distance_km) {
  if (DEBUG_VIEW == VIEW_DISTANCE_ERROR) {
    DoubleFloatChord truth = double_float_roots(radius_km, altitude_km, direction, 0.0);
    bool hits = truth.hit && !(altitude_km == 0.0 && direction.z >= 0.0);
    if (hits != (distance_km >= 0.0)) return MISS_DIFFERS;
    if (!hits) return SPACE;
    float error = abs((distance_km - truth.enter_km.x) - truth.enter_km.y);
    return scale_colour(on_log_scale(error, ERROR_FIRST_KM, ERROR_DECADES));
  }
  if (distance_km < 0.0) return SPACE;
  if (DEBUG_VIEW == VIEW_DISTANCE) return scale_colour(on_log_scale(distance_km, DISTANCE_FIRST_KM, DISTANCE_DECADES));
  if (DEBUG_VIEW == VIEW_NORMAL) return 0.5 + 0.5 * surface_at(radius_km, altitude_km, direction, distance_km).normal;
  float height = hit_altitude(radius_km, altitude_km, direction, distance_km);
  return signed_colour(sign(height) * on_log_scale(abs(height), ERROR_FIRST_KM, ERROR_DECADES));
}
// [/views]

// The strip with the colour scale; ticks stand at powers of ten.
vec3 legend(float x) {
  bool is_signed = DEBUG_VIEW == VIEW_ALTITUDE_OF_HIT;
  float decades = is_signed ? 2.0 * ERROR_DECADES : DEBUG_VIEW == VIEW_DISTANCE ? DISTANCE_DECADES : ERROR_DECADES;
  float from_tick = abs(x * decades - round(x * decades)) / decades * float(push.camera.size.x);
  if (from_tick < 1.0) return vec3(0.0);
  return is_signed ? signed_colour(2.0 * x - 1.0) : scale_colour(x);
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  const ivec2 size = push.camera.size;
  if (any(greaterThanEqual(pixel, size))) return;
  // [main]
  const float radius_km = push.planet.x;
  const float altitude_km = push.camera.altitude_km;
  const vec3 direction = camera_direction(push.camera, pixel);
  const float distance_km = ground_distance(RAYS_FORM, radius_km, altitude_km, direction);
  vec3 colour;
  if (DEBUG_VIEW == VIEW_SHADED)
    colour = shaded(radius_km, push.planet.y, altitude_km, direction, push.camera.sun, distance_km);
  else
    colour = debug_colour(radius_km, altitude_km, direction, distance_km);
  // [/main]
  const bool has_scale = DEBUG_VIEW != VIEW_SHADED && DEBUG_VIEW != VIEW_NORMAL;
  if (has_scale && pixel.y >= size.y - size.y / 36) colour = legend((float(pixel.x) + 0.5) / float(size.x));
  imageStore(target, pixel, vec4(colour, 1.0));
}
