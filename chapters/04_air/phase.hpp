// The phase functions of shaders/04_air/phase.glsl in double. They are written from the printed formulas and share no
// text with the shader, so that the shader can be tested against them. nu: cosine between the directions of
// propagation. Units: 1/sr.
#pragma once

#include <cmath>
#include <numbers>

namespace welkin::phase {

inline double isotropic() { return 0.25 / std::numbers::pi; }

inline double rayleigh(double nu) { return 3.0 / (16.0 * std::numbers::pi) * (1.0 + nu * nu); }

inline double rayleigh_anisotropic(double nu, double rho) {
  const double c = rho / (2.0 - rho);
  return 3.0 / (16.0 * std::numbers::pi * (1.0 + 2.0 * c)) * ((1.0 + 3.0 * c) + (1.0 - c) * nu * nu);
}

// Takes 1 - nu: from nu, 1 + g^2 - 2 g nu cancels even in double, and small float values of 1 - nu would give one
// result.
inline double henyey_greenstein(double one_minus_nu, double g) {
  return 0.25 / std::numbers::pi * (1.0 - g) * (1.0 + g) /
         std::pow((1.0 - g) * (1.0 - g) + 2.0 * g * one_minus_nu, 1.5);
}

inline double draine(double one_minus_nu, double g, double alpha) {
  const double nu = 1.0 - one_minus_nu;
  return henyey_greenstein(one_minus_nu, g) * (1.0 + alpha * nu * nu) * 3.0 / (3.0 + alpha * (1.0 + 2.0 * g * g));
}

inline double cornette_shanks(double one_minus_nu, double g) {
  const double nu = 1.0 - one_minus_nu;
  return 3.0 / (8.0 * std::numbers::pi) * (1.0 - g) * (1.0 + g) * (1.0 + nu * nu) /
         ((2.0 + g * g) * std::pow((1.0 - g) * (1.0 - g) + 2.0 * g * one_minus_nu, 1.5));
}

inline double double_hg(double one_minus_nu, double g, double second_g, double second_weight) {
  return (1.0 - second_weight) * henyey_greenstein(one_minus_nu, g) +
         second_weight * henyey_greenstein(one_minus_nu, second_g);
}

inline double droplet(double one_minus_nu, double diameter_um) {
  const double weight = std::exp(-0.599085 / (diameter_um - 0.641583) - 0.665888);
  const double peak = henyey_greenstein(one_minus_nu, std::exp(-0.0990567 / (diameter_um - 1.67154)));
  const double body = draine(one_minus_nu, std::exp(-2.20679 / (diameter_um + 3.91029) - 0.428934),
                             std::exp(3.62489 - 8.29288 / (diameter_um + 5.52825)));
  return (1.0 - weight) * peak + weight * body;
}

}  // namespace welkin::phase
