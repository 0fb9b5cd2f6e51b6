// The light meter and the display as passes. See display.hpp and docs/chapters/06_display.md.
#include "chapters/06_display/display.hpp"

#include <cmath>

namespace welkin {
namespace {

constexpr uint32_t kMeterBins = 256;
constexpr uint32_t kTile = 32;  // a workgroup of the histogram counts kTile x kTile samples
// log2 of the exposure factor at 0 stops, where it is set by hand: the factor that earlier chapters use.
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
std::vector<Knob> exposure_knobs() {
  return {{.name = "exposure.adaptation",
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
           .integer = true}};
}

std::vector<Knob> display_knobs() {
  return {
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

// [histogram]
// Counts the picture's log2 luminances; every frame starts again from zero.
static graph::Pass histogram_pass(const app::Context& context, graph::Resource picture, graph::Resource histogram) {
  graph::Pass pass{.name = "histogram", .changed = [](const app::Frame&) { return true; }};
  pass.steps.push_back({.accesses = {{histogram, gpu::kUpdate}}, .record = [histogram](const graph::Recorder& r) {
                          vkCmdFillBuffer(r.frame.commands, r.graph.buffer(histogram).handle, 0, VK_WHOLE_SIZE, 0);
                        }});
  pass.steps.push_back({.shader = "06_display/histogram.comp",
                        .bindings = {{"picture", picture}, {"Histogram", histogram}},
                        .record = [context, picture](const graph::Recorder& r) {
                          const VkExtent2D size = r.graph.image(picture).size;
                          const uint32_t stride = static_cast<uint32_t>(context.settings.integer("exposure.stride"));
                          const uint32_t across = (size.width + stride - 1) / stride,
                                         down = (size.height + stride - 1) / stride;
                          r.push(CountPush{{static_cast<int32_t>(size.width), static_cast<int32_t>(size.height)},
                                           {static_cast<int32_t>(across), static_cast<int32_t>(down)},
                                           static_cast<int32_t>(stride)});
                          r.dispatch((across + kTile - 1) / kTile, (down + kTile - 1) / kTile);
                        }});
  return pass;
}
// [/histogram]

// [exposure_pass]
// Turns the counts into a target and moves the exposure towards it: every frame reads and writes the same state.
static graph::Pass exposure_pass(const app::Context& context, graph::Resource histogram, graph::Resource state) {
  graph::Pass pass{.name = "exposure", .changed = [](const app::Frame&) { return true; }};
  pass.steps.push_back(
      {.shader = "06_display/exposure.comp",
       .bindings = {{"Histogram", histogram}, {"State", state}},
       .record = [context, fresh = true](const graph::Recorder& r) mutable {
         const Settings& settings = context.settings;
         const auto number = [&](const char* knob) { return static_cast<float>(settings.number(knob)); };
         const auto share = [&](const char* knob) {
           return static_cast<float>(adapted_share(r.frame.seconds, settings.number(knob)));
         };
         const bool first = std::exchange(fresh, false), snap = r.frame.index == 0 || r.frame.cut || first;
         r.push(ExposePush{.low = number("exposure.low"),
                           .high = number("exposure.high"),
                           .to_bright = share("exposure.to_bright_s"),
                           .to_dark = share("exposure.to_dark_s"),
                           .adaptation = number("exposure.adaptation"),
                           .fallback = static_cast<float>(kBaseLog2),
                           .snap = snap ? 1 : 0});
         r.dispatch(1);
       }});
  return pass;
}
// [/exposure_pass]

// [exposure]
app::Effect exposure() {
  app::Effect effect{.name = "exposure", .chapter = 6, .knobs = exposure_knobs()};
  effect.wanted = [](const Scene& scene, const Settings&) -> app::Wanted {
    if (scene.post.manual) return {false, "post.exposure is manual: set by hand"};
    return {true, "post.exposure is auto: the light meter"};
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const graph::Resource picture = board.get<app::Picture>("a picture").image;
    const graph::Resource histogram = builder.graph.add_buffer("histogram", {kMeterBins * sizeof(uint32_t)});
    const graph::Resource state = builder.graph.add_buffer("exposure", {sizeof(ExposureState)});
    builder.graph.add(histogram_pass(builder.context, picture, histogram));
    builder.graph.add(exposure_pass(builder.context, histogram, state));
    board.offer(Exposure{state, histogram});
  };
  return effect;
}
// [/exposure]

// [display]
app::Effect display() {
  app::Effect effect{.name = "display", .chapter = 6, .knobs = display_knobs()};
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const graph::Resource picture = board.get<app::Picture>("a picture").image;
    const graph::Resource displayed = builder.displayed(board);
    const Exposure* meter = board.find<Exposure>();
    const Settings& settings = builder.context.settings;
    graph::Step step{.shader = meter != nullptr ? "06_display/display_metered.comp" : "06_display/display_fixed.comp",
                     .constants = {{"CURVE", settings.integer("display.curve")},
                                   {"ON_LUMINANCE", settings.integer("display.space")},
                                   {"DITHER", settings.integer("display.dither")}},
                     .bindings = {{"picture", picture}, {"displayed", displayed}}};
    if (meter != nullptr) step.bindings.push_back({"State", meter->state});
    step.record = [context = builder.context, picture, metered = meter != nullptr](const graph::Recorder& r) {
      const Post& post = context.scene.post;
      const double stops = metered ? post.compensation_ev : kBaseLog2 + post.exposure_ev;
      const VkExtent2D size = r.graph.image(picture).size;
      r.push(DisplayPush{{static_cast<int32_t>(size.width), static_cast<int32_t>(size.height)},
                         static_cast<float>(stops)});
      r.dispatch_over(size);
    };
    graph::Pass pass{.name = "display", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/display]

}  // namespace welkin
