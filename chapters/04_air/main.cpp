// Chapter 04, air: what scatters and absorbs light, how much, and in which directions; and a first sky made of it: air
// of one density everywhere, in closed form, drawn on the triangles of a sky sphere.
#include "chapters/02_window/window.hpp"
#include "chapters/04_air/constant_sky.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 4,
      .name = "04_air",
      .title = "Air",
      .whats_new = "Coefficients and phase functions of air; a sky of constant density on a sky sphere.",
      .try_next =
          "./welkin run 04 --scene sunset   (and see what is wrong with it), then ./welkin run 05 --scene sunset",
      .sky = true,
      // [knobs]
      .knobs = {{.name = "sky.method",
                 .meaning = "where the sky is computed: at the sphere's vertices, or at every pixel",
                 .initial = 1,
                 .choices = {"per_vertex", "per_pixel"},
                 .ladder = {0, 1},
                 .rebuilds = true},
                {.name = "sphere.detail",
                 .meaning = "how often each of the sphere's 320 triangles is split in four",
                 .minimum = 0,
                 .maximum = 4,
                 .initial = 2,
                 .integer = true,
                 .ladder = {0, 1, 2, 3, 4},
                 .rebuilds = true},
                {.name = "phase.detail",
                 .meaning = "phase functions: none; of the molecules; and Henyey-Greenstein's of the aerosol; and the "
                            "scene's; and the molecules' anisotropy",
                 .initial = 3,
                 .choices = {"isotropic", "rayleigh", "henyey_greenstein", "scene", "anisotropic"},
                 .ladder = {0, 1, 2, 3, 4},
                 .rebuilds = true}},
      // [/knobs]
      .reference = {{"sky.method", "per_pixel"}, {"phase.detail", "anisotropic"}},
      .standard_views = {{"noon", "horizon"}, {"sunset", "sun"}, {"orbit", "limb"}},
      .window = open_window_system,
      .extra_bytes = 4 << 20,
      .make = [](const app::Context& context) { return std::make_unique<ConstantSkyProgram>(context); }};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
