// Chapter 02's window: GLFW, input, and the loop that draws frames until it is closed. Every later chapter uses it by
// `.window = open_window_system` in its app::Chapter.
#pragma once

#include "common/app/chapter.hpp"

namespace welkin {

// Initialises GLFW. Throws Error if the display that was announced cannot be opened.
std::unique_ptr<app::WindowSystem> open_window_system();

}  // namespace welkin
