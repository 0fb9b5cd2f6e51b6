// Chapter 07's program: a path tracer for pictures that accumulate and for single rays. Later chapters measure
// themselves against it: path_truth().
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "chapters/04_air/air_block.hpp"
#include "common/app/chapter.hpp"

namespace welkin {

// The chapter's knobs: samples, orders, tracking, spectral, target.standard_error, probe.samples.
std::vector<Knob> path_knobs();

// What a later chapter is measured against: 2048 paths per pixel.
app::Truth path_truth();

// The path tracer as an effect; it makes the frame's first picture.
app::Effect paths();
// FirstSurfaces (below) as images of a frame's graph.
struct SurfaceImages {
  graph::Resource normals, albedos;
};
// For the declaration of such an effect: adds the pass that draws the picture, with barriers and timestamps of its own.
// Where `surfaces` are given, the rays from the eye end on them.
void add_paths(app::Builder& builder, app::Board& board, const std::string& pass,
               const std::optional<SurfaceImages>& surfaces = {});
std::vector<app::ProbeResult> probe_paths(const app::Context& context, std::span<const app::ProbeRay> rays);

// How many batches a number of samples is cut into, and how many samples each has: few enough that no invocation's
// loops come near the iterations a software driver allows.
struct Batches {
  int count = 1;
  int samples = 1;
};
Batches batches_of(int samples, int tracking);

// What rays from the eye meet before the smooth planet, pixel by pixel: rgba32f storage images of the picture's size in
// layout GENERAL, whose writes are visible to compute when draw() is called. They must outlive what is drawn with them.
struct FirstSurfaces {
  const gpu::Image* normals = nullptr;  // unit, in the eye's local frame; w: distance along the ray in km, 0: none
  const gpu::Image* albedos = nullptr;  // of a Lambert surface, per channel
};

class GroundTruth : public app::Program {
 public:
  // With `surfaces`, set_surfaces() must be called before the first draw and whenever the images are made anew. Their
  // contents may change only when the camera does, which restarts the picture.
  explicit GroundTruth(const app::Context& context, bool surfaces = false);
  void set_surfaces(const FirstSurfaces& surfaces);
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override;
  std::string explain() const override;

 private:
  // Everything a picture depends on. When it changes, the accumulation starts again.
  struct Subject {
    CameraRays camera;
    interop::Atmosphere air;
    std::vector<double> settings;
  };
  gpu::Specialization variant() const;
  void update_air(VkCommandBuffer commands) const;
  bool changed(const app::Frame& frame);
  double relative_error() const;  // of the picture so far; 0 while it is not known

  const app::Context context_;
  const bool surfaces_;
  gpu::Buffer air_;                  // the uniform block of the atmosphere
  gpu::Buffer unfinished_;           // one counter
  std::array<gpu::Buffer, 2> sums_;  // read one, write the other
  gpu::Buffer groups_;               // standard error and luminance per workgroup, read by the host a frame later
  gpu::ComputePipeline trace_, resolve_;
  std::array<gpu::DescriptorSet, 2> trace_sets_, resolve_sets_;  // [i]: reads sums_[i]
  Subject subject_;
  VkExtent2D size_{};
  int newest_ = 0;   // index of the newest of sums_
  int batches_ = 0;  // summed up in it
  int64_t samples_ = 0;
  int accumulation_ = 0;  // number of restarts
  bool done_ = false;
};

}  // namespace welkin
