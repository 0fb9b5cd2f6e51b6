// Optical depths of layer, disc, sphere and grid against closed forms in double and the tables of tests/data, through
// the program as a probe runs it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "common/app/camera.hpp"
#include "common/image/csv.hpp"
#include "tests/gpu/17_clouds.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kR = 6360.0;

Cloud layer(double base_km, double top_km, double extinction_per_km) {
  return {.kind = "layer", .base_km = base_km, .top_km = top_km, .extinction_per_km = extinction_per_km};
}

// Length of a ray inside a set, in double: boundaries are found by bisection between 20,000 samples.
template <typename Inside>
double length_inside(double end_km, const Inside& inside) {
  constexpr int kSamples = 20000;
  double sum = 0.0, from = 0.0;
  bool in = inside(0.0);
  for (int i = 1; i <= kSamples; ++i) {
    const double t = end_km * i / kSamples;
    if (inside(t) == in) continue;
    double a = end_km * (i - 1) / kSamples, b = t;
    for (int k = 0; k < 60; ++k) (inside(0.5 * (a + b)) == in ? a : b) = 0.5 * (a + b);
    if (in) sum += b - from;
    in = !in, from = b;
  }
  return in ? sum + end_km - from : sum;
}

double altitude_at(const glm::dvec3& p) { return glm::length(p + glm::dvec3(0.0, 0.0, kR)) - kR; }

}  // namespace

TEST_CASE("truth: a layer from half a metre to 36,000 km, tangent rays among them") {
  const CsvTable table =
      read_csv(std::string(WELKIN_TEST_DATA) + "/cloud_shell_length.csv",
               {"h_km", "view_zenith_deg", "length_km", "dlength_dzenith_km_per_urad", "T_0.5"}, {"ray_end"});
  std::vector<app::ProbeRay> rays;
  for (size_t i = 0; i < table.rows; ++i)
    rays.push_back(ray_up(table.column("h_km")[i], table.column("view_zenith_deg")[i], 77.0));
  size_t strict = 0, tangent = 0;
  for (const auto& [extinction, column] : {std::pair(0.5, "T_0.5"), std::pair(5.0, "T_5"), std::pair(30.0, "T_30")}) {
    const CloudRun run(scene_of({layer(1.5, 4.0, extinction)}));
    const std::vector<double> depths = run.optical_depths(rays);
    for (size_t i = 0; i < table.rows; ++i) {
      // A float32 direction is known to 0.06 microradians; where that moves the length, nothing is better known.
      const double length = table.column("length_km")[i],
                   slack = 0.15 * std::abs(table.column("dlength_dzenith_km_per_urad")[i]);
      CAPTURE(extinction, table.column("h_km")[i], table.column("view_zenith_deg")[i], length, depths[i] / extinction);
      CHECK(std::abs(depths[i] / extinction - length) < 2e-5 * length + 2e-5 + slack);
      if (slack > 1e-4) {
        ++tangent;
        continue;
      }
      ++strict;
      CHECK(std::abs(std::exp(-depths[i]) - table.column(column)[i]) < 1e-3);
    }
  }
  CHECK(strict > 100);
  CHECK(tangent > 10);
}

TEST_CASE("truth: a ball is a chord, from outside, inside and its own surface") {
  Random random(5);
  for (const double extinction : {0.05, 2.0, 60.0}) {
    const glm::dvec3 centre(3.0, -4.0, 9.0);
    const double radius = 0.5;
    const CloudRun run(scene_of({{.kind = "sphere",
                                  .east_km = centre.x,
                                  .north_km = centre.y,
                                  .up_km = centre.z,
                                  .radius_km = radius,
                                  .extinction_per_km = extinction}}));
    std::vector<app::ProbeRay> rays;
    std::vector<double> wanted;
    for (int i = 0; i < 2000; ++i) {
      const glm::dvec3 d = app::direction_from(random.uniform(5.0, 175.0), random.uniform(0.0, 360.0));
      const glm::dvec3 across = glm::normalize(glm::cross(d, glm::dvec3(0.3, 0.7, 0.1)));
      const double b = i % 5 == 0 ? 0.999 : random.uniform(0.0, 1.05);
      const double back = i % 3 == 0 ? random.uniform(-0.4, 0.4) : random.uniform(0.6, 8.0);
      const double half = b < 1.0 ? radius * std::sqrt(1.0 - b * b) : 0.0;
      wanted.push_back(std::max(half + std::min(half, back), 0.0) * (half > 0.0));
      rays.push_back(ray_from(centre + across * (b * radius) - d * back, d));
    }
    const std::vector<double> depths = run.optical_depths(rays);
    double worst = 0.0;
    for (size_t i = 0; i < rays.size(); ++i)
      worst = std::max(worst, std::abs(std::exp(-depths[i]) - std::exp(-extinction * wanted[i])));
    CAPTURE(extinction, worst);
    CHECK(worst < 3e-4);
  }
}

TEST_CASE("truth: a disc is a shell cut out by a cone, over the place and 60 km away, from below, inside and space") {
  for (const auto& [east, north, radius] : {std::array{0.0, 0.0, 5.0}, std::array{20.0, -57.0, 20.0},
                                            std::array{-300.0, 100.0, 60.0}, std::array{0.0, 0.0, 3000.0}}) {
    const Cloud disc{.kind = "disc",
                     .base_km = 1.5,
                     .top_km = 4.0,
                     .east_km = east,
                     .north_km = north,
                     .radius_km = radius,
                     .extinction_per_km = 1.0};
    const CloudRun run(scene_of({disc}));
    const double arc = std::hypot(east, north) / (kR + 1.5), alpha = radius / (kR + 1.5);
    const glm::dvec3 axis = arc > 0.0 ? glm::dvec3(std::sin(arc) * east / std::hypot(east, north),
                                                   std::sin(arc) * north / std::hypot(east, north), std::cos(arc))
                                      : glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 centre = axis * (kR + 2.75) - glm::dvec3(0.0, 0.0, kR);
    Random random(11);
    std::vector<app::ProbeRay> rays;
    for (int i = 0; i < 300; ++i) {
      // Towards a point of the disc, or a little beside it.
      glm::dvec3 beside = glm::cross(axis, app::direction_from(90.0, random.uniform(0.0, 360.0)));
      const double away = std::min(radius, 100.0) * random.uniform(0.0, 1.2);
      const glm::dvec3 at = centre + glm::normalize(beside) * away + axis * random.uniform(-1.2, 1.2);
      const double h = i % 4 == 0 ? 0.0005 : i % 4 == 1 ? 2.5 : i % 4 == 2 ? 11.0 : 20000.0;
      const glm::dvec3 from = i % 4 == 3 ? axis * (kR + h) - glm::dvec3(0.0, 0.0, kR) + glm::normalize(beside) * 4000.0
                                         : glm::dvec3(random.uniform(-30.0, 30.0), random.uniform(-30.0, 30.0), h);
      if (altitude_at(from) < 0.0003) continue;
      rays.push_back(ray_from(from, at - from));
    }
    const std::vector<double> depths = run.optical_depths(rays);
    double worst = 0.0, sum = 0.0;
    for (size_t i = 0; i < rays.size(); ++i) {
      // From space the samples would be too far apart: begin where the ray comes down to 5 km.
      glm::dvec3 from = rays[i].position_km;
      const glm::dvec3& d = rays[i].direction;
      double altitude = altitude_at(from);
      if (altitude > 100.0) {
        const glm::dvec3 c = from + glm::dvec3(0.0, 0.0, kR);
        const double along = glm::dot(c, d), closest2 = glm::dot(c, c) - along * along, top = kR + 5.0;
        if (along >= 0.0 || closest2 >= top * top) continue;
        from += d * (-along - std::sqrt(top * top - closest2));
      }
      const auto inside = [&](double t) {
        const glm::dvec3 p = from + d * t, c = p + glm::dvec3(0.0, 0.0, kR);
        const double h = altitude_at(p);
        return h >= 1.5 && h <= 4.0 && std::acos(std::min(glm::dot(c, axis) / glm::length(c), 1.0)) <= alpha;
      };
      double end = 700.0;
      for (double t = 0.0; t < end; t += 0.1)
        if (altitude_at(from + d * t) < 0.0) end = t;
      const double wanted = length_inside(end, inside);
      CAPTURE(east, radius, i, altitude_at(rays[i].position_km), wanted, depths[i]);
      // From 20,000 km a float32 direction is known to a metre or two on the ground.
      CHECK(std::abs(depths[i] - wanted) < (altitude > 100.0 ? 0.02 : 2e-3) + 1e-4 * wanted);
      worst = std::max(worst, std::abs(depths[i] - wanted)), sum += wanted;
    }
    CHECK(sum > 100.0);  // most rays do cross it
  }
}

TEST_CASE(
    "truth: columns of the grids, exact to 1e-3 and marched to 1 % in the median, at optical depths 0.5, 10, 60") {
  for (const char* name : {"blob", "cumulus", "deck"}) {
    const GridScore exact = grid_score(name, {{"cloud.grid", "exact"}}), marched = grid_score(name, {});
    CAPTURE(name, exact.rows, exact.worst_t, exact.median_depth, exact.median_t, marched.worst_t, marched.median_depth,
            marched.median_t);
    CHECK(exact.rows > 100);
    CHECK(exact.worst_t < 1e-3);
    CHECK(exact.median_t < 1e-3);
    CHECK(exact.median_depth < 1e-4);
    CHECK(marched.median_depth < 0.01);
    CHECK(marched.median_t < 0.01);
    const GridScore fine = grid_score(name, {{"cloud.grid_steps", "8"}});
    CAPTURE(fine.median_depth);
    CHECK(fine.median_depth < 0.5 * marched.median_depth + 1e-6);  // it converges
  }
}

TEST_CASE("truth: bodies that overlap add their extinctions") {
  const GridFile file("blob");
  const Cloud grid{.kind = "grid",
                   .east_km = -1,
                   .north_km = -1,
                   .up_km = 2,
                   .file = file.path().string(),
                   .size_km = file.size_km,
                   .extinction_per_km = 3.0};
  const std::vector<Cloud> bodies{
      layer(1.5, 4.0, 0.7),
      layer(2.0, 9.0, 0.2),
      {.kind = "disc", .base_km = 2.0, .top_km = 3.0, .radius_km = 4.0, .extinction_per_km = 2.0},
      {.kind = "sphere", .up_km = 3.0, .radius_km = 1.0, .extinction_per_km = 5.0},
      grid,
      grid};
  std::vector<app::ProbeRay> rays;
  for (int i = 0; i < 40; ++i)
    rays.push_back(ray_from({0.1 * i - 2.0, 0.05 * i - 1.0, i % 2 ? 0.001 : 12.0}, {0.1, -0.2, i % 2 ? 1.0 : -1.0}));
  const std::vector<double> all = CloudRun(scene_of(bodies)).optical_depths(rays);
  std::vector<double> sum(rays.size(), 0.0);
  for (const Cloud& body : bodies) {
    const std::vector<double> one = CloudRun(scene_of({body})).optical_depths(rays);
    for (size_t i = 0; i < rays.size(); ++i) sum[i] += one[i];
  }
  for (size_t i = 0; i < rays.size(); ++i) CHECK(all[i] == Approx(sum[i]).epsilon(1e-6));
  CHECK(*std::max_element(sum.begin(), sum.end()) > 10.0);
}
