// What chapter 05's tests share: rays and planets of the reference quadrature, marched by the shader on the device.
// Units: km, degrees where a name says so, radiance per unit of solar irradiance.
#pragma once

#include <array>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/reference/quadrature.hpp"

namespace welkin::test {

enum Rule { kLeft, kMidpoint, kOffset03, kNonuniform, kGaussLegendre, kAdapted };
enum Phase { kHenyeyGreenstein, kCornetteShanks, kDraine, kDoubleHg };

// A ray in the camera's local frame, z up.
struct SkyRay {
  double altitude_km = 0.0;
  reference::Direction view{0.0, 0.0, 1.0};
  reference::Direction sun{0.0, 0.0, 1.0};
};

struct March {
  int view_steps = 32;
  int light_steps = 8;
  Rule rule = kAdapted;
  Phase phase = kHenyeyGreenstein;
  double g = 0.8;
  double albedo = 0.0;
  bool enter_in_double = true;  // rays from space start where they meet the air, as --probe does
  bool rayleigh = true, mie = true, ozone = true;
};

struct Light {
  reference::Rgb radiance{};
  reference::Rgb transmittance{};
};

// What tests/gpu/shaders/05_ray.comp reads.
struct RayItem {
  float rayleigh[4], mie_scattering[4], mie_extinction[4], ozone[4], shape[4], ground[4], sun_irradiance[4];
  float view[4], sun[4], steps[4];
};
static_assert(sizeof(RayItem) == 160);

// The same ray from the point where it meets the air, found in double; one that misses looks up from the top.
SkyRay enter_in_double(const reference::Planet& planet, const SkyRay& ray);

RayItem ray_item(const reference::Planet& planet, const SkyRay& ray, const March& march);
std::vector<Light> march_items(std::span<const RayItem> items, const March& march);
std::vector<Light> march_rays(const reference::Planet& planet, std::span<const SkyRay> rays, const March& march);

// A row of tests/data/single_scattering_*.csv; the columns are explained there.
struct TruthRow {
  double view_zenith_deg = 0.0, sun_zenith_deg = 0.0, azimuth_deg = 0.0;
  SkyRay ray;
  reference::Rgb ground1{}, transmittance{}, henyey_greenstein{}, cornette_shanks{};
  double sky_maximum = 0.0;
};

// A camera's altitude in km and its sun's zenith angle in degrees.
using Camera = std::pair<double, double>;

// The brightest channel of each camera's sky over black ground (Henyey-Greenstein, g 0.8), over a grid of 7 azimuths by
// 60 zenith angles (in space: 60 tangent altitudes) marched at 32 x 8. A grid can only miss some of the maximum, and a
// smaller maximum scores more rays, not fewer.
std::map<Camera, double> sky_maxima(const reference::Planet& planet, const std::set<Camera>& cameras);

// The table with sky_maximum filled in: the larger of the grid's and of the table's own rows for that camera.
std::vector<TruthRow> truth_rows(const std::string& file, const reference::Planet& planet);

// One item for tests/gpu/shaders/05_parts.comp: which function, then its arguments. Eight floats come back for each.
struct Part {
  enum { kSegment, kMeanTransmittance, kSunColumns, kSunUp, kEnter, kDisc };
  float values[8] = {};
};
std::vector<std::array<float, 8>> evaluate_parts(std::span<const Part> parts);

SkyRay ray_from_degrees(double altitude_km, double view_zenith_deg, double sun_zenith_deg, double azimuth_deg);

// Relative errors of radiance, one per channel above the floor; and their statistics.
struct Errors {
  std::vector<double> values;
  void add(const reference::Rgb& got, const reference::Rgb& expected, double floor);
  double maximum() const;
  double quantile(double share) const;
};

}  // namespace welkin::test
