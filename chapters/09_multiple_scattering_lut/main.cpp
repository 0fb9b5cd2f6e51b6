// Chapter 09, multiple scattering: light scattered twice and more comes from a table, which is computed when the air
// changes and integrated along every ray.
#include "chapters/02_window/window.hpp"
#include "chapters/06_display/display.hpp"
#include "chapters/07_ground_truth/ground_truth.hpp"
#include "chapters/09_multiple_scattering_lut/all_orders_sky.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 9,
      .name = "09_multiple_scattering_lut",
      .title = "Multiple scattering",
      .whats_new = "All orders of scattering: a small table of the light that has been scattered before.",
      .try_next = "./welkin compare 05 09 --scene twilight   (or: ./welkin run 09 --set orders=1)",
      .sky = true,
      .images = {"multiple_scattering"},
      .reference = {{"view.steps", "128"},
                    {"multiple_scattering.view_steps", "128"},
                    {"multiple_scattering.size", "64"},
                    {"multiple_scattering.directions", "256"},
                    {"multiple_scattering.iterations", "32"},
                    {"multiple_scattering.steps", "32"}},
      .truth = path_truth(),
      .standard_views =
          {{"noon", "horizon"}, {"sunset", "sun"}, {"twilight", "glow"}, {"orbit", "limb"}, {"alien", "horizon"}},
      .window = open_window_system,
      .still_passes = {"march", "histogram", "exposure", "display"},
      .extra_bytes = 1 << 20,
      .effects = {air(), multiple_scattering_table(), all_orders_march(), exposure(), display()},
      .probe = probe_all_orders};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
