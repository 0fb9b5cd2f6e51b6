// The march against a bare loop of the same arithmetic (shaders/05_yardstick.comp), in turns on the same device, best
// of several: how much being readable and adjustable costs. And that a frame makes nothing it did not have.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "chapters/05_single_scattering/single_scattering.hpp"
#include "common/app/renderer.hpp"
#include "common/app/session.hpp"
#include "common/graph/composition.hpp"
#include "common/scene/scene_knobs.hpp"
#include "tests/gpu/harness.hpp"

namespace welkin::test {
thread_local long heap_allocations = 0;  // 08_graph_test.cpp asks, too: a program has one operator new
}
using welkin::test::heap_allocations;

// Counted on the thread that asks: a software driver compiles and draws on threads of its own.
void* operator new(std::size_t bytes) {
  ++heap_allocations;
  if (void* memory = std::malloc(bytes == 0 ? 1 : bytes); memory != nullptr) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

using namespace welkin;

// The bare loop as a program of its own.
struct Yardstick : app::Program {
  const gpu::Device& device;
  gpu::ComputePipeline pipeline;
  gpu::DescriptorSet set;
  explicit Yardstick(const app::Context& context)
      : device(context.device),
        pipeline(gpu::create_compute_pipeline(device, "tests/05_yardstick.comp", {{0}}, sizeof(CameraRays))),
        set(gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings)) {}
  void set_target(const gpu::Image& target) override { gpu::write_storage_image(device, set, 0, target); }
  void draw(const app::Frame& frame) override {
    gpu::image_barrier(frame.commands, frame.target.handle, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT},
                       gpu::kComputeWrite);
    const gpu::TimedPass pass(frame.timer, frame.commands, "yardstick");
    gpu::dispatch_over(frame.commands, pipeline, set, frame.camera, frame.target.size);
  }
  void rebuild() override {}
};

struct World {
  Scene scene = load_scene("noon", app::scenes_directory());
  Settings settings = [this] {
    std::vector<Knob> knobs = march_knobs();
    for (Knob& knob : scene_knobs(scene)) knobs.push_back(knob);
    Settings all(knobs);
    all.set("rule", "midpoint");
    return all;
  }();
  std::string no_fault;
  app::Context context{test::device(), scene, settings, no_fault};
  app::Chapter chapter;
  app::CameraPose pose = app::pose_of(scene.view("horizon"), scene.planet.ground_radius_km);
};

}  // namespace

TEST_CASE("speed: the march stays within 1.3 of the bare loop") {
  World world;
  world.scene.sun.disc = false;
  app::Composition march(world.context, {air(), single_scattering()});
  Yardstick bare(world.context);
  constexpr VkExtent2D size{640, 360};
  app::Renderer march_renderer(world.context, world.chapter, march, size),
      bare_renderer(world.context, world.chapter, bare, size);
  double best_march = 1e30, best_bare = 1e30;
  for (uint32_t i = 0; i < 9; ++i) {  // the first of each compiles
    march_renderer.draw(world.pose, 0.0, 1, i);
    best_march = std::min(best_march, march_renderer.pass_times().front().milliseconds);
    bare_renderer.draw(world.pose, 0.0, 1, i);
    best_bare = std::min(best_bare, bare_renderer.pass_times().front().milliseconds);
  }
  // The yardstick measures the same work only if it draws the same picture.
  const Image ours = march_renderer.picture(), theirs = bare_renderer.picture();
  double worst = 0.0;
  for (size_t i = 0; i < ours.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, double(std::abs(ours.pixels[i][c] - theirs.pixels[i][c]) / theirs.pixels[i][c]));
  CHECK(worst < 2e-3);
  WARN("640x360, 32x8 midpoint on " << test::device().candidate().name << ": march " << best_march << " ms, bare loop "
                                    << best_bare << " ms, ratio " << best_march / best_bare);
  CHECK(best_march < 1.3 * best_bare);
}

TEST_CASE("speed: no allocation by a frame after the first") {
  World world;
  app::Composition march(world.context, {air(), single_scattering()});
  app::Renderer renderer(world.context, world.chapter, march, {64, 36});
  renderer.draw(world.pose, 0.0, 1, 0);
  renderer.draw(world.pose, 0.0, 1, 1);
  const uint64_t device_before = test::device().allocation_count();
  const long heap_before = heap_allocations;
  renderer.draw(world.pose, 0.0, 1, 2);
  const long heap_by_frame = heap_allocations - heap_before;
  CHECK(test::device().allocation_count() == device_before);
  CHECK(heap_by_frame == 0);
}
