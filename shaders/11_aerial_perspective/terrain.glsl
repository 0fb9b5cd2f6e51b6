// Where a height map lies on the planet, and the sun behind a ridge. Pure functions.
//
// km. Global frame: origin on the ground at the scene's place, x east, y north, z up there; the planet's centre is at
// (0, 0, -R). A place of the map is where the vertical through a point pierces the sphere, seen along z: (x, y).
#ifndef WELKIN_TERRAIN_GLSL
#define WELKIN_TERRAIN_GLSL

// [on_planet]
// [point_above]
// The point at altitude h above a place. z of the sphere there, sqrt(R^2 - d^2) - R, in the form that does not cancel.
vec3 on_planet(float ground_radius_km, vec2 place_km, float altitude_km) {
  float d2 = min(dot(place_km, place_km), ground_radius_km * ground_radius_km);
  float upright = sqrt(ground_radius_km * ground_radius_km - d2);  // cosine of the tilt, times R
  float scale = altitude_km / ground_radius_km;
  return vec3(place_km.x * (1.0 + scale), place_km.y * (1.0 + scale),
              upright * scale - d2 / (ground_radius_km + upright));
}
// [/point_above]

// Altitude of a point, (|p - c|^2 - R^2) / (|p - c| + R).
float altitude_of(float ground_radius_km, vec3 point_km) {
  float from_centre = point_km.z + ground_radius_km;
  float r = sqrt(point_km.x * point_km.x + point_km.y * point_km.y + from_centre * from_centre);
  return (dot(point_km, point_km) + 2.0 * ground_radius_km * point_km.z) / (r + ground_radius_km);
}

// The place below a point, and the unit vector up there.
vec2 place_below(float ground_radius_km, vec3 point_km) {
  float scale = ground_radius_km / (ground_radius_km + altitude_of(ground_radius_km, point_km));
  return vec2(point_km.x * scale, point_km.y * scale);
}

vec3 up_at(float ground_radius_km, vec2 place_km) {
  float d2 = min(dot(place_km, place_km), ground_radius_km * ground_radius_km);
  return vec3(place_km.x, place_km.y, sqrt(ground_radius_km * ground_radius_km - d2)) / ground_radius_km;
}
// [/on_planet]

// Texture coordinates of a place; row 0 of the map is north.
vec2 map_uv(vec2 place_km, float extent_km) { return vec2(place_km.x / extent_km + 0.5, 0.5 - place_km.y / extent_km); }

// [disc_above]
// Share of the sun's disc above a straight edge; `above` is how far its centre is above, in radii of the disc.
float disc_above(float above) {
  float e = clamp(above, -1.0, 1.0);
  return clamp(0.5 + (e * sqrt(1.0 - e * e) + asin(e)) * 0.31830988618379067, 0.0, 1.0);
}

// The altitude from which the sun is seen past something of altitude h at the horizontal distance s towards the sun:
// the sunray that grazes it comes down by s tan(elevation), and the ground curves away by s^2 / 2R on the way.
float shadow_altitude(float ground_radius_km, float altitude_km, float s_km, float tan_elevation) {
  return altitude_km - s_km * tan_elevation - s_km * s_km / (2.0 * ground_radius_km);
}
// [/disc_above]

#endif
