// Draws frames of a chapter without a window: the target, the display pass, timestamps and readback. The window uses
// the same recording, so that both show the same bits.
#pragma once

#include <memory>

#include "common/app/chapter.hpp"
#include "common/image/image.hpp"

namespace welkin::app {

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

// A program and what turns its picture into 8 bits: its own display, or the framework's (shaders/app/display.comp),
// which shows values raw or exposed until chapter 06 teaches better. For a window and for files the same.
class Drawing {
 public:
  Drawing(const Context& context, const Chapter& chapter, Program& program);
  ~Drawing();
  // Before the first frame and after every resize, when no frame is in flight. They keep their address.
  void set_targets(const Targets& targets);
  // Whether scene or settings want something built anew; follow() does, when no frame is in flight.
  bool stale();
  void follow();
  void reload();  // shaders were compiled anew
  // Records a whole frame: the chapter's passes into targets.picture, then the display into targets.displayed. Both end
  // in layout GENERAL.
  void record(const Frame& frame);

 private:
  class PlainDisplay;

  Context context_;
  Program& program_;
  Display mode_;
  std::unique_ptr<PlainDisplay> display_;  // none: the program has its own
  const Targets* targets_ = nullptr;
  std::vector<double> compiled_;  // values of the knobs it was built for
};

class Renderer {
 public:
  Renderer(const Context& context, const Chapter& chapter, Program& program, VkExtent2D size);

  // Draws one frame and waits for it. Scene and settings are followed. Frame 0 begins anew: nothing is remembered.
  void draw(const CameraPose& pose, double time_s, uint32_t seed, uint32_t index,
            double seconds = kHeadlessFrameSeconds);

  double record_ms() const { return record_ms_; }  // what the CPU took to record the last frame
  std::vector<gpu::PassTime> pass_times() { return timer_.read(); }
  Image picture();  // linear, with the fault --inject nan planted if asked
  Image8 displayed();
  VkExtent2D size() const { return targets_.picture.size; }

 private:
  Context context_;
  gpu::CommandPool pool_;
  VkCommandBuffer commands_;
  gpu::Timer timer_;
  Targets targets_;
  Drawing drawing_;  // into targets_
  double record_ms_ = 0.0;
};

// Reads back an rgba32f (or rgba16f) or rgba8 image that compute wrote last (layout GENERAL before and after).
Image read_picture(const gpu::Device& device, VkCommandPool pool, const gpu::Image& image);
Image8 read_displayed(const gpu::Device& device, VkCommandPool pool, const gpu::Image& image);

}  // namespace welkin::app
