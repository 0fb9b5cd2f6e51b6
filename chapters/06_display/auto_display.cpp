// The passes of the display on the device. See auto_display.hpp and docs/chapters/06_display.md.
#include "chapters/06_display/auto_display.hpp"

#include <cmath>

namespace welkin {
namespace {

constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr uint32_t kMeterBins = 256;
constexpr uint32_t kTile = 32;  // samples a workgroup of the histogram counts, each way
// Of an exposure set by hand, at 0 stops: the factor the chapters before this one use.
const double kBaseLog2 = std::log2(24.0);

struct CountPush {
  int32_t size[2], samples[2];
  int32_t stride;
};

struct ExposePush {
  float low, high;
  float to_bright, to_dark;
  float adaptation;
  float fallback;
  int32_t snap;
};

struct DisplayPush {
  int32_t size[2];
  float exposure;
};

}  // namespace

// [knobs]
std::vector<Knob> display_knobs() {
  return {
      {.name = "exposure.adaptation",
       .meaning = "share of the way to middle grey the meter goes; 1: every scene equally bright",
       .minimum = 0.0,
       .maximum = 1.0,
       .initial = 0.85},
      {.name = "exposure.to_bright_s",
       .unit = "s",
       .meaning = "time constant when it gets brighter",
       .minimum = 0.0,
       .maximum = 60.0,
       .initial = 0.4},
      {.name = "exposure.to_dark_s",
       .unit = "s",
       .meaning = "time constant when it gets darker",
       .minimum = 0.0,
       .maximum = 60.0,
       .initial = 1.5},
      {.name = "exposure.low",
       .meaning = "share of the picture, darkest first, that is not measured",
       .minimum = 0.0,
       .maximum = 0.49,
       .initial = 0.45},
      {.name = "exposure.high",
       .meaning = "share, darkest first, up to which it is",
       .minimum = 0.51,
       .maximum = 1.0,
       .initial = 0.95},
      {.name = "exposure.stride",
       .unit = "pixels",
       .meaning = "the meter looks at one pixel of every n x n",
       .minimum = 1,
       .maximum = 64,
       .initial = 4,
       .integer = true},
      {.name = "display.curve",
       .meaning = "tone curve; compare: all of them, each in a strip of its own",
       .initial = 3,
       .choices = {"clamp", "reinhard", "aces_narkowicz", "aces_hill", "lottes", "uchimura", "uncharted2", "compare"},
       .rebuilds = true},
      {.name = "display.space",
       .meaning = "what the curve bends: each channel, or the luminance Y of xyY",
       .initial = 0,
       .choices = {"rgb", "xyY"},
       .rebuilds = true},
      {.name = "display.dither",
       .meaning = "noise of one level before rounding to 8 bits",
       .initial = 1,
       .choices = {"off", "on"},
       .rebuilds = true}};
}
// [/knobs]

// [share]
double adapted_share(double seconds, double tau_s) { return tau_s > 0.0 ? -std::expm1(-seconds / tau_s) : 1.0; }
// [/share]

AutoDisplay::AutoDisplay(const app::Context& context) : context_(context) { rebuild(); }

// [meter]
void AutoDisplay::make_meter() {
  const gpu::Device& device = context_.device;
  constexpr VkBufferUsageFlags kUsage =
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  meter_.emplace(Meter{
      .histogram = gpu::create_buffer(device, "histogram", kMeterBins * sizeof(uint32_t), kUsage, gpu::Where::device),
      .state = gpu::create_buffer(device, "exposure", sizeof(ExposureState), kUsage, gpu::Where::device),
      .count = gpu::create_compute_pipeline(device, "06_display/histogram.comp", {{0, kImage}, {1, kStorage}},
                                            sizeof(CountPush)),
      .expose = gpu::create_compute_pipeline(device, "06_display/exposure.comp", {{0, kStorage}, {1, kStorage}},
                                             sizeof(ExposePush))});
  meter_->count_set = gpu::create_descriptor_set(device, meter_->count.set_layout, meter_->count.bindings);
  meter_->expose_set = gpu::create_descriptor_set(device, meter_->expose.set_layout, meter_->expose.bindings);
  gpu::write_buffer(device, meter_->count_set, 1, kStorage, meter_->histogram);
  gpu::write_buffer(device, meter_->expose_set, 0, kStorage, meter_->histogram);
  gpu::write_buffer(device, meter_->expose_set, 1, kStorage, meter_->state);
}
// [/meter]

void AutoDisplay::rebuild() {
  // The meter's own shaders have no variants, and what it has adapted to should outlive a change of curve.
  if (context_.scene.post.manual)
    meter_.reset();
  else if (!meter_)
    make_meter();
  const auto constant = [&](const char* knob) { return static_cast<uint32_t>(context_.settings.integer(knob)); };
  const gpu::Specialization variant{constant("display.curve"), constant("display.space"), constant("display.dither")};
  std::vector<gpu::Binding> bindings{{0, kImage}, {1, kImage}};
  if (meter_) bindings.push_back({2, kStorage});
  display_ = gpu::create_compute_pipeline(context_.device,
                                          meter_ ? "06_display/display_metered.comp" : "06_display/display_fixed.comp",
                                          bindings, sizeof(DisplayPush), variant);
  display_set_ = gpu::create_descriptor_set(context_.device, display_.set_layout, display_.bindings);
  bind();
}

std::string AutoDisplay::explain() const {
  return meter_ ? "light meter            on   the scene's [post] asks for it: passes histogram and exposure\n"
                : "light meter            off  the scene's [post] sets the exposure by hand: no pass, no buffer\n";
}

void AutoDisplay::set_images(const gpu::Image& picture, const gpu::Image& displayed) {
  picture_ = &picture;
  displayed_ = &displayed;
  bind();
}

void AutoDisplay::bind() {
  if (meter_) gpu::write_buffer(context_.device, display_set_, 2, kStorage, meter_->state);
  if (picture_ == nullptr) return;
  if (meter_) gpu::write_storage_image(context_.device, meter_->count_set, 0, *picture_);
  gpu::write_storage_image(context_.device, display_set_, 0, *picture_);
  gpu::write_storage_image(context_.device, display_set_, 1, *displayed_);
}

// [measure]
// The buffers are the same in every frame: what an earlier frame still does with them comes first.
void AutoDisplay::measure(const app::Frame& frame) {
  const Settings& settings = context_.settings;
  constexpr gpu::Use atomics{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                             VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
  {
    const gpu::TimedPass pass(frame.timer, frame.commands, "histogram");
    gpu::buffer_barrier(frame.commands, meter_->histogram.handle, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT},
                        gpu::kUpdate);
    vkCmdFillBuffer(frame.commands, meter_->histogram.handle, 0, VK_WHOLE_SIZE, 0);
    gpu::buffer_barrier(frame.commands, meter_->histogram.handle, gpu::kUpdate, atomics);
    const uint32_t stride = static_cast<uint32_t>(settings.integer("exposure.stride"));
    const uint32_t across = (picture_->size.width + stride - 1) / stride,
                   down = (picture_->size.height + stride - 1) / stride;
    const CountPush push{{static_cast<int32_t>(picture_->size.width), static_cast<int32_t>(picture_->size.height)},
                         {static_cast<int32_t>(across), static_cast<int32_t>(down)},
                         static_cast<int32_t>(stride)};
    gpu::dispatch(frame.commands, meter_->count, meter_->count_set, push, (across + kTile - 1) / kTile,
                  (down + kTile - 1) / kTile);
  }
  const gpu::TimedPass pass(frame.timer, frame.commands, "exposure");
  gpu::buffer_barrier(frame.commands, meter_->histogram.handle, gpu::kComputeWrite, gpu::kComputeRead);
  gpu::buffer_barrier(frame.commands, meter_->state.handle, gpu::kComputeWrite,
                      atomics);  // written by the frame before
  const bool snap = frame.index == 0 || meter_->fresh;
  const ExposePush push{
      .low = static_cast<float>(settings.number("exposure.low")),
      .high = static_cast<float>(settings.number("exposure.high")),
      .to_bright = static_cast<float>(adapted_share(frame.seconds, settings.number("exposure.to_bright_s"))),
      .to_dark = static_cast<float>(adapted_share(frame.seconds, settings.number("exposure.to_dark_s"))),
      .adaptation = static_cast<float>(settings.number("exposure.adaptation")),
      .fallback = static_cast<float>(kBaseLog2),
      .snap = snap ? 1 : 0};
  gpu::dispatch(frame.commands, meter_->expose, meter_->expose_set, push, 1);
  gpu::buffer_barrier(frame.commands, meter_->state.handle, gpu::kComputeWrite, gpu::kComputeRead);
  meter_->fresh = false;
}
// [/measure]

// [draw]
void AutoDisplay::draw(const app::Frame& frame) {
  if (meter_) measure(frame);
  const Post& post = context_.scene.post;
  const double stops = meter_ ? post.compensation_ev : kBaseLog2 + post.exposure_ev;
  const gpu::TimedPass pass(frame.timer, frame.commands, "display");
  const DisplayPush push{{static_cast<int32_t>(picture_->size.width), static_cast<int32_t>(picture_->size.height)},
                         static_cast<float>(stops)};
  gpu::dispatch_over(frame.commands, display_, display_set_, push, picture_->size);
}
// [/draw]

std::unique_ptr<app::DisplaySystem> make_display(const app::Context& context) {
  return std::make_unique<AutoDisplay>(context);
}

}  // namespace welkin
