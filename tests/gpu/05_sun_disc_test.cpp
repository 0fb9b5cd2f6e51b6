// The sun's disc and the edge of the planet's shadow, against closed forms in double.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/05_rays.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kPi = 3.14159265358979323846;
const double kAlpha[] = {0.397, 0.503, 0.652};
const float kRadii[] = {1e-4f, 0.00465f, 0.05f, 0.2f};  // a far star's, the sun's, a close star's, the largest accepted

// The disc at the cosine m of the surface.
Part disc(double radius, double m) { return {{Part::kDisc, float(radius), float(m)}}; }

}  // namespace

TEST_CASE("sun disc: as a whole it sends exactly the irradiance") {
  // Irradiance = integral of L cos(angle) over the disc = pi sin^2 a * integral over m in [0, 1] of L(m) 2 m dm.
  constexpr int kPoints = 4096;
  std::vector<Part> parts;
  for (float radius : kRadii)
    for (int i = 0; i < kPoints; ++i) parts.push_back(disc(radius, (i + 0.5) / kPoints));
  const auto results = evaluate_parts(parts);
  size_t next = 0;
  for (float radius : kRadii) {
    double irradiance[3] = {};
    for (int i = 0; i < kPoints; ++i, ++next)
      for (int k = 0; k < 3; ++k)
        irradiance[k] +=
            results[next][k] * kPi * std::pow(std::sin(double(radius)), 2) * 2.0 * (i + 0.5) / kPoints / kPoints;
    CAPTURE(radius);
    // pow() of a driver may err by 1e-5; the midpoint sum by 1e-7.
    for (double value : irradiance) CHECK(value == Approx(1.0).epsilon(5e-5));
  }
}

TEST_CASE("sun disc: darker towards the limb, more so in blue") {
  const double cosines[] = {1.0, 0.9, 0.5, 0.2, 0.05};
  std::vector<Part> parts;
  for (double m : cosines) parts.push_back(disc(0.00465, m));
  const auto results = evaluate_parts(parts);
  for (size_t i = 0; i < parts.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double centre = (kAlpha[k] + 2.0) / 2.0 / (kPi * std::pow(std::sin(double(0.00465f)), 2));
      CAPTURE(cosines[i], k);
      CHECK(results[i][k] == Approx(centre * std::pow(cosines[i], kAlpha[k])).epsilon(1e-4));
    }
  CHECK(results[3][2] / results[0][2] < results[3][0] / results[0][0]);
}

TEST_CASE("sun above the horizon: the same answer as in double") {
  // From half a metre to the Moon, suns on both sides of the dip by a ten-thousandth of it and more.
  Random random(3);
  std::vector<Part> parts;
  std::vector<bool> up;
  for (int i = 0; i < 100'000; ++i) {
    const float radius_km = i % 4 ? 6360.0f : float(random.log_uniform(10.0, 1e5));
    const float altitude_km = float(random.log_uniform(5e-4, 3e5));
    const double r = double(radius_km) + altitude_km;
    const double dip = std::sqrt(altitude_km * (2.0 * radius_km + altitude_km)) / r;
    const double off = random.log_uniform(1e-4, 1.0) * (random.next() % 2 ? 1.0 : -1.0);
    // From far away the rim is where the float sine ends: 1e-4 of the planet's angular radius, not of the dip.
    const double sine = r > 2.0 * radius_km ? double(radius_km) / r * (1.0 + off * 0.5) : 0.0;
    const double mu = sine > 0.0 ? -std::sqrt(std::max((1.0 - sine) * (1.0 + sine), 0.0)) : -dip * (1.0 + off);
    const float mu_sun = float(std::fmax(mu, -1.0));
    const double m = mu_sun, tangent = r * std::sqrt((1.0 - m) * (1.0 + m)) - radius_km;
    if (std::abs(tangent) < 1e-4 * altitude_km && r <= 2.0 * radius_km) continue;
    if (r > 2.0 * radius_km && std::abs(tangent) < 1e-3 * radius_km * r / radius_km) continue;
    parts.push_back({{Part::kSunUp, radius_km, altitude_km, mu_sun}});
    up.push_back(m >= 0.0 || tangent >= 0.0);
  }
  REQUIRE(parts.size() > 60'000);
  const auto results = evaluate_parts(parts);
  size_t wrong = 0, lit = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    wrong += (results[i][0] != 0.0f) != up[i];
    lit += up[i];
  }
  CHECK(wrong == 0);
  CHECK(lit > parts.size() / 5);  // both answers occur
  CHECK(lit < parts.size() * 4 / 5);
}
