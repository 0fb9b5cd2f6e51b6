// The sun's disc in pictures: the light of all its pixels, against quadrature over the disc in double. It must not
// depend on the picture's size, nor on where between the pixels' middles the disc stands.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "common/app/camera.hpp"
#include "tests/gpu/harness.hpp"
#include "tests/reference/quadrature.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSunRadius = 0.004675;
constexpr glm::uvec2 kSizes[] = {{80, 45}, {160, 90}, {320, 180}, {640, 360}, {1280, 720}};
const glm::dvec3 kAlpha{0.397, 0.503, 0.652};

// A camera and a sun: degrees, km, radians.
struct Shot {
  double azimuth, elevation, fov, sun_zenith, sun_azimuth;
  double altitude_km = 0.0005, radius = kSunRadius;
  CameraRays camera(glm::uvec2 size) const {
    Scene scene;
    scene.planet.ground_radius_km = 6360.0;
    scene.sun.zenith_deg = sun_zenith;
    scene.sun.azimuth_deg = sun_azimuth;
    View view;
    view.altitude_km = altitude_km, view.azimuth_deg = azimuth, view.elevation_deg = elevation, view.fov_deg = fov;
    return app::camera_rays(app::pose_of(view, scene.planet.ground_radius_km), scene, 0.0, size, 1, 0);
  }
};

struct Totals {
  glm::dvec3 drawn{0.0};   // sum of the pixels' radiance times their area in a plane at distance 1
  glm::dvec3 middle{0.0};  // the same of the disc at the pixels' middles
};

// Which pixels may see the disc: those around the directions of its rim.
glm::dvec4 bounds(const CameraRays& camera, double radius) {
  const glm::dvec3 sun = glm::normalize(glm::dvec3(camera.sun));
  const glm::dvec3 side =
      glm::normalize(glm::cross(sun, std::abs(sun.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
  glm::dvec4 box{1e9, 1e9, -1e9, -1e9};
  for (int i = 0; i < 32; ++i) {
    const double turn = 2.0 * kPi * i / 32;
    const glm::dvec3 rim =
        sun + std::tan(1.05 * radius) * (side * std::cos(turn) + glm::cross(sun, side) * std::sin(turn));
    const glm::dvec3 right(camera.right), up(camera.up);
    const double z = glm::dot(rim, glm::dvec3(camera.forward));
    const double x = (glm::dot(rim, right) / glm::dot(right, right) / z + 1.0) / 2.0 * camera.size.x;
    const double y = (1.0 - glm::dot(rim, up) / glm::dot(up, up) / z) / 2.0 * camera.size.y;
    box = {std::min(box.x, x), std::min(box.y, y), std::max(box.z, x), std::max(box.w, y)};
  }
  return glm::floor(box) + glm::dvec4(-2.0, -2.0, 2.0, 2.0);
}

Totals draw(const Shot& shot, glm::uvec2 size, bool air) {
  const CameraRays camera = shot.camera(size);
  const glm::dvec4 box = bounds(camera, shot.radius);
  std::vector<float> items;
  for (double y = std::max(box.y, 0.0); y <= std::min(box.w, size.y - 1.0); ++y)
    for (double x = std::max(box.x, 0.0); x <= std::min(box.z, size.x - 1.0); ++x) {
      for (const glm::vec3& v : {camera.right, camera.up, camera.forward, camera.sun})
        items.insert(items.end(), {v.x, v.y, v.z});
      items.insert(items.end(), {camera.altitude_km, float(size.x), float(size.y), float(x), float(y),
                                 float(shot.radius), 0.0f, 0.0f});
    }
  const uint32_t has = air ? 1 : 0;
  const std::vector<float> out = evaluate("tests/05_sun_disc.comp", items, 20, 6, {has, has, has, 0});
  const double area =
      4.0 * glm::length(glm::dvec3(camera.right)) * glm::length(glm::dvec3(camera.up)) / size.x / size.y;
  Totals totals;
  for (size_t i = 0; i < out.size(); i += 6)
    for (int k = 0; k < 3; ++k) {
      totals.drawn[k] += out[i + k] * area;
      totals.middle[k] += out[i + 3 + k] * area;
    }
  return totals;
}

// Integral of L through(direction) |P|^3 over the disc's solid angle: |P|^3 is what a solid angle is in the plane.
glm::dvec3 truth(const Shot& shot, const std::function<glm::dvec3(double)>& through, int side = 300) {
  const CameraRays camera = shot.camera({16, 9});
  const glm::dvec3 sun = glm::normalize(glm::dvec3(camera.sun));
  const glm::dvec3 across =
      glm::normalize(glm::cross(sun, std::abs(sun.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
  const double sine = std::sin(shot.radius);
  glm::dvec3 sum(0.0);
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const double m = (i + 0.5) / side, turn = 2.0 * kPi * (j + 0.5) / side;
      const double s = sine * std::sqrt((1.0 - m) * (1.0 + m)), c = std::sqrt((1.0 - s) * (1.0 + s));
      const glm::dvec3 view = sun * c + (across * std::cos(turn) + glm::cross(sun, across) * std::sin(turn)) * s;
      const glm::dvec3 limb = (kAlpha + 2.0) / (2.0 * kPi) *
                              glm::dvec3(std::pow(m, kAlpha.x), std::pow(m, kAlpha.y), std::pow(m, kAlpha.z));
      sum += limb * through(view.z) *
             (m / c * 2.0 * kPi / side / side / std::pow(glm::dot(view, glm::dvec3(camera.forward)), 3.0));
    }
  return sum;
}

double worst(const glm::dvec3& got, const glm::dvec3& expected) {
  double error = 0.0;
  for (int k = 0; k < 3; ++k) error = std::max(error, std::abs(got[k] / expected[k] - 1.0));
  return error;
}

}  // namespace

TEST_CASE("sun pixels: pictures of every size hold the disc's light") {
  // Per size: every azimuth, elevation and field of view. The closed form beside the quadrature: E / cos^3 of the angle
  // from the picture's middle, but for terms of the order of the radius squared.
  for (const glm::uvec2 size : kSizes) {
    double drawn = 0.0, middle = 0.0;
    int gone = 0, shots = 0;
    for (const double fov : {10.0, 60.0, 100.0})
      for (const double elevation : {-30.0, 0.0, 15.0, 55.0})
        for (int turn = 0; turn < 8; ++turn) {
          const double azimuth = 45.0 * turn + 3.7;
          const Shot shot{azimuth, elevation, fov, 90.0 - elevation - 0.21 * fov, azimuth + 0.3 * fov};
          if (shot.sun_zenith > 85.0) continue;
          const Totals totals = draw(shot, size, false);
          const glm::dvec3 expected = truth(
              shot, [](double) { return glm::dvec3(1.0); }, 100);
          const CameraRays camera = shot.camera(size);
          CHECK(
              expected.g ==
              Approx(1.0 / std::pow(glm::dot(glm::dvec3(camera.sun), glm::dvec3(camera.forward)), 3.0)).epsilon(1e-3));
          drawn = std::max(drawn, worst(totals.drawn, expected));
          middle = std::max(middle, worst(totals.middle, expected));
          gone += totals.middle.g == 0.0;
          ++shots;
        }
    CAPTURE(size.x, drawn, middle, gone, shots);
    CHECK(drawn < 5e-3);
    CHECK(middle > 10.0 * drawn);
    if (size.x <= 160) CHECK(gone > shots / 4);
  }
}

TEST_CASE("sun pixels: from a far star's disc to the largest") {
  for (const double radius : {1e-4, 0.05, 0.2})
    for (const double fov : {1.0, 40.0, 120.0})
      for (const glm::uvec2 size : {kSizes[0], kSizes[3]}) {
        if (radius > 0.01 * fov) continue;  // it would not fit into the picture
        const Shot shot{10.0, 35.0, fov, 55.0 - 0.1 * fov, 10.0 + 0.2 * fov, 0.0005, radius};
        const double error = worst(draw(shot, size, false).drawn, truth(shot, [](double) { return glm::dvec3(1.0); }));
        CAPTURE(radius, fov, size.x, error);
        CHECK(error < 5e-3);
      }
}

TEST_CASE("sun pixels: the horizon cuts the disc, on the ground and in space") {
  for (const double altitude_km : {0.0005, 10.0, 400.0, 36000.0}) {
    const double r = 6360.0 + altitude_km, horizon = -std::sqrt(altitude_km * (2.0 * 6360.0 + altitude_km)) / r;
    const double dip = std::asin(-horizon) * 180.0 / kPi;
    for (const double above_deg : {0.2, 0.05, 0.0, -0.1, -0.2})
      for (const glm::uvec2 size : kSizes) {
        const Shot shot{20.0, -dip - 6.0, 60.0, 90.0 + dip - above_deg, 41.0, altitude_km};
        const glm::dvec3 expected = truth(
            shot, [&](double mu) { return glm::dvec3(mu > horizon ? 1.0 : 0.0); }, 800);
        const glm::dvec3 whole = truth(
            shot, [&](double) { return glm::dvec3(1.0); }, 100);
        const glm::dvec3 error = glm::abs(draw(shot, size, false).drawn - expected) / whole;
        CAPTURE(altitude_km, above_deg, size.x, error.r, error.g, error.b, expected.g / whole.g);
        CHECK(std::max({error.r, error.g, error.b}) < 6e-3);
      }
  }
}

TEST_CASE("sun pixels: behind the air") {
  // The air above the horizon lets through e times as much light at the disc's upper rim as at the lower.
  const reference::Planet planet = reference::earth();
  for (const double zenith : {60.0, 85.0, 89.0, 89.6, 90.1})
    for (const glm::uvec2 size : kSizes) {
      const Shot shot{20.0, 5.0, 60.0, zenith, 41.0};
      std::vector<glm::dvec3> depths;
      const double low = std::max(std::cos(zenith * kPi / 180.0 + 0.005), -3.9652e-4),
                   high = std::cos(zenith * kPi / 180.0 - 0.005);
      constexpr int kSteps = 200;
      for (int i = 0; i <= kSteps; ++i) {
        const auto t = reference::transmittance_to_top(planet, 0.0005, low + (high - low) * i / kSteps);
        depths.push_back({std::log(t[0]), std::log(t[1]), std::log(t[2])});
      }
      const glm::dvec3 expected = truth(shot, [&](double mu) {
        const double place = (mu - low) / (high - low) * kSteps;
        if (place < 0.0) return glm::dvec3(0.0);
        const int i = std::min(int(place), kSteps - 1);
        return glm::exp(glm::mix(depths[i], depths[i + 1], place - i));
      });
      const glm::dvec3 drawn = draw(shot, size, true).drawn;
      const glm::dvec3 error = glm::abs(drawn - expected) / std::max({expected.r, expected.g, expected.b});
      CAPTURE(zenith, size.x, error.r, error.g, error.b);
      CHECK(std::max({error.r, error.g, error.b}) < 6e-3);
    }
}
