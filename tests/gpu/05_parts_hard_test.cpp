// Single functions of chapter 05 where formulas break: named cases, each with the figure of the naive form, which runs
// in the same shader (tests/gpu/shaders/05_parts.comp), beside that of the form that holds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <iterator>

#include "tests/gpu/05_rays.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

TEST_CASE("hard: a camera exactly on the top, skimming it") {
  // The dip below the top is r mu^2 / 2: at 90.002 degrees 4 m, and at 90.01 it is 0.1 m per ulp of the altitude.
  std::vector<Part> parts;
  std::vector<double> lengths;
  for (double zenith_deg = 90.0005; zenith_deg < 90.02; zenith_deg += 0.0005) {
    const reference::Direction view = reference::direction_from_degrees(zenith_deg, 0.0);
    parts.push_back({{Part::kEnter, 100.0f, float(view[0]), float(view[2])}});
    lengths.push_back(-2.0 * 6460.0 * double(float(view[2])));  // chord through the sphere of the top
  }
  const auto results = evaluate_parts(parts);
  int naive_misses = 0;
  double worst = 0.0;
  for (size_t i = 0; i < parts.size(); ++i) {
    CHECK(results[i][0] == 1.0f);
    if (results[i][2] == 0.0f) ++naive_misses;
    worst = std::max(worst, std::abs(results[i][1] / lengths[i] - 1.0));
  }
  CAPTURE(naive_misses, worst);
  CHECK(naive_misses >= 1);  // top - tangent rounds to 0: the ray is thought to miss
  CHECK(worst < 1e-4);
}

TEST_CASE("hard: a sun path that dips to the ground") {
  // From 2 km towards a sun whose rays touch the ground, through aerosol of scale height 1.2 km.
  const reference::Planet planet = reference::earth();
  std::vector<Part> parts;
  std::vector<std::array<double, 3>> truth;
  for (double altitude_km : {0.5, 2.0, 5.0, 10.0, 30.0, 60.0})
    for (double tangent_km : {0.001, 0.3, 1.0}) {
      if (tangent_km > altitude_km) continue;
      const double sine = (6360.0 + tangent_km) / (6360.0 + altitude_km);
      const float mu = float(-std::sqrt((1.0 - sine) * (1.0 + sine)));
      const double exact_mu = mu, exact_sine = std::sqrt((1.0 - exact_mu) * (1.0 + exact_mu));
      parts.push_back({{Part::kSunColumns, float(altitude_km), mu, 8.0f}});
      const double r = 6360.0 + double(float(altitude_km));
      truth.push_back(reference::columns(planet, double(float(altitude_km)), exact_mu, exact_sine,
                                         -r * exact_mu + std::sqrt(6460.0 * 6460.0 - r * r * exact_sine * exact_sine)));
    }
  const auto results = evaluate_parts(parts);
  double naive = 0.0, holds = 0.0;
  for (size_t i = 0; i < parts.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      holds = std::max(holds, std::abs(results[i][k] / truth[i][k] - 1.0));
      naive = std::max(naive, std::abs(results[i][3 + k] / truth[i][k] - 1.0));
    }
  CAPTURE(naive, holds);
  CHECK(naive > 0.15);
  CHECK(holds < 0.001);
}

TEST_CASE("hard: a sun path that dips hardly at all") {
  // Twice the column from the tangent point less the column outward: nearly the same number twice.
  const reference::Planet planet = reference::earth();
  std::vector<Part> parts;
  std::vector<double> truth;
  for (double altitude_km : {0.5, 1.0, 3.0, 10.0})
    for (double mu : {-1e-6, -1e-5, -1e-4, -1e-3}) {
      parts.push_back({{Part::kSunColumns, float(altitude_km), float(mu), 8.0f}});
      const double m = float(mu), sine = std::sqrt((1.0 - m) * (1.0 + m)), h = float(altitude_km), r = 6360.0 + h;
      truth.push_back(
          reference::columns(planet, h, m, sine, -r * m + std::sqrt(6460.0 * 6460.0 - r * r * sine * sine))[1]);
    }
  const auto results = evaluate_parts(parts);
  double naive = 0.0, holds = 0.0;
  for (size_t i = 0; i < parts.size(); ++i) {
    holds = std::max(holds, std::abs(results[i][1] / truth[i] - 1.0));
    naive = std::max(naive, std::abs(results[i][4] / truth[i] - 1.0));
  }
  CAPTURE(naive, holds);
  CHECK(naive > 0.005);
  CHECK(holds < 1e-3);
}

TEST_CASE("hard: segments from sample to sample do not tile the ray") {
  std::vector<Part> parts;
  for (int n : {2, 8, 32})
    for (int i = 0; i < n; ++i) parts.push_back({{Part::kSegment, float(kOffset03), float(i), float(n)}});
  const auto results = evaluate_parts(parts);
  size_t next = 0;
  for (int n : {2, 8, 32}) {
    double holds = 0.0, naive = 0.0;
    for (int i = 0; i < n; ++i, ++next) {
      holds += results[next][1];
      naive += results[next][3];
    }
    CAPTURE(n);
    CHECK(holds == Approx(1.0).epsilon(1e-6));
    CHECK(naive == Approx((n - 0.7) / n).epsilon(1e-6));  // 65 % of the ray at two steps
  }
}

TEST_CASE("hard: the mean transmittance of almost no air") {
  std::vector<Part> parts;
  const double taus[] = {0.0, 1e-10, 3e-8, 1e-7, 1e-5, 1e-3, 0.049, 0.051, 1.0, 80.0};
  for (double tau : taus) parts.push_back({{Part::kMeanTransmittance, float(tau)}});
  const auto results = evaluate_parts(parts);
  for (size_t i = 0; i < std::size(taus); ++i) {
    const double tau = float(taus[i]), exact = tau > 0.0 ? -std::expm1(-tau) / tau : 1.0;
    CAPTURE(tau, results[i][0], results[i][1]);
    CHECK(results[i][0] == Approx(exact).epsilon(1e-5));
    if (tau == 0.0) CHECK(std::isnan(results[i][1]));
    // 1 - exp(-tau) is a whole number of 6e-8: nothing, or as much too much as exp() is rounded the wrong way.
    if (tau > 0.0 && tau < 3.1e-8) CHECK(std::abs(results[i][1] - 1.0) > 0.5);
    if (taus[i] == 1e-7) CHECK(std::abs(results[i][1] / exact - 1.0) > 0.1);
  }
}

TEST_CASE("hard: the edge of the planet's shadow from half a metre") {
  // Suns within a thousandth of the horizon's dip, judged by 1 - (R/r)^2 and by the altitude of the tangent point.
  Random random(9);
  std::vector<Part> parts;
  std::vector<bool> up;
  for (int i = 0; i < 20'000; ++i) {
    const float altitude_km = float(random.log_uniform(5e-4, 0.1));
    const double r = 6360.0 + double(altitude_km);
    const double dip = std::sqrt(altitude_km * (2.0 * 6360.0 + altitude_km)) / r;
    const float mu = float(-dip * (1.0 + random.uniform(-0.01, 0.01)));
    if (std::abs(-mu / dip - 1.0) < 1e-4) continue;  // closer than this no float knows its altitude
    parts.push_back({{Part::kSunUp, 6360.0f, altitude_km, mu}});
    up.push_back(-double(mu) <= dip);
  }
  const auto results = evaluate_parts(parts);
  size_t wrong = 0, naive_wrong = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    wrong += (results[i][0] != 0.0f) != up[i];
    naive_wrong += (results[i][1] != 0.0f) != up[i];
  }
  CAPTURE(wrong, naive_wrong, parts.size());
  CHECK(wrong == 0);
  CHECK(double(naive_wrong) > 0.1 * double(parts.size()));
}
