// A camera's path: from views passed at given times to the view at any time.
#pragma once

#include <optional>

#include "common/scene/scene.hpp"

namespace welkin {

struct PathPoint {
  View view;
  double moment_s;  // the scene's time then
};

// Of a path of the scene, at a time clamped to the path's. Every number runs smoothly (its rate does not jump, it
// starts and ends at rest) and never beyond the two views it is between, so that no camera dips below the ground;
// altitude runs in the logarithm of its height above -1 m, azimuths the shorter way. At the time of a view it is that
// view.
PathPoint point_on(const Scene& scene, const Path& path, double time_s);

}  // namespace welkin
