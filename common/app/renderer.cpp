// Frame recording and readback. See renderer.hpp.
#include "common/app/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

namespace welkin::app {
namespace {

struct DisplayPush {
  int32_t size[2];
  float exposure;
  int32_t mode;
};

// Copies an image into host memory and hands the bytes over.
template <typename T>
void read_back(const gpu::Device& device, VkCommandPool pool, const gpu::Image& image, std::vector<T>& out) {
  const gpu::Buffer buffer = gpu::create_buffer(device, "readback", out.size() * sizeof(T),
                                                VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Where::readback);
  gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
    gpu::image_barrier(commands, image.handle, gpu::kComputeWrite, gpu::kTransferRead);
    gpu::copy_image_to_buffer(commands, image, buffer);
    gpu::buffer_barrier(commands, buffer.handle, gpu::kTransferWrite, gpu::kHostRead);
    gpu::image_barrier(commands, image.handle, gpu::kTransferRead, gpu::kComputeRead);
  });
  std::memcpy(out.data(), buffer.mapped, out.size() * sizeof(T));
}

}  // namespace

std::vector<ProbeResult> Program::probe(std::span<const ProbeRay>) {
  fail("--probe: this chapter has no sky to ask; chapters from 04 on do");
}

const gpu::Image* Program::image(const std::string&) const { return nullptr; }

class Drawing::PlainDisplay {
 public:
  PlainDisplay(const Context& context, Display mode)
      : context_(context),
        mode_(mode),
        pipeline_(gpu::create_compute_pipeline(context.device, "app/display.comp", {{0}, {1}}, sizeof(DisplayPush))),
        set_(gpu::create_descriptor_set(context.device, pipeline_.set_layout, pipeline_.bindings)) {}

  void set_images(const Targets& targets) {
    gpu::write_storage_image(context_.device, set_, 0, targets.picture);
    gpu::write_storage_image(context_.device, set_, 1, targets.displayed);
  }

  void draw(const Frame& frame) {
    const VkExtent2D size = frame.target.size;
    const DisplayPush push{{static_cast<int32_t>(size.width), static_cast<int32_t>(size.height)},
                           static_cast<float>(kBaseExposure * std::exp2(context_.scene.post.exposure_ev)),
                           mode_ == Display::exposed ? 1 : 0};
    const gpu::TimedPass pass(frame.timer, frame.commands, "display");
    gpu::dispatch_over(frame.commands, pipeline_, set_, push, size);
  }

 private:
  const Context context_;
  const Display mode_;
  gpu::ComputePipeline pipeline_;
  gpu::DescriptorSet set_;
};

Drawing::Drawing(const Context& context, const Chapter& chapter, Program& program)
    : context_(context), program_(program), mode_(chapter.display), compiled_(context.settings.values()) {}
Drawing::~Drawing() = default;

void Drawing::set_targets(const Targets& targets) {
  targets_ = &targets;
  if (program_.set_displayed(targets.displayed))
    display_.reset();
  else if (!display_)
    display_ = std::make_unique<PlainDisplay>(context_, mode_);
  if (display_) display_->set_images(targets);
  program_.set_target(targets.picture);
}

bool Drawing::stale() {
  const std::vector<Knob>& knobs = context_.settings.knobs();
  for (size_t i = 0; i < knobs.size(); ++i)
    if (knobs[i].rebuilds && compiled_[i] != context_.settings.values()[i]) return true;
  return program_.stale();
}

void Drawing::follow() {
  compiled_ = context_.settings.values();
  program_.rebuild();
}

void Drawing::reload() {
  if (display_) display_ = std::make_unique<PlainDisplay>(context_, mode_), display_->set_images(*targets_);
  program_.reload();
}

// [frame]
void Drawing::record(const Frame& frame) {
  frame.timer.begin_frame(frame.commands);
  program_.draw(frame);
  if (!display_) return;
  // The display pass reads what the chapter wrote; leaving this out is the fault the synchronization test plants.
  if (context_.inject != "missing-barrier")
    gpu::image_barrier(frame.commands, targets_->picture.handle, gpu::kComputeWrite, gpu::kComputeRead);
  // The old content of the displayed picture is not needed, but whoever read it last must have finished.
  constexpr gpu::Use read_before{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT};
  gpu::image_barrier(frame.commands, targets_->displayed.handle, read_before, gpu::kComputeWrite);
  display_->draw(frame);
}
// [/frame]

Targets create_targets(const gpu::Device& device, VkExtent2D size) {
  return {gpu::create_image(device, "picture", size, VK_FORMAT_R32G32B32A32_SFLOAT,
                            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT),
          gpu::create_image(device, "displayed", size, VK_FORMAT_R8G8B8A8_UNORM,
                            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT)};
}

Renderer::Renderer(const Context& context, const Chapter& chapter, Program& program, VkExtent2D size)
    : context_(context),
      pool_(gpu::create_command_pool(context.device)),
      commands_(gpu::allocate_commands(context.device, pool_)),
      timer_(context.device),
      targets_(create_targets(context.device, size)),
      drawing_(context, chapter, program) {
  drawing_.set_targets(targets_);
}

void Renderer::draw(const CameraPose& pose, double time_s, uint32_t seed, uint32_t index, double seconds) {
  if (drawing_.stale()) drawing_.follow();
  const auto begin = std::chrono::steady_clock::now();
  const CameraRays camera = camera_rays(pose, context_.scene, time_s, {size().width, size().height}, seed, index);
  gpu::begin_commands(commands_);
  drawing_.record({commands_, targets_.picture, camera, timer_, index, seed, index == 0 ? 0.0 : seconds,
                   pose.position_km, index == 0});
  gpu::end_commands(commands_);
  record_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  gpu::submit_and_wait(context_.device, commands_);
}

Image read_picture(const gpu::Device& device, VkCommandPool pool, const gpu::Image& image) {
  Image picture{image.size.width, image.size.height, {}};
  picture.pixels.resize(size_t{image.size.width} * image.size.height);
  if (image.format != VK_FORMAT_R16G16B16A16_SFLOAT) {
    read_back(device, pool, image, picture.pixels);
    return picture;
  }
  std::vector<uint64_t> halves(picture.pixels.size());
  read_back(device, pool, image, halves);
  std::transform(halves.begin(), halves.end(), picture.pixels.begin(),
                 [](uint64_t four) { return glm::unpackHalf4x16(four); });
  return picture;
}

Image8 read_displayed(const gpu::Device& device, VkCommandPool pool, const gpu::Image& image) {
  Image8 picture{image.size.width, image.size.height, {}};
  picture.rgba.resize(size_t{4} * image.size.width * image.size.height);
  read_back(device, pool, image, picture.rgba);
  return picture;
}

Image Renderer::picture() {
  Image picture = read_picture(context_.device, pool_, targets_.picture);
  if (context_.inject == "nan") picture.pixels.front().r = std::numeric_limits<float>::quiet_NaN();
  return picture;
}

Image8 Renderer::displayed() { return read_displayed(context_.device, pool_, targets_.displayed); }

}  // namespace welkin::app
