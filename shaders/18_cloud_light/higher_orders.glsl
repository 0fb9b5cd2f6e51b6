// Light of the second and all higher orders of scattering, from two optical depths and one number. Pure functions.
//
// Light that is scattered forward is hardly turned. Split the phase function: a share 1 - g of the scatterings forgets its
// direction, the others keep to it more or less. Then (g the mean cosine, albedo omega; k = 1 - omega g, the share lost from the
// straight way)
//
//   straight  Light that has only kept its direction, n times on a way of optical depth t, from the sun to the point and on to
//             the eye. One of the n is the corner. n lobes in a row are one lobe of g^n, and their number is Poisson's:
//                sum over n >= 2 of  t^(n-1)/n! e^-t omega^n HG(nu; g^n)
//             In Legendre's moments each is a closed form. The isotropic one counts (omega g)^n: the others have forgotten.
//   diffuse   Light that has forgotten. Where it goes is what was known before it came: by reciprocity, the light at x from a
//             sun in direction s is the chance that light born at x leaves towards s. All light leaves somewhere, so
//                fluence(x, s) = f(tau(x, s)) / mean over all directions of f(tau(x, .)),    f(tau) = (1 + k tau)^(-3/2)
//             keeps the light of a white furnace by construction. It is seen through the same straight ways: e^(-k tau).
//             Light of the sky and of the ground comes by the same ways: each has its directions' share of that mean.
//
// f was chosen among powers on slabs and balls alone; it has no other constant. See docs/chapters/18_cloud_light_more.md.
#ifndef WELKIN_HIGHER_ORDERS_GLSL
#define WELKIN_HIGHER_ORDERS_GLSL

#include "07_ground_truth/flight.glsl"
#include "18_cloud_light/cloud_phase.glsl"

// [escape]
// Chance, up to a factor, that light which has forgotten its direction leaves through an optical depth. apart: k above.
float escape_chance(float tau, float apart) {
  float x = 1.0 / (1.0 + apart * tau);
  return x * sqrt(x);
}

// Four directions to the corners of a tetrahedron: their mean of a smooth function is that over the sphere, and exactly so
// for polynomials of degree 2.
const int kEscapeDirections = 4;
vec3 escape_direction(int i) {
  float x = i == 0 || i == 3 ? 0.57735026918962576 : -0.57735026918962576;
  float y = i == 0 || i == 2 ? 0.57735026918962576 : -0.57735026918962576;
  float z = i == 0 || i == 1 ? 0.57735026918962576 : -0.57735026918962576;
  return vec3(x, y, z);
}
// [/escape]

// [higher_orders]
// What all points of a ray share.
struct HigherOrders {
  float albedo;
  float apart;      // k = 1 - albedo g
  float keeps;      // albedo g, the moments 0 and 1 of one scattering
  float keeps_two;  // albedo g^2, moment 2
  float low;        // (1 + 3 nu) / 4 pi
  float second;     // 5 P2(nu) / 4 pi
  float order_2;    // what moments 0 to 2 leave of HG(nu; g^n), times albedo^n
  float order_3;
  float order_4;
  float absorbs;    // per optical depth k tau: half the diffusion exponent sqrt(3 (1 - albedo'))
};

float rest_of_lobe(float g, float one_minus_nu, float one_plus_nu, float nu, float p2) {
  return henyey_greenstein_lobe(one_minus_nu, one_plus_nu, g) - 0.079577471545947668 * (1.0 + 3.0 * g * nu + 5.0 * g * g * p2);
}

HigherOrders higher_orders(CloudPhase phase, float albedo, float one_minus_nu, float one_plus_nu) {
  float g = cloud_mean_cosine(phase);
  float nu = 1.0 - one_minus_nu;
  float p2 = 1.5 * nu * nu - 0.5;
  HigherOrders orders;
  orders.albedo = albedo;
  orders.keeps = albedo * g;
  orders.keeps_two = albedo * g * g;
  orders.apart = 1.0 - orders.keeps;
  orders.low = 0.079577471545947668 * (1.0 + 3.0 * nu);
  orders.second = 0.079577471545947668 * 5.0 * p2;
  orders.order_2 = albedo * albedo * rest_of_lobe(g * g, one_minus_nu, one_plus_nu, nu, p2);
  orders.order_3 = albedo * albedo * albedo * rest_of_lobe(g * g * g, one_minus_nu, one_plus_nu, nu, p2);
  orders.order_4 = albedo * albedo * albedo * albedo * rest_of_lobe(g * g * g * g, one_minus_nu, one_plus_nu, nu, p2);
  orders.absorbs = 0.5 * sqrt(max(3.0 * (1.0 - albedo) / max(orders.apart, 1.0e-6), 0.0));
  return orders;
}
// [/higher_orders]

// [straight]
// Integral over a step of the view ray of e^(-c tau), from its optical depth before the step.
float step_weight(float c, float before, float across) { return across * exp(-c * before) * mean_exponential(c * across); }

// One moment of orders >= 2 over a step: (e^-(1-G)t - e^-t)/t - G e^-t, with t = tau + tau_sun. weight: step_weight of 1 - G,
// plain: of 1.
float straight_moment(float keeps, float t, float tau_sun, float weight, float plain) {
  float x = keeps * t;
  if (t < 0.05) return plain * exp(-tau_sun) * keeps * x * (0.5 + x * (0.16666666666666667 + x * 0.041666666666666667));
  return (exp(-(1.0 - keeps) * tau_sun) * weight - exp(-tau_sun) * plain) / t - keeps * exp(-tau_sun) * plain;
}
// [/straight]

// [skylight]
// Of one step, the share of the skies' radiance that is scattered there to the eye: of the upper and the lower half, whose
// directions have these sums of escape chances.
vec2 skylight_of_step(HigherOrders orders, float before, float across, vec2 escape) {
  float scattered = (orders.albedo - orders.keeps) * step_weight(orders.apart, before, across);
  return vec2(escape.x, escape.y) * (scattered / max(escape.x + escape.y, 1.0e-20));
}

// And the share of the radiance behind the cloud that comes through having only kept its direction, without what comes through
// untouched. With the two above and e^-tau the shares of a cloud that absorbs nothing add up to 1.
float blurred_behind(HigherOrders orders, float tau) { return exp(-orders.apart * tau) - exp(-tau); }
// [/skylight]

// [orders_of_step]
// Radiance of orders >= 2 from one step, with the sun's irradiance 1: optical depth before it and across it, from its middle to
// the sun, and the mean escape chance there.
float higher_orders_of_step(HigherOrders orders, float before, float across, float tau_sun, float mean_escape) {
  float t = before + 0.5 * across + tau_sun;
  float plain = step_weight(1.0, before, across);
  float apart = step_weight(orders.apart, before, across);
  float two = step_weight(1.0 - orders.keeps_two, before, across);
  float sum = orders.low * straight_moment(orders.keeps, t, tau_sun, apart, plain);
  sum += orders.second * straight_moment(orders.keeps_two, t, tau_sun, two, plain);
  sum += exp(-tau_sun) * plain * t * (0.5 * orders.order_2 + t * (0.16666666666666667 * orders.order_3 + t * 0.041666666666666667 * orders.order_4));
  float fluence = escape_chance(tau_sun, orders.apart) / max(mean_escape, 1.0e-20) * exp(-orders.absorbs * orders.apart * tau_sun);
  float forgets = orders.albedo - orders.keeps;
  return sum + 0.079577471545947668 * forgets * (apart * fluence - plain * exp(-tau_sun));
}
// [/orders_of_step]

#endif
