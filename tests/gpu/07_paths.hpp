// What chapter 07's tests share: many random paths per ray on the device, with their standard errors. Units: km,
// degrees where a name says so, radiance per unit of solar irradiance.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/gpu/05_rays.hpp"

namespace welkin::test {

enum Tracking { kNaive, kShells, kExponential, kClosedForm };

// How paths are traced: what the shader is compiled for.
struct PathVariant {
  Tracking tracking = kClosedForm;
  bool hero = true;
  bool spread = true;        // collisions are also put where no flight gets
  bool environment = false;  // uniform light of radiance 1 from outside in place of the sun
  Phase phase = kCornetteShanks;
  bool rayleigh = true, mie = true, ozone = true;
  bool surfaces = false;  // rays end on a surface, level as the eye is, where PathRay says so
};

struct PathRay {
  SkyRay ray;
  reference::Rgb albedo{};
  int orders = 0;  // 0: all
  uint32_t seed = 1;
  double g = 0.8;
  double second_g = 0.0, shape = 0.0;  // double HG's second lobe; Draine's alpha or the second lobe's weight
  double surface_km = 0.0;             // distance to a surface of the ground's albedo; 0: none
};

struct PathMean {
  reference::Rgb mean{}, error{};  // error: one standard error
  double unfinished = 0.0;         // paths the driver cut
  double longest = 0.0;            // vertices of the longest path
};

// Means over blocks x paths_per_block paths of each ray, in batches that a software driver's loop limit never meets.
std::vector<PathMean> trace(const reference::Planet& planet, const std::vector<PathRay>& rays,
                            const PathVariant& variant, int blocks, int paths_per_block);

// A row of tests/data/multiple_scattering_*.csv: orders 1 (by quadrature), 2, 3, 5 and all of one channel.
struct OrdersRow {
  PathRay ray;
  int channel = 0;
  double radiance[5] = {}, error[5] = {};
};
constexpr int kOrders[5] = {1, 2, 3, 5, 0};
std::vector<OrdersRow> orders_rows(const std::string& file);

// Statistics of z = difference / combined standard error.
struct ZScores {
  std::vector<double> values;
  double share_within_3() const;
  double rms() const;
  double mean() const;
};

struct OrdersTable {
  const char* file;
  bool alien;
  Phase phase;
};
inline constexpr OrdersTable kTables[] = {{"multiple_scattering_earth_cs.csv", false, kCornetteShanks},
                                          {"multiple_scattering_earth_hg.csv", false, kHenyeyGreenstein},
                                          {"multiple_scattering_alien_cs.csv", true, kCornetteShanks}};
// Nothing darker is scored: a thousandth of moonlight. Few paths find what little light is there, and the spread of
// those that did not says nothing.
inline constexpr double kDark = 1e-8;

// The blue light of the dense planet's dusk, scattered once, that lies behind an optical depth of twenty; the table's
// row.
struct UnfoundLight {
  PathRay ray;
  double expected = 0.0;  // by quadrature
};
UnfoundLight unfound_light();

reference::Planet planet_of(bool alien);
double score(double got, double error, double expected, double expected_error);

// Scores rows first, first + stride, … of a table, of one order, or (order < 0) of one order each in turn. An assertion
// fails for paths that the driver cut.
void score_rows(const OrdersTable& table, size_t first, size_t stride, int order, int blocks,
                const PathVariant& variant, ZScores& z);

}  // namespace welkin::test
