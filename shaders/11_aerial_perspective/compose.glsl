// What the camera sees: terrain or a sign, lit by sun and sky, through the air in front of it; or the sky. Included by
// compose.comp (FROXELS 1) and compose_march.comp (FROXELS 0: a march per pixel instead of froxels).
layout(local_size_x = 8, local_size_y = 8) in;
#define WELKIN_WITH_SIGNS
#include "11_aerial_perspective/block.glsl"

layout(constant_id = 22) const int MARCH_SLICES = 64;
layout(constant_id = 23) const bool HAS_EDGES = true;
layout(constant_id = 24) const bool HAS_DETAIL = true;
layout(constant_id = 25) const bool HAS_SIGNS = true;

#if FROXELS
layout(binding = 3) uniform sampler3D froxel_in_scattering;
layout(binding = 4) uniform sampler3D froxel_extinction;
#endif
layout(binding = 5, rgba32f) uniform readonly image2D terrain_distance;
layout(binding = 6) uniform sampler2D slope_map;
layout(binding = 7) uniform sampler2D cover_map;
layout(binding = 8, rgba32f) uniform readonly image2D sky;
layout(binding = 9, rgba32f) uniform writeonly image2D target;

vec2 slope_at(vec2 uv) { return textureLod(slope_map, uv, 0.0).rg; }
vec4 cover_at(vec2 uv) { return textureLod(cover_map, uv, 0.0); }
vec4 sign_place(int k) { return sign_places[k]; }
#include "11_aerial_perspective/surface.glsl"

#if FROXELS
// [froxel_light]
// The air up to a distance from the froxels, filtered. place: 0 ... 1 over the picture.
RayLight froxel_light(vec2 place, float t_km) {
  const vec3 count = vec3(textureSize(froxel_in_scattering, 0));
  const float s = slices_before(t_km, count.z, farthest_km, POWER);
  // Texel k holds the end of slice k: s = k + 1 is found at its centre. Before the first one the air is taken as that
  // up to it.
  const vec3 uvw = vec3(0.5 / count.xy + place * (1.0 - 1.0 / count.xy), (max(s, 1.0) - 0.5) / count.z);
  const vec4 stored = textureLod(froxel_in_scattering, uvw, 0.0);
  Froxel froxel;
  froxel.in_scattering = stored.rgb;
  froxel.extinction = HAS_COLOUR ? textureLod(froxel_extinction, uvw, 0.0).rgb : stored.aaa;
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
  RayLight light = march_to(method_air(air, MS_METHOD), ray.air, scattering_along(air, view, frame.camera.sun),
                            max(t_km - ray.begins_km, 0.0), MARCH_SLICES, SAMPLES, above ? 1.0 : POWER);
  light.radiance *= air.solar_irradiance;
  return light;
}

// [compose]
// [surface_seen]
// A surface, lit by sun and sky, through the air before it.
vec3 surface_seen(Atmosphere air, Surface surface, vec3 view, vec3 sun, float altitude, vec2 place) {
  const float mu_sun = dot(sun, surface.up);
  const MethodAir method = method_air(air, MS_METHOD);
  const float seen_sun = surface.is_terrain ? sun_on_ground(surface.place_km) : sun_over(surface.place_km, altitude);
  const vec3 beam = sun_through_air(method.air, altitude, mu_sun) * seen_sun;
  const vec3 from_sky = HIGHER_ORDERS ? sky_irradiance(air, altitude, mu_sun) : vec3(0.0);
  const vec3 lit = air.solar_irradiance * surface_light(surface.albedo, air.ground_albedo, surface.normal, surface.up,
                                                       sun, beam, from_sky);
  const RayLight before = air_before(air, place, view, surface.t_km);
  return before.radiance + before.transmittance * lit;
}
// [/surface_seen]

int next_layer(vec3 shares, int layer) {
  if (layer == 0 && shares.x <= 0.0) layer = 1;
  if (layer == 1 && shares.y <= 0.0) layer = 2;
  return layer == 2 && shares.z <= 0.0 ? 3 : layer;
}

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, frame.camera.size))) return;
  const Atmosphere air = atmosphere;
  const vec3 view = camera_direction(frame.camera, pixel);
  const vec3 direction = to_global(view), sun = to_global(frame.camera.sun);
  const vec2 place = (vec2(pixel) + 0.5) / vec2(frame.camera.size);
  const float pixel_rad = 2.0 * length(frame.camera.up) / float(frame.camera.size.y);

  // From behind: the sky, or the terrain; the edge of a ridge that covers a part of the pixel; a sign that may, too.
  const vec4 terrain = imageLoad(terrain_distance, pixel);
  vec3 radiance = terrain.x > 0.0 ? vec3(0.0) : imageLoad(sky, pixel).rgb;
  SignSeen sign;
  sign.share = 0.0;
  if (HAS_SIGNS)
    sign = sign_before(air.ground_radius_km, frame.position_km, direction, terrain.x > 0.0 ? terrain.x : 1.0e9,
                       pixel_rad);
  const vec3 shares = vec3(terrain.x > 0.0 ? 1.0 : 0.0, HAS_EDGES ? terrain.z : 0.0, sign.share);
  // Nearly all pixels have one of the three at most: a loop over those that are there.
  for (int layer = next_layer(shares, 0); layer < 3; layer = next_layer(shares, layer + 1)) {
    const float share = shares[layer];
    Surface surface;
    if (layer == 2) surface = sign.surface;
    else surface = terrain_surface(air.ground_radius_km, extent_km, air.ground_albedo, frame.position_km, direction,
                                   layer == 0 ? terrain.x : terrain.y, HAS_DETAIL ? pixel_rad : kNoDetail);
    const float altitude = max(altitude_of(air.ground_radius_km, frame.position_km + direction * surface.t_km), 0.0);
    radiance = mix(radiance, surface_seen(air, surface, view, sun, altitude, place), share);
  }
  imageStore(target, pixel, vec4(radiance, 1.0));
}
// [/compose]
