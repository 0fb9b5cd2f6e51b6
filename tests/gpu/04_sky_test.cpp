// Chapter 04's program: the drawn sphere shows the sky along every pixel's ray, vertex colours converge to it, and what
// is not asked for is not allocated.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

#include "chapters/04_air/constant_sky.hpp"
#include "common/app/renderer.hpp"
#include "tests/gpu/harness.hpp"
#include "tree.hpp"

using namespace welkin;

namespace {

constexpr VkExtent2D kSize{96, 54};

// A program with its scene and settings, and the pictures it draws.
struct Drawing {
  Scene scene;
  Settings settings{{{.name = "sky.method", .initial = 1, .choices = {"per_vertex", "per_pixel"}},
                     {.name = "sphere.detail", .maximum = 4, .initial = 2, .integer = true},
                     {.name = "phase.detail",
                      .initial = 3,
                      .choices = {"isotropic", "rayleigh", "henyey_greenstein", "scene", "anisotropic"}}}};
  std::string inject;
  app::Chapter chapter;

  explicit Drawing(const char* name)
      : scene(load_scene(name, std::string(WELKIN_SOURCE_DIRECTORY) + "/chapters/scenes")) {}
  Image draw(const char* view = "") {
    const app::Context context{test::device(), scene, settings, inject};
    ConstantSkyProgram program(context);
    app::Renderer renderer(context, chapter, program, kSize);
    renderer.draw(app::pose_of(scene.view(view), scene.planet.ground_radius_km), 0.0, 1, 0);
    allocations.clear();
    for (const gpu::Allocation& allocation : test::device().allocations()) allocations.push_back(allocation.name);
    return renderer.picture();
  }
  std::vector<std::string> allocations;
};

double largest_difference(const Image& a, const Image& b) {
  double worst = 0.0, brightest = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, double(std::abs(a.pixels[i][c] - b.pixels[i][c])));
      brightest = std::max(brightest, double(b.pixels[i][c]));
    }
  return worst / brightest;
}

// Share of the pixels that are not the sky within `box` pixels, each way, of the rays through (x + 1/2 + beside, y +
// 1/2 + beside).
double off(const Image& picture, const Scene& scene, const CameraRays& camera, double beside, double box) {
  const interop::Atmosphere air = make_atmosphere(scene);
  const float* numbers = &air.rayleigh_scattering.x;
  std::vector<float> in;
  for (uint32_t y = 0; y < kSize.height; ++y)
    for (uint32_t x = 0; x < kSize.width; ++x)
      for (int ray = 0; ray < 9; ++ray) {
        const double u = 2.0 * (x + 0.5 + beside + (ray % 3 - 1) * box) / kSize.width - 1.0;
        const double v = 2.0 * (y + 0.5 + beside + (ray / 3 - 1) * box) / kSize.height - 1.0;
        const glm::dvec3 view =
            glm::normalize(glm::dvec3(camera.forward) + u * glm::dvec3(camera.right) - v * glm::dvec3(camera.up));
        in.insert(in.end(), numbers, numbers + 28);
        for (const double value : {double(camera.altitude_km), view.x, view.y, view.z, double(camera.sun.x),
                                   double(camera.sun.y), double(camera.sun.z)})
          in.push_back(static_cast<float>(value));
      }
  const std::vector<float> out =
      test::evaluate("tests/04_constant_sky.comp", in, 35, 13, specialization(air_variant(scene)));
  size_t count = 0;
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    bool differs = false;
    for (int c = 0; c < 3; ++c) {
      float low = out[13 * 9 * i + c], high = low;
      for (int ray = 1; ray < 9; ++ray) {
        low = std::min(low, out[13 * (9 * i + ray) + c]);
        high = std::max(high, out[13 * (9 * i + ray) + c]);
      }
      differs |=
          !(picture.pixels[i][c] >= low - 2e-3f * low - 1e-7f && picture.pixels[i][c] <= high + 2e-3f * high + 1e-7f);
    }
    count += differs;
  }
  return double(count) / double(picture.pixels.size());
}

}  // namespace

// A rasterizer may move each corner of a triangle to its grid of 2^-subPixelPrecisionBits pixels before it interpolates
// (lavapipe interpolates from the corners as they were, NVIDIA's driver from the moved ones). Between corners moved by
// at most a cell the ray is off by at most a cell, here 1/256 pixel. Directions in float add a few 2^-24 of a component
// each: together below 1e-6 rad. Within that box a pixel may show any of the sky's values: at the shell's edge and at
// the ground's they jump. Nine rays of the box, its corners among them, bound them; 2e-3 is for their bending between
// these. (Corners rounded to that grid by the vertex shader leave 100 pixels of orbit/limb beside the sky of their one
// ray on lavapipe, too: as many as on NVIDIA's driver. A grid of 1/16 pixel fails here in every view.)
TEST_CASE("04 sky: a pixel of the drawn sphere is the sky along the pixel's ray") {
  const double cell = std::ldexp(1.0, -static_cast<int>(test::device().limits().subPixelPrecisionBits));  // pixels
  for (const auto& [name, view] :
       {std::pair{"noon", "horizon"}, {"noon", "zenith"}, {"sunset", "antisun"}, {"orbit", "limb"}}) {
    Drawing drawing(name);
    drawing.scene.sun.disc = false;
    const Image picture = drawing.draw(view);
    const app::CameraPose pose = app::pose_of(drawing.scene.view(view), drawing.scene.planet.ground_radius_km);
    const CameraRays camera = app::camera_rays(pose, drawing.scene, 0.0, {kSize.width, kSize.height}, 1, 0);
    const double pixel_rad = 2.0 * glm::length(glm::dvec3(camera.up)) / kSize.height;
    const double right = off(picture, drawing.scene, camera, 0.0, cell + 1e-6 / pixel_rad);
    const double half_a_pixel = off(picture, drawing.scene, camera, 0.5, cell + 1e-6 / pixel_rad);
    INFO(name << " " << view << ": box of " << cell + 1e-6 / pixel_rad << " pixels");
    CHECK(right == 0.0);
    CHECK(half_a_pixel > 0.3);  // the same box half a pixel beside: what a wrong sample position would look like
  }
}

TEST_CASE("04 sky: vertex colours converge to pixel colours as the triangles shrink") {
  Drawing drawing("noon");
  drawing.scene.sun.disc = false;
  const Image exact = drawing.draw("zenith");
  drawing.settings.set("sky.method", "per_vertex");
  double before = 1.0;
  for (const char* detail : {"0", "1", "2", "3"}) {
    drawing.settings.set("sphere.detail", detail);
    const double error = largest_difference(drawing.draw("zenith"), exact);
    INFO("detail " << detail << ": " << error);
    CHECK(error < before * 0.6);  // towards 1/4 where the sky is smooth; the ground at the frame's edge spoils it
    before = error;
  }
}

TEST_CASE("04 sky: vertex colours are allocated only if asked for") {
  Drawing drawing("noon");
  const auto has = [](const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  drawing.draw();
  CHECK(!has(drawing.allocations, "vertex colours"));
  drawing.settings.set("sky.method", "per_vertex");
  drawing.draw();
  CHECK(has(drawing.allocations, "vertex colours"));
}

TEST_CASE("04 sky: each phase function detail, each missing medium and a planted wrong constant changes the picture") {
  Drawing drawing("noon");
  std::vector<Image> pictures;
  for (const char* detail : {"isotropic", "rayleigh", "henyey_greenstein", "scene", "anisotropic"}) {
    drawing.settings.set("phase.detail", detail);
    pictures.push_back(drawing.draw());
  }
  for (size_t i = 1; i < pictures.size(); ++i) CHECK(largest_difference(pictures[i - 1], pictures[i]) > 1e-4);
  for (const char* kind : {"rayleigh", "mie", "ozone"}) {
    Drawing less("noon");
    std::erase_if(less.scene.media, [&](const Medium& medium) { return medium.kind == kind; });
    const Image picture = less.draw();
    for (const glm::vec4& pixel : picture.pixels) REQUIRE((std::isfinite(pixel.r) && pixel.r >= 0.0f));
    CHECK(largest_difference(picture, pictures[3]) > 1e-3);
  }
  Drawing wrong("noon");
  wrong.inject = "wrong-constant";
  CHECK(largest_difference(wrong.draw(), pictures[3]) > 1e-3);
}

TEST_CASE("04 sky: --probe gives the sky without the disc, and nothing where nothing is") {
  Drawing drawing("earth");
  const app::Context context{test::device(), drawing.scene, drawing.settings, drawing.inject};
  ConstantSkyProgram program(context);
  const std::vector<app::ProbeRay> rays{{0.0005, 30.0, 30.0, 0.0},
                                        {0.0005, 30.0, 30.0, 180.0},
                                        {400.0, 0.0, 30.0, 0.0},
                                        {36000.0, 90.0, 30.0, 0.0},
                                        {0.0, 180.0, 0.0, 0.0}};
  const std::vector<app::ProbeResult> results = program.probe(rays);
  REQUIRE(results.size() == rays.size());
  CHECK(results[0].radiance.z > results[1].radiance.z);  // towards the sun is brighter
  CHECK(results[0].radiance.z < 1.0);                    // the disc would be 1e4
  for (const size_t miss : {2, 3}) {
    CHECK(results[miss].radiance == glm::dvec3(0.0));
    CHECK(results[miss].transmittance == glm::dvec3(1.0));
  }
  CHECK(results[4].transmittance == glm::dvec3(1.0));  // the ground at the lens: 0.3/pi of sunlight
  CHECK(results[4].radiance.x == Approx(0.3 / 3.14159265 * std::exp(-0.0615)).epsilon(2e-3));
}
