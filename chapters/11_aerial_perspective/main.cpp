// Chapter 11, aerial perspective: terrain under the sky of chapter 10, and the air in front of it. Mountains turn blue
// with distance; at sunset they lay their shadows through the haze.
#include "chapters/02_window/window.hpp"
#include "chapters/06_display/auto_display.hpp"
#include "chapters/11_aerial_perspective/aerial_sky.hpp"
#include "chapters/11_aerial_perspective/terrain_truth.hpp"

using namespace welkin;

namespace {

std::vector<Knob> knobs() {
  std::vector<Knob> all = aerial_sky_knobs();
  for (Knob& knob : display_knobs()) {
    knob.ladder.clear();  // chapter 06's page has its curve
    all.push_back(std::move(knob));
  }
  return all;
}

}  // namespace

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
      .knobs = knobs(),
      .reference = {{"aerial.method", "march"}, {"aerial.march_slices", "256"}, {"froxels.samples", "4"}},
      .truth = terrain_truth(),
      .standard_views = {{"noon", "horizon"},
                         {"noon", "airliner"},
                         {"sunset", "sun"},
                         {"sunset", "wide"},
                         {"twilight", "glow"},
                         {"alien", "horizon"}},
      .window = open_window_system,
      .make = [](const app::Context& context) { return std::make_unique<AerialSky>(context); },
      .make_display = make_display};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
