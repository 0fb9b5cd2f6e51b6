// Shared by chapter 09's tests: the functions of tests/gpu/shaders/09_parts.comp, the chapter's probe and table for a
// scene and settings, and the rows of the Monte Carlo tables. Units: km, degrees in names that end in _deg, radiance
// per unit of solar irradiance.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/app/chapter.hpp"

namespace welkin::test {

struct OrderPart {
  enum { kDirection, kMap, kTransfer, kFurnace, kClose, kMoments };
  float values[8] = {};
};
std::vector<std::array<float, 12>> evaluate_orders(const std::vector<OrderPart>& parts);

using Choices = std::vector<std::pair<std::string, std::string>>;  // knobs that differ from their defaults

// A row of tests/data/multiple_scattering_*.csv: one ray and ground albedo, one channel.
struct OrderRow {
  app::ProbeRay ray;
  int channel = 0;
  double albedo = 0.0;
  double first = 0.0, second = 0.0, all = 0.0, all_error = 0.0;  // up to order 1, 2, infinity; one standard error
  bool near_horizon = false;                                     // within 0.5 degrees of it
};
std::vector<OrderRow> order_rows(const std::string& file);

// The chapter's radiance for each row.
std::vector<double> sky_of_rows(const std::string& scene, Phase phase, const Choices& choices,
                                const std::vector<OrderRow>& rows);

// The chapter's probe for any scene and settings.
std::vector<app::ProbeResult> chapter_09_sky(const Scene& scene, const Choices& choices,
                                             const std::vector<app::ProbeRay>& rays);
Scene orders_scene(const std::string& name);

// The texels of the table: mean radiance J and the irradiance from above, in float.
struct TableTexel {
  double mu_sun, altitude_km;
  std::array<double, 3> mean{}, irradiance{};
};
std::vector<TableTexel> table_of(const Scene& scene, const Choices& choices);

// Relative errors against the rows' `all`, for rows whose standard error is below 1 % of it.
struct OrderErrors {
  std::vector<double> values;
  double quantile(double share) const;
};
enum class Rows { all, target };  // target: sun above -4 degrees and not within 0.5 degrees of the horizon
OrderErrors errors_of(const std::vector<OrderRow>& rows, const std::vector<double>& got, Rows which);

// Relative errors of the sky 1 to 40 degrees above a sun at an elevation of 45 degrees, against `paths` paths per ray
// of chapter 07, and the relative standard error of these.
struct Aureole {
  double angle_deg;
  glm::dvec3 error, noise;
};
std::vector<Aureole> aureole(const std::string& scene, const std::string& paths);

}  // namespace welkin::test
