// What air is made of: its coefficients derived from physics, the same as the field quotes them, and the block that
// hands a scene's to the shaders.
//
// Wavelengths in um, coefficients in 1/km, columns in km (of air as dense as at the ground, or at the ozone's peak).
// CPU, double. The derivations and the sources with equation numbers are in docs/chapters/04_air.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/gpu/pipeline.hpp"
#include "common/scene/scene.hpp"
#include "shaders/interop/atmosphere.h"

namespace welkin {

inline constexpr std::array<double, 3> kWavelengths_um{0.680, 0.550, 0.440};  // red, green, blue
inline constexpr double kStandardPressure_Pa = 101325.0;
inline constexpr double kStandardTemperature_K = 288.15;  // 15 C: the air Peck and Reeder measured

// --- molecules ---
// n of dry air at kStandardPressure_Pa and kStandardTemperature_K, 0.03 % CO2. Domain 0.23 … 1.69 um.
double refractive_index(double wavelength_um);
// Molecules per m^3 of an ideal gas: p / (k T).
double number_density(double pressure_Pa, double temperature_K);
// King factor, > 1: how much more molecules scatter because they are not round. Dry air with 0.036 % CO2.
double king_factor(double wavelength_um);
// The share of depolarised light, rho, follows from the King factor F and F from it: F = (6 + 3 rho) / (6 - 7 rho).
double depolarization(double king);
double king_factor_from_depolarization(double rho);
// beta = 8 pi^3 (n^2 - 1)^2 / (3 N lambda^4) F, in 1/km, N in 1/m^3.
double rayleigh_scattering_per_km(double wavelength_um, double n, double molecules_per_m3, double king);
// The same for standard air, everything from the functions above.
double rayleigh_scattering_per_km(double wavelength_um);

// --- aerosol ---
// Vertical optical depth of the aerosol from turbidity T, after Angstrom: tau = (0.04608 T - 0.04586) lambda^-1.3.
// Domain: 1 <= T <= 20 (10 is haze; the line is a fit, and negative below T = 0.9952), 0.3 … 1.1 um.
double aerosol_optical_depth(double wavelength_um, double turbidity);

// --- ozone ---
// Absorption at the peak of a tent of this half width that holds `column_DU` (1 DU = 2.687e20 molecules per m^2).
double ozone_absorption_per_km(double cross_section_m2, double column_DU, double half_width_km);
inline constexpr std::array<double, 3> kOzoneCrossSection_m2{1.209e-25, 3.500e-25, 1.582e-26};  // at kWavelengths_um

// --- media ---
// The three media of the neutral Earth as the field quotes them, and as the functions above derive them.
std::vector<Medium> quoted_earth();
std::vector<Medium> derived_earth(double turbidity, double ozone_DU);
// A medium's density at an altitude, relative to where its coefficients hold (the ground, or the tent's peak); and the
// integral of that from 0 to `top_km`.
double relative_density(const Medium& medium, double altitude_km);
double vertical_column_km(const Medium& medium, double top_km);

// --- for shaders ---
// The scene's air, ground and sun. What the scene lacks is 0 (and not compiled in: see AirVariant).
interop::Atmosphere make_atmosphere(const Scene& scene);

// Which constituents a scene has: the specialization constants 0 to 3 of shaders/04_air/variant.glsl.
struct AirVariant {
  bool rayleigh = false, mie = false, ozone = false;
  uint32_t mie_phase = 0;  // 0 henyey_greenstein, 1 cornette_shanks, 2 draine, 3 double_hg
  bool operator==(const AirVariant&) const = default;
};
AirVariant air_variant(const Scene& scene);
gpu::Specialization specialization(const AirVariant& variant);

}  // namespace welkin
