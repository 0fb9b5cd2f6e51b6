// Chapter 05, single scattering: sunlight that is scattered once on its way to the eye. Every pixel marches along its
// view ray, and each sample marches towards the sun. With the planet's shadow, ozone, the ground and the sun's disc.
#include "chapters/02_window/window.hpp"
#include "chapters/05_single_scattering/single_scattering.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 5,
      .name = "05_single_scattering",
      .title = "Single scattering",
      .whats_new = "A march along the view, at each sample the air on the way to the sun: the first true sky.",
      .try_next = "./welkin run 05 --scene sunset   (or: ./welkin compare 04 05 --scene sunset)",
      .sky = true,
      .reference = {{"view.steps", "512"}, {"light.steps", "64"}, {"rule", "adapted"}},
      .standard_views =
          {{"noon", "horizon"}, {"sunset", "sun"}, {"twilight", "glow"}, {"orbit", "limb"}, {"alien", "horizon"}},
      .window = open_window_system,
      .still_passes = {"march", "display"},
      .effects = {air(), single_scattering()},
      .probe = probe_single_scattering};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
