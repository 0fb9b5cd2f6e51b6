// Chapter 07's program: a path tracer for pictures that accumulate and for single rays. Later chapters measure
// themselves against it: path_truth().
#pragma once

#include <array>
#include <vector>

#include "chapters/04_air/air_block.hpp"
#include "common/app/chapter.hpp"

namespace welkin {

// The chapter's knobs: samples, orders, tracking, spectral, target.standard_error, probe.samples.
std::vector<Knob> path_knobs();

// What a later chapter says it is measured against: 2048 paths a pixel.
app::Truth path_truth();

// The path tracer as an effect: its picture is a frame's first.
app::Effect paths();
std::vector<app::ProbeResult> probe_paths(const app::Context& context, std::span<const app::ProbeRay> rays);

// Batches a number of samples is cut into, so that no invocation's loops come near what a software driver allows, and
// the samples of each.
struct Batches {
  int count = 1;
  int samples = 1;
};
Batches batches_of(int samples, int tracking);

// What rays from the eye meet before the smooth planet, pixel by pixel: rgba32f storage images of the picture's size in
// layout GENERAL, whose writes are visible to compute when draw() is called. They must outlive what is drawn with them.
struct FirstSurfaces {
  const gpu::Image* normals =
      nullptr;  // unit normals in the eye's local frame; w: distance along the ray in km, 0: none
  const gpu::Image* albedos = nullptr;  // share of light reflected, evenly to all sides, per channel
};

class GroundTruth : public app::Program {
 public:
  // With `surfaces`, set_surfaces() is called before the first draw and whenever the images are made anew; what is on
  // them may change only with the camera, which starts the picture again.
  explicit GroundTruth(const app::Context& context, bool surfaces = false);
  void set_surfaces(const FirstSurfaces& surfaces);
  void set_target(const gpu::Image& target) override;
  void draw(const app::Frame& frame) override;
  void rebuild() override;
  std::vector<app::ProbeResult> probe(std::span<const app::ProbeRay> rays) override;
  std::string explain() const override;

 private:
  // Everything a picture depends on: when it changes, what was accumulated is of another picture.
  struct Subject {
    CameraRays camera;
    interop::Atmosphere air;
    std::vector<double> settings;
  };
  gpu::Specialization variant() const;
  void update_air(VkCommandBuffer commands) const;
  bool changed(const app::Frame& frame);
  double relative_error() const;  // of the accumulation going on; 0 while it is not known

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
  int newest_ = 0;   // of sums_
  int batches_ = 0;  // in them
  int64_t samples_ = 0;
  int accumulation_ = 0;  // counts restarts
  bool done_ = false;
};

}  // namespace welkin
