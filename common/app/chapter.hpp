// What a chapter is to the framework: facts about itself, knobs, and a program that records its passes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/app/camera.hpp"
#include "common/gpu/commands.hpp"
#include "common/gpu/pipeline.hpp"
#include "common/gpu/timer.hpp"
#include "common/knobs.hpp"
#include "common/scene/scene.hpp"

namespace welkin::app {

// How a picture becomes 8 bits until chapter 06 teaches it: values as they are, or 1 - exp(-exposure L) and sRGB.
enum class Display { raw, exposed };

// A picture a chapter is measured and tested by: a view, or frame `frame` of a path that is drawn in `frames` frames,
// after all those before it.
struct StandardView {
  std::string scene;
  std::string view;  // or the path
  uint32_t frame = 0, frames = 0;
};

// What a program may use for as long as it lives. Scene and settings change under it between frames.
struct Context {
  const gpu::Device& device;
  const Scene& scene;
  const Settings& settings;
  const std::string& inject;  // --inject FAULT
};

// What a program gets for one frame.
struct Frame {
  VkCommandBuffer commands;
  const gpu::Image& target;  // rgba32f storage image; draw() writes all of it and leaves it in layout GENERAL
  const CameraRays& camera;
  gpu::Timer& timer;
  uint32_t index;
  uint32_t seed;
  double seconds;               // since the frame before; 0 for the first
  glm::dvec3 position_km{0.0};  // of the camera, in the global frame of camera.hpp
};

// A ray of --probe, in degrees as in the file; relative azimuth 0 looks towards the sun.
struct ProbeRay {
  double altitude_km, view_zenith_deg, sun_zenith_deg, relative_azimuth_deg;
};
struct ProbeResult {
  glm::dvec3 radiance, transmittance;
  glm::dvec3 standard_error{0.0};  // of the radiance, where the chapter is stochastic
};

// A running chapter.
struct Program {
  virtual ~Program() = default;
  // The image draw() writes: called before the first draw and after every resize, when no frame is in flight.
  virtual void set_target(const gpu::Image& target) = 0;
  // Records the passes of one frame, each timed, with their barriers.
  virtual void draw(const Frame& frame) = 0;
  // Makes the pipelines anew: a knob marked `rebuilds` changed, or a shader was recompiled. No frame is in flight.
  virtual void rebuild() = 0;
  // Radiance and transmittance along rays, in the order given. Chapters without a sky have none.
  virtual std::vector<ProbeResult> probe(std::span<const ProbeRay> rays);
  // What --explain prints beside passes and bytes: whole lines, or nothing.
  virtual std::string explain() const { return {}; }
  // An intermediate image for --dump: rgba32f or rgba16f, 2-D, left in layout GENERAL. nullptr: there is none of this
  // name.
  virtual const gpu::Image* image(const std::string& name) const;
};

// Turns the linear picture into 8 bits. The framework's own shows values raw or exposed, until chapter 06 teaches
// better.
struct DisplaySystem {
  virtual ~DisplaySystem() = default;
  // Before the first draw and after every resize, when no frame is in flight. Both are storage images in layout
  // GENERAL.
  virtual void set_images(const gpu::Image& picture, const gpu::Image& displayed) = 0;
  // Records its timed passes. The picture may be read, and `displayed` written, by compute without a barrier.
  virtual void draw(const Frame& frame) = 0;
  virtual void rebuild() = 0;                         // as Program::rebuild
  virtual std::string explain() const { return {}; }  // as Program::explain
};

// An unbiased method of a lower chapter that a method is measured against, with knobs of its own.
struct Truth {
  std::vector<Knob> knobs;
  std::vector<std::pair<std::string, std::string>> settings;
  std::function<std::unique_ptr<Program>(const Context&)> make;
  uint32_t frames = 1;  // it accumulates over this many
};

struct Session;

// A way to show frames, made before the Vulkan instance and destroyed after it. Chapter 02 makes the one there is.
struct WindowSystem {
  virtual ~WindowSystem() = default;
  virtual std::vector<const char*> vulkan_extensions() const = 0;  // what surfaces need of the instance
  virtual Exit show(Session& session) = 0;                         // until the window is closed
};

struct Chapter {
  int number = 0;
  std::string name;       // "05_single_scattering"
  std::string title;      // "Single scattering"
  std::string whats_new;  // one line for --help and the panel
  std::string try_next;   // a command worth typing after the first picture
  Display display = Display::exposed;
  bool sky = false;                 // has scene knobs (mie.g, sun.zenith_deg, …)
  bool stochastic = false;          // a probe's radiance has a standard error
  std::vector<std::string> images;  // names Program::image knows
  std::vector<Knob> knobs;
  std::vector<std::pair<std::string, std::string>> reference;  // knob values the sweep's reference is drawn with
  std::optional<Truth> truth;                                  // what a window measures its view against
  std::string default_scene = "noon";
  std::vector<StandardView> standard_views;
  std::function<std::unique_ptr<WindowSystem>()> window;  // none: the chapter draws into files only
  std::function<std::unique_ptr<Program>(const Context&)> make;
  std::function<std::unique_ptr<DisplaySystem>(const Context&)> make_display;  // none: as `display` says
};

// main() of every chapter: command line, device, and whichever of picture, window or instrument was asked for.
int run(int argc, char** argv, const Chapter& chapter);

}  // namespace welkin::app
