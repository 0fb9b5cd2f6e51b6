// Chapter 17 as effects: what a scene does not call for is not there, keys and reasons, the picture, pictures of
// chapters below; and bodies and phase functions as numbers.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "chapters/16_noise/noise.hpp"
#include "common/app/camera.hpp"
#include "common/app/session.hpp"
#include "tests/gpu/17_clouds.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

// A scene drawn by all effects of the chapter, small.
struct Shown {
  Scene scene;
  Settings settings;
  std::string no_fault;
  app::Context context{device(), scene, settings, no_fault};
  app::Chapter chapter;
  std::unique_ptr<app::Composition> program;
  std::unique_ptr<app::Renderer> renderer;

  explicit Shown(Scene drawn, std::vector<app::Effect> effects = cloud_effects())
      : scene(std::move(drawn)), settings(app::knobs_of(effects, 17)) {
    for (const char* quick :
         {"multiple_scattering.iterations=3", "multiple_scattering.directions=16", "transmittance.height=16",
          "terrain.shadow_size=64", "froxels.size=8", "froxels.slices=8"}) {
      const auto [name, value] = split_assignment(quick);
      if (settings.has(name)) settings.set(name, value);
    }
    program = std::make_unique<app::Composition>(context, std::move(effects));
    renderer = std::make_unique<app::Renderer>(context, chapter, *program, VkExtent2D{48, 32});
  }
  Image draw(const View& view) {
    renderer->draw(app::pose_of(view, scene.planet.ground_radius_km), 0.0, 1, 0);
    return renderer->picture();
  }
  bool has_image(const char* name) const { return program->image(name) != nullptr; }
};

Scene noon_with(std::vector<Cloud> clouds) {
  Scene scene = scene_named("noon");
  scene.terrain.reset();  // chapter 11's passes are tested there
  scene.clouds = std::move(clouds);
  return scene;
}

const Cloud kLayer{.kind = "layer", .base_km = 1.5, .top_km = 4.0, .extinction_per_km = 0.1};

}  // namespace

TEST_CASE("only what the scene calls for: no cloud, a layer, a grid, noise") {
  const View view{.altitude_km = 0.05, .azimuth_deg = 180.0, .elevation_deg = 20.0};
  Shown none(noon_with({}));
  const Image clear = none.draw(view);
  for (const char* image : {"noise_base", "noise_detail", "noise_curl", "weather_map", "weather", "cloud_grids"})
    CHECK_FALSE(none.has_image(image));
  CHECK(none.program->passes_of("cloud picture").empty());
  CHECK(none.program->resources_of("clouds").empty());
  CHECK(none.program->explain().find("no [[cloud]] and no [weather] in scene") != std::string::npos);
  Shown below(noon_with({kLayer}), terrain_effects());
  CHECK(below.draw(view).pixels == clear.pixels);  // chapters below draw a scene with clouds without them
  const uint64_t bytes = none.program->bytes();

  Shown layer(noon_with({kLayer}));
  layer.draw(view);
  CHECK(layer.program->passes_of("cloud picture") == std::vector<std::string>{"cloud picture"});
  CHECK(layer.program->explain().find("1 body of cloud") != std::string::npos);
  CHECK(layer.program->explain().find("no noise, weather or curl texture") != std::string::npos);
  // The block, a texel here and there, and one picture more.
  CHECK(layer.program->bytes() < bytes + 8192 + 64 * 32 * 16 + 65536);

  const GridFile file("deck");
  Shown grid(noon_with({{.kind = "grid", .up_km = 3.0, .file = file.path().string(), .size_km = file.size_km}}));
  grid.draw(view);
  // A device may tile a volume and take up to three times its texels for it: still a tenth of the noise textures.
  CHECK(grid.program->bytes() < bytes + 8192 + 64 * 32 * 16 + 98304 + 3 * 65 * 65 * 17 * 4);
  CHECK(grid.program->explain().find("no noise, weather or curl texture") != std::string::npos);

  Scene windy = noon_with({});
  windy.weather = Weather{.preset = "fair"};
  Shown noise(windy);
  noise.draw(view);
  CHECK(noise.program->bytes() > bytes + (9 << 20));  // 128^3 of four bytes and their mips, and the others
  // The same program follows the scene to clear weather, and everything of it is gone.
  noise.scene.weather->preset = "clear";
  CHECK(noise.program->stale());
  noise.program->rebuild();
  CHECK(noise.draw(view).pixels == clear.pixels);
  CHECK(noise.program->explain().find("weather.preset is clear") != std::string::npos);
  CHECK(noise.program->bytes() < bytes + 65536);
}

TEST_CASE("a picture behind a layer keeps its transmittance, and a grey comes before it") {
  const View up{.altitude_km = 0.05, .azimuth_deg = 0.0, .elevation_deg = 90.0, .fov_deg = 2.0};
  Shown clear(noon_with({})), cloudy(noon_with({kLayer}));
  const Image without = clear.draw(up), with = cloudy.draw(up);
  // Straight up 2.5 km of a layer of 0.1 per km: T = exp(-0.25). The grey is one for the whole picture: from two
  // layers, one thick enough to hide what is behind, it and T follow.
  Shown hidden(noon_with({{.kind = "layer", .base_km = 1.5, .top_km = 4.0, .extinction_per_km = 100.0}}));
  const Image grey = hidden.draw(up);
  const double t = std::exp(-0.25);
  for (size_t i = 0; i < with.pixels.size(); ++i) {
    const double behind = double(without.pixels[i].r), before = double(grey.pixels[i].r);
    REQUIRE(std::abs(before - behind) > 0.1 * behind);  // else T would not show
    CHECK((double(with.pixels[i].r) - before) / (behind - before) == Approx(t).epsilon(0.02));
  }
  cloudy.settings.set("cloud.show", "side");
  cloudy.program->rebuild();
  const Image side = cloudy.draw(up);
  CHECK(app::count_not_finite(side) == 0);
  CHECK(side.pixels.front() != side.pixels[48 * 31]);
}

TEST_CASE(
    "hard: cameras in, under, over, on the edges of cloud, half a metre up, in space, far away: every pixel finite") {
  Scene scene = scene_named("fair");
  scene.terrain.reset();  // chapter 11's passes are tested there
  scene.clouds = {kLayer,
                  {.kind = "sphere", .east_km = 1.0, .up_km = 2.0, .radius_km = 0.5},
                  {.kind = "disc", .base_km = 5.0, .top_km = 6.0, .radius_km = 3.0}};
  Shown shown(scene);
  for (const double altitude_km : {0.0, 0.0005, 1.3, 1.5, 2.0, 3.4, 4.0, 5.0, 11.0, 100.0, 400.0, 36000.0})
    for (const double elevation_deg : {-90.0, -2.0, 0.0, 60.0, 90.0}) {
      const Image picture =
          shown.draw({.altitude_km = altitude_km, .azimuth_deg = 33.0, .elevation_deg = elevation_deg});
      CAPTURE(altitude_km, elevation_deg);
      CHECK(app::count_not_finite(picture) == 0);
    }
  for (const double east_km : {200.0, 9990.0, 19000.0})
    CHECK(app::count_not_finite(shown.draw({.east_km = east_km, .altitude_km = 2.0, .elevation_deg = 1.0})) == 0);
}

TEST_CASE("bodies and presets as numbers; phase functions as mixtures") {
  const Scene scene = scene_of({});
  for (const auto& [preset, bodies] : {std::pair("clear", 0u), std::pair("fair", 1u), std::pair("broken", 1u),
                                       std::pair("overcast", 1u), std::pair("storm", 1u), std::pair("mackerel", 1u)}) {
    const std::vector<Cloud> list = preset_bodies({.preset = preset});
    CHECK(list.size() == bodies);
    for (const Cloud& cloud : list) {
      CHECK((cloud.base_km >= 0.0 && cloud.base_km < cloud.top_km && cloud.top_km < 20.0));
      CHECK((cloud.coverage > 0.0 && cloud.coverage <= 1.0));
    }
  }
  // The mean cosine of droplets, as PHYSICS of the field has it: 0.843, 0.864, 0.879, 0.891; and both lobes integrate
  // to 1.
  const auto draine = [](double mu, double g, double alpha) {
    return (1 - g * g) / (4 * 3.14159265358979323846 * std::pow(1 + g * g - 2 * g * mu, 1.5)) * (1 + alpha * mu * mu) /
           (1 + alpha * (1 + 2 * g * g) / 3);
  };
  for (const auto& [diameter, cosine] :
       {std::pair(5.0, 0.843), std::pair(10.0, 0.864), std::pair(20.0, 0.879), std::pair(50.0, 0.891)}) {
    const PhaseMixture mixture = droplet_phase(diameter);
    double integral = 0.0, mean = 0.0;
    constexpr int kSteps = 400000;
    for (int i = 0; i < kSteps; ++i) {  // evenly in a variable that crowds towards mu = 1
      const double u = (i + 0.5) / kSteps, mu = 1.0 - 2.0 * u * u * u * u, weight = 8.0 * u * u * u / kSteps;
      const double p = mixture.weight * draine(mu, mixture.g, mixture.alpha) +
                       (1 - mixture.weight) * draine(mu, mixture.second_g, mixture.second_alpha);
      integral += 2 * 3.14159265358979323846 * p * weight, mean += 2 * 3.14159265358979323846 * p * mu * weight;
    }
    CHECK(integral == Approx(1.0).epsilon(1e-4));
    CHECK(mean == Approx(cosine).margin(0.002));
  }
  for (const double diameter : {1.5, 2.0, 4.9, 5.0, 50.0}) {
    const PhaseMixture mixture = droplet_phase(diameter);
    for (const double value : {mixture.weight, mixture.g, mixture.alpha, mixture.second_g}) CHECK(std::isfinite(value));
    CHECK(
        (mixture.weight > 0.0 && mixture.weight < 1.0 && mixture.g > 0.0 && mixture.g < 1.0 && mixture.second_g < 1.0));
  }
  CHECK(phase_of({.g = 0.5}).g == 0.5);
  CHECK(phase_of({.g = 0.5}).weight == 1.0);
  // A disc's axis stands at the end of its arc, at the base.
  const interop::CloudBlock block = make_cloud_block(
      {{.kind = "disc", .base_km = 1.5, .top_km = 4.0, .north_km = 6361.5, .radius_km = 10.0}}, scene.planet);
  CHECK(double(block.bodies[0].axis.y) == Approx(std::sin(1.0)));
  CHECK(double(block.bodies[0].place_km.z) == Approx(6361.5 * std::cos(1.0) - 6360.0).epsilon(1e-6));
  CHECK(block.ceiling_km == 4.0f);
}
