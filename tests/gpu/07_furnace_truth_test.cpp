// What chapter 07's paths must conserve, whatever the air: energy (the white furnace), reciprocity, irradiance.
#include <catch2/catch.hpp>
#include <cmath>

#include "common/image/csv.hpp"
#include "tests/gpu/07_paths.hpp"
#include "tests/gpu/harness.hpp"
#include "tree.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

// Nothing absorbs: neither the aerosol nor the ozone that is left out with the variant.
reference::Planet conservative(reference::Planet planet) {
  planet.mie_extinction_per_km = planet.mie_scattering_per_km;
  return planet;
}

}  // namespace

// Light of radiance 1 from every side, air and ground that absorb nothing: then it is 1 everywhere, in every direction.
// Any slip in phase functions, ground, flights or weights shows. Tolerance: 3 standard errors, on 99 % of the values.
TEST_CASE("truth: white furnace") {
  const bool alien = GENERATE(false, true);
  const Phase phase = GENERATE(kHenyeyGreenstein, kCornetteShanks, kDraine, kDoubleHg);
  std::vector<PathRay> rays;
  uint32_t seed = 1;
  for (double altitude : {0.0005, 2.0, 30.0, 100.0, 400.0, 36000.0})
    for (double zenith : {0.0, 60.0, 89.9, 92.0, 109.5, 140.0, 171.3, 180.0}) {
      if (altitude < 101.0 ? zenith == 171.3 : altitude < 1000.0 ? zenith < 109.0 : zenith < 171.0) continue;
      rays.push_back({.ray = ray_from_degrees(altitude, zenith, 45.0, 0.0),
                      .albedo = {1.0, 1.0, 1.0},
                      .seed = seed++,
                      .g = phase == kDraine ? 0.6 : 0.8,
                      .second_g = -0.3,
                      .shape = phase == kDraine ? 3.0 : 0.3});
    }
  const std::vector<PathMean> means =
      trace(conservative(alien ? reference::dense_alien() : reference::earth()), rays,
            {.environment = true, .phase = phase, .ozone = false}, alien ? 1024 : 512, alien ? 1 : 4);
  ZScores z;
  double longest = 0.0;
  for (size_t i = 0; i < rays.size(); ++i) {
    REQUIRE(means[i].unfinished == 0.0);  // no loop of a path was cut, however dense the air
    longest = std::max(longest, means[i].longest);
    for (int c = 0; c < 3; ++c) {
      const double error = std::hypot(means[i].error[c], 2e-5);
      z.values.push_back((means[i].mean[c] - 1.0) / error);
      CHECK(means[i].error[c] < 0.1);
      if (std::abs(z.values.back()) > 3.0)
        UNSCOPED_INFO("h " << rays[i].ray.altitude_km << " view " << rays[i].ray.view[2] << " channel " << c << ": "
                           << means[i].mean[c] << " +- " << means[i].error[c]);
    }
  }
  CAPTURE(alien, phase, z.share_within_3(), z.rms(), z.mean(), longest);
  CHECK(z.values.size() >= 60);
  CHECK(z.share_within_3() >= 0.985);  // of some hundred values: two may be outside
  CHECK(z.rms() < 1.3);
  if (alien) CHECK(longest > 50.0);
}

// Over flat ground, exchanging eye and sun exchanges nothing but the cosines: L(view, sun) / mu_sun is symmetric. The
// planet is made a thousand times larger to be flat.
TEST_CASE("truth: reciprocity over flat ground") {
  reference::Planet planet = reference::earth();
  planet.ground_radius_km = 2.0e6;
  planet.top_radius_km = 2.0e6 + 100.0;
  ZScores z;
  std::vector<PathRay> rays;
  const double angles[][3] = {
      {20.0, 70.0, 0.0}, {0.0, 60.0, 0.0}, {45.0, 80.0, 120.0}, {10.0, 80.0, 90.0}, {35.0, 65.0, 180.0}};
  for (const auto& [a, b, azimuth] : angles)
    for (const auto& [view, sun] : {std::pair{a, b}, {b, a}})
      rays.push_back({.ray = ray_from_degrees(100.0, 180.0 - view, sun, azimuth),
                      .albedo = {0.3, 0.3, 0.3},
                      .seed = static_cast<uint32_t>(rays.size() + 1)});
  const std::vector<PathMean> means = trace(planet, rays, {}, 4096, 8);
  for (size_t i = 0; i < rays.size(); i += 2)
    for (int c = 0; c < 3; ++c) {
      const double mu_1 = rays[i].ray.sun[2], mu_2 = rays[i + 1].ray.sun[2];
      const double one = means[i].mean[c] / mu_1, other = means[i + 1].mean[c] / mu_2;
      const double error = std::hypot(means[i].error[c] / mu_1, means[i + 1].error[c] / mu_2);
      CAPTURE(i, c, one, other, error);
      CHECK(error < 0.05 * one);
      z.values.push_back((one - other) / error);
      CHECK(std::abs(z.values.back()) < 3.5);
    }
  CHECK(z.rms() < 1.6);
}

// Diffuse irradiance on a horizontal plane: pi times the mean radiance over directions drawn with the plane's cosine.
TEST_CASE("truth: irradiance is the table's") {
  const CsvTable table =
      read_csv(WELKIN_TEST_DATA "/irradiance_earth_cs.csv",
               {"h_km", "sun_zenith_deg", "ground_albedo", "Einf", "Einf_se"}, {"hemisphere", "mie_phase", "channel"});
  Random random(5);
  ZScores z;
  constexpr int kDirections = 4096;
  for (size_t row = 5; row < table.rows; row += 19) {
    const double albedo = table.column("ground_albedo")[row];
    const bool up = table.text("hemisphere")[row] == "upwelling";
    const int channel = table.text("channel")[row] == "r" ? 0 : table.text("channel")[row] == "g" ? 1 : 2;
    std::vector<PathRay> rays;
    for (int i = 0; i < kDirections; ++i) {
      const double zenith = std::asin(std::sqrt(random.uniform(0.0, 1.0))) * 180.0 / 3.14159265358979324;
      rays.push_back({.ray = ray_from_degrees(table.column("h_km")[row], up ? 180.0 - zenith : zenith,
                                              table.column("sun_zenith_deg")[row], random.uniform(0.0, 360.0)),
                      .albedo = {albedo, albedo, albedo},
                      .seed = static_cast<uint32_t>(row + 1)});
    }
    double sum = 0.0, squares = 0.0;
    for (const PathMean& mean : trace(reference::earth(), rays, {}, 1, 4))
      sum += mean.mean[channel], squares += mean.mean[channel] * mean.mean[channel];
    const double mean = sum / kDirections,
                 error = std::sqrt((squares / kDirections - mean * mean) / kDirections) * 3.14159265358979324;
    const double expected = table.column("Einf")[row], expected_error = table.column("Einf_se")[row];
    CAPTURE(row, mean * 3.14159265358979324, error, expected, expected_error);
    z.values.push_back((mean * 3.14159265358979324 - expected) / std::hypot(error, expected_error));
    CHECK(std::abs(z.values.back()) < 4.0);
  }
  CAPTURE(z.values.size(), z.rms(), z.share_within_3());
  CHECK(z.values.size() >= 12);
  CHECK(z.rms() < 1.5);
}
