// Four ways to intersect a ray with a planet, from the one everybody writes first to the one with twice the digits.
// The robust one, which the rest of the book uses, stands in ray_sphere.glsl.
//
// The ray starts at o, r = |o| = R + h from the planet's centre, with the unit direction d, given in the local frame at
// the camera (z up). Its points o + t d lie on the sphere of radius R_s = R + shell where
//   t^2 + 2 b t + c = 0,   b = o·d = (R + h) d_z,   c = o·o - R_s^2,   t = -b -/+ sqrt(b^2 - c).
// Lengths in km. Every form keeps what `Chord` promises and returns neither NaN nor infinity in its domain.
#ifndef WELKIN_RAY_FORMS_GLSL
#define WELKIN_RAY_FORMS_GLSL

#include "03_planet_and_rays/double_float.glsl"
#include "03_planet_and_rays/ray_sphere.glsl"

const int FORM_NAIVE = 0;            // knob rays.form, in this order
const int FORM_CAMERA_RELATIVE = 1;
const int FORM_ROBUST = 2;
const int FORM_DOUBLE_FLOAT = 3;

// From the two roots, near <= far, to the part of the ray with t >= 0.
Chord chord_of_roots(float near_km, float far_km) {
  if (far_km <= 0.0) return Chord(-1.0, -1.0);
  return Chord(max(near_km, 0.0), far_km);
}

// [naive]
// As everyone writes it first: positions in a frame at the planet's centre, here with the camera above Zagreb
// (45.815 N, 15.982 E). One unit in the last place of a position is 0.5 m, and three differences of nearly equal numbers
// follow: in c, in b^2 - c, and in -b - sqrt(...).
const vec3 PLACE_EAST = vec3(-0.275335353, 0.961348243, 0.000000000);
const vec3 PLACE_NORTH = vec3(-0.689376192, -0.197441082, 0.696977392);
const vec3 PLACE_UP = vec3(0.670037991, 0.191902516, 0.717093100);

Chord naive_chord(float ground_radius_km, float altitude_km, vec3 direction, float shell_km) {
  vec3 origin = PLACE_UP * (ground_radius_km + altitude_km);
  vec3 d = PLACE_EAST * direction.x + PLACE_NORTH * direction.y + PLACE_UP * direction.z;
  float radius = ground_radius_km + shell_km;
  float b = dot(origin, d);
  float c = dot(origin, origin) - radius * radius;
  float discriminant = b * b - c;
  if (discriminant < 0.0) return Chord(-1.0, -1.0);
  float root = sqrt(discriminant);
  return chord_of_roots(-b - root, -b + root);
}
// [/naive]

// [camera_relative]
// The cheap trick: measure from the ground under the camera, o = (0, 0, h) with the centre at (0, 0, -R). The large
// squares drop out of c by algebra instead of by subtraction. The other two differences stay.
Chord camera_relative_chord(float ground_radius_km, float altitude_km, vec3 direction, float shell_km) {
  vec3 origin = vec3(0.0, 0.0, altitude_km);
  float b = dot(origin, direction) + ground_radius_km * direction.z;
  float c = altitude_km * (2.0 * ground_radius_km + altitude_km) - shell_km * (2.0 * ground_radius_km + shell_km);
  float discriminant = b * b - c;
  if (discriminant < 0.0) return Chord(-1.0, -1.0);
  float root = sqrt(discriminant);
  return chord_of_roots(-b - root, -b + root);
}
// [/camera_relative]

struct DoubleFloatChord {
  bool hit;
  vec2 enter_km;
  vec2 leave_km;
};

// [double_float]
// The naive formula, line for line, with 48 bits. The direction is made a unit vector again, because its own float32
// rounding is worth 40 m at the Moon's distance.
DoubleFloatChord double_float_roots(float ground_radius_km, float altitude_km, vec3 direction, float shell_km) {
  vec2 squared = df_add(df_add(two_product(direction.x, direction.x), two_product(direction.y, direction.y)),
                        two_product(direction.z, direction.z));
  vec2 size = df_sqrt(squared);
  vec2 mu = size.x > 0.0 ? df_divide(df(direction.z), size) : df(0.0);
  vec2 r = two_sum(ground_radius_km, altitude_km);
  vec2 radius = two_sum(ground_radius_km, shell_km);
  vec2 b = df_multiply(r, mu);
  vec2 c = df_subtract(df_multiply(r, r), df_multiply(radius, radius));
  vec2 discriminant = df_subtract(df_multiply(b, b), c);
  vec2 root = df_sqrt(discriminant);
  DoubleFloatChord chord;
  chord.enter_km = df_subtract(df_negate(b), root);
  chord.leave_km = df_subtract(root, b);
  chord.hit = discriminant.x >= 0.0 && chord.leave_km.x > 0.0;
  if (chord.enter_km.x < 0.0) chord.enter_km = vec2(0.0);
  return chord;
}
// [/double_float]

// One of the four, by number. `direction` is a unit vector to float32's precision.
Chord shell_chord(int form, float ground_radius_km, float altitude_km, vec3 direction, float shell_km) {
  if (form == FORM_NAIVE) return naive_chord(ground_radius_km, altitude_km, direction, shell_km);
  if (form == FORM_CAMERA_RELATIVE) return camera_relative_chord(ground_radius_km, altitude_km, direction, shell_km);
  if (form == FORM_DOUBLE_FLOAT) {
    DoubleFloatChord chord = double_float_roots(ground_radius_km, altitude_km, direction, shell_km);
    if (!chord.hit) return Chord(-1.0, -1.0);
    return Chord(chord.enter_km.x, chord.leave_km.x);
  }
  return robust_chord(ground_radius_km, altitude_km, direction.z, length(direction.xy), shell_km);
}

// Distance to the ground, or -1. A camera below the ground counts as standing on it.
float ground_distance(int form, float ground_radius_km, float altitude_km, vec3 direction) {
  float altitude = max(altitude_km, 0.0);
  if (altitude == 0.0 && direction.z >= 0.0) return -1.0;  // from the ground, up or level
  return shell_chord(form, ground_radius_km, altitude, direction, 0.0).enter_km;
}

#endif
