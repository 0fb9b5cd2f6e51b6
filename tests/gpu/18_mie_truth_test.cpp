// Chapter 18: Mie's series against limits, identities and published values; the fit by lobes against the series.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <numbers>

#include "chapters/18_cloud_light/mie.hpp"
#include "tests/gpu/18_parts.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kPi = std::numbers::pi;

// Integral over the sphere, and mean cosine, of values at angles: parabolas through three neighbours, in the angle.
struct Moments {
  double integral = 0.0, mean_cosine = 0.0;
};
Moments moments(const std::vector<double>& angles, const std::vector<double>& phase) {
  Moments m;
  for (size_t i = 0; i + 1 < angles.size(); ++i) {
    // Trapezoids in cos(theta), with the mean of P over the interval.
    const double nu[2] = {std::cos(angles[i]), std::cos(angles[i + 1])};
    const double share = 2.0 * kPi * 0.5 * (phase[i] + phase[i + 1]) * (nu[0] - nu[1]);
    m.integral += share;
    m.mean_cosine += share * 0.5 * (nu[0] + nu[1]);
  }
  return m;
}

}  // namespace

TEST_CASE("18 truth: Mie's series has the published efficiencies") {
  // Wiscombe's table of 1979/1980, six digits: index, x, Q_ext, Q_sca, mean cosine.
  const struct {
    std::complex<double> index;
    double x, extinction, scattering, cosine;
  } table[] = {
      {{1.5, 0.0}, 10.0, 2.881999, 2.881999, 0.742913},    {{1.5, 0.0}, 100.0, 2.094388, 2.094388, 0.818246},
      {{1.5, 0.0}, 1000.0, 2.013945, 2.013945, 0.827882},  {{1.33, 1e-5}, 1.0, 0.093952, 0.093923, 0.184517},
      {{1.33, 1e-5}, 100.0, 2.101321, 2.096594, 0.868959}, {{1.33, 1e-5}, 10000.0, 2.004089, 1.723857, 0.907840}};
  for (const auto& row : table) {
    const mie::Series sphere = mie::series(row.x, row.index);
    INFO(fmt::format("m {} + {}i, x {}", row.index.real(), row.index.imag(), row.x));
    CHECK(mie::extinction_efficiency(sphere) == Approx(row.extinction).margin(1e-6));
    CHECK(mie::scattering_efficiency(sphere) == Approx(row.scattering).margin(1e-6));
    CHECK(mie::mean_cosine(sphere) == Approx(row.cosine).margin(1e-6));
  }
  // The textbooks' start of the downward recurrence, 16 above |m x|, is wrong in the fourth digit at x = 1000.
  CHECK(std::abs(mie::extinction_efficiency(mie::series(1000.0, {1.5, 0.0}, 0.0)) - 2.013945) > 3e-4);
}

TEST_CASE("18 truth: small spheres are Rayleigh's, large ones take twice their shadow") {
  const std::complex<double> m(1.33, 0.01), k = (m * m - 1.0) / (m * m + 2.0);
  const double x = 0.01;
  const mie::Series small = mie::series(x, m);
  const double scattering = mie::scattering_efficiency(small);
  // The next term of the expansion is of order x^2.
  CHECK(scattering == Approx(8.0 / 3.0 * std::pow(x, 4) * std::norm(k)).epsilon(2e-4));
  CHECK(mie::extinction_efficiency(small) - scattering == Approx(4.0 * x * k.imag()).epsilon(2e-4));
  CHECK(std::abs(mie::mean_cosine(small)) < 1e-4);
  // |S1|^2 + |S2|^2 goes as 1 + nu^2.
  const auto power = [&](double nu) {
    const mie::Amplitudes s = mie::amplitudes(small, nu);
    return std::norm(s.across) + std::norm(s.along);
  };
  CHECK(power(0.6) / power(0.0) == Approx(1.36).epsilon(1e-4));
  // Q_ext - 2 falls as 1.99 x^(-2/3) (Nussenzveig and Wiscombe 1980), with ripples under it.
  for (const double large : {2000.0, 19000.0})
    CHECK(mie::extinction_efficiency(mie::series(large, {1.333, 1e-4})) - 2.0 ==
          Approx(1.9924 * std::pow(large, -2.0 / 3.0)).epsilon(0.15));
}

TEST_CASE("18 truth: Mie's series conserves energy and keeps the optical theorem") {
  Random random(7);
  for (int i = 0; i < 60; ++i) {
    const double x = random.log_uniform(0.05, 3000.0), n = random.uniform(1.2, 1.6);
    const mie::Series sphere = mie::series(x, {n, 0.0});
    INFO(fmt::format("x {} n {}", x, n));
    const double extinction = mie::extinction_efficiency(sphere);
    CHECK(mie::scattering_efficiency(sphere) == Approx(extinction).epsilon(1e-8));
    CHECK(4.0 / (x * x) * mie::amplitudes(sphere, 1.0).across.real() == Approx(extinction).epsilon(1e-10));
    // A sphere seen along its axis has no plane: both polarisations are one.
    const mie::Amplitudes ahead = mie::amplitudes(sphere, 1.0), back = mie::amplitudes(sphere, -1.0);
    CHECK(std::abs(ahead.across - ahead.along) <= 1e-9 * std::abs(ahead.across));
    CHECK(std::abs(back.across + back.along) <= 1e-9 * std::abs(ahead.across));
    const mie::Series grey = mie::series(x, {n, 0.01});
    CHECK(mie::scattering_efficiency(grey) < mie::extinction_efficiency(grey));
  }
}

TEST_CASE("18 truth: a cloud's phase function integrates to 1 and has fogbow and glory") {
  const std::vector<double> angles = mie::table_angles(2048);
  const auto begin = std::chrono::steady_clock::now();
  const mie::CloudScattering cloud = mie::cloud_scattering({10.0, 0.02}, 0.55, mie::water_index(0.55), angles, 200);
  WARN(fmt::format("200 sizes at 2048 angles: {:.2f} s; mean cosine {:.4f}, Q_ext {:.4f}",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), cloud.mean_cosine,
                   cloud.extinction_efficiency));
  const Moments m = moments(angles, cloud.phase);
  CHECK(m.integral == Approx(1.0).margin(3e-4));  // trapezoids
  CHECK(m.mean_cosine == Approx(cloud.mean_cosine).margin(3e-4));
  const auto at = [&](double degrees) {
    const auto i = std::lower_bound(angles.begin(), angles.end(), degrees * kPi / 180.0) - angles.begin();
    return cloud.phase[i];
  };
  // Fogbow: the brightest between 130 and 160 degrees lies where geometrical optics has a rainbow, drawn inward by
  // diffraction.
  double brightest = 0.0, where = 0.0;
  for (double degrees = 130.0; degrees < 160.0; degrees += 0.1)
    if (at(degrees) > brightest) brightest = at(degrees), where = degrees;
  CHECK(where > 139.0);
  CHECK(where < 145.0);
  CHECK(brightest > 3.0 * at(120.0));
  // Glory: a ring some degrees from the shadow of the eye, and a bright middle.
  CHECK(at(180.0) > 3.0 * at(165.0));
  double ring = 0.0, dip = 1e9;
  for (double degrees = 176.0; degrees < 178.8; degrees += 0.02) ring = std::max(ring, at(degrees));
  for (double degrees = 178.0; degrees < 179.5; degrees += 0.02) dip = std::min(dip, at(degrees));
  CHECK(ring > 1.15 * dip);
}

TEST_CASE("18 truth: the mean over sizes has converged, and the lobes follow it") {
  const std::vector<double> angles = mie::table_angles(512);
  const mie::CloudScattering coarse = mie::cloud_scattering({10.0, 0.1}, 0.55, mie::water_index(0.55), angles);
  const mie::CloudScattering fine = mie::cloud_scattering({10.0, 0.1}, 0.55, mie::water_index(0.55), angles, 1600);
  double squares = 0.0;
  for (size_t i = 0; i < angles.size(); ++i) squares += std::pow(coarse.phase[i] / fine.phase[i] - 1.0, 2.0);
  const double rms = std::sqrt(squares / angles.size());
  WARN(fmt::format("400 sizes against 1600: {:.3f} RMS over the angles", rms));
  // Resonances narrower than the step of sizes are caught by one sample or by none.
  CHECK(rms < 0.04);
  CHECK(coarse.mean_cosine == Approx(fine.mean_cosine).margin(5e-4));
  // Absorption: the shader's geometrical estimate is a fifth below the series', which also knows
  // the resonances of round drops.
  const PartResult optics = parts({{kOptics, 0.3f, 10.0f}})[0];
  CHECK(1.0 - fine.single_scattering_albedo == Approx(optics[5]).epsilon(0.25));
  // The fit of two lobes for droplets of 20 um, away from the peak, from fogbow and glory.
  std::vector<PartItem> items;
  std::vector<double> truth;
  for (size_t i = 0; i < angles.size(); ++i) {
    const double degrees = angles[i] * 180.0 / kPi;
    if (degrees < 15.0 || degrees > 80.0) continue;
    const double half = 0.5 * angles[i];
    items.push_back({kDroplet, 20.0f, static_cast<float>(2.0 * std::sin(half) * std::sin(half)),
                     static_cast<float>(2.0 * std::cos(half) * std::cos(half))});
    truth.push_back(fine.phase[i]);
  }
  const std::vector<PartResult> fit = parts(items);
  std::vector<double> errors;
  for (size_t i = 0; i < fit.size(); ++i) errors.push_back(std::abs(fit[i][0] / truth[i] - 1.0));
  std::sort(errors.begin(), errors.end());
  WARN(fmt::format("fit of lobes against the series, 15 to 80 degrees: median {:.2f}, worst {:.2f}",
                   errors[errors.size() / 2], errors.back()));
  CHECK(errors[errors.size() / 2] < 0.25);
}
