// The pieces a compute pass is made of. See first_light.hpp and docs/chapters/01_first_light.md.
#include "chapters/01_first_light/first_light.hpp"

namespace welkin {
namespace {

struct Push {
  int32_t width, height;
};

}  // namespace

// [make]
FirstLight::FirstLight(const app::Context& context) : context_(context) { rebuild(); }

void FirstLight::rebuild() {
  // What the shader names: binding 0 is a storage image, and 8 bytes of push constants are the size.
  pipeline_ = gpu::create_compute_pipeline(context_.device, "01_first_light/first_light.comp",
                                           {{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}, sizeof(Push));
  if (set_.handle == VK_NULL_HANDLE)
    set_ = gpu::create_descriptor_set(context_.device, pipeline_.set_layout, pipeline_.bindings);
}

void FirstLight::set_target(const gpu::Image& target) {
  gpu::write_storage_image(context_.device, set_, 0, target);  // binding 0 of the set is this image from now on
}
// [/make]

// [draw]
void FirstLight::draw(const app::Frame& frame) {
  // The image's old content is of no use, so its layout before may be UNDEFINED. But the display pass of an earlier
  // frame may still be reading it: its stage stands on the "before" side, and our write on the "after" side waits for
  // it.
  constexpr gpu::Use earlier_read{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT};
  gpu::image_barrier(frame.commands, frame.target.handle, earlier_read, gpu::kComputeWrite);

  const gpu::TimedPass pass(frame.timer, frame.commands, "first light");
  const Push push{static_cast<int32_t>(frame.target.size.width), static_cast<int32_t>(frame.target.size.height)};
  gpu::dispatch_over(frame.commands, pipeline_, set_, push, frame.target.size);
}
// [/draw]

}  // namespace welkin
