// Coefficients of air. See air.hpp.
#include "chapters/04_air/air.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/error.hpp"

namespace welkin {
namespace {

using std::numbers::pi;

void require(bool good, const char* what, double value, const char* accepted) {
  if (!good) fail("{} = {:g} is outside the formula's domain: accepted is {}", what, value, accepted);
}

}  // namespace

// [refractive_index]
double refractive_index(double wavelength_um) {
  require(wavelength_um >= 0.23 && wavelength_um <= 1.69, "wavelength", wavelength_um, "0.23 … 1.69 um");
  const double wavenumber2 = 1.0 / (wavelength_um * wavelength_um);  // um^-2
  return 1.0 + 1e-8 * (5791817.0 / (238.0185 - wavenumber2) +
                       167909.0 / (57.362 - wavenumber2));  // Peck and Reeder 1972, four constants
}
// [/refractive_index]

// [number_density]
double number_density(double pressure_Pa, double temperature_K) {
  require(pressure_Pa >= 0.0 && std::isfinite(pressure_Pa), "pressure", pressure_Pa, "0 Pa and more");
  require(temperature_K > 0.0 && std::isfinite(temperature_K), "temperature", temperature_K, "more than 0 K");
  constexpr double boltzmann_J_per_K = 1.380649e-23;
  return pressure_Pa / (boltzmann_J_per_K * temperature_K);
}
// [/number_density]

// [king_factor]
double king_factor(double wavelength_um) {
  require(wavelength_um >= 0.2 && wavelength_um <= 4.0, "wavelength", wavelength_um, "0.2 … 4 um");
  const double x = 1.0 / (wavelength_um * wavelength_um);
  const double nitrogen = 1.034 + 3.17e-4 * x;                    // Bates 1984, as Bodhaine et al. 1999, eq. 5
  const double oxygen = 1.096 + 1.385e-3 * x + 1.448e-4 * x * x;  // eq. 6
  constexpr double argon = 1.00, carbon_dioxide = 1.15;           // an argon atom is round
  constexpr double share[] = {78.084, 20.946, 0.934, 0.036};      // per cent of volume
  return (share[0] * nitrogen + share[1] * oxygen + share[2] * argon + share[3] * carbon_dioxide) /
         (share[0] + share[1] + share[2] + share[3]);  // eq. 23
}

double king_factor_from_depolarization(double rho) { return (6.0 + 3.0 * rho) / (6.0 - 7.0 * rho); }
double depolarization(double king) { return 6.0 * (king - 1.0) / (3.0 + 7.0 * king); }
// [/king_factor]

// [rayleigh]
double rayleigh_scattering_per_km(double wavelength_um, double n, double molecules_per_m3, double king) {
  require(molecules_per_m3 > 0.0, "number density", molecules_per_m3, "more than 0");
  const double wavelength_m = wavelength_um * 1e-6;
  const double refraction = (n - 1.0) * (n + 1.0);  // n^2 - 1, without the cancellation
  return 1e3 * 8.0 * pi * pi * pi * refraction * refraction / (3.0 * molecules_per_m3 * std::pow(wavelength_m, 4)) *
         king;
}

double rayleigh_scattering_per_km(double wavelength_um) {
  return rayleigh_scattering_per_km(wavelength_um, refractive_index(wavelength_um),
                                    number_density(kStandardPressure_Pa, kStandardTemperature_K),
                                    king_factor(wavelength_um));
}
// [/rayleigh]

// [aerosol]
double aerosol_optical_depth(double wavelength_um, double turbidity) {
  require(turbidity >= 1.0 && turbidity <= 20.0, "turbidity", turbidity, "1 … 20");
  require(wavelength_um >= 0.3 && wavelength_um <= 1.1, "wavelength", wavelength_um, "0.3 … 1.1 um");
  return (0.04608365822050 * turbidity - 0.04586025928522) * std::pow(wavelength_um, -1.3);
}
// [/aerosol]

// [ozone]
double ozone_absorption_per_km(double cross_section_m2, double column_DU, double half_width_km) {
  require(half_width_km > 0.0, "half width", half_width_km, "more than 0 km");
  constexpr double molecules_per_m2_and_DU = 2.687e20;
  const double peak_per_m3 =
      column_DU * molecules_per_m2_and_DU / (half_width_km * 1e3);  // a tent's area is height times half width
  return 1e3 * cross_section_m2 * peak_per_m3;
}
// [/ozone]

// [quoted]
std::vector<Medium> quoted_earth() {
  return {{.kind = "rayleigh", .scattering_per_km = {5.802e-3, 13.558e-3, 33.1e-3}, .scale_height_km = 8.0},
          // Absorption is extinction - scattering = 4.440e-3 - 3.996e-3.
          {.kind = "mie",
           .scattering_per_km = glm::dvec3(3.996e-3),
           .absorption_per_km = glm::dvec3(0.444e-3),
           .scale_height_km = 1.2,
           .phase = Phase::cornette_shanks,
           .g = 0.8},
          {.kind = "ozone",
           .absorption_per_km = {0.650e-3, 1.881e-3, 0.085e-3},
           .profile = Profile::tent,
           .peak_altitude_km = 25.0,
           .half_width_km = 15.0}};
}
// [/quoted]

// [derived]
std::vector<Medium> derived_earth(double turbidity, double ozone_DU) {
  constexpr double aerosol_albedo = 0.9;
  std::vector<Medium> media = quoted_earth();  // keeps profiles and phase functions; replaces every coefficient
  for (int c = 0; c < 3; ++c) {
    media[0].scattering_per_km[c] = rayleigh_scattering_per_km(kWavelengths_um[c]);
    const double extinction = aerosol_optical_depth(kWavelengths_um[c], turbidity) / media[1].scale_height_km;
    media[1].scattering_per_km[c] = aerosol_albedo * extinction;
    media[1].absorption_per_km[c] = (1.0 - aerosol_albedo) * extinction;
    media[2].absorption_per_km[c] = ozone_absorption_per_km(kOzoneCrossSection_m2[c], ozone_DU, media[2].half_width_km);
  }
  return media;
}
// [/derived]

// [columns]
double relative_density(const Medium& medium, double altitude_km) {
  if (medium.profile == Profile::tent)
    return std::max(0.0, 1.0 - std::abs(altitude_km - medium.peak_altitude_km) / medium.half_width_km);
  return std::exp(-altitude_km / medium.scale_height_km);
}

double vertical_column_km(const Medium& medium, double top_km) {
  if (medium.profile == Profile::exponential)
    return -medium.scale_height_km * std::expm1(-top_km / medium.scale_height_km);
  // A tent. With u the distance of z from its lower end, in half widths, its integral up to z is u^2/2 half widths
  // below the peak (u <= 1) and 1 - (2-u)^2/2 above it.
  const auto below = [&](double z) {
    const double u = std::clamp((z - medium.peak_altitude_km) / medium.half_width_km + 1.0, 0.0, 2.0);
    return medium.half_width_km * (u <= 1.0 ? u * u / 2.0 : 1.0 - (2.0 - u) * (2.0 - u) / 2.0);
  };
  return below(top_km) - below(0.0);
}
// [/columns]

// [make_atmosphere]
interop::Atmosphere make_atmosphere(const Scene& scene) {
  // Coefficients are 0; lengths are 1 km, since shaders divide by them.
  const Medium none{.scale_height_km = 1.0, .half_width_km = 1.0};
  const auto medium = [&](const char* kind) -> const Medium& {
    const Medium* found = scene.medium(kind);
    return found ? *found : none;
  };
  const Medium &rayleigh = medium("rayleigh"), &mie = medium("mie"), &ozone = medium("ozone");
  const Planet& planet = scene.planet;
  const auto single = [](double value) { return static_cast<float>(value); };
  return {.rayleigh_scattering = rayleigh.scattering_per_km,
          .rayleigh_scale_height_km = single(rayleigh.scale_height_km),
          .mie_scattering = mie.scattering_per_km,
          .mie_scale_height_km = single(mie.scale_height_km),
          .mie_extinction = mie.scattering_per_km + mie.absorption_per_km,
          .mie_g = single(mie.g),
          .ozone_absorption = ozone.absorption_per_km,
          .ozone_peak_km = single(ozone.peak_altitude_km),
          .ground_radius_km = single(planet.ground_radius_km),
          .top_km = single(planet.top_radius_km - planet.ground_radius_km),
          .ozone_half_width_km = single(ozone.half_width_km),
          .sun_angular_radius = single(scene.sun.angular_radius_deg * pi / 180.0),
          .ground_albedo = planet.ground_albedo,
          .second_g = single(mie.second_g),
          .solar_irradiance = scene.sun.irradiance,
          .mie_alpha = single(mie.phase == Phase::double_hg ? mie.second_weight : mie.draine_alpha)};
}
// [/make_atmosphere]

// [variant]
AirVariant air_variant(const Scene& scene) {
  AirVariant variant;
  for (const Constituent& effect : constituents(scene)) {  // the same list that --explain prints
    if (effect.name == "rayleigh") variant.rayleigh = effect.on;
    if (effect.name == "mie") variant.mie = effect.on;
    if (effect.name == "ozone") variant.ozone = effect.on;
  }
  if (variant.mie) variant.mie_phase = static_cast<uint32_t>(scene.medium("mie")->phase);
  return variant;
}

gpu::Specialization specialization(const AirVariant& variant) {
  return {variant.rayleigh, variant.mie, variant.ozone, variant.mie_phase};
}
// [/variant]

}  // namespace welkin
