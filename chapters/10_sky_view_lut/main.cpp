// Chapter 10, sky view table: the sky seen by the camera is computed for about twenty thousand directions and looked up
// for every pixel. From altitudes where the table cannot resolve the planet, the direct march replaces it.
#include "chapters/02_window/window.hpp"
#include "chapters/06_display/display.hpp"
#include "chapters/07_ground_truth/ground_truth.hpp"
#include "chapters/08_transmittance_lut/transmittance_lut.hpp"
#include "chapters/10_sky_view_lut/sky.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 10,
      .name = "10_sky_view_lut",
      .title = "Sky view table",
      .whats_new =
          "The whole sky in a small table around the horizon and the sun; where it fails, the march comes back.",
      .try_next = "./welkin compare 05 10 --scene sunset   (or: ./welkin run 10 --headless --explain)",
      .sky = true,
      .images = {"sky_view", "transmittance", "multiple_scattering"},
      .reference = {{"sky_view.method", "march"}, {"view.steps", "128"}, {"multiple_scattering.view_steps", "64"}},
      .truth = path_truth(),
      .standard_views =
          {{"noon", "horizon"}, {"sunset", "sun"}, {"twilight", "glow"}, {"orbit", "limb"}, {"alien", "horizon"}},
      .window = open_window_system,
      .still_passes = {"sky", "histogram", "exposure", "display"},
      .extra_bytes = 7 << 19,
      .effects = {air(), transmittance_table(), multiple_scattering_table(), sky_view(), sky(), exposure(), display()},
      .probe = probe_sky};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
