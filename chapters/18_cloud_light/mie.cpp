// See mie.hpp.
#include "chapters/18_cloud_light/mie.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace welkin::mie {
namespace {

using Complex = std::complex<double>;

// D_n(z) for n = 0 to terms: D_(n-1) = n/z - 1/(D_n + n/z). It begins with 0 so far above |z| that nothing of that is
// left: the error falls only while n > |z|, and the way down to there must grow as the cube root of |z|, as the series'
// own does.
std::vector<Complex> logarithmic_derivatives(Complex z, int terms, double above) {
  const double size = std::abs(z);
  const int begin = std::max(terms, static_cast<int>(size + above * std::cbrt(size))) + 16;
  std::vector<Complex> d(begin + 1);
  for (int n = begin; n > 0; --n) {
    const Complex ratio = static_cast<double>(n) / z;
    d[n - 1] = ratio - 1.0 / (d[n] + ratio);
  }
  return d;
}

// Angular functions pi_n and tau_n go up together: call next() once for each n from 1 on.
struct AngularFunctions {
  double nu;
  double pi_n = 1.0, pi_before = 0.0, tau_n = 0.0;
  int n = 1;

  explicit AngularFunctions(double cosine) : nu(cosine), tau_n(cosine) {}
  void next() {
    const double up = ((2.0 * n + 1.0) * nu * pi_n - (n + 1.0) * pi_before) / n;
    pi_before = pi_n;
    pi_n = up;
    ++n;
    tau_n = n * nu * pi_n - (n + 1.0) * pi_before;
  }
};

}  // namespace

Series series(double x, Complex index, double derivatives_above) {
  const int terms = static_cast<int>(x + 4.05 * std::cbrt(x) + 2.0) + 1;
  const std::vector<Complex> d = logarithmic_derivatives(index * x, terms, derivatives_above);
  Series sphere{x, std::vector<Complex>(terms), std::vector<Complex>(terms)};
  // psi_n = x j_n(x) goes upward as far as terms are needed; chi_n = -x y_n(x) is stable that way.
  double psi_before = std::cos(x), psi = std::sin(x), chi_before = -std::sin(x), chi = std::cos(x);
  for (int n = 1; n <= terms; ++n) {
    const double psi_n = (2.0 * n - 1.0) / x * psi - psi_before, chi_n = (2.0 * n - 1.0) / x * chi - chi_before;
    const Complex xi_n(psi_n, -chi_n), xi(psi, -chi);
    const Complex for_a = d[n] / index + n / x, for_b = index * d[n] + n / x;
    sphere.a[n - 1] = (for_a * psi_n - psi) / (for_a * xi_n - xi);
    sphere.b[n - 1] = (for_b * psi_n - psi) / (for_b * xi_n - xi);
    psi_before = psi, psi = psi_n, chi_before = chi, chi = chi_n;
  }
  return sphere;
}

double extinction_efficiency(const Series& sphere) {
  double sum = 0.0;
  for (size_t i = 0; i < sphere.a.size(); ++i) sum += (2.0 * i + 3.0) * (sphere.a[i] + sphere.b[i]).real();
  return 2.0 * sum / (sphere.size_parameter * sphere.size_parameter);
}

double scattering_efficiency(const Series& sphere) {
  double sum = 0.0;
  for (size_t i = 0; i < sphere.a.size(); ++i)
    sum += (2.0 * i + 3.0) * (std::norm(sphere.a[i]) + std::norm(sphere.b[i]));
  return 2.0 * sum / (sphere.size_parameter * sphere.size_parameter);
}

double mean_cosine(const Series& sphere) {
  double sum = 0.0;
  for (size_t i = 0; i < sphere.a.size(); ++i) {
    const double n = i + 1.0;
    sum += (2.0 * n + 1.0) / (n * (n + 1.0)) * (sphere.a[i] * std::conj(sphere.b[i])).real();
    if (i + 1 < sphere.a.size())
      sum += n * (n + 2.0) / (n + 1.0) *
             (sphere.a[i] * std::conj(sphere.a[i + 1]) + sphere.b[i] * std::conj(sphere.b[i + 1])).real();
  }
  return 4.0 * sum / (sphere.size_parameter * sphere.size_parameter * scattering_efficiency(sphere));
}

Amplitudes amplitudes(const Series& sphere, double nu) {
  Amplitudes s{};
  AngularFunctions angular(nu);
  for (size_t i = 0; i < sphere.a.size(); ++i, angular.next()) {
    const double n = i + 1.0, weight = (2.0 * n + 1.0) / (n * (n + 1.0));
    s.across += weight * (sphere.a[i] * angular.pi_n + sphere.b[i] * angular.tau_n);
    s.along += weight * (sphere.a[i] * angular.tau_n + sphere.b[i] * angular.pi_n);
  }
  return s;
}

CloudScattering cloud_scattering(const Droplets& droplets, double wavelength_um, Complex index,
                                 const std::vector<double>& angles_rad, int radii) {
  const double k = 2.0 * std::numbers::pi / wavelength_um, v = droplets.effective_variance,
               r_e = droplets.effective_radius_um;
  // Midpoints in r. The cross-section r^2 n(r) is a gamma distribution of shape 1/v - 1 and scale r_e v: it has mean
  // r_e (1 - v) and spread r_e sqrt(v (1 - v)). 1e-9 of it lies beyond the end.
  const double high = r_e * (1.0 + 7.0 * std::sqrt(v) + 8.0 * v);
  CloudScattering mean{};
  mean.phase.assign(angles_rad.size(), 0.0);
  double area = 0.0, extinction = 0.0, scattering = 0.0, cosine = 0.0;
  for (int i = 0; i < radii; ++i) {
    const double r = high * (i + 0.5) / radii;
    const double number = std::exp((1.0 - 3.0 * v) / v * std::log(r / r_e) - (r / r_e - 1.0) / v);
    const double weight = number * r * r;
    if (weight < 1e-9 * r_e * r_e) continue;
    const Series sphere = series(k * r, index);
    const double q_sca = scattering_efficiency(sphere);
    area += weight;
    extinction += weight * extinction_efficiency(sphere);
    scattering += weight * q_sca;
    cosine += weight * q_sca * mean_cosine(sphere);
    for (size_t j = 0; j < angles_rad.size(); ++j) {
      const Amplitudes s = amplitudes(sphere, std::cos(angles_rad[j]));
      mean.phase[j] += number / (k * k) * (std::norm(s.across) + std::norm(s.along)) / (2.0 * std::numbers::pi);
    }
  }
  for (double& p : mean.phase) p /= scattering;
  mean.extinction_efficiency = extinction / area;
  mean.single_scattering_albedo = scattering / extinction;
  mean.mean_cosine = cosine / scattering;
  return mean;
}

Complex water_index(double wavelength_um) {
  const double n = 1.3257 + 0.0022 / (wavelength_um * wavelength_um);
  // Absorption in 1/m at 440, 550 and 680 nm; logarithms in between.
  const double at[3] = {0.44, 0.55, 0.68}, absorption[3] = {0.00635, 0.0565, 0.465};
  const int i = wavelength_um < at[1] ? 0 : 1;
  const double t = (wavelength_um - at[i]) / (at[i + 1] - at[i]);
  const double per_m = absorption[i] * std::pow(absorption[i + 1] / absorption[i], t);
  return {n, per_m * wavelength_um * 1e-6 / (4.0 * std::numbers::pi)};
}

std::vector<double> table_angles(int count) {
  std::vector<double> angles(count);
  for (int i = 0; i < count; ++i) {
    const double u = static_cast<double>(i) / (count - 1);
    angles[i] = std::numbers::pi * u * u * (3.0 - 2.0 * u);
  }
  return angles;
}

}  // namespace welkin::mie
