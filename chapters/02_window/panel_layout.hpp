// What the panel shows: the scene, this chapter's knobs, those of the effects below, times. Between Dear ImGui's
// NewFrame and Render; panel.cpp calls it.
#pragma once

#include <span>
#include <string>

#include "chapters/02_window/panel.hpp"

namespace welkin {

// What the panel only reads.
struct PanelContext {
  const Chapter& chapter;
  Scene& scene;
  const gpu::Device& device;
  const CameraPose& pose;
  std::span<const std::string> scenes;  // the shipped ones
  std::span<const float> history_ms;    // of whole frames, a ring
  size_t oldest;                        // where the ring begins
};

struct PixelSize {
  float width, height;
};

void set_style();

// Lays the panel out in a window of `size` pixels; may change settings, the time, and what state says was asked for.
void lay_out(const PanelContext& shown, PixelSize size, Settings& settings, PanelState& state);

}  // namespace welkin
