// Phase functions: the share of light scattered per steradian. Each integrates to 1 over the sphere. Units: 1/sr.
//
// They take one_minus_nu = 1 - nu, nu the cosine between the two directions of propagation (forward: nu = 1), because
// in float32 1 + g^2 - 2 g nu cancels for g near 1, while (1-g)^2 + 2 g (1-nu) does not. Domain: one_minus_nu in
// [0, 2] (rounding may pass 2 a little), |g| <= 1; at |g| = 1 the value is that of the limit, 0, in every direction but
// the lobe's own. A strong backward lobe cancels near nu = -1 instead: there, pass (1 - a.(-b), -g).
#ifndef WELKIN_PHASE_GLSL
#define WELKIN_PHASE_GLSL

// [cosine]
// 1 - a.b = |a - b|^2 / 2 for unit vectors: exact to the last digits where a.b rounds to 1.
float one_minus_cosine(vec3 a, vec3 b) {
  vec3 difference = a - b;
  return 0.5 * dot(difference, difference);
}
// [/cosine]

// 1/(4 pi): the same in every direction.
float isotropic_phase() { return 0.079577471545947668; }

// [rayleigh]
// 3/(16 pi) (1 + nu^2): the mean pattern of dipoles that follow unpolarised light.
float rayleigh_phase(float one_minus_nu) {
  float nu = 1.0 - one_minus_nu;
  return 0.059683103659460751 * (1.0 + nu * nu);
}

// 3/(16 pi (1 + 2 c)) ((1 + 3 c) + (1 - c) nu^2), c = rho/(2 - rho): molecules that are not round scatter a share rho
// of depolarised light (Chandrasekhar 1960, section 18). rho = 0.035 gives 0.7629 (1 + 0.932 nu^2)/(4 pi).
float rayleigh_anisotropic_phase(float one_minus_nu, float depolarization) {
  float nu = 1.0 - one_minus_nu;
  float c = depolarization / (2.0 - depolarization);
  return 0.059683103659460751 * ((1.0 + 3.0 * c) + (1.0 - c) * nu * nu) / (1.0 + 2.0 * c);
}
// [/rayleigh]

// [henyey_greenstein]
// (1 - g^2) / (4 pi (1 + g^2 - 2 g nu)^(3/2)), the base being (1-g)^2 + 2 g (1-nu), or (1+g)^2 - 2 g (1+nu) for g < 0.
// The floor 1e-20 is below any base a float g < 1 can give; it makes |g| = 1 give 0 instead of 0/0.
float henyey_greenstein_phase(float one_minus_nu, float g) {
  float d = g >= 0.0 ? (1.0 - g) * (1.0 - g) + 2.0 * g * one_minus_nu
                     : (1.0 + g) * (1.0 + g) - 2.0 * g * max(2.0 - one_minus_nu, 0.0);
  d = max(d, 1.0e-20);
  return 0.079577471545947668 * (1.0 - g) * (1.0 + g) / (d * sqrt(d));
}

// The same formula as it is printed: for the demonstration of what it loses, and for nothing else.
float henyey_greenstein_phase_naive(float nu, float g) {
  float d = 1.0 + g * g - 2.0 * g * nu;
  return 0.079577471545947668 * (1.0 - g * g) / (d * sqrt(d));
}
// [/henyey_greenstein]

// The same for a lobe that may look backward, p(nu, g) = p(-nu, -g): it needs the digits of 1 + nu where a forward lobe
// needs those of 1 - nu. Both come from the vectors, neither from the other.
float henyey_greenstein_lobe(float one_minus_nu, float one_plus_nu, float g) {
  return henyey_greenstein_phase(g >= 0.0 ? one_minus_nu : one_plus_nu, abs(g));
}

// [draine]
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

// Two Henyey-Greenstein lobes, the second with weight in [0, 1]. Both have 1 - g^2 in the numerator.
float double_hg_phase(float one_minus_nu, float one_plus_nu, float g, float second_g, float second_weight) {
  // Not mix(): a driver may compute a + w (b - a), which for w near 1 and a far larger than b has lost b.
  return henyey_greenstein_lobe(one_minus_nu, one_plus_nu, g) * (1.0 - second_weight) +
         henyey_greenstein_lobe(one_minus_nu, one_plus_nu, second_g) * second_weight;
}

// Water droplets of 5 to 50 um diameter: a Henyey-Greenstein peak and a Draine body, fitted to Mie's series by
// Jendersie and d'Eon 2023.
float droplet_phase(float one_minus_nu, float diameter_um) {
  float peak_g = exp(-0.0990567 / (diameter_um - 1.67154));
  float body_g = exp(-2.20679 / (diameter_um + 3.91029) - 0.428934);
  float alpha = exp(3.62489 - 8.29288 / (diameter_um + 5.52825));
  float weight = exp(-0.599085 / (diameter_um - 0.641583) - 0.665888);
  return mix(henyey_greenstein_phase(one_minus_nu, peak_g), draine_phase(one_minus_nu, body_g, alpha), weight);
}
// [/draine]

#endif
