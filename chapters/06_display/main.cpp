// Chapter 06, display: the sky of chapter 05 seen through a light meter, a tone curve and a dither. The light is the
// same as in chapter 05; this chapter decides how a screen shows it.
#include "chapters/02_window/window.hpp"
#include "chapters/05_single_scattering/single_scattering.hpp"
#include "chapters/06_display/display.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 6,
      .name = "06_display",
      .title = "Display",
      .whats_new = "A light meter that adapts, seven tone curves side by side, and no bands at dusk.",
      .try_next = "./welkin run 06 --scene sunset --set display.curve=compare",
      .sky = true,
      .reference = {{"view.steps", "512"}, {"light.steps", "64"}, {"rule", "adapted"}},
      .standard_views =
          {{"noon", "horizon"}, {"sunset", "sun"}, {"twilight", "glow"}, {"orbit", "limb"}, {"alien", "horizon"}},
      .window = open_window_system,
      .still_passes = {"march", "histogram", "exposure", "display"},
      .effects = {air(), single_scattering(), exposure(), display()},
      .probe = probe_single_scattering};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
