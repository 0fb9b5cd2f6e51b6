// What chapter 11 is measured against: the path tracer of chapter 07, whose rays end on the terrain and on the signs.
//
// The terrain comes from the same maps and the same noise. The light comes from the path tracer alone, without froxels,
// tables or an estimate of what lights a slope. Two limits: light that has met the terrain continues over the smooth
// planet, and mountains do not block sunlight, so compare with terrain.shadows = false.
#pragma once

#include "common/app/chapter.hpp"

namespace welkin {

// For Chapter::truth: 2048 paths per pixel. A scene without terrain gets chapter 07's program.
app::Truth terrain_truth();

}  // namespace welkin
