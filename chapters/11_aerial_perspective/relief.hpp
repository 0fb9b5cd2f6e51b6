// The terrain on the device: its maps, the pass that finds its shadows, and the pass that draws its mesh into a depth
// image.
//
// Nothing but depth is drawn: from it the compose pass knows where a pixel lies, and all else is a look-up in the maps.
// The mesh is rings of square cells around the camera, each ring with cells twice as large as the one inside it.
#pragma once

#include <vector>

#include "chapters/11_aerial_perspective/terrain_map.hpp"
#include "common/graph/graph.hpp"

namespace welkin {

inline constexpr double kNear_km = 1e-4;  // of the reversed depth

std::vector<Knob> terrain_knobs();  // terrain.cells, terrain.shadow_size

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
  void set_size(VkExtent2D size);  // of the picture: makes the depth image
  void rebuild();

  bool has_shadows() const { return context_.scene.terrain->shadows; }
  const TerrainMap& map() const { return map_; }
  const gpu::Image& slopes() const { return slopes_; }
  const gpu::Image& cover() const { return cover_; }
  const gpu::Image& shadows() const { return has_shadows() ? shadows_ : heights_; }
  const gpu::Image& depth() const { return depth_; }
  VkSampler sampler() const { return sampler_; }
  VkSampler depth_sampler() const { return depth_sampler_; }
  graph::Resource depth_resource() const { return depth_resource_; }
  graph::Resource shadow_resource() const { return shadow_resource_; }  // only with shadows

 private:
  void make_mesh(int cells);
  void make_mesh_pipeline(int cells);
  void make_shadow_image();
  glm::dvec3 sun_of(const app::Frame& frame) const;
  void draw_shadows(const app::Frame& frame);
  void draw_mesh(const app::Frame& frame) const;

  const app::Context context_;
  graph::Graph& graph_;
  TerrainMap map_;
  gpu::Sampler sampler_, depth_sampler_;
  gpu::Image heights_, slopes_, cover_, shadows_, depth_;
  graph::Resource depth_resource_ = 0, shadow_resource_ = 0;
  glm::dvec3 shadowed_from_{0.0};  // the sun the shadow map was made for
  Watch watch_;
  int cells_ = 0;
  gpu::Buffer indices_;
  uint32_t whole_count_ = 0, ring_count_ = 0;
  gpu::SetLayout mesh_set_layout_;
  gpu::PipelineLayout mesh_layout_;
  gpu::PipelineHandle mesh_pipeline_;
  gpu::DescriptorSet mesh_set_, shadow_set_;
  gpu::ComputePipeline shadow_pipeline_;
};

// The camera of a frame, lifted out of the ground. Straight up: directions stay what they are.
struct Lifted {
  CameraRays camera;
  glm::dvec3 position_km;
};
Lifted lifted(const app::Frame& frame, const TerrainMap& map, double ground_radius_km);

}  // namespace welkin
