// Chapter 07, ground truth: light followed along random paths, all orders of scattering, nothing approximated but the
// number of paths. Every later method is measured against it.
#include "chapters/02_window/window.hpp"
#include "chapters/06_display/display.hpp"
#include "chapters/07_ground_truth/ground_truth.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 7,
      .name = "07_ground_truth",
      .title = "Ground truth",
      .whats_new = "Random paths through the air, as many scatterings as it takes: right, and slow.",
      .try_next = "./welkin run 07 --scene sunset --frames 64   (or: --set orders=1, and watch the sky grow dark)",
      .sky = true,
      .stochastic = true,
      .reference = {{"samples", "4096"}, {"orders", "0"}, {"tracking", "closed_form"}, {"spectral", "hero"}},
      .standard_views =
          {{"noon", "horizon"}, {"sunset", "sun"}, {"twilight", "glow"}, {"orbit", "limb"}, {"alien", "horizon"}},
      .window = open_window_system,
      .still_passes = {"trace", "resolve", "histogram", "exposure", "display"},
      .extra_bytes = 320 * 180 * 64 + (64 << 10),
      .effects = {paths(), exposure(), display()},
      .probe = probe_paths};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
