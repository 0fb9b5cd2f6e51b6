// The terrain as effects: its maps and the pass that draws its mesh into a depth image; and the pass that finds its
// shadows.
//
// Nothing but depth is drawn: from it the compose pass knows where a pixel lies, and all else is a look-up in the maps.
// The mesh is rings of square cells around the camera, each ring with cells twice as large as the one inside it.
#pragma once

#include <memory>
#include <vector>

#include "chapters/11_aerial_perspective/terrain_map.hpp"
#include "common/graph/effect.hpp"

namespace welkin {

inline constexpr double kNear_km = 1e-4;  // of the reversed depth

std::vector<Knob> terrain_knobs();  // terrain.cells, terrain.shadow_size

// On the board where the scene has terrain: heights in km, slopes, cover, each a square map; and the depth of the
// picture's pixels, reversed, 0 where there is none.
struct TerrainMaps {
  graph::Resource heights, slopes, cover, depth;
  std::shared_ptr<const TerrainMap> map;
};

// On the board where terrain keeps the sun from itself: from which altitude on the sun is seen, and how wide the half
// shadow is.
struct TerrainShadows {
  graph::Resource image;
};

// Pass "terrain", and the camera lifted out of the ground.
app::Effect terrain();
// Pass "terrain shadows": when the sun has moved.
app::Effect terrain_shadows();

// Whether a frame is seen from elsewhere than one noted before; time and frame number do not count.
class ViewChange {
 public:
  bool differs(const app::Frame& frame) const;
  void note(const app::Frame& frame);

 private:
  CameraRays camera_{};
  glm::dvec3 position_km_{0.0};
  bool fresh_ = true;
};

}  // namespace welkin
