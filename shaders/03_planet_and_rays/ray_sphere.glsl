// Rays around a planet, in float32: the robust form. Pure functions, also valid C++; lengths in km.
//
// A ray starts at altitude h above a sphere of radius R, r = R + h, with zenith cosine mu and sine = sqrt(1 - mu^2),
// both from the direction vector (sine is the length of its horizontal part, never sqrt(1 - mu^2) of a rounded mu).
// Points on it are found from altitudes, never as length(p) - R, which is only known to 0.5 m in float32:
//   r(t)^2 = r^2 + 2 r mu t + t^2        h(t) = h + t (2 r mu + t) / (r(t) + r)
// The line's closest point to the centre (tangent point) is at distance b = r sine, altitude
//   b - R = h - r mu^2 / (1 + sine),     and s = r mu + t is the distance measured from it.
// A shell is the sphere at altitude `shell_km`: 0 is the ground. Domain of all: R >= 0, altitudes >= -R, |mu| <= 1,
// lengths below 1e9 km. No input in it gives NaN or infinity.
#ifndef WELKIN_RAY_SPHERE_GLSL
#define WELKIN_RAY_SPHERE_GLSL

// The part of a ray that lies inside a shell, as distances from its start; enter is 0 if it starts inside, and both are
// -1 if it has no such part. A ray that starts exactly on the shell and does not go down misses it.
struct Chord {
  float enter_km;
  float leave_km;
};

// [altitude_along]
// Altitude after a distance t along the ray, t >= 0. For rays that start within a few radii of the planet: r(t)^2 is a
// difference of squares as large as r^2, so from the Moon's distance the altitude of a point near the ground is only
// known to a few km. Move the start to where the ray enters the air first.
float altitude_along(float ground_radius_km, float altitude_km, float mu, float t_km) {
  float r = ground_radius_km + altitude_km;
  float r_t = sqrt(max(r * r + t_km * (2.0 * r * mu + t_km), 0.0));
  return altitude_km + t_km * (2.0 * r * mu + t_km) / max(r_t + r, 1.0e-20);
}
// [/altitude_along]

// [tangent_altitude]
// Altitude of the tangent point of the line; negative: the line meets the sphere. Two forms: near the horizontal the
// first keeps all digits of h; seen from far away (r mu^2 is then thousands of km) the second loses less.
float tangent_altitude(float ground_radius_km, float altitude_km, float mu, float sine) {
  float r = ground_radius_km + altitude_km;
  if (abs(mu) < 0.5) return altitude_km - r * mu * mu / (1.0 + sine);
  return r * sine - ground_radius_km;
}
// [/tangent_altitude]

// Distance along a line between its tangent point and the altitude h, 0 if the line does not go that low:
// sqrt((R+h)^2 - b^2) = sqrt((h - h_p)(2R + h + h_p)).
float half_chord(float ground_radius_km, float tangent_altitude_km, float altitude_km) {
  return sqrt(max((altitude_km - tangent_altitude_km) * (2.0 * ground_radius_km + altitude_km + tangent_altitude_km),
                  0.0));
}

// [robust]
// Distance from a point at altitude h, below or on the shell, out to it.
// (shell - h)(2R + shell + h) / (r mu + sqrt(...)) for mu >= 0: no difference of nearly equal numbers.
float distance_to_shell_from_inside(float ground_radius_km, float altitude_km, float mu, float shell_km) {
  float r_mu = (ground_radius_km + altitude_km) * mu;
  float c = max((shell_km - altitude_km) * (2.0 * ground_radius_km + shell_km + altitude_km), 0.0);
  float root = sqrt(r_mu * r_mu + c);
  return mu >= 0.0 ? c / max(r_mu + root, 1.0e-20) : root - r_mu;
}

// Distance down to the shell from a point at or above it, or -1 if the ray misses it.
// Near root as c / q, never b - sqrt(b^2 - c).
float distance_to_shell_from_outside(float ground_radius_km, float altitude_km, float mu, float sine, float shell_km) {
  if (mu >= 0.0) return -1.0;
  float below = shell_km - tangent_altitude(ground_radius_km, altitude_km, mu, sine);
  if (below < 0.0) return -1.0;
  float r_mu = (ground_radius_km + altitude_km) * mu;
  float root = sqrt(max(below * (2.0 * (ground_radius_km + shell_km) - below), 0.0));
  float c = max((altitude_km - shell_km) * (2.0 * ground_radius_km + shell_km + altitude_km), 0.0);
  return c / max(root - r_mu, 1.0e-20);
}

// Both roots. The far one of a ray from outside is -b + sqrt(b^2 - c): a sum of two positive numbers.
Chord robust_chord(float ground_radius_km, float altitude_km, float mu, float sine, float shell_km) {
  Chord chord;
  chord.enter_km = -1.0;
  chord.leave_km = -1.0;
  if (altitude_km < shell_km || (altitude_km == shell_km && mu < 0.0)) {
    chord.enter_km = 0.0;
    chord.leave_km = distance_to_shell_from_inside(ground_radius_km, altitude_km, mu, shell_km);
    return chord;
  }
  float enter = distance_to_shell_from_outside(ground_radius_km, altitude_km, mu, sine, shell_km);
  if (enter < 0.0) return chord;
  float below = shell_km - tangent_altitude(ground_radius_km, altitude_km, mu, sine);
  float root = sqrt(max(below * (2.0 * (ground_radius_km + shell_km) - below), 0.0));
  chord.enter_km = enter;
  chord.leave_km = max(root - (ground_radius_km + altitude_km) * mu, enter);
  return chord;
}
// [/robust]

// [horizon]
// The geometric horizon seen from altitude h: cosine and sine of its zenith angle, -sqrt(h (2R + h)) / r and R / r.
vec2 horizon_at(float ground_radius_km, float altitude_km) {
  float h = max(altitude_km, 0.0);
  float r = ground_radius_km + h;
  return vec2(-sqrt(h * (2.0 * ground_radius_km + h)) / r, ground_radius_km / r);
}
// [/horizon]

#endif
