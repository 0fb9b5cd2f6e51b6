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
#include "common/app/program.hpp"
#include "common/graph/composition.hpp"

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
  // What a still frame of scene noon may cost at 320x180: these passes, and so many bytes beside its two pictures.
  std::vector<std::string> still_passes;
  uint64_t extra_bytes = 64 << 10;
  std::vector<Effect> effects;                                   // of a frame, in order; their knobs are the chapter's
  ProbeFunction probe;                                           // radiance along rays, beside effects
  std::function<std::unique_ptr<Program>(const Context&)> make;  // instead of effects: a program of its own
};

// Whether its pictures go through a light meter: the scene's exposure can then be automatic.
bool has_meter(const Chapter& chapter);

// The chapter's program: a composition of its effects, or its own.
std::unique_ptr<Program> make_program(const Chapter& chapter, const Context& context);

// main() of every chapter: command line, device, and whichever of picture, window or instrument was asked for.
int run(int argc, char** argv, Chapter chapter);

}  // namespace welkin::app
