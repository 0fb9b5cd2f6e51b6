// Where rays meet the terrain and how far its shadows reach: the walks over a height map against closed forms, at any
// side of the map, and the passes that run them against slow marches in double over the same map.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "chapters/11_aerial_perspective/relief.hpp"
#include "tests/gpu/11_parts.hpp"
#include "tests/unit/temporary.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kRadius_km = 6360.0;

glm::dvec3 point_at(double x, double y, double altitude_km) {
  const double upright = std::sqrt(kRadius_km * kRadius_km - x * x - y * y), scale = 1.0 + altitude_km / kRadius_km;
  return {x * scale, y * scale, upright * scale - kRadius_km};
}

double altitude_of(const glm::dvec3& p) { return glm::length(p + glm::dvec3(0, 0, kRadius_km)) - kRadius_km; }

// A ray for AirPart::hit; side and number of the map as the harness has them.
AirItem ray_between(const glm::dvec3& from, const glm::dvec3& to, double side, double map) {
  const glm::dvec3 direction = glm::normalize(to - from), up = glm::normalize(from + glm::dvec3(0, 0, kRadius_km));
  return {AirPart::hit,
          {from.x, from.y, from.z, altitude_of(from)},
          {direction.x, direction.y, direction.z, glm::dot(direction, up)},
          {side, map, 0, 0}};
}

// A scene's relief on the device, its passes run once; images read back.
class Run {
 public:
  Run(const Scene& scene, VkExtent2D size, const View& view, const char* shadow_size = "64")
      : scene_(scene), settings_(app::knobs_of(terrain_effects(), 11)), context_{device(), scene_, settings_, inject_} {
    settings_.set("terrain.shadow_size", shadow_size);
    settings_.set("terrain.detail", "off");
    TerrainMaps maps;
    graph::Resource shadow_map = 0;
    app::Effect kept{.name = "kept", .chapter = 11};
    kept.declare = [&](app::Builder& builder, app::Board& board) {
      maps = *board.find<TerrainMaps>(), shadow_map = board.find<TerrainShadows>()->image;
      builder.graph.set_output(maps.distance);
      builder.graph.set_output(shadow_map);
    };
    app::Composition relief(context_, {terrain(), terrain_shadows(), kept});
    relief.graph().compile(size);
    const app::CameraPose pose = app::pose_of(view, kRadius_km);
    camera = app::camera_rays(pose, scene_, 0.0, {int(size.width), int(size.height)}, 0, 0);
    const gpu::CommandPool pool = gpu::create_command_pool(device());
    gpu::Timer timer(device());
    gpu::run_once(device(), pool, [&](VkCommandBuffer commands) {
      timer.begin_frame(commands);
      relief.draw({commands, relief.graph().image(maps.distance), camera, timer, 0, 0, 0.0, pose.position_km});
    });
    distances = read(relief.graph().image(maps.distance), 4, pool);
    shadows = read(relief.graph().image(shadow_map), 4, pool);
    map = *maps.map;
  }

  TerrainMap map;
  CameraRays camera;
  std::vector<float> distances, shadows;

 private:
  static std::vector<float> read(const gpu::Image& image, size_t channels, const gpu::CommandPool& pool) {
    const size_t count = size_t{image.size.width} * image.size.height * channels;
    const gpu::Buffer out = gpu::create_buffer(device(), "read back", count * sizeof(float),
                                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Where::readback);
    gpu::run_once(device(), pool, [&](VkCommandBuffer commands) {
      gpu::image_barrier(commands, image.handle, gpu::kComputeWrite, gpu::kTransferRead);
      const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = {image.size.width, image.size.height, 1}};
      vkCmdCopyImageToBuffer(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, out.handle, 1, &copy);
      gpu::buffer_barrier(commands, out.handle, gpu::kTransferWrite, gpu::kHostRead);
    });
    const std::span<float> values = out.as<float>();
    return {values.begin(), values.end()};
  }

  Scene scene_;
  Settings settings_;
  std::string inject_;
  app::Context context_;
};

// Crests of all sizes and nothing that repeats; 0 ... 65535.
double rough(uint32_t i, uint32_t j) {
  const double u = i * 0.13, v = j * 0.11;
  return 65535.0 * std::clamp(0.3 + 0.3 * std::sin(u + 2 * std::sin(0.4 * v)) + 0.2 * std::sin(2.3 * v - 0.7 * u) +
                                  0.2 * std::sin(0.31 * u) * std::cos(0.23 * v),
                              0.0, 1.0);
}

Scene scene_of(const std::string& file, double extent_km, double height_km) {
  Scene scene = scene_named("noon");
  scene.terrain = Terrain{.height_map = file, .extent_km = extent_km, .height_km = height_km};
  return scene;
}

}  // namespace

TEST_CASE("a ridge 50 km away throws the same shadow whatever the side of the map") {
  const double tangent = std::tan(2.0 * 3.14159265358979323846 / 180.0);
  for (const double side : {257.0, 1024.0, 1025.0, 4096.0}) {
    std::vector<AirItem> items;
    std::vector<double> places;
    for (double x = -48.0; x < 60.0; x += 1.7) {
      items.push_back({AirPart::shadow, {x, 0.3 * x, tangent, 0}, {-1, 0, 0, 0}, {side, 1, 0, 0}});
      places.push_back(x);
    }
    const double texel_km = 128.0 / side, edge_km = -49.0;
    // The last sample on the ridge, and one texel of leeway: what the map cannot tell.
    const double crest_km = ((std::floor((edge_km / 128.0 + 0.5) * side - 0.5) + 0.5) / side - 0.5) * 128.0;
    const std::vector<AirAnswer> answers = evaluate_air(reference::earth(), items);
    double worst = 0.0, visits = 0.0;
    for (size_t i = 0; i < items.size(); ++i) {
      // Far out the ridge's shadow has sunk below the ground, and level ground where the walk begins decides.
      const double s = places[i] - crest_km, ridge = 3.0 - s * tangent - s * s / (2 * kRadius_km),
                   truth = std::max(ridge, -0.1 * tangent);
      worst = std::max(worst, std::abs(answers[i].radiance[0] - truth));
      visits = std::max(visits, answers[i].radiance[2]);
      CHECK(std::abs(ridge - (3.0 - (places[i] - edge_km) * tangent - std::pow(places[i] - edge_km, 2) / 12720.0)) <
            texel_km * (tangent + 0.02));
    }
    CAPTURE(side, worst, visits);
    CHECK(worst < 1e-4);
    CHECK(visits < 128);
  }
}

TEST_CASE("one white sample is as high as a white pixel, for even sides and odd") {
  for (const double side : {64.0, 65.0, 1024.0, 1025.0}) {
    const double x = ((std::floor(3 * side / 4) + 0.5) / side - 0.5) * 64.0,
                 y = (0.5 - (std::floor(side / 2) + 0.5) / side) * 64.0;
    std::vector<AirItem> items;
    for (const double fraction : {0.5, 0.99, 0.999, 1.001, 1.01})
      for (const auto& [dx, dy] : {std::pair{-40.0, 0.3}, {-3.0, 11.0}, {0.2, -29.0}, {9.0, 9.0}})
        items.push_back(ray_between(point_at(x + dx, y + dy, 1.0), point_at(x, y, 2.0 * fraction), side, 0));
    const std::vector<AirAnswer> answers = evaluate_air(reference::earth(), items);
    for (size_t i = 0; i < items.size(); ++i) {
      CAPTURE(side, i, answers[i].radiance[0], answers[i].radiance[1]);
      CHECK((answers[i].radiance[0] > 0.0) == (i < 12));
    }
  }
}

TEST_CASE("hard: no terrain through the planet, none beyond the horizon") {
  std::vector<AirItem> items;
  // From the other side of the planet, from its side, and along the ground away from the map.
  items.push_back(ray_between(point_at(-48, 0, 2.9) - glm::dvec3(0, 0, 2 * kRadius_km + 6.0), {-50, 0, 0}, 1025, 1));
  items.push_back(ray_between({-6361.0, 0, -6360.0}, {-50, 0, 3.0}, 1025, 1));
  items.push_back(ray_between({-200, 0, -3.0}, {-400, 0, -3.0}, 1025, 1));
  // From 2 m above the ground 260 km from the ridge, which its 3 km put below the horizon; and 150 km away, where they
  // do not.
  const glm::dvec3 far = point_at(210, 0, 0.002), near = point_at(100, 0, 0.002);
  items.push_back(ray_between(far, point_at(-49, 0, 2.9), 1025, 1));
  items.push_back(ray_between(near, point_at(-49, 0, 2.9), 1025, 1));
  const std::vector<AirAnswer> answers = evaluate_air(reference::earth(), items);
  for (size_t i = 0; i < 4; ++i) {
    CAPTURE(i, answers[i].radiance[0], answers[i].radiance[1]);
    CHECK(answers[i].radiance[0] < 0.0);
  }
  CAPTURE(answers[4].radiance[1]);
  CHECK(answers[4].radiance[0] == Approx(149.0).epsilon(0.01));
}

TEST_CASE("shadows of a rough map against a march in double, even side and odd") {
  const TemporaryDirectory directory;
  for (const uint32_t side : {97u, 300u}) {
    write_height_map(directory / "rough.png", side, side, rough);
    Scene scene = scene_of((directory / "rough.png").string(), 40.0, 2.0);
    scene.sun.zenith_deg = 84.0, scene.sun.azimuth_deg = 250.0;
    const Run run(scene, {8, 8}, scene.views[0]);
    double worst = 0.0;
    for (int n = 0; n < 64 * 64; n += 37) {
      const double x = ((n % 64 + 0.5) / 64 - 0.5) * 40.0, y = (0.5 - (n / 64 + 0.5) / 64) * 40.0;
      const glm::dvec3 sun(run.camera.sun), up = glm::normalize(point_at(x, y, 0) + glm::dvec3(0, 0, kRadius_km));
      const double mu = glm::dot(sun, up), sine = std::sqrt(1 - mu * mu);
      const glm::dvec3 level = (sun - up * mu) / sine;
      double highest = -1e3;
      for (double s = 0.75 * 40.0 / 64; s < 60.0; s += 0.002) {
        const double at_x = x + level.x * s, at_y = y + level.y * s;
        if (std::max(std::abs(at_x), std::abs(at_y)) > 20.0) break;
        highest = std::max(highest, height_at(run.map, at_x, at_y) - s * mu / sine - s * s / (2 * kRadius_km));
      }
      worst = std::max(worst, std::abs(run.shadows[4 * size_t(n)] - highest));
      CHECK(run.shadows[4 * size_t(n) + 2] == Approx(height_at(run.map, x, y)).margin(1e-5));
    }
    CAPTURE(side, worst);
    CHECK(worst < 5e-4);  // the march's own step, on slopes of up to 0.4
  }
}

TEST_CASE("distances of a rough map against a march in double, from the ground, the air and space") {
  const TemporaryDirectory directory;
  write_height_map(directory / "rough.png", 300, 300, rough);
  const Scene scene = scene_of((directory / "rough.png").string(), 40.0, 2.0);
  for (const View& view : {View{.altitude_km = 1.6, .azimuth_deg = 40, .elevation_deg = -3, .fov_deg = 60},
                           View{.altitude_km = 9.0, .azimuth_deg = 200, .elevation_deg = -25, .fov_deg = 60},
                           View{.altitude_km = 300.0, .azimuth_deg = 0, .elevation_deg = -90, .fov_deg = 10}}) {
    constexpr int kSide = 40;
    const Run run(scene, {kSide, kSide}, view);
    int compared = 0, unlike = 0;
    for (int n = 0; n < kSide * kSide; n += 3) {
      const double px = (2 * (n % kSide) + 1 - kSide) / double(kSide),
                   py = (2 * (n / kSide) + 1 - kSide) / double(kSide);
      const glm::dvec3 direction = glm::normalize(glm::dvec3(run.camera.forward) + glm::dvec3(run.camera.right) * px -
                                                  glm::dvec3(run.camera.up) * py),
                       start(0, 0, view.altitude_km);
      double truth = 0.0, step = 0.002;
      for (double t = std::max(0.0, 0.99 * (view.altitude_km - 2.0)); t < view.altitude_km + 120.0; t += step) {
        const glm::dvec3 p = start + direction * t;
        const double altitude = altitude_of(p), x = p.x * kRadius_km / (kRadius_km + altitude),
                     y = p.y * kRadius_km / (kRadius_km + altitude);
        if (std::max(std::abs(x), std::abs(y)) > 20.0) continue;
        if (altitude > height_at(run.map, x, y)) continue;
        truth = t;
        break;
      }
      const double met = run.distances[4 * size_t(n)];
      ++compared;
      // A ray that grazes a crest may meet it or pass it by less than a step.
      if ((met > 0.0) != (truth > 0.0) || std::abs(met - truth) > 0.02) ++unlike;
    }
    CAPTURE(view.altitude_km, compared, unlike);
    CHECK(unlike * 100 <= compared);
  }
}

// Bumps too gentle to shade each other: with shadows and without the picture is the same. A surface drawn lower than
// the one that throws the shadow would lie in it.
TEST_CASE("hard: sunlit crests have no shadow of their own") {
  const TemporaryDirectory directory;
  write_height_map(directory / "bumps.png", 512, 512, [](uint32_t i, uint32_t j) {
    return 32767.0 * (1.0 + std::sin(i * 6.2831853 / 12) * std::sin(j * 6.2831853 / 12));
  });
  for (const double altitude_km : {0.5, 6.0}) {
    Scene scene = scene_of((directory / "bumps.png").string(), 64.0, 0.3);  // slopes up to 0.63
    scene.sun.zenith_deg = 52.0;                                            // 0.78
    View view = scene.views[0];
    view.altitude_km = altitude_km, view.elevation_deg = -8.0;
    const Image with = Drawn(scene, {96, 54}, {{"aerial.method", "march"}}).picture(view);
    scene.terrain->shadows = false;
    const Image without = Drawn(scene, {96, 54}, {{"aerial.method", "march"}}).picture(view);
    int darker = 0;
    for (size_t i = 0; i < with.pixels.size(); ++i) darker += with.pixels[i].g < 0.999f * without.pixels[i].g;
    CAPTURE(altitude_km);
    CHECK(darker == 0);
  }
}

// The camera turns by half a pixel. A ground that sparkles changes everywhere; this one only where it has borders.
TEST_CASE("hard: a ground that moves by half a pixel does not flicker") {
  Scene scene = scene_named("noon");
  scene.terrain->size = 256;
  scene.terrain->signs_azimuth_deg.reset();
  constexpr int kWide = 240, kHigh = 135;
  Drawn drawn(scene, {kWide, kHigh}, {});
  View view = scene.views[0];
  view.fov_deg = 45.0, view.elevation_deg = 0.0;
  const Image before = drawn.picture(view);
  view.azimuth_deg += 0.5 * 45.0 / kHigh;
  const Image after = drawn.picture(view, 1);
  double sum = 0.0;
  int count = 0;
  for (int y = kHigh * 3 / 5; y < kHigh; ++y)
    for (int x = 0; x < kWide; ++x, ++count) {
      const float a = before.pixels[size_t(y) * kWide + x].g, b = after.pixels[size_t(y) * kWide + x].g;
      sum += std::abs(a - b) / (a + b);
    }
  CAPTURE(sum / count);
  CHECK(sum / count < 0.03);
}
