// Chapter 16, noise: the textures clouds are made of, made once, kept on disk, and looked at.
#include "chapters/02_window/window.hpp"
#include "chapters/16_noise/noise.hpp"
#include "chapters/16_noise/viewer.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 16,
      .name = "16_noise",
      .title = "Noise",
      .whats_new = "Perlin, Worley, alligator and curl noise in textures that tile, the same bits on every device.",
      .try_next = "./welkin run 16 --set noise.show=base --set noise.tiles=2",
      .display = app::Display::raw,
      .images = {},
      .reference = {{"noise.base_size", "256"}, {"noise.octaves", "6"}, {"noise.format", "half"}},
      .standard_views = {{"noon", "horizon"}},
      .window = open_window_system,
      .still_passes = {"noise viewer", "display"},
      .extra_bytes = 24 << 20,
      .effects = {noise_textures(), weather_texture(), alligator_texture(), noise_viewer()}};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
