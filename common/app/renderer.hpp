// Draws frames of a chapter without a window: the target, the display pass, timestamps and readback. The window uses
// the same recording, so that both show the same bits.
#pragma once

#include <memory>

#include "common/app/chapter.hpp"
#include "common/image/image.hpp"

namespace welkin::app {

// The chapter's way to 8 bits, or the framework's. See shaders/app/display.comp.
std::unique_ptr<DisplaySystem> make_display_system(const Context& context, const Chapter& chapter);

// Exposure factor at 0 stops: a clear noon sky of about 0.03 per unit solar irradiance comes out at middle grey and
// above.
inline constexpr double kBaseExposure = 24.0;

// A file has no clock: what lies between two frames unless something says otherwise.
inline constexpr double kHeadlessFrameSeconds = 1.0 / 60.0;

// The images a frame is drawn into.
struct Targets {
  gpu::Image picture;    // rgba32f, linear
  gpu::Image displayed;  // rgba8
};
Targets create_targets(const gpu::Device& device, VkExtent2D size);

// Records a whole frame: the chapter's passes into targets.picture, then the display pass into targets.displayed. Both
// end in layout GENERAL, last written or read by compute.
void record_frame(const Context& context, Program& program, DisplaySystem& display, const Targets& targets,
                  const Frame& frame);

class Renderer {
 public:
  Renderer(const Context& context, const Chapter& chapter, Program& program, VkExtent2D size);

  // Draws one frame and waits for it.
  void draw(const CameraPose& pose, double time_s, uint32_t seed, uint32_t index,
            double seconds = kHeadlessFrameSeconds);

  std::vector<gpu::PassTime> pass_times() { return timer_.read(); }
  Image picture();  // linear, with the fault --inject nan planted if asked
  Image8 displayed();
  VkExtent2D size() const { return targets_.picture.size; }
  const gpu::Image& target() const { return targets_.picture; }
  std::string explain_display() const { return display_->explain(); }
  void rebuild() {
    program_.rebuild();
    display_->rebuild();
  }

 private:
  Context context_;
  Program& program_;
  gpu::CommandPool pool_;
  VkCommandBuffer commands_;
  gpu::Timer timer_;
  std::unique_ptr<DisplaySystem> display_;
  Targets targets_;
};

// Reads back an rgba32f (or rgba16f) or rgba8 image that compute wrote last (layout GENERAL before and after).
Image read_picture(const gpu::Device& device, VkCommandPool pool, const gpu::Image& image);
Image8 read_displayed(const gpu::Device& device, VkCommandPool pool, const gpu::Image& image);

}  // namespace welkin::app
