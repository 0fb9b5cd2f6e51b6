// Chapter 16's picture: slices of the textures, alone or all on one sheet, tiled, with their histogram.
#pragma once

#include <vector>

#include "common/graph/effect.hpp"

namespace welkin {

std::vector<Knob> viewer_knobs();  // noise.show, .channel, .slice, .tiles, .level, .histogram, .mip

// Pass "noise viewer", and pass "noise histogram" where one is shown. The picture is for a display that shows values as
// they are.
app::Effect noise_viewer();

}  // namespace welkin
