// The pass "multiple scattering". See multiple_scattering_lut.hpp and docs/chapters/09_multiple_scattering_lut.md.
#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

#include <algorithm>
#include <cmath>

namespace welkin {
namespace {

constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkDescriptorType kTable = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr uint32_t kLayers = 7;  // of shaders/09_multiple_scattering_lut/table.glsl
constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr size_t kNodeBytes = 48;  // RayNode of shaders/09_multiple_scattering_lut/ray_nodes.glsl
constexpr gpu::Use kEarlierRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT};
constexpr gpu::Use kAnyRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                            VK_IMAGE_LAYOUT_GENERAL};

struct NoPush {
  int32_t unused[4] = {};
};

}  // namespace

// [knobs]
std::vector<Knob> multiple_scattering_knobs() {
  return {{.name = "orders",
           .meaning = "orders of scattering: 0 all, 1 single scattering only (then there is no table)",
           .minimum = 0,
           .maximum = 1,
           .initial = 0,
           .integer = true,
           .ladder = {1, 0},
           .rebuilds = true},
          {.name = "multiple_scattering.method",
           .meaning = "what the table holds and how its series of orders is summed",
           .initial = 2,
           .choices = {"published", "isotropic", "moments"},
           .ladder = {0, 1, 2},
           .rebuilds = true},
          {.name = "multiple_scattering.iterations",
           .unit = "orders",
           .meaning = "orders gathered one by one before the series is closed, at least 3; 0: as many as the air asks "
                      "for (not by the published method)",
           .minimum = 0,
           .maximum = 64,
           .initial = 0,
           .integer = true,
           .ladder = {3, 5, 10, 20},
           .rebuilds = true},
          {.name = "multiple_scattering.directions",
           .unit = "directions",
           .meaning = "directions light is gathered from, a multiple of 16",
           .minimum = 16,
           .maximum = 512,
           .initial = 32,
           .integer = true,
           .ladder = {16, 32, 64, 128, 256},
           .rebuilds = true},
          {.name = "multiple_scattering.set",
           .meaning = "where those directions are",
           .initial = 0,
           .choices = {"fibonacci", "horizon"},
           .ladder = {0, 1},
           .rebuilds = true},
          {.name = "multiple_scattering.steps",
           .unit = "steps",
           .meaning = "samples along each of them, in fours",
           .minimum = 4,
           .maximum = 64,
           .initial = 8,
           .integer = true,
           .ladder = {4, 8, 16, 32},
           .rebuilds = true},
          {.name = "multiple_scattering.view_steps",
           .unit = "steps",
           .meaning = "samples of the table along a view ray, in fours",
           .minimum = 4,
           .maximum = 256,
           .initial = 16,
           .integer = true,
           .ladder = {4, 8, 16, 32}},
          {.name = "multiple_scattering.size",
           .unit = "texels",
           .meaning = "altitudes, and sun heights, in the table",
           .minimum = 8,
           .maximum = 128,
           .initial = 32,
           .integer = true,
           .ladder = {16, 24, 32, 64},
           .rebuilds = true},
          {.name = "multiple_scattering.map",
           .meaning = "where its texels are and what they hold: evenly and as it is, or denser where light changes and "
                      "by logarithm",
           .initial = 1,
           .choices = {"published", "horizon"},
           .ladder = {0, 1},
           .rebuilds = true},
          {.name = "multiple_scattering.format",
           .meaning = "bits of a number in the table: 16 or 32",
           .initial = 1,
           .choices = {"half", "float"},
           .ladder = {0, 1},
           .rebuilds = true}};
}
// [/knobs]

// [orders_of]
// The ratio of two orders is the one the series ends with only after light has crossed the air, however it gets there:
// straight on in about tau scatterings, or by diffusion in some tau^2 / 3, after which slab eigenmodes have died out.
int orders_of(const interop::Atmosphere& air) {
  const double top_km = air.top_km;
  double deepest = 0.0;
  for (int c = 0; c < 3; ++c) {
    double tau = 0.0;
    for (const auto& [scattering, scale_height_km] : {std::pair(air.rayleigh_scattering, air.rayleigh_scale_height_km),
                                                      std::pair(air.mie_scattering, air.mie_scale_height_km)})
      if (scale_height_km > 0.0f) tau += scattering[c] * scale_height_km * (1.0 - std::exp(-top_km / scale_height_km));
    deepest = std::max(deepest, tau);
  }
  return static_cast<int>(std::min(3.0 + std::ceil(deepest * (2.0 + 0.3 * deepest)), 64.0));
}
// [/orders_of]

bool wants_multiple_scattering(const Settings& settings) { return settings.integer("orders") != 1; }

MultipleScatteringLut::MultipleScatteringLut(const app::Context& context, graph::Graph& graph, const AirBlock& air)
    : context_(context), graph_(graph), air_(air), sampler_(gpu::create_sampler(context.device)) {
  make_images();
  resource_ = graph.add("multiple scattering", table_);
  graph.add({.name = "multiple scattering",
             .accesses = {{air.resource(), gpu::kUniformRead}, {resource_, gpu::kComputeWrite}},
             .record = [this](const app::Frame& frame) { record(frame); }});
  rebuild();
}

void MultipleScatteringLut::make_images() {
  const Settings& settings = context_.settings;
  const uint32_t side = static_cast<uint32_t>(settings.integer("multiple_scattering.size"));
  const VkExtent2D size{side, published() ? side : side * kLayers};
  const VkFormat format = settings.choice("multiple_scattering.format") == "half" ? VK_FORMAT_R16G16B16A16_SFLOAT
                                                                                  : VK_FORMAT_R32G32B32A32_SFLOAT;
  constexpr VkImageUsageFlags kUsage =
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  table_ = {};
  orders_ = {};
  table_ = gpu::create_image(context_.device, "multiple scattering", size, format, kUsage);
  for (size_t i = 0; i < (published() ? 1 : orders_.size()); ++i)
    orders_[i] =
        gpu::create_image(context_.device, "orders " + std::to_string(i), size, VK_FORMAT_R32G32B32A32_SFLOAT, kUsage);
  nodes_ = {};
  nodes_ = gpu::create_buffer(context_.device, "ray nodes", kNodeBytes * rays() * static_cast<size_t>(steps() + 1),
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::device);
}

// Fibonacci's directions all have zenith angles of their own; the horizon's set stands in 8 rings, or 16.
uint32_t MultipleScatteringLut::rays() const {
  const int rings = directions() >= 128 ? 16 : 8;
  return table_.size.width * static_cast<uint32_t>(context_.settings.choice("multiple_scattering.set") == "fibonacci"
                                                       ? directions()
                                                       : rings);
}

gpu::Specialization MultipleScatteringLut::variant() const {
  gpu::Specialization constants = specialization(air_variant(context_.scene));
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("multiple_scattering.method")));
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("multiple_scattering.map")));
  constants.push_back(table_.size.width);
  return constants;
}

// [rebuild]
void MultipleScatteringLut::rebuild() {
  const Settings& settings = context_.settings;
  const gpu::Device& device = context_.device;
  make_images();
  graph_.replace(resource_, table_);

  gpu::Specialization gather = variant();
  gather.push_back(static_cast<uint32_t>(directions()));
  gather.push_back(static_cast<uint32_t>(settings.integer("multiple_scattering.set")));
  gather.push_back(static_cast<uint32_t>(steps()));
  gpu::Specialization close = variant();
  close.push_back(!published());

  const auto make = [&](gpu::ComputePipeline& pipeline, const std::string& shader, std::vector<gpu::Binding> bindings,
                        const gpu::Specialization& constants) {
    pipeline = gpu::create_compute_pipeline(device, "09_multiple_scattering_lut/" + shader + ".comp",
                                            std::move(bindings), sizeof(NoPush), constants);
  };
  const auto make_set = [&](const gpu::ComputePipeline& pipeline) {
    gpu::DescriptorSet set = gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings);
    gpu::write_buffer(device, set, 0, kUniform, air_.buffer());
    return set;
  };
  make(place_, "nodes", {{0, kUniform}, {4, kBuffer}}, gather);
  place_set_ = make_set(place_);
  gpu::write_buffer(device, place_set_, 4, kBuffer, nodes_);
  make(first_, published() ? "published" : "first", {{0, kUniform}, {1, kImage}, {4, kBuffer}}, gather);
  first_set_ = make_set(first_);
  gpu::write_storage_image(device, first_set_, 1, orders_[kFirst]);
  gpu::write_buffer(device, first_set_, 4, kBuffer, nodes_);
  if (!published()) {
    make(next_, "next", {{0, kUniform}, {1, kTable}, {2, kImage}, {3, kImage}, {4, kBuffer}}, gather);
    for (size_t from = 0; from < next_sets_.size(); ++from) {
      next_sets_[from] = make_set(next_);
      gpu::write_sampled_image(device, next_sets_[from], 1, orders_[from], sampler_);
      gpu::write_storage_image(device, next_sets_[from], 2, orders_[kFirst]);
      gpu::write_storage_image(device, next_sets_[from], 3, orders_[1 + from % 3]);
      gpu::write_buffer(device, next_sets_[from], 4, kBuffer, nodes_);
    }
  }
  make(close_, table_.format == VK_FORMAT_R32G32B32A32_SFLOAT ? "close_float" : "close_half",
       {{0, kUniform}, {1, kImage}, {2, kImage}, {3, kImage}, {4, kImage}}, close);
  close_set_ = make_set(close_);
  const int last = orders_gathered();
  for (int less = 0; less < 3; ++less)
    gpu::write_storage_image(device, close_set_, static_cast<uint32_t>(1 + less),
                             orders_[place_of(std::max(last - less, 1))]);
  gpu::write_storage_image(device, close_set_, 4, table_);
  graph_.redo();
}
// [/rebuild]

int MultipleScatteringLut::orders_gathered() const {
  if (published()) return 1;
  const int wanted = context_.settings.integer("multiple_scattering.iterations");
  return wanted == 0 ? orders_of(make_atmosphere(context_.scene)) : std::max(wanted, 3);
}

std::string MultipleScatteringLut::explain() const {
  if (published())
    return "  multiple scattering  on   two orders, and a geometric series for the rest: the published method\n";
  return fmt::format("  multiple scattering  on   {} orders gathered: {}\n", orders_gathered(),
                     context_.settings.integer("multiple_scattering.iterations") == 0
                         ? "the air's optical depth asks for them"
                         : "multiple_scattering.iterations");
}

// [record]
// The images of the orders are the pass's own: the graph sees the table they end in.
void MultipleScatteringLut::record(const app::Frame& frame) const {
  const uint32_t side = table_.size.width;
  const auto write = [&](const gpu::Image& image) {
    gpu::image_barrier(frame.commands, image.handle, kEarlierRead, gpu::kComputeWrite);
  };
  const auto read = [&](const gpu::Image& image) {
    gpu::image_barrier(frame.commands, image.handle, gpu::kComputeWrite, kAnyRead);
  };
  gpu::buffer_barrier(frame.commands, nodes_.handle, kEarlierRead, gpu::kComputeWrite);
  gpu::dispatch(frame.commands, place_, place_set_, NoPush{}, (rays() * static_cast<uint32_t>(steps() / 4) + 31) / 32);
  gpu::buffer_barrier(frame.commands, nodes_.handle, gpu::kComputeWrite, gpu::kComputeRead);
  write(orders_[kFirst]);
  gpu::dispatch(frame.commands, first_, first_set_, NoPush{}, side, side);
  read(orders_[kFirst]);
  for (int n = 2; n <= orders_gathered(); ++n) {
    const gpu::Image& to = orders_[place_of(n)];
    write(to);
    gpu::dispatch(frame.commands, next_, next_sets_[place_of(n - 1)], NoPush{}, side, side);
    read(to);
  }
  gpu::dispatch_over(frame.commands, close_, close_set_, NoPush{}, {side, side});
}
// [/record]

}  // namespace welkin
