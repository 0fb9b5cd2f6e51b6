// Directions after a scattering, and how likely each was. Pure functions.
//
// A cosine nu between two directions is carried as 1 - nu and 1 + nu, both with all their digits (see phase.glsl).
#ifndef WELKIN_SAMPLING_GLSL
#define WELKIN_SAMPLING_GLSL

#include "04_air/medium.glsl"
#include "07_ground_truth/random.glsl"

struct Turn {
  float one_minus_nu;
  float one_plus_nu;
};

// [rayleigh_turn]
// 3/8 (1 + nu^2) dnu is three quarters of a uniform nu and one quarter of 3/2 nu^2, whose distribution is inverted by a
// cube root.
Turn rayleigh_turn(float which, float u) {
  Turn turn;
  if (which < 0.75) {
    turn.one_minus_nu = 2.0 * u;
    turn.one_plus_nu = 2.0 * (1.0 - u);
    return turn;
  }
  float signed_u = 2.0 * u - 1.0;
  float nu = pow(max(abs(signed_u), 1.0e-20), 0.33333333333333333);
  nu = signed_u < 0.0 ? -nu : nu;
  turn.one_minus_nu = 1.0 - nu;
  turn.one_plus_nu = 1.0 + nu;
  return turn;
}
// [/rayleigh_turn]

// [henyey_greenstein_turn]
// Inverse of the distribution. With a = 1 - g, w = 1 - g + 2 g u (g >= 0) it is 1 - nu = a (1-u) (a (1+g)/w + a) / w:
// no difference of nearly equal numbers for any g, 0 and almost 1 included. A backward lobe is a forward one seen from
// behind.
Turn henyey_greenstein_turn(float g, float u) {
  float size = abs(g);
  float a = 1.0 - size;
  float w = a + 2.0 * size * u;
  float one_minus_nu = min(a * (1.0 - u) * (a * (1.0 + size) / w + a) / w, 2.0);
  Turn turn;
  turn.one_minus_nu = g >= 0.0 ? one_minus_nu : 2.0 - one_minus_nu;
  turn.one_plus_nu = g >= 0.0 ? 2.0 - one_minus_nu : one_minus_nu;
  return turn;
}
// [/henyey_greenstein_turn]

// [mie_turn]
// Directions are drawn from Henyey-Greenstein's lobe, or from the two lobes where there are two. Cornette-Shanks and
// Draine are that lobe times 1 + alpha nu^2: of the turns drawn for them a share (1 + alpha nu^2) / (1 + alpha) is
// kept, a third at least. The weight could take the factor instead, and its mean would stay right, but a product of a
// thousand such factors is 0 on nearly every path and enormous on the rare others.
Turn mie_turn(Atmosphere atmosphere, float which, float u) {
  float g = atmosphere.mie_g;
  if (MIE_PHASE == 3 && which < atmosphere.mie_alpha) g = atmosphere.second_g;
  return henyey_greenstein_turn(g, u);
}

bool mie_turn_kept(Atmosphere atmosphere, Turn turn, float u) {
  if (MIE_PHASE == 0 || MIE_PHASE == 3) return true;
  float alpha = MIE_PHASE == 1 ? 1.0 : atmosphere.mie_alpha;
  float nu = 1.0 - turn.one_minus_nu;
  return u * (1.0 + alpha) <= 1.0 + alpha * nu * nu;
}

// Draws turns until one is kept: their density is the phase function. After 64 tries the last is taken: 5e-12 of all.
struct MieTurn {
  Turn turn;
  Random random;
};
MieTurn kept_mie_turn(Atmosphere atmosphere, float which, float u, Random random) {
  MieTurn drawn;
  drawn.turn = mie_turn(atmosphere, which, u);
  drawn.random = random;
  bool kept = mie_turn_kept(atmosphere, drawn.turn, which);
  for (int i = 0; i < 64 && !kept; i++) {
    drawn.random = draw(drawn.random);
    drawn.turn = mie_turn(atmosphere, drawn.random.value.x, drawn.random.value.y);
    kept = mie_turn_kept(atmosphere, drawn.turn, drawn.random.value.x);
  }
  return drawn;
}
// [/mie_turn]

// [turned]
// The direction that makes this turn with `axis`, at an angle around it. 1 - nu enters as it is: a turn of 1e-4 keeps
// its digits. Frame without square roots or poles: Duff et al. 2017.
vec3 turned(vec3 axis, Turn turn, float around) {
  float side = axis.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (side + axis.z);
  float b = axis.x * axis.y * a;
  vec3 first = vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
  vec3 second = vec3(b, side + axis.y * axis.y * a, -axis.y);
  float sine = sqrt(max(turn.one_minus_nu * turn.one_plus_nu, 0.0));
  float angle = 6.28318530717958648 * around;
  vec3 to = axis + (first * cos(angle) + second * sin(angle)) * sine - axis * turn.one_minus_nu;
  return to / length(to);
}

// The vector whose components in a frame around `axis`, the same as turned()'s, are those of v.
vec3 about(vec3 axis, vec3 v) {
  float side = axis.z >= 0.0 ? 1.0 : -1.0;
  float a = -1.0 / (side + axis.z);
  float b = axis.x * axis.y * a;
  vec3 first = vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
  vec3 second = vec3(b, side + axis.y * axis.y * a, -axis.y);
  vec3 to = first * v.x + second * v.y + axis * v.z;
  return to / length(to);
}

// A direction into the upper hemisphere with density mu / pi.
vec3 cosine_hemisphere(float u, float around) {
  float angle = 6.28318530717958648 * around;
  float sine = sqrt(u);
  return vec3(sine * cos(angle), sine * sin(angle), sqrt(1.0 - u));
}
// [/turned]

#endif
