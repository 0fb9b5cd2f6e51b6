// The sky view table's map against trigonometry in double, and its round trip.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/harness.hpp"

using namespace welkin::test;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius_km = 6360.0;

struct Query {
  float altitude, radius = kRadius_km;
  float view[3], sun[3];
  float width, height, x, y;
};
struct Answer {
  float azimuth_coordinate, elevation_coordinate, below_horizon;
  float mu, sine, cos_phi, sin_phi;
  float u, v;
};

std::vector<Answer> evaluate_map(const std::vector<Query>& queries) {
  const float* first = &queries.front().altitude;
  const std::vector<float> out =
      evaluate("tests/10_map.comp", std::vector<float>(first, first + 12 * queries.size()), 12, 9);
  std::vector<Answer> answers(queries.size());
  std::copy(out.begin(), out.end(), &answers.front().azimuth_coordinate);
  return answers;
}

double altitude_of(Random& random, size_t i) {
  const double named[] = {0.0, 0.0005, 0.002, 1.0, 10.0, 99.9, 400.0, 36000.0};
  return i % 3 ? named[random.next() % 8] : random.log_uniform(1e-4, 4e4);
}

double horizon_zenith(double h) { return kPi - std::asin(kRadius_km / (kRadius_km + h)); }

}  // namespace

TEST_CASE("10 map: a direction's place is what trigonometry in double says") {
  Random random(10);
  std::vector<Query> queries;
  for (size_t i = 0; i < 200000; ++i) {
    const double h = static_cast<float>(altitude_of(random, i));
    // Half of the views are close to the horizon: 1e-7 to 1e-1 rad from it, on both sides.
    double zenith = std::acos(random.uniform(-1.0, 1.0));
    if (i % 2)
      zenith = std::clamp(horizon_zenith(h) + (random.next() % 2 ? 1 : -1) * random.log_uniform(1e-7, 0.1), 0.0, kPi);
    const double azimuth = random.uniform(-kPi, kPi), sun_zenith = std::acos(random.uniform(-1.0, 1.0)),
                 sun_azimuth = random.uniform(-kPi, kPi);
    queries.push_back(
        {static_cast<float>(h),
         static_cast<float>(kRadius_km),
         {static_cast<float>(std::sin(zenith) * std::cos(azimuth)),
          static_cast<float>(std::sin(zenith) * std::sin(azimuth)), static_cast<float>(std::cos(zenith))},
         {static_cast<float>(std::sin(sun_zenith) * std::cos(sun_azimuth)),
          static_cast<float>(std::sin(sun_zenith) * std::sin(sun_azimuth)), static_cast<float>(std::cos(sun_zenith))},
         192,
         108,
         0,
         0});
  }
  const std::vector<Answer> answers = evaluate_map(queries);
  double worst_angle = 0.0, worst_azimuth = 0.0;
  size_t wrong_side = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const Query& q = queries[i];
    const double view_zenith = std::atan2(std::hypot(q.view[0], q.view[1]), q.view[2]);
    const double horizon = horizon_zenith(q.altitude), from = horizon - view_zenith;
    const bool below_horizon = answers[i].below_horizon > 0.5f;
    const double range = below_horizon ? kPi - horizon : horizon;
    // Back from the table's coordinate to an angle: 2 atan(n tan(range / 2)), with n = s^2 above the horizon.
    const double s2 = double{answers[i].elevation_coordinate} * answers[i].elevation_coordinate;
    const double m = std::max(std::tan(0.5 * (horizon - 0.5 * kPi)), 1e-6), knee = m + std::sqrt(m);
    const double angle = 2.0 * std::atan((below_horizon ? knee * s2 / (1.0 + knee - s2) : s2) * std::tan(0.5 * range));
    // An eye near the ground has hardly any rows towards the nadir: there the coordinate is compared, not the angle.
    const double n = std::tan(0.5 * std::abs(from)) / std::tan(0.5 * range);
    const double right = std::sqrt(below_horizon ? n * (1.0 + knee) / (n + knee) : n);
    if (std::abs(right - answers[i].elevation_coordinate) > 2e-7)
      worst_angle = std::max(worst_angle, std::abs(angle - std::abs(from)));
    if (below_horizon != (from < 0.0) && std::abs(from) > 3e-7) ++wrong_side;
    if (std::hypot(q.view[0], q.view[1]) > 1e-3 && std::hypot(q.sun[0], q.sun[1]) > 1e-3) {
      const double phi = std::atan2(q.view[1], q.view[0]) - std::atan2(q.sun[1], q.sun[0]);
      worst_azimuth = std::max(worst_azimuth, std::abs(std::abs(std::sin(0.5 * phi)) - answers[i].azimuth_coordinate));
    }
  }
  CAPTURE(worst_angle, worst_azimuth);
  CHECK(wrong_side == 0);  // but for directions within their rounding, 3e-7 rad
  // Float32 directions: a few units of 6e-8, times the range's tangent near the zenith seen from 36 000 km (a factor
  // 13).
  CHECK(worst_angle < 2e-6);
  CHECK(worst_azimuth < 1e-6);
}

TEST_CASE("10 map: texel to direction and back is the texel's centre") {
  Random random(11);
  std::vector<Query> queries;
  for (size_t i = 0; i < 200000; ++i) {
    const int sizes[][2] = {{96, 54}, {192, 108}, {384, 216}, {2, 4}, {17, 6}};
    const int* size = sizes[random.next() % 5];
    queries.push_back({static_cast<float>(altitude_of(random, i)),
                       static_cast<float>(kRadius_km),
                       {0, 0, 1},
                       {1, 0, 0},
                       static_cast<float>(size[0]),
                       static_cast<float>(size[1]),
                       static_cast<float>(random.next() % static_cast<uint32_t>(size[0])),
                       static_cast<float>(random.next() % static_cast<uint32_t>(size[1]))});
  }
  const std::vector<Answer> answers = evaluate_map(queries);
  double worst_x = 0.0, worst_y = 0.0, worst_horizon = 0.0, worst_unit = 0.0;
  for (size_t i = 0; i < queries.size(); ++i) {
    const Query& q = queries[i];
    const Answer& a = answers[i];
    const double row = double{a.v} * q.height - 0.5;
    const bool at_horizon = q.y == q.height / 2 || q.y == q.height / 2 - 1;
    // A row whose directions all point to the zenith or the nadir has no azimuth.
    if (a.sine > 1e-3f) worst_x = std::max(worst_x, std::abs(double{a.u} * q.width - 0.5 - q.x));
    (at_horizon ? worst_horizon : worst_y) = std::max(at_horizon ? worst_horizon : worst_y, std::abs(row - q.y));
    worst_unit = std::max(worst_unit, std::abs(double{a.mu} * a.mu + double{a.sine} * a.sine - 1.0));
  }
  CAPTURE(worst_x, worst_y, worst_horizon, worst_unit);
  CHECK(worst_x < 2e-4);        // texels; float32 knows 384 columns to 1e-4 of one
  CHECK(worst_y < 2e-3);        // the root magnifies a direction's rounding most in the second row
  CHECK(worst_horizon < 0.12);  // they are moved off it by a thousandth of their half: 107 rows here
  CHECK(worst_unit < 1e-6);
}
