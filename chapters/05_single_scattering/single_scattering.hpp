// Chapter 05's effect: the ray march that draws the picture, and the same march for single rays.
#pragma once

#include <vector>

#include "chapters/04_air/air_block.hpp"

namespace welkin {

inline constexpr int kRuleAdapted = 5;  // index in the choices of the knob `rule`; later chapters use this rule

// The chapter's knobs: view.steps, light.steps, rule.
std::vector<Knob> march_knobs();
// One of them by name, for a later chapter that has the same knob.
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

// And of its probe.comp; count: of rays.
struct MarchProbePush {
  int32_t view_steps, count, unused[2];
};

}  // namespace welkin
