// Chapter 05's effect: the ray march that draws the picture, and the same march for single rays.
#pragma once

#include <vector>

#include "chapters/04_air/air_block.hpp"

namespace welkin {

inline constexpr int kRuleAdapted = 5;  // of the choices of the knob `rule`: the one later chapters march by

// The chapter's knobs: view.steps, light.steps, rule.
std::vector<Knob> march_knobs();
// The one of this name, as a later chapter takes it over.
Knob march_knob(const std::string& name);

// Pass "march": a picture of the sky by single scattering, the sun's disc behind the air.
app::Effect single_scattering();

// --probe by the same march.
std::vector<app::ProbeResult> probe_single_scattering(const app::Context& context, std::span<const app::ProbeRay> rays);

// Push constants of chapter 05's image.comp.
struct MarchPush {
  CameraRays camera;
  int32_t view_steps, unused[3];
};

}  // namespace welkin
