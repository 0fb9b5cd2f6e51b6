// Noise has no closed form: its truth is the same field marched in double, in steps of a few metres. The shaders' own
// text is compiled as C++ with float meaning double and reads the texels of the device's textures, mixed in double.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/glm.hpp>

#include "common/app/camera.hpp"
#include "tests/gpu/17_clouds.hpp"

// The compiler does not see that loops over components set them all.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wunused-variable"

namespace cloud_twin {
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using namespace glm;

// A texture that repeats, filtered in double.
struct Volume {
  int side = 1, slices = 1;
  std::vector<std::array<double, 4>> texels;
  vec4 at(int i, int j, int k) const {
    const auto wrap = [](int x, int n) { return (x % n + n) % n; };
    const auto& texel = texels[(size_t(wrap(k, slices)) * side + wrap(j, side)) * side + wrap(i, side)];
    return {texel[0], texel[1], texel[2], texel[3]};
  }
  vec4 read(const vec3& uvw) const {
    const vec3 place = uvw * vec3(side, side, slices) - vec3(0.5, 0.5, slices > 1 ? 0.5 : 0.0);
    const vec3 low = floor(place), share = place - low;
    vec4 sum(0.0);
    for (int corner = 0; corner < (slices > 1 ? 8 : 4); ++corner) {
      const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
      const double weight = (x ? share.x : 1.0 - share.x) * (y ? share.y : 1.0 - share.y) *
                            (slices == 1 ? 1.0
                             : z         ? share.z
                                         : 1.0 - share.z);
      sum += at(int(low.x) + x, int(low.y) + y, slices == 1 ? 0 : int(low.z) + z) * weight;
    }
    return sum;
  }
};
Volume base_volume, detail_volume, curl_map, weather_map;

const int CLOUD_KINDS = 31;
vec4 weather_texel(vec2 uv) { return weather_map.read(vec3(uv, 0.0)); }
vec4 base_noise(vec3 uvw) { return base_volume.read(uvw); }
vec4 detail_noise(vec3 uvw) { return detail_volume.read(uvw); }
vec4 curl_noise(vec2 uv) { return curl_map.read(vec3(uv, 0.0)); }
double grid_texel(int, int, int) { return 0.0; }
double grid_filtered(vec3) { return 0.0; }
#undef WELKIN_INTEROP_CLOUD_H
#define precise
#define float double
#define WELKIN_SHADER_TWIN
#include "17_cloud_shapes/optical_depth.glsl"
#undef WELKIN_SHADER_TWIN
#undef float
#undef precise

// The numbers the device is given, so that their rounding is no part of a difference.
CloudBody body_of(const welkin::interop::CloudBody& b) {
  CloudBody body{};
  body.kind = b.kind, body.extinction_per_km = b.extinction_per_km;
  body.base_km = b.base_km, body.top_km = b.top_km, body.place_km = vec3(b.place_km), body.coverage = b.coverage;
  body.type = b.type, body.cell_km = b.cell_km, body.extent_km = b.extent_km, body.turn_x = b.turn_x;
  body.turn_y = b.turn_y, body.shift_x = b.shift_x, body.shift_y = b.shift_y, body.painted = b.painted;
  return body;
}
}  // namespace cloud_twin

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kR = 6360.0;

Scene scene_with(const std::string& preset) {
  Scene scene = scene_of({});
  scene.weather = Weather{.preset = preset};
  return scene;
}

void read_textures(const CloudRun& run) {
  const auto read = [&](cloud_twin::Volume& volume, CloudRun::Read which, int side, int slices) {
    volume = {side, slices, run.texels(which, size_t(side) * side * slices)};
  };
  read(cloud_twin::base_volume, CloudRun::Read::base, 128, 128);
  read(cloud_twin::detail_volume, CloudRun::Read::detail, 32, 32);
  read(cloud_twin::curl_map, CloudRun::Read::curl, 128, 1);
  read(cloud_twin::weather_map, CloudRun::Read::weather, 512, 1);
}

cloud_twin::CloudRay twin_ray(const app::ProbeRay& ray) {
  const glm::dvec3 position = ray.position_km, centre = position + glm::dvec3(0.0, 0.0, kR);
  const double r = glm::length(centre), mu = glm::dot(centre, ray.direction) / r;
  const double sine = glm::length(glm::cross(centre, ray.direction)) / r;
  const double altitude = app::altitude_km({.position_km = position}, kR);
  cloud_twin::CloudRay from{position,
                            glm::dvec3(0.0),
                            ray.direction,
                            altitude,
                            mu,
                            sine,
                            0.0,
                            cloud_twin::ground_end(kR, altitude, mu, sine)};
  return from;
}

// Optical depth of the bodies of a scene along a ray, marched in double.
double truth_of(const interop::CloudBlock& block, const app::ProbeRay& ray, int steps, int detail) {
  const cloud_twin::CloudRay from = cloud_twin::below_ceiling(kR, block.ceiling_km, twin_ray(ray));
  double sum = 0.0;
  for (int i = 0; i < block.count && from.end_km > 0.0; ++i)
    sum += cloud_twin::body_optical_depth(cloud_twin::body_of(block.bodies[i]), kR, from, {steps, detail, 0, 1, 0.5});
  return sum;
}

std::vector<app::ProbeRay> rays_through(size_t count) {
  Random random(3);
  std::vector<app::ProbeRay> rays;
  for (size_t i = 0; i < count; ++i) {
    const double h = i % 4 == 0 ? 0.002 : i % 4 == 1 ? 1.9 : i % 4 == 2 ? 12.0 : 400.0;
    const double zenith = i % 4 == 0   ? random.uniform(0.0, 88.0)
                          : i % 4 == 1 ? random.uniform(0.0, 180.0)
                          : i % 4 == 2 ? random.uniform(95.0, 175.0)
                                       : random.uniform(120.0, 178.0);
    app::ProbeRay ray = ray_up(h, zenith, random.uniform(0.0, 360.0));
    ray.position_km.x = random.uniform(-20.0, 20.0);  // the tangent plane leaves the ground by 63 m at most
    ray.position_km.y = random.uniform(-20.0, 20.0);
    rays.push_back(ray);
  }
  return rays;
}

struct Score {
  double median = 0.0, p95 = 0.0, worst = 0.0;
};
Score score_of(const std::vector<double>& got, const std::vector<double>& truth) {
  std::vector<double> errors;
  for (size_t i = 0; i < got.size(); ++i)
    if (truth[i] > 1e-3) errors.push_back(std::abs(std::exp(-got[i]) - std::exp(-truth[i])));
  REQUIRE(errors.size() > 20);
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors[errors.size() * 95 / 100], errors.back()};
}

}  // namespace

TEST_CASE("truth: a march through noise converges to the same field marched in double") {
  for (const char* preset : {"fair", "storm"}) {
    const Scene scene = scene_with(preset);
    const std::vector<app::ProbeRay> rays = rays_through(120);
    const CloudRun fine(scene, {{"noise.format", "half"}, {"cloud.steps", "256"}});
    read_textures(fine);
    const interop::CloudBlock block = make_cloud_block(bodies_of(scene), scene.planet);
    std::vector<double> truth;
    for (const app::ProbeRay& ray : rays) truth.push_back(truth_of(block, ray, 256, 2));
    const Score converged = score_of(fine.optical_depths(rays), truth);
    std::vector<Score> ladder;
    for (const char* steps : {"8", "32", "128"}) {
      const CloudRun coarse(scene, {{"noise.format", "half"}, {"cloud.steps", steps}});
      ladder.push_back(score_of(coarse.optical_depths(rays), truth));
    }
    CAPTURE(preset, converged.median, converged.p95, converged.worst, ladder[0].median, ladder[1].median,
            ladder[2].median, ladder[1].p95);
    CHECK(converged.median < 1e-3);  // the same steps: what float32 and the sampler lose
    CHECK(converged.p95 < 5e-3);
    CHECK(ladder[2].median < ladder[0].median);
    CHECK(ladder[1].median < 0.05);
  }
}
