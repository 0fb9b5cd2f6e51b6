// Light scattered by water droplets: Mie's series for one sphere, and its mean over a distribution of sizes.
//
// Purpose: the phase function of a real cloud, with its corona, fogbow and glory, which no lobe has. The renderer's
// lobes are fitted to it; a table of it is one more phase function to render with.
//
// Units: radii and wavelengths in um. x = 2 pi r / wavelength, the size parameter; m = n + i k, the refractive index of
// water relative to air, k >= 0 (absorption). Everything in double.
//
// Equations (Bohren and Huffman 1983, chapter 4), psi_n and xi_n the Riccati-Bessel functions, D_n the logarithmic
// derivative of psi_n at m x, which is computed downward because it is unstable upward:
//   a_n = ((D_n/m + n/x) psi_n - psi_(n-1)) / ((D_n/m + n/x) xi_n - xi_(n-1))
//   b_n = ((m D_n + n/x) psi_n - psi_(n-1)) / ((m D_n + n/x) xi_n - xi_(n-1))
//   Q_ext = 2/x^2 sum (2n+1) Re(a_n + b_n)      Q_sca = 2/x^2 sum (2n+1) (|a_n|^2 + |b_n|^2)
//   phase = (|S1|^2 + |S2|^2) / (2 pi x^2 Q_sca), 1/sr, of unpolarised light
#pragma once

#include <complex>
#include <vector>

namespace welkin::mie {

// The series of one sphere: a and b from n = 1 on. About x + 4 x^(1/3) + 2 terms (Wiscombe 1980).
struct Series {
  double size_parameter;
  std::vector<std::complex<double>> a, b;
};

// Domain: 0 < x < 2e4, n > 0, k >= 0. derivatives_above: how many cube roots of |m x| above |m x| the D_n begin. 0 is
// the textbooks' n = |m x| + 16, which loses four digits at x = 1000.
Series series(double size_parameter, std::complex<double> index, double derivatives_above = 8.0);

double extinction_efficiency(const Series& sphere);
double scattering_efficiency(const Series& sphere);
double mean_cosine(const Series& sphere);

// S1 and S2: amplitudes across and along the plane of scattering, nu the cosine of its angle.
struct Amplitudes {
  std::complex<double> across, along;
};
Amplitudes amplitudes(const Series& sphere, double nu);

// Droplets whose number goes as r^((1-3v)/v) exp(-r/(r_e v)) (Hansen and Travis 1974): r_e is the effective radius
// <r^3>/<r^2>, v the effective variance. Clouds have v near 0.1, and less where fogbow and glory stand out.
struct Droplets {
  double effective_radius_um = 10.0;
  double effective_variance = 0.1;
};

// The mean over the droplets, per droplet cross-section.
struct CloudScattering {
  double extinction_efficiency;  // near 2
  double single_scattering_albedo;
  double mean_cosine;
  std::vector<double> phase;  // at the angles asked for, 1/sr; integrates to 1
};

// radii: how many sizes the mean takes. Ripples of one size cancel in it, from 200 on.
CloudScattering cloud_scattering(const Droplets& droplets, double wavelength_um, std::complex<double> index,
                                 const std::vector<double>& angles_rad, int radii = 400);

// Refractive index of water for 0.4 to 0.7 um: n by Cauchy's formula, within 0.001 of Hale and Querry (1973); k from
// Pope and Fry's absorption coefficient (1997), a = 4 pi k / wavelength.
std::complex<double> water_index(double wavelength_um);

// Angles that resolve both ends: theta = pi u^2 (3 - 2u), u = i / (count - 1).
std::vector<double> table_angles(int count);

}  // namespace welkin::mie
