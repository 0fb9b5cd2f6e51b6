// Reference single scattering: adaptive Gauss-Kronrod quadrature in double precision, nested in depth two.
//
// Purpose: the truth of rank 2 that the chapters are tested against. It shares nothing with the shaders: neither code,
// nor parameters, nor the choice of nodes. It is slow (milliseconds per ray) and says how wrong it may be.
//
// Units: km, radians, coefficients 1/km; radiance per unit of solar irradiance at the top of the atmosphere.
// Model: a spherical planet of radius R, an atmosphere from R to R_top of three constituents
//   rayleigh  exp(-h/H_R)      scatters
//   mie       exp(-h/H_M)      scatters and absorbs
//   ozone     max(0, 1 - |h - peak|/half_width)   absorbs
// The sun is a point direction without refraction, so the planet's shadow is a cylinder of radius R.
//
//   L = P_R(nu) I_R + P_M(nu) I_M + albedo * ground1
//   I_k = scattering_k * integral over the lit part of the ray of  density_k(t) T(camera, t) T(t, sun) dt
//   ground1 = T(camera, ground) T(ground, sun) max(mu_sun, 0) / pi        (0 when the ray does not end on the ground)
#pragma once

#include <array>

namespace welkin::reference {

using Rgb = std::array<double, 3>;
using Direction = std::array<double, 3>;

struct Planet {
  double ground_radius_km = 6360.0;
  double top_radius_km = 6460.0;
  Rgb rayleigh_scattering_per_km{5.802e-3, 13.558e-3, 33.1e-3};
  double rayleigh_scale_height_km = 8.0;
  Rgb mie_scattering_per_km{3.996e-3, 3.996e-3, 3.996e-3};
  Rgb mie_extinction_per_km{4.440e-3, 4.440e-3, 4.440e-3};
  double mie_scale_height_km = 1.2;
  Rgb ozone_absorption_per_km{0.650e-3, 1.881e-3, 0.085e-3};
  double ozone_peak_km = 25.0;
  double ozone_half_width_km = 15.0;
};

Planet earth();
Planet dense_alien();

// Phase functions over the cosine nu between the two directions of propagation; each integrates to 1 over the sphere.
double rayleigh_phase(double nu);
double henyey_greenstein(double nu, double g);
double cornette_shanks(double nu, double g);
double draine(double nu, double g, double alpha);

enum class RayEnd { kSky, kGround, kMiss };

struct SingleScattering {
  Rgb rayleigh{};                    // I_R, before its phase function
  Rgb mie{};                         // I_M, before its phase function
  Rgb ground1{};                     // radiance of the directly lit ground of albedo 1, seen through the air
  Rgb transmittance{1.0, 1.0, 1.0};  // of the whole ray
  double nu = 1.0;                   // cosine between view and sun
  double tangent_altitude_km = 0.0;  // of the line the ray lies on; minus the radius when vertical
  double relative_error = 0.0;       // largest estimated relative error of the six integrals
  RayEnd end = RayEnd::kMiss;
};

// Integrals of the three densities (rayleigh, mie, ozone), in km, over the straight line from altitude_km with zenith
// cosine mu and the given sine (pass both: near the vertical neither follows from the other), for length_km.
// Domain: the segment lies inside the atmosphere. Relative error below 1e-11.
std::array<double, 3> columns(const Planet& planet, double altitude_km, double mu, double sine, double length_km);

// Transmittance from a point inside the atmosphere to its top; 0 when the planet is in the way.
Rgb transmittance_to_top(const Planet& planet, double altitude_km, double mu);

// altitude_km >= 0, any distance; view and sun are unit vectors in the camera's local frame, z up.
// tolerance: relative, of each of the six integrals. Never throws; a ray that misses gives 0 and transmittance 1.
SingleScattering single_scattering(const Planet& planet, double altitude_km, const Direction& view,
                                   const Direction& sun, double tolerance = 1e-8);

// Unit direction from angles in degrees; azimuth 0 is +x. Exact zeros at 0, 90 and 180 degrees.
Direction direction_from_degrees(double zenith_deg, double azimuth_deg);

}  // namespace welkin::reference
