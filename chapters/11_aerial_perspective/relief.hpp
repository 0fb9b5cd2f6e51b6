// The terrain as effects: its maps and the pass that finds where each pixel's ray meets it; and the pass that finds its
// shadows.
//
// The height map is walked over as it is, with a tree of maxima to pass what a ray flies over: there is no mesh that
// would be a little higher or lower than the map. From the distance the compose pass knows where a pixel lies, and all
// else is a look-up in the maps.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "chapters/11_aerial_perspective/terrain_map.hpp"
#include "common/graph/effect.hpp"

namespace welkin {

std::vector<Knob> terrain_knobs();  // terrain.detail, .edges, .shadow_size

// On the board where the scene has terrain: heights in km, the tree of their maxima, slopes, cover, each a square map;
// and for the picture's pixels how far away the terrain is, km, as terrain.comp writes it.
struct TerrainMaps {
  graph::Resource heights, maxima, slopes, cover, distance;
  int levels = 0;  // of the tree
  std::shared_ptr<const TerrainMap> map;
};

// On the board where terrain keeps the sun from itself: from which altitude on the sun is seen, how wide the half
// shadow is, and how high the ground.
struct TerrainShadows {
  graph::Resource image;
};

// Pass "terrain", and the camera lifted out of the ground.
app::Effect terrain();
// Pass "terrain shadows": when the sun has moved.
app::Effect terrain_shadows();

// Makes an image that passes sample and fills it with rows of texels, once, before any frame.
gpu::Image uploaded_map(const gpu::Device& device, const char* name, VkFormat format, VkExtent2D size,
                        std::span<const std::byte> texels);

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
