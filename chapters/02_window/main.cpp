// Chapter 02, a window: the same image as chapter 01, bit for bit, on screen: surface, swapchain, frames in flight,
// input, panel, shader reload and pictures that restore.
#include "chapters/01_first_light/first_light.hpp"
#include "chapters/02_window/window.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 2,
      .name = "02_window",
      .title = "A window",
      .whats_new = "The image of chapter 01 on screen: swapchain, frames in flight, panel, shader reload.",
      .try_next = "./welkin run 03   (a planet)",
      .display = app::Display::raw,
      .standard_views = {{"noon", "horizon"}},
      .window = open_window_system,
      .still_passes = {"first light", "display"},
      .make = [](const app::Context& context) { return std::make_unique<FirstLight>(context); }};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
