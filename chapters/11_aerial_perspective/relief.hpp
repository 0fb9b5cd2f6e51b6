// The terrain as effects: its maps and the pass that finds where each pixel's ray meets it; and the pass that finds its
// shadows.
//
// Rays walk over the height map itself, and a tree of maxima lets them skip what they fly over. There is no mesh, which
// would lie a little above or below the map. From a pixel's distance the compose pass computes its place; everything
// else it looks up in the maps.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "chapters/11_aerial_perspective/terrain_map.hpp"
#include "common/graph/effect.hpp"

namespace welkin {

std::vector<Knob> terrain_knobs();  // terrain.detail, .edges, .shadow_size

// On the board where the scene has terrain: heights in km, the tree of their maxima, slopes, cover; and for each pixel
// the distance to the terrain in km, as terrain.comp writes it.
struct TerrainMaps {
  graph::Resource heights, maxima, slopes, cover, distance;
  int levels = 0;  // of the tree
  std::shared_ptr<const TerrainMap> map;
};

// On the board where the terrain casts shadows, for every place of the map, in km: the altitude from which the sun's
// centre is seen, the altitude over which its radius rises (half the penumbra), and the height of the ground.
struct TerrainShadows {
  graph::Resource image;
};

// Pass "terrain", and the camera lifted out of the ground.
app::Effect terrain();
// Pass "terrain shadows": runs when the sun has moved.
app::Effect terrain_shadows();

// Makes an image that passes sample and fills it with rows of texels, once, before any frame. 3-D if depth is above 0.
gpu::Image filled_image(const gpu::Device& device, const char* name, VkFormat format, VkExtent2D size, uint32_t depth,
                        std::span<const std::byte> texels);

// Tells whether a frame's view differs from the one noted last. Time and frame number do not count.
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
