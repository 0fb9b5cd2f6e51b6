// Chapter 03, planet and rays: where does a ray meet the planet, when the planet has 6360 km, the camera stands half a
// metre above it or beside the Moon, and a float has 24 bits?
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
      // From the grass to the Moon's distance: each loses other digits.
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
