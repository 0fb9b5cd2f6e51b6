// What chapter 11 is measured against: the path tracer of chapter 07, whose rays end on the terrain and on the signs.
//
// The terrain is where the same maps and the same noise put it; all that happens to light is the path
// tracer's: no froxels, no tables, no guess of what lights a slope. Light that has met the terrain goes on over the
// smooth planet, and no mountain stands in the way of sunlight: compare with terrain.shadows = false.
#pragma once

#include "common/app/chapter.hpp"

namespace welkin {

// For Chapter::truth: 2048 paths a pixel. A scene without terrain gets chapter 07's program.
app::Truth terrain_truth();

}  // namespace welkin
