// The window library (GLFW). Headless runs never construct it, so GLFW is never initialised there.
#pragma once

#include <vector>

namespace welkin::app {

// Initialised first and terminated last: it outlives the instance and everything made from it.
class WindowLibrary {
 public:
  WindowLibrary();  // throws Error if the display that was announced cannot be opened
  ~WindowLibrary();
  WindowLibrary(const WindowLibrary&) = delete;
  WindowLibrary& operator=(const WindowLibrary&) = delete;
  std::vector<const char*> vulkan_extensions() const;  // what surfaces need
};

}  // namespace welkin::app
