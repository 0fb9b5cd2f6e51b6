// The panel: scene, knobs, time per pass, memory. Dear ImGui is in panel.cpp (its set-up) and panel_layout.cpp (what is
// shown) and nowhere else.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "chapters/02_window/swapchain.hpp"
#include "common/app/camera.hpp"
#include "common/app/chapter.hpp"

struct GLFWwindow;

namespace welkin {

using app::CameraPose;
using app::Chapter;

// What the panel shows and what the user did with it.
struct PanelState {
  bool visible = true;
  bool flying = false;
  std::vector<int> keys;              // whose buttons were pressed since the last frame
  std::string scene_asked;            // a shipped scene that was chosen since the last frame
  std::string view_asked;             // a view of the scene, likewise
  std::string view_now;               // the view that was chosen last
  float width = 0.0f, height = 0.0f;  // of the panel, in pixels; 0: not yet shown
  std::string message;                // shader error, "saved …": shown until the next
  std::vector<gpu::PassTime> times;   // of the last finished frame
  std::vector<std::string> changed;   // knobs changed since the last frame
};

class Panel {
 public:
  // The library and the window outlive the panel. Needs a render pass (Dear ImGui 1.86 knows no dynamic rendering).
  Panel(GLFWwindow* window, const gpu::Instance& instance, const gpu::Device& device, const WindowSwapchain& swapchain);
  ~Panel();
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;

  void swapchain_changed(const WindowSwapchain& swapchain);
  bool wants_mouse() const;
  bool wants_keyboard() const;

  // Lays the panel out; may change settings (recording names in state.changed) and the scene's time.
  void layout(const Chapter& chapter, Scene& scene, Settings& settings, const gpu::Device& device,
              const CameraPose& pose, PanelState& state);
  // Draws over the image, which is in COLOR_ATTACHMENT_OPTIMAL and ends in PRESENT_SRC.
  void record(VkCommandBuffer commands, uint32_t image_index);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace welkin
