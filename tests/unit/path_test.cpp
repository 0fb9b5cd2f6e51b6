// Camera paths: through their views, smoothly, never beyond them, angles the shorter way, and the sun's moments.
#include "common/scene/path.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using welkin::Path;
using welkin::PathPoint;
using welkin::Scene;
using welkin::View;

namespace {

const std::vector<View> kViews = {{"a", 0.0, 0.0, 0.0, 350.0, -5.0, 60.0},
                                  {"b", 3.0, -1.0, 0.002, 10.0, 90.0, 20.0},
                                  {"c", 3.0, 4.0, 400.0, 181.0, 90.0, 170.0},
                                  {"d", -2000.0, 4.0, 1e6, 0.0, -90.0, 1.0}};

Scene scene_with(std::vector<std::string> views, std::vector<double> time_s, std::vector<double> moment_s = {}) {
  Scene scene;
  scene.time_s = 17.0;
  scene.views = kViews;
  scene.paths = {{"p", std::move(views), std::move(time_s), std::move(moment_s)}};
  return scene;
}

PathPoint at(const Scene& scene, double time_s) { return welkin::point_on(scene, scene.paths[0], time_s); }

}  // namespace

TEST_CASE("a path passes its views exactly, and stays at both ends", "[path]") {
  const Scene scene = scene_with({"a", "b", "c", "d", "a"}, {-1.0, 0.1, 4.0, 5.0, 90.0});
  for (size_t i = 0; i < 5; ++i) {
    View view = scene.view(scene.paths[0].views[i]);
    view.name = "p";
    CHECK(at(scene, scene.paths[0].time_s[i]).view == view);
  }
  CHECK(at(scene, -100.0).view == at(scene, -1.0).view);
  CHECK(at(scene, 1e9).view == at(scene, 90.0).view);
  CHECK(at(scene, 3.0).moment_s == 17.0);
}

TEST_CASE("a path is smooth, and between two views is between them", "[path]") {
  const Scene scene = scene_with({"a", "b", "c", "d", "b"}, {0.0, 1.0, 3.0, 4.0, 9.0}, {0.0, 0.0, 100.0, 50.0, 60.0});
  const Path& path = scene.paths[0];
  constexpr double kStep = 1e-4;
  const auto log_height = [](const View& view) { return std::log(view.altitude_km + 0.001); };
  double before = 0.0;
  for (int i = 0; i * kStep < 9.0 - 2.0 * kStep; ++i) {
    const double t = i * kStep;
    size_t k = 0;
    while (k + 2 < path.time_s.size() && t >= path.time_s[k + 1]) ++k;
    const View &a = scene.view(path.views[k]), &b = scene.view(path.views[k + 1]), view = at(scene, t).view;
    for (double View::*field :
         {&View::east_km, &View::north_km, &View::altitude_km, &View::elevation_deg, &View::fov_deg}) {
      REQUIRE(view.*field >= std::min(a.*field, b.*field) - 1e-9);
      REQUIRE(view.*field <= std::max(a.*field, b.*field) * (1.0 + 1e-12) + 1e-9);
    }
    // The rate of climb does not jump: by less in a step than its own curvature can account for.
    const double rate = (log_height(at(scene, t + kStep).view) - log_height(view)) / kStep;
    REQUIRE(std::abs(rate - before) < 0.05);
    before = rate;
  }
}

TEST_CASE("azimuths turn the shorter way, over north", "[path]") {
  const Scene scene = scene_with({"a", "b"}, {0.0, 2.0});
  double total = 0.0, last = 350.0;
  for (int i = 0; i <= 1000; ++i) {
    const double azimuth = at(scene, 0.002 * i).view.azimuth_deg;
    REQUIRE(azimuth >= 0.0);
    REQUIRE(azimuth < 360.0);
    const double step = std::remainder(azimuth - last, 360.0);
    REQUIRE(step >= 0.0);
    REQUIRE(step < 0.1);
    total += step, last = azimuth;
  }
  CHECK(total == Approx(20.0));
  CHECK(at(scene, 1.0).view.azimuth_deg == Approx(0.0).margin(1e-9));
}

TEST_CASE("a path may move the sun with the camera still", "[path]") {
  const Scene scene = scene_with({"b", "b"}, {0.0, 10.0}, {0.0, 3600.0});
  View still = scene.view("b");
  still.name = "p";
  for (double time_s = 0.0; time_s < 10.0; time_s += 0.0137) REQUIRE(at(scene, time_s).view == still);
  CHECK(at(scene, 5.0).moment_s == Approx(1800.0));
  CHECK(at(scene, 10.0).moment_s == 3600.0);
}
