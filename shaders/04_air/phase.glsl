// Phase functions: the share of light scattered per steradian. Each integrates to 1 over the sphere. Units: 1/sr.
//
// They take one_minus_nu = 1 - nu, nu the cosine between the two directions of propagation (forward: nu = 1), because
// in float32 1 + g^2 - 2 g nu cancels for g near 1, while (1-g)^2 + 2 g (1-nu) does not. Domain: one_minus_nu in
// [0, 2], |g| < 1.
#ifndef WELKIN_PHASE_GLSL
#define WELKIN_PHASE_GLSL

// 1 - a.b = |a - b|^2 / 2 for unit vectors: exact to the last digits where a.b rounds to 1.
float one_minus_cosine(vec3 a, vec3 b) {
  vec3 difference = a - b;
  return 0.5 * dot(difference, difference);
}

// 3/(16 pi) (1 + nu^2)
float rayleigh_phase(float one_minus_nu) {
  float nu = 1.0 - one_minus_nu;
  return 0.059683103659460751 * (1.0 + nu * nu);
}

// (1 - g^2) / (4 pi (1 + g^2 - 2 g nu)^(3/2))
float henyey_greenstein_phase(float one_minus_nu, float g) {
  float d = (1.0 - g) * (1.0 - g) + 2.0 * g * one_minus_nu;
  return 0.079577471545947668 * (1.0 - g) * (1.0 + g) / (d * sqrt(d));
}

// Draine 2003: Henyey-Greenstein times (1 + alpha nu^2) / (1 + alpha (1 + 2 g^2) / 3).
// alpha = 0: Henyey-Greenstein; alpha = 1: Cornette-Shanks; g = 0, alpha = 1: Rayleigh.
float draine_phase(float one_minus_nu, float g, float alpha) {
  float nu = 1.0 - one_minus_nu;
  return henyey_greenstein_phase(one_minus_nu, g) * (1.0 + alpha * nu * nu) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

// 3/(8 pi) (1 - g^2)(1 + nu^2) / ((2 + g^2)(1 + g^2 - 2 g nu)^(3/2))
float cornette_shanks_phase(float one_minus_nu, float g) {
  return draine_phase(one_minus_nu, g, 1.0);
}

// Two Henyey-Greenstein lobes, the second with weight in [0, 1].
float double_hg_phase(float one_minus_nu, float g, float second_g, float second_weight) {
  return mix(henyey_greenstein_phase(one_minus_nu, g), henyey_greenstein_phase(one_minus_nu, second_g), second_weight);
}

#endif
