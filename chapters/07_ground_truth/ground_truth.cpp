// The path tracer's passes on the device. See ground_truth.hpp and docs/chapters/07_ground_truth.md.
#include "chapters/07_ground_truth/ground_truth.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "shaders/interop/camera.h"

namespace welkin {
namespace {

constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDeviceSize kSumBytes = 32;  // per pixel: Accumulated in accumulate.glsl
// From fewer batches a standard error is too uncertain to stop at.
constexpr int kBatchesToJudge = 16;

struct TracePush {
  CameraRays camera;
  int32_t first_sample, samples, orders, first;
};

struct ResolvePush {
  CameraRays camera;
  int32_t batches, accumulation, unused[2];
};

uint32_t groups_over(VkExtent2D size) { return ((size.width + 7) / 8) * ((size.height + 7) / 8); }

}  // namespace

// [knobs]
std::vector<Knob> path_knobs() {
  return {{.name = "samples",
           .unit = "paths",
           .meaning = "paths per pixel and frame; frames add up",
           .minimum = 1,
           .maximum = 4096,
           .initial = 4,
           .integer = true,
           .ladder = {1, 4, 16, 64}},
          {.name = "orders",
           .meaning = "scatterings and ground reflections at most; 0: all",
           .minimum = 0,
           .maximum = 64,
           .initial = 0,
           .integer = true,
           .ladder = {1, 2, 3, 5, 0}},
          {.name = "tracking",
           .meaning = "how free flights are drawn and the way to the sun is weighed",
           .initial = 3,
           .choices = {"naive", "shells", "exponential", "closed_form"},
           .ladder = {0, 1, 2, 3},
           .rebuilds = true},
          {.name = "spectral",
           .meaning = "what one path carries: one channel, or all three weighted by a hero's",
           .initial = 1,
           .choices = {"one_channel", "hero"},
           .ladder = {0, 1},
           .rebuilds = true},
          {.name = "target.standard_error",
           .meaning = "the picture is done when its mean relative standard error is below; 0: never",
           .minimum = 0,
           .maximum = 1,
           .initial = 0},
          {.name = "probe.samples",
           .unit = "paths",
           .meaning = "paths per ray of a probe",
           .minimum = 2,
           .maximum = 1e8,
           .initial = 4096,
           .integer = true}};
}
// [/knobs]

// [batches]
Batches batches_of(int samples, int tracking) {
  // A driver may silently end loops after 65,535 iterations in all, and a flight under one constant majorant takes
  // hundreds: the looser the majorant, the fewer samples per invocation.
  constexpr int kSamplesPerInvocation[] = {1, 2, 4, 8};
  const int most = kSamplesPerInvocation[tracking];
  const int count = (samples + most - 1) / most;
  return {count, (samples + count - 1) / count};
}
// [/batches]

app::Truth path_truth() {
  return {path_knobs(),
          {{"samples", "64"}},
          [](const app::Context& context) { return std::make_unique<GroundTruth>(context); },
          32};
}

GroundTruth::GroundTruth(const app::Context& context, bool surfaces)
    : context_(context),
      surfaces_(surfaces),
      air_(gpu::create_buffer(context.device, "atmosphere", sizeof(interop::Atmosphere),
                              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                              gpu::Where::device)),
      unfinished_(gpu::create_buffer(context.device, "unfinished paths", sizeof(uint32_t),
                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback)) {
  unfinished_.as<uint32_t>()[0] = 0;
  rebuild();
}

gpu::Specialization GroundTruth::variant() const {
  gpu::Specialization constants = specialization(air_variant(context_.scene));
  constants.push_back(context_.scene.sun.disc);
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("tracking")));
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("spectral")));
  return constants;
}

// [pipelines]
void GroundTruth::rebuild() {
  std::vector<gpu::Binding> trace{{0, kUniform}, {1, kStorage}, {2, kStorage}, {3, kStorage}},
      resolve{{0, kUniform}, {1, kStorage}, {2, kImage}, {3, kStorage}};
  if (surfaces_) {
    trace.insert(trace.end(), {{4, kImage}, {5, kImage}});
    resolve.push_back({4, kImage});
  }
  trace_ = gpu::create_compute_pipeline(
      context_.device, surfaces_ ? "07_ground_truth/trace_surfaces.comp" : "07_ground_truth/trace.comp", trace,
      sizeof(TracePush), variant());
  resolve_ = gpu::create_compute_pipeline(
      context_.device, surfaces_ ? "07_ground_truth/resolve_surfaces.comp" : "07_ground_truth/resolve.comp", resolve,
      sizeof(ResolvePush), variant());
  if (trace_sets_[0].handle != VK_NULL_HANDLE) return;
  for (int i = 0; i < 2; ++i) {
    trace_sets_[i] = gpu::create_descriptor_set(context_.device, trace_.set_layout, trace_.bindings);
    resolve_sets_[i] = gpu::create_descriptor_set(context_.device, resolve_.set_layout, resolve_.bindings);
    gpu::write_buffer(context_.device, trace_sets_[i], 0, kUniform, air_);
    gpu::write_buffer(context_.device, trace_sets_[i], 3, kStorage, unfinished_);
    gpu::write_buffer(context_.device, resolve_sets_[i], 0, kUniform, air_);
  }
}
// [/pipelines]

void GroundTruth::set_surfaces(const FirstSurfaces& surfaces) {
  for (int i = 0; i < 2; ++i) {
    gpu::write_storage_image(context_.device, trace_sets_[i], 4, *surfaces.normals);
    gpu::write_storage_image(context_.device, trace_sets_[i], 5, *surfaces.albedos);
    gpu::write_storage_image(context_.device, resolve_sets_[i], 4, *surfaces.normals);
  }
  batches_ = 0;
}

void GroundTruth::set_target(const gpu::Image& target) {
  if (target.size.width != size_.width || target.size.height != size_.height) {
    size_ = target.size;
    for (gpu::Buffer& sums : sums_) sums = {};  // frees the old ones before the new ones are made
    for (gpu::Buffer& sums : sums_)
      sums = gpu::create_buffer(context_.device, "path sums", kSumBytes * size_.width * size_.height,
                                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::device);
    groups_ = gpu::create_buffer(context_.device, "standard errors", groups_over(size_) * sizeof(glm::vec4),
                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback);
    std::memset(groups_.mapped, 0, groups_.bytes);
    batches_ = 0;
  }
  for (int i = 0; i < 2; ++i) {
    gpu::write_buffer(context_.device, trace_sets_[i], 1, kStorage, sums_[i]);
    gpu::write_buffer(context_.device, trace_sets_[i], 2, kStorage, sums_[1 - i]);
    gpu::write_buffer(context_.device, resolve_sets_[i], 1, kStorage, sums_[i]);
    gpu::write_storage_image(context_.device, resolve_sets_[i], 2, target);
    gpu::write_buffer(context_.device, resolve_sets_[i], 3, kStorage, groups_);
  }
}

// Writes the atmosphere into its block. Earlier frames may still read it: the barrier waits for them.
void GroundTruth::update_air(VkCommandBuffer commands) const {
  const interop::Atmosphere air = air_of_device(context_);
  constexpr gpu::Use written{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
  gpu::buffer_barrier(commands, air_.handle, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT}, written);
  vkCmdUpdateBuffer(commands, air_.handle, 0, sizeof air, &air);
  gpu::buffer_barrier(commands, air_.handle, written, gpu::kUniformRead);
}

// [changed]
bool GroundTruth::changed(const app::Frame& frame) {
  Subject now{frame.camera, make_atmosphere(context_.scene), {}};
  now.camera.time_s = 0.0f;  // time and frame number do not change the picture
  now.camera.frame = 0;
  for (const Knob& knob : context_.settings.knobs())
    if (knob.name == "samples" || knob.name == "orders" || knob.name == "tracking" || knob.name == "spectral")
      now.settings.push_back(context_.settings.number(knob.name));
  const bool same = batches_ > 0 && frame.index > 0 &&
                    std::memcmp(&now.camera, &subject_.camera, sizeof now.camera) == 0 &&
                    std::memcmp(&now.air, &subject_.air, sizeof now.air) == 0 && now.settings == subject_.settings;
  subject_ = std::move(now);
  return !same;
}
// [/changed]

// From what the device wrote for an earlier frame. It may be writing the next one meanwhile: that some workgroups are
// then newer does not matter.
double GroundTruth::relative_error() const {
  double errors = 0.0, luminances = 0.0;
  for (const glm::vec4& group : groups_.as<glm::vec4>()) {
    if (group.w != static_cast<float>(accumulation_) || group.z < static_cast<float>(kBatchesToJudge)) return 0.0;
    errors += group.x;
    luminances += group.y;
  }
  return luminances > 0.0 ? errors / luminances : 0.0;
}

// [draw]
void GroundTruth::draw(const app::Frame& frame) {
  const Settings& settings = context_.settings;
  if (changed(frame)) {
    batches_ = 0;
    samples_ = 0;
    accumulation_ = (accumulation_ + 1) % (1 << 24);
    done_ = false;
  }
  const double target = settings.number("target.standard_error"), reached = target > 0.0 ? relative_error() : 0.0;
  done_ = reached > 0.0 && reached <= target;
  update_air(frame.commands);
  constexpr gpu::Use earlier_read{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT};
  if (!done_) {
    const gpu::TimedPass pass(frame.timer, frame.commands, "trace");
    const Batches plan = batches_of(settings.integer("samples"), settings.integer("tracking"));
    for (int i = 0; i < plan.count; ++i) {
      gpu::buffer_barrier(frame.commands, sums_[newest_].handle, gpu::kComputeWrite, gpu::kComputeRead);
      gpu::buffer_barrier(frame.commands, sums_[1 - newest_].handle, earlier_read, gpu::kComputeWrite);
      constexpr gpu::Use counted{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
      gpu::buffer_barrier(frame.commands, unfinished_.handle, counted, counted);
      const TracePush push{frame.camera, static_cast<int32_t>(samples_ & 0x7fffffff), plan.samples,
                           settings.integer("orders"), batches_ == 0};
      gpu::dispatch_over(frame.commands, trace_, trace_sets_[newest_], push, size_);
      newest_ = 1 - newest_;
      ++batches_;
      samples_ += plan.samples;
    }
  }
  gpu::buffer_barrier(frame.commands, sums_[newest_].handle, gpu::kComputeWrite, gpu::kComputeRead);
  gpu::buffer_barrier(frame.commands, groups_.handle, earlier_read, gpu::kComputeWrite);
  gpu::image_barrier(frame.commands, frame.target.handle, earlier_read, gpu::kComputeWrite);
  {
    const gpu::TimedPass pass(frame.timer, frame.commands, "resolve");
    const ResolvePush push{frame.camera, batches_, accumulation_, {}};
    gpu::dispatch_over(frame.commands, resolve_, resolve_sets_[newest_], push, size_);
  }
  gpu::buffer_barrier(frame.commands, groups_.handle, gpu::kComputeWrite, gpu::kHostRead);
}
// [/draw]

std::string GroundTruth::explain() const {
  const double error = relative_error();
  std::string text = fmt::format("paths:\n  {} per pixel, in {} batches\n", samples_, batches_);
  text += error > 0.0 ? fmt::format("  mean relative standard error {:.3g}{}\n", error,
                                    done_ ? ": the target is reached, no more paths" : "")
                      : fmt::format("  standard error not known from fewer than {} batches\n", kBatchesToJudge);
  text += fmt::format("  {} cut by the driver\n", unfinished_.as<uint32_t>()[0]);
  text += fmt::format("  {}\n", surfaces_ ? "first surfaces: from images" : "first surfaces: none, no image is read");
  return text;
}

void add_paths(app::Builder& builder, app::Board& board, const std::string& pass,
               const std::optional<SurfaceImages>& surfaces) {
  const auto tracer = std::make_shared<GroundTruth>(builder.context, surfaces.has_value());
  const graph::Resource picture = builder.picture(board, "picture");
  graph::Step step;
  if (surfaces) step.accesses = {{surfaces->normals, gpu::kComputeRead}, {surfaces->albedos, gpu::kComputeRead}};
  step.accesses.push_back({picture, gpu::kComputeWrite});
  step.record = [tracer, surfaces, picture, drawn_into = uint64_t{0}](const graph::Recorder& r) mutable {
    const gpu::Image& target = r.graph.image(picture);
    const uint64_t version = r.graph.version(picture);
    if (std::exchange(drawn_into, version) != version) {
      tracer->set_target(target);
      if (surfaces) tracer->set_surfaces({&r.graph.image(surfaces->normals), &r.graph.image(surfaces->albedos)});
    }
    const app::Frame& f = r.frame;
    tracer->draw({f.commands, target, f.camera, f.timer, f.index, f.seed, f.seconds, f.position_km, f.cut});
  };
  graph::Pass drawing{.name = pass, .changed = [](const app::Frame&) { return true; }, .times_itself = true};
  drawing.steps.push_back(std::move(step));
  builder.graph.add(std::move(drawing));
  builder.explain = [tracer] { return tracer->explain(); };
}

app::Effect paths() {
  app::Effect effect{.name = "paths", .chapter = 7, .knobs = path_knobs()};
  effect.declare = [](app::Builder& builder, app::Board& board) { add_paths(builder, board, "program"); };
  effect.key = [](const Scene& scene, const Settings&) { return air_key(scene) + fmt::format(" {}", scene.sun.disc); };
  return effect;
}

std::vector<app::ProbeResult> probe_paths(const app::Context& context, std::span<const app::ProbeRay> rays) {
  return GroundTruth(context).probe(rays);
}

}  // namespace welkin
