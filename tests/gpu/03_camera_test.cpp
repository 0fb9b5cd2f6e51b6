// The fly camera of common/app: no roll, exact altitudes from the grass to the Moon, views that come back, the sun's
// day; and the shader's directions over whole pictures.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "common/app/camera.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kRadius = 6360.0;

// A pose at an altitude, `angle` radians around the planet from the scene's place.
app::CameraPose pose_around(double altitude_km, double angle, double towards) {
  const double r = kRadius + altitude_km, half = std::sin(0.5 * angle);
  // z = r cos(angle) - R, written so that a small angle keeps the altitude's digits.
  return {.position_km = {r * std::sin(angle) * std::cos(towards), r * std::sin(angle) * std::sin(towards),
                          altitude_km - 2.0 * r * half * half}};
}

}  // namespace

TEST_CASE("camera: a view comes back from its pose") {
  Random random(320);
  for (int i = 0; i < 10000; ++i) {
    const View view{.name = "v",
                    .east_km = i % 5 == 0 ? 0.0 : random.uniform(-9000.0, 9000.0),
                    .north_km = i % 7 == 0 ? 0.0 : random.uniform(-9000.0, 9000.0),
                    .altitude_km = random.log_uniform(5e-4, 1e6),
                    .azimuth_deg = random.uniform(0.0, 359.9),
                    .elevation_deg = i % 3 == 0 ? (i % 2 == 0 ? 90.0 : -90.0) : random.uniform(-90.0, 90.0),
                    .fov_deg = random.uniform(1.0, 170.0)};
    const View back = app::view_of(app::pose_of(view, kRadius), kRadius);
    REQUIRE(back.altitude_km == Approx(view.altitude_km).epsilon(1e-12).margin(1e-11));
    REQUIRE(std::abs(back.east_km - view.east_km) < 1e-8);  // a hundredth of a millimetre, from anywhere
    REQUIRE(std::abs(back.north_km - view.north_km) < 1e-8);
    REQUIRE(back.azimuth_deg == view.azimuth_deg);
    REQUIRE(back.elevation_deg == view.elevation_deg);
    REQUIRE(back.fov_deg == view.fov_deg);
  }
  // Along the ground: a quarter of the way round to the east the camera's up is the place's east.
  const double quarter_km = 0.5 * 3.14159265358979323846 * kRadius;
  const app::CameraPose east = app::pose_of({.east_km = quarter_km, .altitude_km = 2.0}, kRadius);
  CHECK(glm::length(east.position_km - glm::dvec3(kRadius + 2.0, 0.0, -kRadius)) < 1e-9);
}

TEST_CASE("camera: altitude to a millimetre, at 0.5 m and at the Moon, anywhere around the planet") {
  Random random(321);
  for (const double altitude_km : {0.0005, 2.0, 400.0, 36000.0, 378000.0}) {
    double worst_mm = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const app::CameraPose pose = pose_around(altitude_km, random.uniform(0.0, 3.14159), random.uniform(0.0, 6.28318));
      worst_mm = std::max(worst_mm, 1e6 * std::abs(app::altitude_km(pose, kRadius) - altitude_km));
    }
    INFO(altitude_km);
    CHECK(worst_mm < 1e-2);  // doubles at 6360 km know 1e-6 mm; a few squares later
  }
  const CameraRays rays = app::camera_rays(pose_around(0.0005, 1.0, 2.0), Scene{}, 0.0, {960, 540}, 1, 0);
  CHECK(rays.altitude_km == Approx(0.0005).epsilon(1e-5));
  CHECK(rays.altitude_m == Approx(0.5).epsilon(1e-5));
}

TEST_CASE("camera: no roll, whatever one does") {
  Random random(322);
  app::CameraPose pose = app::pose_of({.altitude_km = 0.0005}, 6360.0);
  const Scene scene;
  for (int i = 0; i < 20000; ++i) {
    app::turn(pose, random.uniform(-400.0, 400.0), random.uniform(-80.0, 80.0));  // often straight up or down
    app::fly(pose, {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)}, 0.1, i % 2 == 0,
             kRadius);
    REQUIRE(pose.elevation_deg >= -90.0);
    REQUIRE(pose.elevation_deg <= 90.0);
    REQUIRE(pose.azimuth_deg >= 0.0);
    REQUIRE(pose.azimuth_deg < 360.0);
    const CameraRays rays = app::camera_rays(pose, scene, 0.0, {960, 540}, 1, 0);
    REQUIRE(std::abs(rays.right.z) < 1e-7f);  // the right axis stays level: that is what no roll means
    REQUIRE(rays.up.z >= 0.0f);               // and the picture is never upside down
    REQUIRE(std::abs(glm::dot(glm::vec3(rays.right), glm::vec3(rays.up))) < 1e-6f);
    REQUIRE(std::abs(glm::dot(glm::vec3(rays.right), glm::vec3(rays.forward))) < 1e-6f);
    REQUIRE(std::abs(glm::length(glm::vec3(rays.sun)) - 1.0f) < 1e-6f);
  }
}

TEST_CASE("camera: straight down is straight down, and the picture's sides are where the azimuth says") {
  const app::CameraPose down = app::pose_of({.azimuth_deg = 30.0, .elevation_deg = -90.0}, kRadius),
                        up = app::pose_of({.azimuth_deg = 30.0, .elevation_deg = 90.0}, kRadius);
  const Scene scene;
  const CameraRays below = app::camera_rays(down, scene, 0.0, {100, 100}, 1, 0),
                   above = app::camera_rays(up, scene, 0.0, {100, 100}, 1, 0);
  CHECK(glm::vec3(below.forward).z == -1.0f);
  CHECK(glm::vec3(above.forward).z == 1.0f);
  CHECK(std::hypot(below.forward.x, below.forward.y) < 1e-15f);
  for (const CameraRays& rays : {below, above}) {
    CHECK(std::abs(rays.right.z) < 1e-7f);
    CHECK(glm::length(glm::vec3(rays.right) / std::tan(glm::radians(30.0f)) -
                      glm::vec3(std::cos(glm::radians(30.0)), -std::sin(glm::radians(30.0)), 0.0)) < 1e-6f);
  }
  // Looking down, the top of the picture is where the azimuth points; up again from there it is the same look.
  CHECK(below.up.y > 0.0f);
  app::CameraPose turned = down;
  app::turn(turned, 0.0, -20.0);
  CHECK(turned.elevation_deg == -90.0);
  app::turn(turned, 0.0, 60.0);
  CHECK(turned.elevation_deg == -30.0);
  CHECK(turned.azimuth_deg == 30.0);
}

TEST_CASE("camera: flying over the frame's pole goes on, with the look where it was") {
  const double quarter_km = 0.5 * 3.14159265358979323846 * kRadius;
  app::CameraPose pose = app::pose_of(
      {.east_km = 1.0, .north_km = quarter_km - 40.0, .altitude_km = 10.0, .azimuth_deg = 0.0, .elevation_deg = 0.0},
      kRadius);
  const auto look = [&] {
    const app::LocalFrame frame = app::local_frame(pose, kRadius);
    const glm::dvec3 local = app::direction_from(90.0 - pose.elevation_deg, pose.azimuth_deg);
    return frame.east * local.x + frame.north * local.y + frame.up * local.z;
  };
  glm::dvec3 before = look(), start = pose.position_km;
  for (int i = 0; i < 1000; ++i) {
    app::fly(pose, {0.0, 1.0, 0.0}, 0.02, false, kRadius);
    REQUIRE(glm::dot(look(), before) > std::cos(0.001));  // a step of 0.1 km turns the look with the horizon alone
    before = look();
  }
  CHECK(glm::length(pose.position_km - start) > 90.0);  // it crossed, and did not turn back
  CHECK(pose.azimuth_deg == Approx(180.0).margin(5.0));
}

TEST_CASE("camera: flying ends at the height up to which a view is accepted") {
  app::CameraPose pose = app::pose_of({.altitude_km = 9e5}, kRadius);
  for (int i = 0; i < 100; ++i) app::fly(pose, {1.0, 0.0, 1.0}, 1.0, true, kRadius);
  CHECK(app::altitude_km(pose, kRadius) == Approx(kHighest_km).epsilon(1e-12));
  CHECK(app::view_of(pose, kRadius).altitude_km <= kHighest_km);
}

TEST_CASE("camera: flying never goes below half a metre") {
  Random random(323);
  app::CameraPose pose = app::pose_of({.altitude_km = 0.01}, 6360.0);
  double lowest_km = 1e9;
  for (int i = 0; i < 50000; ++i) {
    app::turn(pose, random.uniform(-30.0, 30.0), random.uniform(-30.0, 30.0));
    app::fly(pose, {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.5, 0.5)}, 0.05, i % 3 == 0,
             kRadius);
    lowest_km = std::min(lowest_km, app::altitude_km(pose, kRadius));
  }
  CHECK(lowest_km > 0.0005 - 1e-9);
  CHECK(lowest_km < 0.00051);  // it was tried
}

TEST_CASE("camera: the sun's day closes, and has noon and sunset in it") {
  for (const double latitude : {-66.0, 0.0, 43.6, 90.0}) {
    const SunAngles back = app::advance_sun(50.0, 120.0, latitude, 86400.0);
    CHECK(back.zenith_deg == Approx(50.0).margin(1e-9));
    CHECK(back.azimuth_deg == Approx(120.0).margin(1e-9));
  }
  // Equinox at the equator: from overhead to the western horizon in six hours.
  const SunAngles set = app::advance_sun(0.0, 0.0, 0.0, 6.0 * 3600.0);
  CHECK(set.zenith_deg == Approx(90.0).margin(1e-9));
  CHECK(set.azimuth_deg == Approx(270.0).margin(1e-9));
  // At the pole the sun circles at one height, clockwise: 15 degrees an hour.
  const SunAngles circled = app::advance_sun(70.0, 10.0, 90.0, 3600.0);
  CHECK(circled.zenith_deg == Approx(70.0).margin(1e-9));
  CHECK(circled.azimuth_deg == Approx(25.0).margin(1e-9));
}

TEST_CASE("camera: a million pixels' directions, of every field of view") {
  Random random(324);
  std::vector<float> inputs;
  std::vector<glm::dvec3> exact;
  for (int i = 0; i < 1 << 20; ++i) {
    const int width = 1 + int(random.next() % 4000), height = 1 + int(random.next() % 4000);
    const int px = int(random.next() % uint32_t(width)), py = int(random.next() % uint32_t(height));
    const app::CameraPose pose{.azimuth_deg = random.uniform(0.0, 360.0),
                               .elevation_deg = random.uniform(-89.9, 89.9),
                               .fov_deg = random.log_uniform(0.1, 170.0)};
    const double scale = std::tan(glm::radians(pose.fov_deg) / 2.0), aspect = double(width) / height;
    const glm::dvec3 forward = app::direction_from(90.0 - pose.elevation_deg, pose.azimuth_deg),
                     right = app::direction_from(90.0, pose.azimuth_deg + 90.0);
    const glm::dvec3 up = glm::cross(right, forward), wide = right * (scale * aspect), high = up * scale;
    for (const glm::dvec3& v : {wide, high, forward})
      for (int k = 0; k < 3; ++k) inputs.push_back(float(v[k]));
    for (const int v : {width, height, px, py}) inputs.push_back(float(v));
    exact.push_back(glm::normalize(forward + wide * ((2 * px + 1 - width) / double(width)) -
                                   high * ((2 * py + 1 - height) / double(height))));
  }
  const std::vector<float> out = evaluate("tests/03_camera.comp", inputs, 13, 3);
  double worst = 0.0;
  size_t not_finite = 0;
  for (size_t i = 0; i < exact.size(); ++i) {
    const glm::dvec3 got(out[3 * i], out[3 * i + 1], out[3 * i + 2]);
    for (int k = 0; k < 3; ++k) not_finite += !std::isfinite(out[3 * i + size_t(k)]);
    worst = std::max(worst, glm::length(got - exact[i]));
  }
  CHECK(not_finite == 0);
  CHECK(worst < 4e-7);  // inputs rounded to 6e-8, three products, two sums, a root and a division
}
