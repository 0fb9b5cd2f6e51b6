// Chapter 04: coefficients derived from physics, the quoted table, and what the scene leaves out.
#include <catch2/catch.hpp>
#include <cmath>

#include "chapters/04_air/air.hpp"
#include "chapters/04_air/phase.hpp"
#include "common/error.hpp"
#include "tree.hpp"

using namespace welkin;

namespace {

Scene named(const char* name) { return load_scene(name, std::string(WELKIN_SOURCE_DIRECTORY) + "/chapters/scenes"); }

// What the numbers of the neutral Earth must add up to; empty if they do. Catches the slips that copied tables carry.
std::vector<std::string> faults_of_earth(const std::vector<Medium>& media) {
  std::vector<std::string> faults;
  const auto expect = [&](const char* what, double value, double wanted, double tolerance) {
    if (!(std::abs(value - wanted) <= tolerance))
      faults.push_back(fmt::format("{} is {:g}, not {:g}", what, value, wanted));
  };
  constexpr double space_km = 1e4;
  for (const Medium& medium : media) {
    const double column = vertical_column_km(medium, space_km);
    if (medium.kind == "rayleigh") expect("Rayleigh column in km", column, 8.0, 1e-9);
    if (medium.kind == "ozone") expect("ozone column in km", column, 15.0, 1e-9);
    if (medium.kind != "mie") continue;
    expect("Mie column in km", column, 1.2, 1e-9);
    for (int c = 0; c < 3; ++c)
      expect("Mie single-scattering albedo",
             medium.scattering_per_km[c] / (medium.scattering_per_km[c] + medium.absorption_per_km[c]), 0.9, 1e-3);
  }
  return faults;
}

}  // namespace

TEST_CASE("04 air: quoted media and the scene 'earth' hold albedo 0.9 and columns 8.00, 1.20, 15.0 km") {
  CHECK(faults_of_earth(quoted_earth()).empty());
  const Scene earth = named("earth");
  CHECK(faults_of_earth(earth.media).empty());
  for (const Medium& quoted : quoted_earth()) {
    const Medium* medium = earth.medium(quoted.kind);
    REQUIRE(medium != nullptr);
    for (int c = 0; c < 3; ++c) {
      CHECK(medium->scattering_per_km[c] == Approx(quoted.scattering_per_km[c]).epsilon(1e-12));
      CHECK(medium->absorption_per_km[c] == Approx(quoted.absorption_per_km[c]).epsilon(1e-12).margin(1e-15));
    }
  }
}

TEST_CASE("04 air: the copied slips are caught by the table test") {
  const auto with = [](auto change) {
    std::vector<Medium> media = quoted_earth();
    change(media);
    return faults_of_earth(media);
  };
  // Absorption printed ten times too large: albedo 0.476.
  CHECK(with([](auto& m) { m[1].absorption_per_km = glm::dvec3(4.40e-3); }).size() == 3);
  CHECK(3.996 / (3.996 + 4.40) == Approx(0.476).margin(5e-4));
  // Scattering and absorption swapped, extinction taken for absorption, one channel wrong.
  CHECK(with([](auto& m) { std::swap(m[1].scattering_per_km, m[1].absorption_per_km); }).size() == 3);
  CHECK(with([](auto& m) { m[1].absorption_per_km = glm::dvec3(4.440e-3); }).size() == 3);
  CHECK(with([](auto& m) { m[1].absorption_per_km.y *= 1.1; }).size() == 1);
  // Scale heights exchanged or in another unit, a tent half as wide or standing on the ground.
  CHECK(with([](auto& m) { std::swap(m[0].scale_height_km, m[1].scale_height_km); }).size() == 2);
  CHECK(with([](auto& m) { m[2].half_width_km = 7.5; }).size() == 1);
  CHECK(with([](auto& m) { m[2].peak_altitude_km = 0.0; }).size() == 1);
}

TEST_CASE("04 air: vertical columns are the integrals of the profiles") {
  for (const Medium& medium : quoted_earth()) {
    double sum = 0.0;
    constexpr int steps = 200'000;
    for (int i = 0; i < steps; ++i) sum += relative_density(medium, (i + 0.5) * 100.0 / steps) * (100.0 / steps);
    CHECK(vertical_column_km(medium, 100.0) ==
          Approx(sum).epsilon(1e-7));  // midpoint rule: (dh/H)^2/24 = 7e-9, 2e-9 at a kink
  }
}

TEST_CASE("04 air: the index of refraction and the density of standard air are the known ones") {
  for (const double wavelength :
       {0.44, 0.5893, 0.68}) {  // another fit to other measurements of the same air: Edlen 1953
    const double x = 1.0 / (wavelength * wavelength);
    CHECK((refractive_index(wavelength) - 1.0) * 1e8 ==
          Approx(6432.8 + 2949810.0 / (146.0 - x) + 25540.0 / (41.0 - x)).epsilon(2e-4));
  }
  CHECK(number_density(101325.0, 273.15) == Approx(2.686780111e25).epsilon(1e-8));  // Loschmidt's constant, CODATA 2018
  CHECK(number_density(kStandardPressure_Pa, kStandardTemperature_K) == Approx(2.5469e25).epsilon(1e-4));
  CHECK(refractive_index(0.4) > refractive_index(0.5));  // normal dispersion
}

TEST_CASE("04 air: King factor and depolarisation are inverse, and of the known size") {
  for (const double wavelength : {0.3, 0.44, 0.55, 0.68, 1.0})
    CHECK(king_factor_from_depolarization(depolarization(king_factor(wavelength))) ==
          Approx(king_factor(wavelength)).epsilon(1e-12));
  CHECK(king_factor(0.55) == Approx(1.0490).margin(2e-4));
  CHECK(king_factor_from_depolarization(0.035) ==
        Approx(1.0608).margin(1e-4));                                       // the older value behind the quoted table
  CHECK(depolarization(king_factor(0.55)) == Approx(0.0283).margin(5e-5));  // AIR_DEPOLARIZATION of constant_sky.glsl
  CHECK(king_factor(0.3) > king_factor(0.7));
}

TEST_CASE("04 air: beta goes as lambda^-4, linearly with density, and vanishes for n = 1") {
  const double at_550 = rayleigh_scattering_per_km(0.55, 1.0003, 2.5e25, 1.05);
  CHECK(rayleigh_scattering_per_km(0.275, 1.0003, 2.5e25, 1.05) / at_550 == Approx(16.0).epsilon(1e-12));
  CHECK(rayleigh_scattering_per_km(0.55, 1.0, 2.5e25, 1.05) == 0.0);
  // Half the density has half of n - 1, and so half the scattering (n^2 - 1 is 1.5e-4 off linear).
  CHECK(rayleigh_scattering_per_km(0.55, 1.00015, 1.25e25, 1.05) / at_550 == Approx(0.5).epsilon(2e-4));
}

TEST_CASE("04 air: the quoted Rayleigh numbers are those of n = 1.0003, N = 2.545e25, rho = 0.035") {
  const std::vector<Medium> quoted = quoted_earth();
  for (int c = 0; c < 3;
       ++c)  // the table is rounded to four digits, and its constant 1.24062e-6 um^4/m to that of older inputs
    CHECK(rayleigh_scattering_per_km(kWavelengths_um[c], 1.0003, 2.545e25, king_factor_from_depolarization(0.035)) ==
          Approx(quoted[0].scattering_per_km[c]).epsilon(1.5e-3));
}

TEST_CASE("04 air: measured n makes the quoted Rayleigh numbers 15 to 20 % too large") {
  const std::vector<Medium> quoted = quoted_earth();
  const double ratio[] = {1.196, 1.180, 1.154};
  for (int c = 0; c < 3; ++c)
    CHECK(quoted[0].scattering_per_km[c] / rayleigh_scattering_per_km(kWavelengths_um[c]) ==
          Approx(ratio[c]).margin(2.5e-3));
}

TEST_CASE("04 air: ozone from cross-sections and 300 Dobson units is the quoted ozone") {
  const std::vector<Medium> quoted = quoted_earth(), derived = derived_earth(2.0, 300.0);
  for (int c = 0; c < 3; ++c)  // the table is rounded to three decimals
    CHECK(derived[2].absorption_per_km[c] == Approx(quoted[2].absorption_per_km[c]).margin(0.5e-6));
}

TEST_CASE("04 air: the quoted aerosol is that of turbidity 1.05") {
  const std::vector<Medium> quoted = quoted_earth();
  const double quoted_depth =
      (quoted[1].scattering_per_km.y + quoted[1].absorption_per_km.y) * quoted[1].scale_height_km;
  CHECK(quoted_depth == Approx(5.328e-3).epsilon(1e-12));
  CHECK(aerosol_optical_depth(0.55, 1.0484) == Approx(quoted_depth).epsilon(0.01));
  CHECK(aerosol_optical_depth(0.55, 2.0) == Approx(0.1007).epsilon(2e-3));  // a clear day is twenty times that
  CHECK(aerosol_optical_depth(0.44, 3.0) / aerosol_optical_depth(0.88, 3.0) ==
        Approx(std::pow(2.0, 1.3)).epsilon(1e-12));
  CHECK(faults_of_earth(derived_earth(3.0, 300.0)).empty());
}

TEST_CASE("04 air: a formula asked outside its domain says so in one line") {
  CHECK_THROWS_WITH(refractive_index(5.0), Catch::Contains("0.23 … 1.69 um"));
  CHECK_THROWS_AS(aerosol_optical_depth(0.55, 0.9), Error);  // the fit would be negative
  CHECK_THROWS_AS(aerosol_optical_depth(0.55, std::nan("")), Error);
  CHECK_THROWS_AS(number_density(101325.0, 0.0), Error);
  CHECK_THROWS_AS(king_factor(0.0), Error);
  CHECK_THROWS_AS(ozone_absorption_per_km(1e-25, 300.0, 0.0), Error);
}

TEST_CASE("04 air: what a scene lacks is not compiled in, and --explain's list says the same") {
  Scene scene = named("earth");
  CHECK(air_variant(scene) == AirVariant{true, true, true, 1});
  for (const char* kind : {"rayleigh", "mie", "ozone"}) {
    Scene less = scene;
    std::erase_if(less.media, [&](const Medium& medium) { return medium.kind == kind; });
    const AirVariant variant = air_variant(less);
    CHECK(variant.rayleigh == (std::string(kind) != "rayleigh"));
    CHECK(variant.mie == (std::string(kind) != "mie"));
    CHECK(variant.ozone == (std::string(kind) != "ozone"));
    CHECK(specialization(variant) != specialization(air_variant(scene)));
    for (const Constituent& effect : constituents(less))
      if (effect.name == kind) CHECK(!effect.on);
    const interop::Atmosphere atmosphere = make_atmosphere(less);  // no shape that would divide by 0
    CHECK(atmosphere.rayleigh_scale_height_km > 0.0f);
    CHECK(atmosphere.mie_scale_height_km > 0.0f);
    CHECK(atmosphere.ozone_half_width_km > 0.0f);
  }
  scene.medium("mie")->scattering_per_km = scene.medium("mie")->absorption_per_km = glm::dvec3(0.0);
  CHECK(!air_variant(scene).mie);  // sigma = 0: there, but nothing of it
}

TEST_CASE("04 air: the shader's struct carries the scene") {
  Scene scene = named("earth");
  Medium& mie = *scene.medium("mie");
  interop::Atmosphere a = make_atmosphere(scene);
  CHECK(a.rayleigh_scattering.z == 33.1e-3f);
  CHECK(a.mie_extinction.x == Approx(4.440e-3).epsilon(1e-6));
  CHECK(a.mie_g == 0.8f);
  CHECK(a.ozone_absorption.y == 1.881e-3f);
  CHECK(a.ozone_peak_km == 25.0f);
  CHECK(a.ground_radius_km == 6360.0f);
  CHECK(a.top_km == 100.0f);
  CHECK(a.sun_angular_radius == Approx(0.00465).epsilon(2e-3));
  mie.draine_alpha = 0.25, mie.second_weight = 0.4, mie.second_g = -0.2;
  CHECK(make_atmosphere(scene).mie_alpha == 0.25f);
  mie.phase = Phase::double_hg;
  CHECK(make_atmosphere(scene).mie_alpha == 0.4f);
  CHECK(make_atmosphere(scene).second_g == -0.2f);
  CHECK(air_variant(scene).mie_phase == 3);
}
