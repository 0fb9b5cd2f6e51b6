// The terrain on the device: its maps, the pass that finds its shadows, and the pass that finds where each pixel's ray
// meets it.
//
// The height map is walked over as it is, with a tree of maxima to pass what a ray flies over: there is no mesh that
// would be a little higher or lower than the map. From the distance the compose pass knows where a pixel lies, and all
// else is a look-up in the maps.
#pragma once

#include <vector>

#include "chapters/11_aerial_perspective/terrain_map.hpp"
#include "common/graph/graph.hpp"

namespace welkin {

std::vector<Knob> terrain_knobs();  // terrain.shadow_size, .detail, .edges

// Where a frame's camera stands, and its frame of east, north and up; km, global frame. Not below `least_km` above
// ground.
struct Standpoint {
  glm::dvec3 position_km, east, north, up;
  double altitude_km;
};
Standpoint standpoint(const app::Frame& frame, double ground_radius_km);

// What a frame was seen from when a pass last ran; time and frame number do not count.
class Watch {
 public:
  bool differs(const app::Frame& frame) const;
  void note(const app::Frame& frame);

 private:
  CameraRays camera_{};
  glm::dvec3 position_km_{0.0};
  bool fresh_ = true;
};

class Relief {
 public:
  Relief(const app::Context& context, graph::Graph& graph);  // of context.scene.terrain, which there must be
  Relief(const Relief&) = delete;
  void set_size(VkExtent2D size);  // of the picture: makes the image of distances
  void rebuild();

  bool has_shadows() const { return context_.scene.terrain->shadows; }
  const TerrainMap& map() const { return map_; }
  const gpu::Image& slopes() const { return slopes_; }
  const gpu::Image& cover() const { return cover_; }
  const gpu::Image& shadows() const { return has_shadows() ? shadows_ : heights_; }
  const gpu::Image& distance() const { return distance_; }  // as terrain.comp writes it
  VkSampler sampler() const { return sampler_; }
  graph::Resource distance_resource() const { return distance_resource_; }
  graph::Resource shadow_resource() const { return shadow_resource_; }  // only with shadows

 private:
  void make_shadow_image();
  glm::dvec3 sun_of(const app::Frame& frame) const;
  void draw_shadows(const app::Frame& frame);
  void find_distances(const app::Frame& frame) const;

  const app::Context context_;
  graph::Graph& graph_;
  TerrainMap map_;
  HeightMaxima maxima_;  // its size; what it held is on the device
  gpu::Sampler sampler_;
  gpu::Image heights_, height_maxima_, slopes_, cover_, shadows_, distance_;
  graph::Resource distance_resource_ = 0, shadow_resource_ = 0;
  glm::dvec3 shadowed_from_{0.0};  // the sun the shadow map was made for
  Watch watch_;
  gpu::DescriptorSet distance_set_, shadow_set_;
  gpu::ComputePipeline distance_pipeline_, shadow_pipeline_;
};

// The camera of a frame, lifted out of the ground. Straight up: directions stay what they are.
struct Lifted {
  CameraRays camera;
  glm::dvec3 position_km;
};
Lifted lifted(const app::Frame& frame, const TerrainMap& map, double ground_radius_km);

}  // namespace welkin
