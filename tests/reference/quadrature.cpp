// Adaptive quadrature for single scattering. See quadrature.hpp for the model and units.
//
// Method. Both integrals are split where their integrands have kinks or peaks (tangent point, ozone tent, a ladder of
// scale heights above the lowest point) and every piece is refined by bisection with the 7-point Gauss, 15-point
// Kronrod pair: the inner one (columns) piece by piece, the outer one globally, worst piece first.
// A ray is measured from its tangent point: s = r mu, b = r sine, h(s) = (b - R) + s^2 / (b + sqrt(b^2 + s^2)).
#include "tests/reference/quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <queue>
#include <vector>

namespace welkin::reference {
namespace {

constexpr double kPi = 3.14159265358979323846;

// Abscissae and weights of the Gauss-Kronrod 7/15 pair (Piessens et al., QUADPACK, qk15).
constexpr std::array<double, 8> kNode{0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                      0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                      0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
                                      0.207784955007898467600689403773245, 0.0};
constexpr std::array<double, 8> kKronrod{0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                         0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                         0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                         0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array<double, 4> kGauss{0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                                       0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

struct Line {
  double b;          // perpendicular distance to the planet's centre, km
  double tangent_h;  // b - R
  double altitude(double s) const { return tangent_h + s * s / (b + std::hypot(b, s)); }
};

// |s| at which the line reaches altitude h >= tangent altitude.
double half_chord(const Line& line, const Planet& planet, double h) {
  const double below = h - line.tangent_h;
  return std::sqrt(std::max(0.0, below * (h + planet.ground_radius_km + line.b)));
}

template <std::size_t N>
struct Estimate {
  std::array<double, N> value{};
  std::array<double, N> error{};
};

template <std::size_t N, typename F>
Estimate<N> kronrod(const F& f, double a, double b) {
  const double centre = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  Estimate<N> out;
  std::array<double, N> gauss{};
  for (int i = 0; i < 8; ++i) {
    for (int side = 0; side < (i == 7 ? 1 : 2); ++side) {
      const auto y = f(centre + (side == 0 ? half : -half) * kNode[i]);
      for (std::size_t c = 0; c < N; ++c) {
        out.value[c] += half * kKronrod[i] * y[c];
        if (i % 2 == 1) gauss[c] += half * kGauss[i / 2] * y[c];
      }
    }
  }
  for (std::size_t c = 0; c < N; ++c) out.error[c] = std::abs(out.value[c] - gauss[c]);
  return out;
}

// Bisection to a tolerance relative to `scale`, the size of what has been summed so far.
template <typename F>
double refine(const F& f, double a, double b, double scale, int depth) {
  const auto piece = kronrod<1>(f, a, b);
  if (depth == 0 || piece.error[0] <= 1e-12 * std::max(scale, std::abs(piece.value[0]))) return piece.value[0];
  const double centre = 0.5 * (a + b);
  return refine(f, a, centre, scale, depth - 1) + refine(f, centre, b, scale, depth - 1);
}

// Adds +-s at which the line is one, four, nine... scale heights above its lowest point in [s0, s1].
void add_ladder(std::vector<double>& cuts, const Line& line, const Planet& planet, double s0, double s1, double scale) {
  const double lowest = s0 <= 0.0 && s1 >= 0.0 ? 0.0 : std::min(std::abs(s0), std::abs(s1));
  const double h_lowest = line.altitude(lowest);
  for (int rung = 1; rung <= 5; ++rung) {
    const double s = half_chord(line, planet, h_lowest + scale * rung * rung);
    cuts.push_back(s);
    cuts.push_back(-s);
  }
  cuts.push_back(0.0);
}

std::vector<double> finish_cuts(std::vector<double> cuts, double s0, double s1) {
  std::erase_if(cuts, [&](double s) { return !(s > s0 && s < s1); });
  cuts.push_back(s0);
  cuts.push_back(s1);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  return cuts;
}

void add_tent(std::vector<double>& cuts, const Line& line, const Planet& planet) {
  for (int k = -1; k <= 1; ++k) {
    const double h = planet.ozone_peak_km + k * planet.ozone_half_width_km;
    if (h <= line.tangent_h) continue;
    const double s = half_chord(line, planet, h);
    cuts.push_back(s);
    cuts.push_back(-s);
  }
}

template <typename F>
double integrate_pieces(const F& f, const std::vector<double>& cuts) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) sum += kronrod<1>(f, cuts[i], cuts[i + 1]).value[0];
  double total = 0.0;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) total += refine(f, cuts[i], cuts[i + 1], sum, 20);
  return total;
}

double tent(const Planet& p, double h) {
  return std::max(0.0, 1.0 - std::abs(h - p.ozone_peak_km) / p.ozone_half_width_km);
}

std::array<double, 3> line_columns(const Planet& planet, const Line& line, double s0, double s1) {
  std::array<double, 3> out{};
  if (!(s1 > s0)) return out;
  const std::array<double, 2> scale{planet.rayleigh_scale_height_km, planet.mie_scale_height_km};
  for (int k = 0; k < 2; ++k) {
    std::vector<double> cuts;
    add_ladder(cuts, line, planet, s0, s1, scale[k]);
    const auto f = [&](double s) { return std::array<double, 1>{std::exp(-line.altitude(s) / scale[k])}; };
    out[k] = integrate_pieces(f, finish_cuts(std::move(cuts), s0, s1));
  }
  std::vector<double> cuts{0.0};
  add_tent(cuts, line, planet);
  const auto f = [&](double s) { return std::array<double, 1>{tent(planet, line.altitude(s))}; };
  out[2] = integrate_pieces(f, finish_cuts(std::move(cuts), s0, s1));
  return out;
}

Rgb optical_depth(const Planet& p, const std::array<double, 3>& column) {
  Rgb tau{};
  for (int c = 0; c < 3; ++c) {
    tau[c] = p.rayleigh_scattering_per_km[c] * column[0] + p.mie_extinction_per_km[c] * column[1] +
             p.ozone_absorption_per_km[c] * column[2];
  }
  return tau;
}

Line line_of(const Planet& planet, double r, double sine) { return {r * sine, r * sine - planet.ground_radius_km}; }

// Parts of [s0, s1] outside the shadow cylinder. along(t) = position . sun, quadratic form of the distance to the axis.
std::vector<std::array<double, 2>> lit_parts(double r0, double mu, double mu_sun, double nu, double length, double R) {
  const double a = 1.0 - nu * nu;
  const double half_b = r0 * (mu - mu_sun * nu);
  const double c = r0 * r0 * (1.0 - mu_sun * mu_sun) - R * R;
  double enter = 0.0;
  double leave = 0.0;  // the dark interval; empty when equal
  const double discriminant = half_b * half_b - a * c;
  if (a < 1e-24) {  // along the axis: the distance to it does not change
    if (c < 0.0) leave = length;
  } else if (discriminant > 0.0) {
    enter = (-half_b - std::sqrt(discriminant)) / a;
    leave = (-half_b + std::sqrt(discriminant)) / a;
  }
  // Only the half behind the planet's centre is dark: r0 mu_sun + t nu < 0.
  if (nu > 0.0) leave = std::min(leave, -r0 * mu_sun / nu);
  if (nu < 0.0) enter = std::max(enter, -r0 * mu_sun / nu);
  if (nu == 0.0 && mu_sun >= 0.0) leave = enter;
  enter = std::clamp(enter, 0.0, length);
  leave = std::clamp(leave, 0.0, length);
  if (!(leave > enter)) return {{0.0, length}};
  std::vector<std::array<double, 2>> parts;
  if (enter > 0.0) parts.push_back({0.0, enter});
  if (leave < length) parts.push_back({leave, length});
  return parts;
}

struct Piece {
  double a, b;
  Estimate<6> estimate;
  double worst;
  bool operator<(const Piece& other) const { return worst < other.worst; }
};

// The sum of an integrand over pieces; the one with the worst error is halved until the whole is good enough.
template <typename F>
struct AdaptiveSum {
  explicit AdaptiveSum(const F& f) : integrand(f) {}

  void add(double a, double b) {
    Piece piece{a, b, kronrod<6>(integrand, a, b), 0.0};
    for (int c = 0; c < 6; ++c) {
      total[c] += piece.estimate.value[c];
      error[c] += piece.estimate.error[c];
    }
    for (int c = 0; c < 6; ++c)
      if (total[c] > 0.0) piece.worst = std::max(piece.worst, piece.estimate.error[c] / total[c]);
    queue.push(piece);
  }
  double relative_error() const {
    double worst = 0.0;
    for (int c = 0; c < 6; ++c)
      if (total[c] > 0.0) worst = std::max(worst, error[c] / total[c]);
    return worst;
  }
  void refine(double tolerance) {
    for (int step = 0; step < 400 && !queue.empty() && relative_error() > tolerance; ++step) {
      const Piece piece = queue.top();
      queue.pop();
      for (int c = 0; c < 6; ++c) {
        total[c] -= piece.estimate.value[c];
        error[c] -= piece.estimate.error[c];
      }
      const double centre = 0.5 * (piece.a + piece.b);
      add(piece.a, centre);
      add(centre, piece.b);
    }
  }

  const F& integrand;
  std::priority_queue<Piece> queue;
  std::array<double, 6> total{}, error{};
};

}  // namespace

Planet earth() { return {}; }

Planet dense_alien() {
  Planet p;
  p.rayleigh_scattering_per_km = {0.149, 0.142, 0.051};
  p.rayleigh_scale_height_km = 18.416;
  p.mie_scattering_per_km = {0.046, 0.047, 0.057};
  p.mie_extinction_per_km = {0.082, 0.071, 0.058};
  p.mie_scale_height_km = 13.143;
  return p;
}

double rayleigh_phase(double nu) { return 3.0 / (16.0 * kPi) * (1.0 + nu * nu); }

double henyey_greenstein(double nu, double g) {
  return (1.0 - g * g) / (4.0 * kPi * std::pow(1.0 + g * g - 2.0 * g * nu, 1.5));
}

double cornette_shanks(double nu, double g) { return draine(nu, g, 1.0); }

double draine(double nu, double g, double alpha) {
  return henyey_greenstein(nu, g) * (1.0 + alpha * nu * nu) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
}

std::array<double, 3> columns(const Planet& planet, double altitude_km, double mu, double sine, double length_km) {
  const double r = planet.ground_radius_km + altitude_km;
  return line_columns(planet, line_of(planet, r, sine), r * mu, r * mu + length_km);
}

Rgb transmittance_to_top(const Planet& planet, double altitude_km, double mu) {
  const double r = planet.ground_radius_km + altitude_km;
  const Line line = line_of(planet, r, std::sqrt(std::max(0.0, (1.0 - mu) * (1.0 + mu))));
  if (mu < 0.0 && line.tangent_h < 0.0) return {};
  const double top = half_chord(line, planet, planet.top_radius_km - planet.ground_radius_km);
  const Rgb tau = optical_depth(planet, line_columns(planet, line, r * mu, std::max(top, r * mu)));
  return {std::exp(-tau[0]), std::exp(-tau[1]), std::exp(-tau[2])};
}

Direction direction_from_degrees(double zenith_deg, double azimuth_deg) {
  const auto sine = [](double degrees) {
    return std::fmod(degrees, 180.0) == 0.0 ? 0.0 : std::sin(degrees * kPi / 180.0);
  };
  const auto cosine = [](double degrees) {
    return std::fmod(degrees, 180.0) == 90.0 ? 0.0 : std::cos(degrees * kPi / 180.0);
  };
  return {sine(zenith_deg) * cosine(azimuth_deg), sine(zenith_deg) * sine(azimuth_deg), cosine(zenith_deg)};
}

SingleScattering single_scattering(const Planet& planet, double altitude_km, const Direction& view,
                                   const Direction& sun, double tolerance) {
  SingleScattering out;
  const double R = planet.ground_radius_km;
  const double top_h = planet.top_radius_km - R;
  const double h0 = std::max(0.0, altitude_km);
  const double r0 = R + h0;
  const double sine = std::hypot(view[0], view[1]), mu = view[2];
  const double nu = view[0] * sun[0] + view[1] * sun[1] + view[2] * sun[2];
  const Line line = line_of(planet, r0, sine);
  out.nu = nu;
  out.tangent_altitude_km = line.tangent_h;

  const double camera_s = r0 * mu;
  const double top_s = half_chord(line, planet, top_h);
  if (line.tangent_h >= top_h || (h0 >= top_h && mu >= 0.0)) return out;
  const bool ground = line.tangent_h < 0.0 && mu < 0.0;
  const double begin = h0 > top_h ? -top_s : camera_s;
  const double end = ground ? -half_chord(line, planet, 0.0) : top_s;
  out.end = ground ? RayEnd::kGround : RayEnd::kSky;
  if (!(end > begin) && !ground) return out;  // on the top looking out; else on the ground looking down

  const auto sun_optical_depth = [&](double s, double h, bool& lit) {
    const double r = R + h;
    const double mu_sun = std::clamp((r0 * sun[2] + (s - camera_s) * nu) / r, -1.0, 1.0);
    const Line light = line_of(planet, r, std::sqrt((1.0 - mu_sun) * (1.0 + mu_sun)));
    lit = mu_sun >= 0.0 || light.tangent_h >= 0.0;
    if (!lit) return Rgb{};
    return optical_depth(planet, line_columns(planet, light, r * mu_sun, half_chord(light, planet, top_h)));
  };
  const auto integrand = [&](double s) {
    std::array<double, 6> y{};
    const double h = line.altitude(s);
    // The caller integrates lit parts only; a point on their edge may look dark through rounding and is worth nothing.
    bool lit = false;
    const Rgb light = sun_optical_depth(s, h, lit);
    if (!lit) return y;
    const Rgb seen = optical_depth(planet, line_columns(planet, line, begin, s));
    const double rayleigh = std::exp(-h / planet.rayleigh_scale_height_km);
    const double mie = std::exp(-h / planet.mie_scale_height_km);
    for (int c = 0; c < 3; ++c) {
      const double t = std::exp(-light[c] - seen[c]);
      y[c] = planet.rayleigh_scattering_per_km[c] * rayleigh * t;
      y[c + 3] = planet.mie_scattering_per_km[c] * mie * t;
    }
    return y;
  };

  AdaptiveSum sum(integrand);
  const double mu_begin_sun = (r0 * sun[2] + (begin - camera_s) * nu);
  const double r_begin = std::hypot(line.b, begin);
  for (const auto& part : lit_parts(r_begin, begin / r_begin, mu_begin_sun / r_begin, nu, end - begin, R)) {
    const double a = begin + part[0], b = begin + part[1];
    if (!(b > a)) continue;
    std::vector<double> cuts;
    add_ladder(cuts, line, planet, a, b, planet.rayleigh_scale_height_km);
    add_ladder(cuts, line, planet, a, b, planet.mie_scale_height_km);
    add_tent(cuts, line, planet);
    cuts = finish_cuts(std::move(cuts), a, b);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) sum.add(cuts[i], cuts[i + 1]);
  }
  sum.refine(tolerance);
  out.relative_error = sum.relative_error();

  const Rgb tau = optical_depth(planet, line_columns(planet, line, begin, end));
  for (int c = 0; c < 3; ++c) {
    out.rayleigh[c] = std::max(0.0, sum.total[c]);
    out.mie[c] = std::max(0.0, sum.total[c + 3]);
    out.transmittance[c] = std::exp(-tau[c]);
  }
  if (ground) {
    const double mu_sun = (r0 * sun[2] + (end - camera_s) * nu) / R;
    if (mu_sun > 0.0) {
      bool lit = true;
      const Rgb light = sun_optical_depth(end, 0.0, lit);
      for (int c = 0; c < 3; ++c) out.ground1[c] = out.transmittance[c] * std::exp(-light[c]) * mu_sun / kPi;
    }
  }
  return out;
}

}  // namespace welkin::reference
