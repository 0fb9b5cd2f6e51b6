// What the camera sees: terrain or a sign, lit by sun and sky, through the air in front of it; the sky where neither is.
// Included by compose.comp (FROXELS 1) and compose_march.comp (0: a march per pixel instead, and nothing to bind for them).
layout(local_size_x = 8, local_size_y = 8) in;
#include "11_aerial_perspective/block.glsl"
#include "11_aerial_perspective/ground.glsl"
#include "11_aerial_perspective/signs.glsl"

layout(constant_id = 22) const int MARCH_SLICES = 64;
layout(constant_id = 23) const bool HAS_SIGNS = true;
layout(constant_id = 24) const float NEAR_KM = 1.0e-4;

#if FROXELS
layout(binding = 3) uniform sampler3D glows;
layout(binding = 4) uniform sampler3D extinctions;
#endif
layout(binding = 5) uniform sampler2D depth_map;
layout(binding = 6) uniform sampler2D slope_map;
layout(binding = 7) uniform sampler2D cover_map;
layout(binding = 8, rgba32f) uniform readonly image2D sky;
layout(binding = 9, rgba32f) uniform writeonly image2D target;

#if FROXELS
// [froxel_light]
// The air up to a distance from the froxels, filtered. place: 0 ... 1 over the picture.
RayLight froxel_light(vec2 place, float t_km) {
  const vec3 count = vec3(textureSize(glows, 0));
  const float s = slices_before(t_km, count.z, farthest_km, POWER);
  // Texel k holds the end of slice k: s = k + 1 is found at its centre. Before the first one the air is taken as that up to it.
  const vec3 uvw = vec3(0.5 / count.xy + place * (1.0 - 1.0 / count.xy), (max(s, 1.0) - 0.5) / count.z);
  const vec4 stored = textureLod(glows, uvw, 0.0);
  Froxel froxel;
  froxel.glow = stored.rgb;
  froxel.extinction = HAS_COLOUR ? textureLod(extinctions, uvw, 0.0).rgb : stored.aaa;
  return light_before(froxel, t_km);
}
// [/froxel_light]
#endif

// The same without them: from above the air and beyond the last slice there are none.
RayLight air_before(Atmosphere air, vec2 place, vec3 view, float t_km) {
  const bool above = frame.camera.altitude_km >= air.top_km;
#if FROXELS
  if (!above && t_km <= farthest_km) return froxel_light(place, t_km);
#endif
  const ClippedRay ray = clipped_ray(view, frame.camera.altitude_km);
  if (!ray.air.hits_air) return RayLight(vec3(0.0), vec3(1.0));
  RayLight light = march_to(method_air(air, MS_METHOD), ray.air, scattering_along(air, view, frame.camera.sun), max(t_km - ray.begins_km, 0.0), MARCH_SLICES, SAMPLES, above ? 1.0 : POWER);
  light.radiance *= air.solar_irradiance;
  return light;
}

// [compose]
void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const Atmosphere air = atmosphere;
  const vec3 view = camera_direction(frame.camera, pixel);
  const vec3 direction = to_global(view), sun = to_global(frame.camera.sun);

  const float depth = texelFetch(depth_map, pixel, 0).r;
  float t_km = depth > 0.0 ? distance_from_depth(depth, NEAR_KM, dot(view, normalize(frame.camera.forward))) : 1.0e9;
  bool seen = depth > 0.0;
  float paint = -1.0;
  vec3 normal = vec3(0.0);
  if (HAS_SIGNS) {
    for (int k = 0; k < kSigns; ++k) {
      const SignHit hit = meet_sign(k, air.ground_radius_km, signs_azimuth, frame.position_km, direction);
      if (hit.t_km < 0.0 || hit.t_km >= t_km) continue;
      t_km = hit.t_km, paint = hit.paint, normal = hit.normal, seen = true;
    }
  }
  if (!seen) {
    imageStore(target, pixel, imageLoad(sky, pixel));
    return;
  }

  const vec3 point = frame.position_km + direction * t_km;
  const vec2 place = place_below(air.ground_radius_km, point);
  const vec3 up = up_at(air.ground_radius_km, place);
  const float altitude = max(altitude_of(air.ground_radius_km, point), 0.0);
  vec3 albedo = vec3(paint);
  if (paint < 0.0) {
    const vec2 uv = map_uv(place, extent_km);
    const Ground ground = ground_at(textureLod(slope_map, uv, 0.0).rg, textureLod(cover_map, uv, 0.0), air.ground_albedo, place, up, t_km / float(frame.camera.size.y));
    albedo = ground.albedo, normal = ground.normal;
  } else if (dot(normal, direction) > 0.0) {
    normal = -normal;
  }
  const float mu_sun = dot(sun, up);
  const MethodAir method = method_air(air, MS_METHOD);
  const float seen_sun = HAS_SHADOWS ? sun_over(place, altitude) : 1.0;
  const vec3 beam = sun_through_air(method.air, altitude, mu_sun) * seen_sun;
  const vec3 from_sky = HIGHER_ORDERS ? sky_irradiance(air, altitude, mu_sun) : vec3(0.0);
  const vec3 lit = surface_light(albedo, air.ground_albedo, normal, up, sun, beam, from_sky) * air.solar_irradiance;

  const RayLight before = air_before(air, (vec2(pixel) + 0.5) / vec2(frame.camera.size), view, t_km);
  imageStore(target, pixel, vec4(before.radiance + before.transmittance * lit, 1.0));
}
// [/compose]
