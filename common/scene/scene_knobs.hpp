// The fields of a scene that can be set from the command line or the panel, as knobs. The scene owns the values: a knob
// is another way to write its field, and programs read the scene.
#pragma once

#include "common/knobs.hpp"
#include "common/scene/scene.hpp"

namespace welkin {

// Knobs for what the scene contains (no mie.* without a Mie medium), each with the scene's value as default;
// those of a light meter only where there is one.
std::vector<Knob> scene_knobs(const Scene& scene, bool metered = true);

// Writes the knobs that were set explicitly into the scene. Setting exposure.ev sets the exposure by hand.
void apply_scene_knobs(const Settings& settings, Scene& scene);

}  // namespace welkin
