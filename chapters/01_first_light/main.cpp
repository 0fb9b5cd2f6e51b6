// Chapter 01, first light: the smallest honest compute program. A device, an image, a shader that writes it, a barrier,
// and the pixels back in memory and on disk. No window.
#include "chapters/01_first_light/first_light.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{.number = 1,
                             .name = "01_first_light",
                             .title = "First light",
                             .whats_new = "A compute shader writes an image; the image comes back and becomes a file.",
                             .try_next = "./welkin run 02   (the same image in a window)",
                             .display = app::Display::raw,
                             .standard_views = {{"noon", "horizon"}},
                             .still_passes = {"first light", "display"},
                             .make = [](const app::Context& context) { return std::make_unique<FirstLight>(context); }};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
