// Hard cases of chapter 10's table of directions: the sun overhead, the sharp horizon, the sun's azimuth, the zenith, a
// night in 16 bits, the view from space; and which passes run again after which change.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "chapters/10_sky_view_lut/sky.hpp"
#include "common/app/renderer.hpp"
#include "tests/gpu/10_sky.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

const Choices kTable{{"sky_view.method", "table"}};
// A cheap table, for tests of the map and not of chapter 09's radiance.
const Choices kQuick{
    {"sky_view.method", "table"}, {"multiple_scattering.method", "published"}, {"sky_view.size", "96x54"}};

double relative(double a, double b) { return std::abs(a / b - 1.0); }

}  // namespace

TEST_CASE("10 hard: with the sun overhead the sky has no azimuth") {
  std::vector<app::ProbeRay> rays;
  for (const double zenith : {0.0, 1.0, 30.0, 80.0, 89.9, 90.5, 120.0, 180.0})
    for (const double azimuth : {0.0, 17.0, 90.0, 179.0, 180.0}) rays.push_back({0.002, zenith, 0.0, azimuth});
  const std::vector<app::ProbeResult> light = chapter_10_sky(orders_scene("earth"), kQuick, rays);
  for (size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(rays[i].view_zenith_deg, rays[i].relative_azimuth_deg);
    CHECK(std::isfinite(light[i].radiance.g));
    CHECK(light[i].radiance.g > 0.0);
    CHECK(relative(light[i].radiance.g, light[i - i % 5].radiance.g) < 2e-5);
  }
}

// The naive table has one row of texels on either side of the horizon and blends them: a band of ground in the sky.
TEST_CASE("10 hard: the horizon is a line, not a band") {
  std::vector<app::ProbeRay> rays;
  std::vector<double> below_horizon_deg;
  for (const double altitude : {0.0005, 0.002, 1.0, 10.0})
    for (const double sun : {60.0, 91.0})
      for (const double off : {-0.2, -0.05, -0.01, -0.003, 0.003, 0.01, 0.05, 0.2}) {
        rays.push_back(
            {altitude, 180.0 - std::asin(6360.0 / (6360.0 + altitude)) * 57.29577951308232 + off, sun, 40.0});
        below_horizon_deg.push_back(off);
      }
  const std::vector<app::ProbeResult> table = chapter_10_sky(orders_scene("earth"), kTable, rays),
                                      march =
                                          chapter_10_sky(orders_scene("earth"), {{"sky_view.method", "march"}}, rays);
  for (size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(rays[i].altitude_km, rays[i].sun_zenith_deg, below_horizon_deg[i], table[i].radiance.g,
            march[i].radiance.g);
    // Just below the horizon a ray's length changes by half within a row of the table; above it nothing does.
    CHECK(relative(table[i].radiance.g, march[i].radiance.g) < (below_horizon_deg[i] < 0.0 ? 0.02 : 0.1));
  }
}

// Half a metre up the horizon is 2.5 km away, and 0.02 degrees below it the ground is 500 m away: with the sun 1 degree
// up nearly all the radiance there comes from the air in front of the ground. Rows that ignore the dip would blend the
// two.
TEST_CASE("10 hard: just under the horizon the air before the ground is as long as it is") {
  std::vector<app::ProbeRay> rays;
  for (const double altitude : {0.0005, 0.002, 0.1, 1.0, 10.0})
    for (const double sun : {60.0, 85.0, 89.0, 91.0, 94.0})
      for (const double azimuth : {0.0, 3.0, 40.0, 180.0})
        for (const double below :
             {0.0003, 0.001, 0.003, 0.006, 0.01, 0.014, 0.02, 0.03, 0.06, 0.13, 0.3, 1.0, 3.0, 9.0, 30.0})
          rays.push_back(
              {altitude, 180.0 - std::asin(6360.0 / (6360.0 + altitude)) * 57.29577951308232 + below, sun, azimuth});
  const std::vector<app::ProbeResult> table = chapter_10_sky(orders_scene("earth"), kTable, rays),
                                      march =
                                          chapter_10_sky(orders_scene("earth"), {{"sky_view.method", "march"}}, rays);
  double worst[5] = {};
  for (size_t i = 0; i < rays.size(); ++i) {
    const double error = relative(table[i].radiance.g, march[i].radiance.g);
    worst[i / 300] = std::max(worst[i / 300], error);
  }
  CAPTURE(worst[0], worst[1], worst[2], worst[3], worst[4]);
  CHECK(std::max({worst[0], worst[1], worst[2], worst[4]}) < 0.01);
  CHECK(worst[3] < 0.05);  // 1 km up with the sun 1 degree down: the shadow's edge on the ground is just there
}

// A seam would be a change of slope larger than between any other neighbours.
TEST_CASE("10 hard: no seam at the sun's azimuth, opposite it, or at the zenith") {
  constexpr int kReach = 20, kLine = 2 * kReach + 1;  // rays of a line, the seam in its middle
  std::vector<app::ProbeRay> rays;
  for (const double sun : {30.0, 85.0, 93.0}) {
    for (int i = -kReach; i <= kReach; ++i) rays.push_back({0.002, 75.0, sun, 0.7 * i});
    for (int i = -kReach; i <= kReach; ++i) rays.push_back({0.002, 75.0, sun, 180.0 + 0.7 * i});
    for (int i = -kReach; i <= kReach; ++i) rays.push_back({0.002, std::abs(0.7 * i), sun, i < 0 ? 120.0 : -60.0});
  }
  const std::vector<app::ProbeResult> light = chapter_10_sky(
      orders_scene("earth"), {{"sky_view.method", "table"}, {"multiple_scattering.method", "published"}}, rays);
  for (size_t line = 0; line < rays.size(); line += kLine) {
    double at_seam = 0.0, elsewhere = 0.0;
    for (int i = 1; i + 1 < kLine; ++i) {
      const auto green = [&](int k) { return light[line + static_cast<size_t>(k)].radiance.g; };
      const double bend = std::abs(green(i - 1) - 2.0 * green(i) + green(i + 1)) / green(i);
      double& worst = std::abs(i - kReach) <= 1 ? at_seam : elsewhere;
      worst = std::max(worst, bend);
    }
    CAPTURE(rays[line].sun_zenith_deg, line / kLine % 3, at_seam, elsewhere);
    CHECK(at_seam < 2.0 * elsewhere);
    CHECK(at_seam < 0.01);
  }
}

TEST_CASE("10 hard: a night keeps its digits in 16 bits") {
  const std::vector<app::ProbeRay> rays = rays_from({0.002}, {100.0, 104.0}, 60, 103);
  const Scene scene = orders_scene("earth");
  const std::vector<app::ProbeResult> whole = chapter_10_sky(scene, kTable, rays);
  const std::vector<app::ProbeResult> half =
      chapter_10_sky(scene, {{"sky_view.method", "table"}, {"sky_view.format", "half"}}, rays);
  const std::vector<double> errors = differences(rays, half, whole, 1e-2);
  double naive = 0.0;  // the same radiances in 16 bits as they are
  for (const app::ProbeResult& light : whole)
    if (light.radiance.g > 1e-9)
      naive = std::max(naive, relative(glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(light.radiance.g))),
                                       light.radiance.g));
  CAPTURE(quantile(errors, 1.0), naive);
  CHECK(quantile(errors, 1.0) < 5e-3);
  CHECK(naive > 0.1);
}

TEST_CASE("10 hard: from space the table fails, and is not asked") {
  const Scene scene = orders_scene("earth");
  const std::vector<app::ProbeRay> rays = rays_from({400.0}, {30.0, 89.0}, 80, 104);
  std::vector<app::ProbeRay> below = rays_from({19.999}, {30.0, 89.0}, 80, 105), above = below, all = rays;
  for (app::ProbeRay& ray : above) ray.altitude_km = 20.001;
  all.insert(all.end(), below.begin(), below.end());
  all.insert(all.end(), above.begin(), above.end());
  const std::vector<app::ProbeResult> march = chapter_10_sky(scene, {{"sky_view.method", "march"}}, rays),
                                      light = chapter_10_sky(scene, {}, all);
  const auto part = [&](size_t first, size_t count) {
    return std::vector<app::ProbeResult>(light.begin() + static_cast<long>(first),
                                         light.begin() + static_cast<long>(first + count));
  };
  const std::vector<double> table = differences(rays, chapter_10_sky(scene, kTable, rays), march),
                            automatic = differences(rays, part(0, rays.size()), march);
  CAPTURE(quantile(table, 0.95), quantile(table, 1.0));
  CHECK(quantile(table, 1.0) > 0.5);
  CHECK(quantile(automatic, 1.0) == 0.0);
  // At the altitude where the march replaces the table the sky must not jump.
  const std::vector<double> step =
      differences(below, part(rays.size() + below.size(), above.size()), part(rays.size(), below.size()));
  CAPTURE(quantile(step, 0.5), quantile(step, 0.95));
  CHECK(quantile(step, 0.5) < 2e-3);
  CHECK(quantile(step, 0.95) < 0.02);
}

TEST_CASE("10 hard: nothing that is not a number, from anywhere") {
  Random random(106);
  std::vector<app::ProbeRay> rays;
  for (const double altitude : {0.0, 0.0005, 99.999, 100.0, 36000.0})
    for (const double sun : {0.0, 90.0, 180.0})
      for (int i = 0; i < 80; ++i) {
        const double edges[] = {0.0, 90.0, 180.0, 89.999999, 90.000001};
        rays.push_back({altitude, i % 2 ? edges[random.next() % 5] : random.uniform(0.0, 180.0), sun,
                        random.uniform(-180.0, 180.0)});
      }
  for (const char* name : {"earth", "alien"})
    for (const app::ProbeResult& light : chapter_10_sky(orders_scene(name), kQuick, rays))
      for (int c = 0; c < 3; ++c) {
        CHECK(std::isfinite(light.radiance[c]));
        CHECK(light.radiance[c] >= 0.0);
        CHECK((light.transmittance[c] >= 0.0 && light.transmittance[c] <= 1.0));
      }
}

TEST_CASE("10 hard: only what changed runs again") {
  Scene scene = orders_scene("noon");
  Settings settings(app::knobs_of(sky_effects(), 10));
  const std::string no_fault;
  const app::Context context{device(), scene, settings, no_fault};
  app::Composition sky(context, sky_effects());
  const app::Chapter chapter;
  app::Renderer renderer(context, chapter, sky, {32, 18});
  app::CameraPose pose = app::pose_of(scene.view(""), scene.planet.ground_radius_km);
  const auto runs = [&](const char* pass) {
    const std::string text = sky.explain();
    const size_t at = text.find(fmt::format("  {:<20} ran in", pass));
    REQUIRE(at != std::string::npos);
    return std::stoi(text.substr(text.find("ran in ", at) + 7));
  };
  const auto frame = [&](uint32_t index) { renderer.draw(pose, 0.0, 1, index); };
  frame(0), frame(1);
  CHECK((runs("air") == 1 && runs("transmittance") == 1 && runs("multiple scattering") == 1 && runs("sky view") == 1 &&
         runs("sky") == 2));
  pose.azimuth_deg += 30.0;  // looking elsewhere
  frame(2);
  scene.sun.azimuth_deg += 50.0;  // the table turns with the sun
  frame(3);
  CHECK((runs("sky view") == 1 && runs("sky") == 4));
  scene.sun.zenith_deg += 1.0;
  frame(4);
  CHECK((runs("air") == 1 && runs("multiple scattering") == 1 && runs("sky view") == 2));
  pose = app::pose_of({.altitude_km = 3.0}, 6360.0);
  frame(5);
  CHECK(runs("sky view") == 3);
  pose = app::pose_of({.altitude_km = 400.0}, 6360.0);  // marched: the table is not filled, whatever changes
  frame(6);
  scene.planet.ground_albedo.r = 0.5;
  frame(7);
  CHECK((runs("air") == 2 && runs("multiple scattering") == 2 && runs("sky view") == 3 && runs("sky") == 8));
  pose = app::pose_of({.altitude_km = 3.0}, 6360.0);  // and is filled again when it is needed
  frame(8);
  CHECK(runs("sky view") == 4);
}
