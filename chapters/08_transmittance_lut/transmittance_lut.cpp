// The passes "air" and "transmittance". See transmittance_lut.hpp and docs/chapters/08_transmittance_lut.md.
#include "chapters/08_transmittance_lut/transmittance_lut.hpp"

#include <cstring>

#include "common/gpu/shader_file.hpp"

namespace welkin {
namespace {

constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;

struct TablePush {
  int32_t width, height, unused[2];
};

VkFormat table_format(const Settings& settings) {
  return settings.choice("transmittance.format") == "half" ? VK_FORMAT_R16G16B16A16_SFLOAT
                                                           : VK_FORMAT_R32G32B32A32_SFLOAT;
}

VkExtent2D table_size(const Settings& settings) {
  return {static_cast<uint32_t>(settings.integer("transmittance.width")),
          static_cast<uint32_t>(settings.integer("transmittance.height"))};
}

gpu::Image make_table(const app::Context& context) {
  return gpu::create_image(context.device, "transmittance", table_size(context.settings),
                           table_format(context.settings),
                           VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

}  // namespace

// [knobs]
// One ladder only: a sweep multiplies them. The page's table of errors has all the others.
std::vector<Knob> transmittance_knobs() {
  return {{.name = "transmittance.width",
           .unit = "texels",
           .meaning = "paths per altitude in the table",
           .minimum = 8,
           .maximum = 1024,
           .initial = 256,
           .integer = true,
           .rebuilds = true},
          {.name = "transmittance.height",
           .unit = "texels",
           .meaning = "altitudes in the table",
           .minimum = 8,
           .maximum = 1024,
           .initial = 512,
           .integer = true,
           .ladder = {64, 512},
           .rebuilds = true},
          {.name = "transmittance.steps",
           .unit = "steps",
           .meaning = "Gauss-Legendre points per texel, in fours; 0: the closed form of chapter 05",
           .minimum = 0,
           .maximum = 512,
           .initial = 0,
           .integer = true,
           .rebuilds = true},
          {.name = "transmittance.mapping",
           .meaning = "which paths the table holds: all that miss the ground, or the upward ones",
           .initial = 1,
           .choices = {"published", "folded"},
           .rebuilds = true},
          {.name = "transmittance.stored",
           .meaning = "what a texel holds",
           .initial = 2,
           .choices = {"transmittance", "optical_depth", "mean_extinction"},
           .rebuilds = true},
          {.name = "transmittance.format",
           .meaning = "bits of a number in the table: 16 or 32",
           .initial = 1,
           .choices = {"half", "float"},
           .rebuilds = true}};
}
// [/knobs]

// [air_block]
AirBlock::AirBlock(const app::Context& context, graph::Graph& graph)
    : context_(context),
      buffer_(gpu::create_buffer(context.device, "atmosphere", sizeof(interop::Atmosphere),
                                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                 gpu::Where::device)),
      resource_(graph.add("air", buffer_)) {
  graph.add({.name = "air",
             .accesses = {{resource_, gpu::kUpdate}},
             .record =
                 [this](const app::Frame& frame) {
                   written_ = wanted();
                   vkCmdUpdateBuffer(frame.commands, buffer_.handle, 0, sizeof *written_, &*written_);
                 },
             .changed =
                 [this](const app::Frame&) {
                   const interop::Atmosphere air = wanted();
                   return !written_ || std::memcmp(&air, &*written_, sizeof air) != 0;
                 }});
}

interop::Atmosphere AirBlock::wanted() const {
  interop::Atmosphere air = make_atmosphere(context_.scene);
  if (context_.inject == "wrong-constant") air.rayleigh_scattering.x *= 1.1f;
  return air;
}
// [/air_block]

// [table]
TransmittanceLut::TransmittanceLut(const app::Context& context, graph::Graph& graph, const AirBlock& air)
    : context_(context),
      graph_(graph),
      air_(air),
      sampler_(gpu::create_sampler(context.device)),
      image_(make_table(context)),
      resource_(graph.add("transmittance", image_)) {
  graph.add(
      {.name = "transmittance",
       .accesses = {{air.resource(), gpu::kUniformRead}, {resource_, gpu::kComputeWrite}},
       .record = [this](const app::Frame& frame) {
         const TablePush push{static_cast<int32_t>(image_.size.width), static_cast<int32_t>(image_.size.height), {}};
         gpu::dispatch_over(frame.commands, pipeline_, set_, push, image_.size);
       }});
  rebuild();
}

gpu::Specialization TransmittanceLut::variant() const {
  gpu::Specialization constants = specialization(air_variant(context_.scene));
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("transmittance.mapping")));
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("transmittance.stored")));
  return constants;
}

void TransmittanceLut::rebuild() {
  const Settings& settings = context_.settings;
  const VkFormat format = table_format(settings);
  const VkExtent2D size = table_size(settings);
  const char* shader = format == VK_FORMAT_R32G32B32A32_SFLOAT ? "08_transmittance_lut/transmittance_float.comp"
                                                               : "08_transmittance_lut/transmittance_half.comp";
  gpu::Specialization constants = variant();
  constants.push_back(static_cast<uint32_t>((settings.integer("transmittance.steps") + 3) / 4 * 4));
  // Another tone curve also rebuilds; the table need not be filled again for it.
  std::vector<uint32_t> wanted = gpu::load_spirv(shader);
  wanted.insert(wanted.end(), constants.begin(), constants.end());
  wanted.insert(wanted.end(), {size.width, size.height, static_cast<uint32_t>(format)});
  if (wanted == built_) return;
  if (image_.format != format || image_.size.width != size.width || image_.size.height != size.height) {
    image_ = make_table(context_);
    graph_.replace(resource_, image_);
  }
  pipeline_ = gpu::create_compute_pipeline(
      context_.device, shader, {{0, kUniform}, {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}, sizeof(TablePush), constants);
  set_ = gpu::create_descriptor_set(context_.device, pipeline_.set_layout, pipeline_.bindings);
  gpu::write_buffer(context_.device, set_, 0, kUniform, air_.buffer());
  gpu::write_storage_image(context_.device, set_, 1, image_);
  graph_.redo(resource_);
  built_ = std::move(wanted);
}
// [/table]

void execute_once(const gpu::Device& device, graph::Graph& graph) {
  const gpu::CommandPool pool = gpu::create_command_pool(device);
  gpu::Timer timer(device);
  const gpu::Image no_target;
  const CameraRays no_camera{};
  gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
    timer.begin_frame(commands);
    graph.execute({commands, no_target, no_camera, timer, 0, 0, 0.0});
  });
}

}  // namespace welkin
