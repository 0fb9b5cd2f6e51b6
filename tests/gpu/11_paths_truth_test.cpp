// Chapter 11 against the path tracer that ends its rays on the same terrain: everything the chapter does to light at
// once. Pictures are compared by the means of blocks, sky and terrain apart, so that the paths' noise is below a per
// cent.
//
//   WELKIN_TABLE=docs/generated/11_paths.csv gpu_tests "[11_paths_table]"
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "chapters/11_aerial_perspective/terrain_truth.hpp"
#include "common/image/csv.hpp"
#include "tests/gpu/07_paths.hpp"
#include "tests/gpu/11_parts.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr VkExtent2D kSize{48, 27};
constexpr uint32_t kBlockWidth = 16, kBlockHeight = 9;
constexpr int kFewest = 40;  // pixels of one kind in a block that is compared

// No mountain's shadow: the path tracer knows of none. No disc: a pixel's centre is in it or is not.
Scene compared_scene(const char* name) {
  Scene scene = scene_named(name);
  scene.terrain->shadows = false;
  scene.terrain->size = 256;  // a sixteenth of the samples: made in no time
  scene.sun.disc = false;
  return scene;
}

struct Block {
  bool terrain;
  glm::dvec3 mean{0.0}, error{0.0};  // of the paths, error: one standard error
  std::vector<size_t> pixels;
};

// The path tracer's picture, cut into blocks: a mean for each of `seeds` pictures of their own gives mean and error.
std::vector<Block> traced(const Scene& scene, const View& view, const std::vector<bool>& terrain, int seeds,
                          int frames) {
  std::vector<Block> blocks;
  for (const bool kind : {false, true})
    for (uint32_t y = 0; y < kSize.height; y += kBlockHeight)
      for (uint32_t x = 0; x < kSize.width; x += kBlockWidth) {
        Block block{.terrain = kind};
        for (uint32_t j = y; j < y + kBlockHeight; ++j)
          for (uint32_t i = x; i < x + kBlockWidth; ++i)
            if (terrain[size_t{j} * kSize.width + i] == kind) block.pixels.push_back(size_t{j} * kSize.width + i);
        if (block.pixels.size() >= kFewest) blocks.push_back(std::move(block));
      }
  const app::Truth truth = terrain_truth();
  Settings settings(truth.knobs);
  settings.set("samples", "16");
  const std::string inject;
  const app::Context context{device(), scene, settings, inject};
  const std::unique_ptr<app::Program> program = truth.make(context);
  const app::Chapter plain;
  app::Renderer renderer(context, plain, *program, kSize);
  std::vector<glm::dvec3> squares(blocks.size(), glm::dvec3(0.0));
  for (int seed = 1; seed <= seeds; ++seed) {
    for (int i = 0; i < frames; ++i)
      renderer.draw(app::pose_of(view, 6360.0), 0.0, static_cast<uint32_t>(seed), static_cast<uint32_t>(i));
    const Image picture = renderer.picture();
    for (size_t b = 0; b < blocks.size(); ++b) {
      glm::dvec3 mean(0.0);
      for (const size_t pixel : blocks[b].pixels)
        mean += glm::dvec3(picture.pixels[pixel]) / double(blocks[b].pixels.size());
      blocks[b].mean += mean / double(seeds), squares[b] += mean * mean / double(seeds);
    }
  }
  for (size_t b = 0; b < blocks.size(); ++b)
    for (int c = 0; c < 3; ++c)
      blocks[b].error[c] =
          std::sqrt(std::max(squares[b][c] - blocks[b].mean[c] * blocks[b].mean[c], 0.0) / (seeds - 1.0));
  return blocks;
}

// Relative errors of a picture's blocks of one kind, all channels, and the paths' noise beside them.
struct Compared {
  std::vector<double> errors, noise;
  double median() const { return middle(errors); }
  double worst() const { return errors.empty() ? 0.0 : *std::max_element(errors.begin(), errors.end()); }
  double middle(std::vector<double> list) const {
    if (list.empty()) return 0.0;
    std::nth_element(list.begin(), list.begin() + list.size() / 2, list.end());
    return list[list.size() / 2];
  }
};
Compared compared(const Image& picture, const std::vector<Block>& blocks, bool terrain) {
  Compared result;
  for (const Block& block : blocks) {
    if (block.terrain != terrain) continue;
    glm::dvec3 mean(0.0);
    for (const size_t pixel : block.pixels) mean += glm::dvec3(picture.pixels[pixel]) / double(block.pixels.size());
    for (int c = 0; c < 3; ++c) {
      result.errors.push_back(std::abs(mean[c] / block.mean[c] - 1.0));
      result.noise.push_back(block.error[c] / block.mean[c]);
    }
  }
  return result;
}

// One view, by froxels and by the march per pixel, against the same paths.
struct Judged {
  Compared froxels_sky, froxels_terrain, march_terrain;
};
Judged judge(const char* name, const char* view_name, int seeds, int frames) {
  const Scene scene = compared_scene(name);
  const View& view = scene.view(view_name);
  // A path meets one surface: no edges that share a pixel.
  const Image picture = Drawn(scene, kSize, {{"terrain.edges", "off"}}).picture(view),
              march = Drawn(scene, kSize, {{"aerial.method", "march"}, {"terrain.edges", "off"}}).picture(view);
  // Where nothing stands, both are the same sky, bit for bit; elsewhere two sums of floats.
  std::vector<bool> terrain(picture.pixels.size());
  for (size_t i = 0; i < terrain.size(); ++i) terrain[i] = picture.pixels[i] != march.pixels[i];
  const std::vector<Block> blocks = traced(scene, view, terrain, seeds, frames);
  return {compared(picture, blocks, false), compared(picture, blocks, true), compared(march, blocks, true)};
}

}  // namespace

// A path that ends on a surface in the air: scattered once on the way by quadrature, and the lit surface behind that
// air. The surface is level where the eye is, not where it stands: it is tilted there by as much as the vertical turns
// on the way, which is up to 1 % of its light and more than the errors asked for.
TEST_CASE("truth: paths end on a surface where an image says so") {
  const reference::Planet planet = reference::earth();
  std::vector<PathRay> rays;
  std::vector<reference::Rgb> wanted;
  for (const auto& [altitude_km, zenith_deg, d_km] :
       {std::tuple{0.5, 85.0, 12.0}, {3.0, 95.0, 30.0}, {10.0, 100.0, 40.0}, {0.1, 60.0, 2.0}})
    for (const double sun_deg : {25.0, 75.0}) {
      const SkyRay ray = ray_from_degrees(altitude_km, zenith_deg, sun_deg, 60.0);
      const Light light = truth_to(planet, ray, d_km);
      const double r = planet.ground_radius_km + altitude_km, mu = ray.view[2],
                   sine = std::hypot(ray.view[0], ray.view[1]);
      const double r_d = std::sqrt(r * r + 2.0 * r * mu * d_km + d_km * d_km), c = (r + d_km * mu) / r_d,
                   s = d_km * sine / r_d;
      const double mu_sun = c * ray.sun[2] + s * (ray.sun[0] * ray.view[0] + ray.sun[1] * ray.view[1]) / sine;
      const reference::Rgb to_sun =
          reference::transmittance_to_top(planet, altitude_km + d_km * (2.0 * r * mu + d_km) / (r_d + r), mu_sun);
      reference::Rgb expected{};
      for (int k = 0; k < 3; ++k)
        expected[k] = light.radiance[k] + light.transmittance[k] * to_sun[k] * ray.sun[2] * 0.4 / 3.14159265358979324;
      wanted.push_back(expected);
      rays.push_back({.ray = ray,
                      .albedo = {0.4, 0.4, 0.4},
                      .orders = 1,
                      .seed = static_cast<uint32_t>(rays.size() + 1),
                      .surface_km = d_km});
    }
  const std::vector<PathMean> means = trace(planet, rays, {.phase = kHenyeyGreenstein, .surfaces = true}, 8192, 8);
  for (size_t i = 0; i < rays.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      CAPTURE(i, k, means[i].mean[k], means[i].error[k], wanted[i][k]);
      CHECK(means[i].error[k] < 0.006 * wanted[i][k]);
      CHECK(std::abs(score(means[i].mean[k], means[i].error[k], wanted[i][k], 0.0)) < 4.0);
    }
}

// With all orders, in a furnace: a surface that reflects everything is not seen, wherever it stands.
TEST_CASE("truth: a white surface in a white furnace is not seen") {
  reference::Planet planet = reference::earth();
  planet.mie_extinction_per_km = planet.mie_scattering_per_km;
  std::vector<PathRay> rays;
  for (const auto& [altitude_km, zenith_deg, d_km] :
       {std::tuple{0.5, 85.0, 12.0}, {10.0, 100.0, 40.0}, {400.0, 120.0, 880.0}})
    rays.push_back({.ray = ray_from_degrees(altitude_km, zenith_deg, 45.0, 0.0),
                    .albedo = {1.0, 1.0, 1.0},
                    .seed = static_cast<uint32_t>(rays.size() + 1),
                    .surface_km = d_km});
  for (const PathMean& mean : trace(planet, rays, {.environment = true, .ozone = false, .surfaces = true}, 1024, 4))
    for (int k = 0; k < 3; ++k) {
      CAPTURE(k, mean.mean[k], mean.error[k]);
      CHECK(mean.error[k] < 0.05);
      CHECK(std::abs(mean.mean[k] - 1.0) < 3.5 * mean.error[k] + 1e-4);
    }
}

// All at once: tables, froxels, the guess that a slope sees an even sky over its open part. The march per pixel errs as
// the froxels do: what is left is the light of the slopes, not the air. Limits: twice what was seen, and the paths'
// noise far below them.
TEST_CASE("truth: pictures with terrain against paths that end on it") {
  struct Case {
    const char *scene, *view;
    double sky, terrain;  // worst block allowed
  };
  for (const Case& one : {Case{"noon", "airliner", 0.015, 0.025}, Case{"sunset", "wide", 0.025, 0.05}}) {
    const Judged judged = judge(one.scene, one.view, 8, 3);
    const Compared &sky = judged.froxels_sky, &terrain = judged.froxels_terrain, &march = judged.march_terrain;
    CAPTURE(one.scene, one.view, sky.median(), sky.worst(), terrain.median(), terrain.worst(), march.worst(),
            sky.middle(sky.noise), terrain.middle(terrain.noise));
    CHECK(sky.errors.size() >= 9);
    CHECK(terrain.errors.size() >= 9);
    CHECK(sky.middle(sky.noise) < 0.01);
    CHECK(terrain.middle(terrain.noise) < 0.01);
    CHECK(sky.worst() < one.sky);
    CHECK(terrain.worst() < one.terrain);
    CHECK(march.worst() < one.terrain);
  }
}

TEST_CASE("table of paths that end on terrain", "[.][11_paths_table]") {
  const char* const file = std::getenv("WELKIN_TABLE");
  if (file == nullptr) return;  // run with this file's tests: there is nothing to write
  std::vector<std::vector<std::string>> rows;
  for (const auto& [scene, view] : {std::pair{"noon", "horizon"},
                                    {"noon", "airliner"},
                                    {"sunset", "wide"},
                                    {"sunset", "airliner"},
                                    {"alien", "horizon"}}) {
    const Judged judged = judge(scene, view, 8, 16);
    for (const auto& [what, method, part] : {std::tuple{"sky", "table", &judged.froxels_sky},
                                             {"terrain", "froxels", &judged.froxels_terrain},
                                             {"terrain", "march", &judged.march_terrain}}) {
      if (part->errors.empty()) continue;
      rows.push_back({fmt::format("{}/{}", scene, view), what, method, fmt::format("{}", part->errors.size() / 3),
                      fmt::format("{:.2g}", 100.0 * part->median()), fmt::format("{:.2g}", 100.0 * part->worst()),
                      fmt::format("{:.2g}", 100.0 * part->middle(part->noise))});
      fmt::print("{}\n", fmt::join(rows.back(), " "));
      std::fflush(stdout);
    }
  }
  if (file)
    write_csv(file,
              {fmt::format("relative errors in % of the means of blocks of {} x {} pixels of {} x {}, all channels, "
                           "against {} paths a pixel that end on the same terrain; no terrain shadows, no sun disc",
                           kBlockWidth, kBlockHeight, kSize.width, kSize.height, 8 * 16 * 16),
               "device: " + device().candidate().name, "driver: " + device().candidate().driver,
               "source: WELKIN_TABLE=docs/generated/11_paths.csv gpu_tests \"[11_paths_table]\""},
              {"view", "what", "air", "blocks", "median_percent", "worst_percent", "noise_percent"}, rows);
}
