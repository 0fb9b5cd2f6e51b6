// Chapter 11, aerial perspective: terrain under the sky of chapter 10, and the air in front of it. Mountains turn blue
// with distance; at sunset they cast shadows through the haze.
#include "chapters/02_window/window.hpp"
#include "chapters/06_display/display.hpp"
#include "chapters/08_transmittance_lut/transmittance_lut.hpp"
#include "chapters/10_sky_view_lut/sky.hpp"
#include "chapters/11_aerial_perspective/lit_terrain.hpp"
#include "chapters/11_aerial_perspective/terrain_truth.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 11,
      .name = "11_aerial_perspective",
      .title = "Aerial perspective",
      .whats_new = "Terrain, its shadows, and the air in front of it in a grid of froxels.",
      .try_next = "./welkin run 11 --scene sunset --view wide   (or: --set aerial.method=march)",
      .sky = true,
      .images = {"sky_view", "multiple_scattering", "transmittance"},
      .reference = {{"aerial.method", "march"}, {"aerial.march_slices", "256"}, {"froxels.samples", "4"}},
      .truth = terrain_truth(),
      .standard_views = {{"noon", "horizon"},
                         {"noon", "airliner"},
                         {"sunset", "sun"},
                         {"sunset", "wide"},
                         {"twilight", "glow"},
                         {"alien", "horizon"},
                         {"noon", "climb", 2, 4}},
      .window = open_window_system,
      .still_passes = {"sky", "compose", "histogram", "exposure", "display"},
      .extra_bytes = 34 << 20,
      .effects = {air(), transmittance_table(), multiple_scattering_table(), sky_view(), sky(), terrain(),
                  terrain_shadows(), aerial_perspective(), lit_terrain(), exposure(), display()},
      .probe = probe_sky};  // a probe's ray has no place on the map: it sees chapter 10's sky
  return app::run(argc, argv, chapter);
  // [/chapter]
}
