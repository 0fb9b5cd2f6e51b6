// Chapter 03, planet and rays: where a ray meets a planet of 6360 km radius, computed in floats of 24 bits, for cameras
// from half a metre above the ground to the Moon's distance.
#include "chapters/02_window/window.hpp"
#include "chapters/03_planet_and_rays/planet_and_rays.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 3,
      .name = "03_planet_and_rays",
      .title = "Planet and rays",
      .whats_new = "A camera from 0.5 m to the Moon's distance, and four ways to intersect its rays with a planet.",
      .try_next = "./welkin run 03 --scene orbit --view moon_limb --set camera.zoom=10 --set rays.form=naive",
      .display = app::Display::raw,
      .knobs = planet_knobs(),
      .reference = {{"rays.form", "double_float"}},
      .default_scene = "earth",
      // From the grass to the Moon's distance: float32 loses digits in a different place in each of them.
      .standard_views = {{"earth", "grass"},
                         {"earth", "summit"},
                         {"orbit", "limb"},
                         {"orbit", "geostationary"},
                         {"orbit", "moon_limb"}},
      .window = open_window_system,
      .make = [](const app::Context& context) { return std::make_unique<PlanetAndRays>(context); }};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
