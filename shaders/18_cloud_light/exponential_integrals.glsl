// Exponential integrals E1, E2 and E3. Pure functions; the argument is an optical depth.
//
//   En(x) = integral over t from 1 to infinity of exp(-x t) / t^n dt
//   An isotropic sky of radiance L above a plane layer sends the flux 2 pi L E3(x) down through an optical depth x, and the
//   mean of its radiance over all directions is L E2(x) / 2.
// E1: Abramowitz and Stegun 5.1.53 for x <= 1, 5.1.56 above. E2 = exp(-x) - x E1 and E3 = (exp(-x) - x E2) / 2.
#ifndef WELKIN_EXPONENTIAL_INTEGRALS_GLSL
#define WELKIN_EXPONENTIAL_INTEGRALS_GLSL

// [exponential_integral_parts]
// E1 for 0 < x <= 1: absolute error below 2e-7.
float small_exponential_integral_1(float x) {
  float sum = 0.00107857;
  sum = sum * x - 0.00976004;
  sum = sum * x + 0.05519968;
  sum = sum * x - 0.24991055;
  sum = sum * x + 0.99999193;
  sum = sum * x - 0.57721566;
  return sum - log(x);
}

// x exp(x) E1(x) for x > 1 is a quotient of two polynomials of degree 4 in x; here both are divided by x^4, so that nothing
// overflows. Then exp(x) E2(x) = 1 - that quotient is a quotient too, with the difference of the numerators on top. The
// differences of the printed coefficients are exact here; in float32 the subtraction would lose a digit for each factor 10 of x.
float large_denominator(float y) {
  return 1.0 + y * (9.5733223454 + y * (25.6329561486 + y * (21.0996530827 + y * 3.9584969228)));
}

// exp(x) E1(x), y = 1/x.
float scaled_exponential_integral_1(float y) {
  return y * (1.0 + y * (8.5733287401 + y * (18.0590169730 + y * (8.6347608925 + y * 0.2677737343)))) / large_denominator(y);
}

// exp(x) E2(x), y = 1/x.
float scaled_exponential_integral_2(float y) {
  return y * (0.9999936053 + y * (7.5739391756 + y * (12.4648921902 + y * 3.6907231885))) / large_denominator(y);
}
// [/exponential_integral_parts]

// [exponential_integrals]
// Domain x > 0: E1 is infinite at 0. Relative error below 1e-6.
float exponential_integral_1(float x) {
  if (x <= 1.0) return small_exponential_integral_1(x);
  return exp(-x) * scaled_exponential_integral_1(1.0 / x);
}

// Domain x >= 0; E2(0) = 1. Relative error below 5e-6 up to 80, where exp(-x) leaves float32.
float exponential_integral_2(float x) {
  if (x <= 0.0) return 1.0;
  if (x <= 1.0) return exp(-x) - x * small_exponential_integral_1(x);
  return exp(-x) * scaled_exponential_integral_2(1.0 / x);
}

// Domain x >= 0; E3(0) = 1/2. Relative error below 2e-4 at 80 and far smaller where the value matters.
float exponential_integral_3(float x) {
  if (x <= 1.0) return 0.5 * (exp(-max(x, 0.0)) - max(x, 0.0) * exponential_integral_2(x));
  return 0.5 * exp(-x) * (1.0 - x * scaled_exponential_integral_2(1.0 / x));
}
// [/exponential_integrals]

// [five_terms]
// E2 by five terms of the power series of E1, as one source prints it: for the demonstration of what that costs. It is negative
// past x = 2.1, and the max(0, E2) that hides this leaves black cores in every thick cloud.
float exponential_integral_2_five_terms(float x) {
  float series = x * (1.0 - x * (1.0 / 4.0 - x * (1.0 / 18.0 - x * (1.0 / 96.0 - x / 600.0))));
  return exp(-x) - x * (series - log(x) - 0.57721566);
}
// [/five_terms]

#endif
