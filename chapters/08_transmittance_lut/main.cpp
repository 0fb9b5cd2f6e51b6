// Chapter 08, transmittance table: the transmittance towards the sun is computed once and then looked up. The frame
// becomes a graph of passes that run only when their inputs have changed.
#include "chapters/02_window/window.hpp"
#include "chapters/06_display/display.hpp"
#include "chapters/08_transmittance_lut/table_sky.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 8,
      .name = "08_transmittance_lut",
      .title = "Transmittance table",
      .whats_new =
          "The air towards the sun computed once and looked up; a frame graph that knows what has to run again.",
      .try_next = "./welkin run 08 --headless --explain   (or: ./welkin compare 05 08)",
      .sky = true,
      .images = {"transmittance"},
      .reference = {{"view.steps", "512"},
                    {"rule", "adapted"},
                    {"transmittance.width", "1024"},
                    {"transmittance.height", "1024"}},
      .standard_views =
          {{"noon", "horizon"}, {"sunset", "sun"}, {"twilight", "glow"}, {"orbit", "limb"}, {"alien", "horizon"}},
      .window = open_window_system,
      .still_passes = {"march", "histogram", "exposure", "display"},
      .extra_bytes = (2 << 20) + (64 << 10),
      .effects = {air(), transmittance_table(), table_march(), exposure(), display()},
      .probe = probe_table_march};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
