// The pass "multiple scattering". See multiple_scattering_lut.hpp and docs/chapters/09_multiple_scattering_lut.md.
#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

namespace welkin {
namespace {

constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkDescriptorType kTable = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr uint32_t kLayers = 7;  // of shaders/09_multiple_scattering_lut/table.glsl
constexpr gpu::Use kEarlierRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT};
constexpr gpu::Use kAnyRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};

struct NoPush {
  int32_t unused[4] = {};
};

}  // namespace

// [knobs]
std::vector<Knob> multiple_scattering_knobs() {
  return {{.name = "orders", .meaning = "orders of scattering: 0 all, 1 single scattering only (then there is no table)", .minimum = 0, .maximum = 1, .initial = 0, .integer = true, .ladder = {1, 0}, .rebuilds = true},
          {.name = "multiple_scattering.method", .meaning = "what the table holds and how its series of orders is summed", .initial = 2, .choices = {"published", "isotropic", "moments"}, .ladder = {0, 1, 2}, .rebuilds = true},
          {.name = "multiple_scattering.iterations", .unit = "orders", .meaning = "orders gathered one by one before the series is closed (not by the published method)", .minimum = 3, .maximum = 64, .initial = 10, .integer = true, .ladder = {3, 5, 10, 20}, .rebuilds = true},
          {.name = "multiple_scattering.directions", .unit = "directions", .meaning = "directions light is gathered from, a multiple of 16", .minimum = 16, .maximum = 512, .initial = 64, .integer = true, .ladder = {16, 32, 64, 128, 256}, .rebuilds = true},
          {.name = "multiple_scattering.set", .meaning = "where those directions are", .initial = 1, .choices = {"fibonacci", "horizon"}, .ladder = {0, 1}, .rebuilds = true},
          {.name = "multiple_scattering.steps", .unit = "steps", .meaning = "samples along each of them, in fours", .minimum = 4, .maximum = 64, .initial = 12, .integer = true, .ladder = {4, 8, 12, 16, 32}, .rebuilds = true},
          {.name = "multiple_scattering.view_steps", .unit = "steps", .meaning = "samples of the table along a view ray, in fours", .minimum = 4, .maximum = 256, .initial = 16, .integer = true, .ladder = {4, 8, 16, 32}},
          {.name = "multiple_scattering.size", .unit = "texels", .meaning = "altitudes, and sun heights, in the table", .minimum = 8, .maximum = 128, .initial = 32, .integer = true, .ladder = {16, 24, 32, 64}, .rebuilds = true},
          {.name = "multiple_scattering.map", .meaning = "where its texels are and what they hold: evenly and as it is, or denser where light changes and by logarithm", .initial = 1, .choices = {"published", "horizon"}, .ladder = {0, 1}, .rebuilds = true},
          {.name = "multiple_scattering.format", .meaning = "bits of a number in the table: 16 or 32", .initial = 1, .choices = {"half", "float"}, .ladder = {0, 1}, .rebuilds = true}};
}
// [/knobs]

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
  const VkFormat format = settings.choice("multiple_scattering.format") == "half" ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT;
  constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  table_ = {};
  orders_ = {};
  table_ = gpu::create_image(context_.device, "multiple scattering", size, format, kUsage);
  for (size_t i = 0; i < (published() ? 1 : orders_.size()); ++i)
    orders_[i] = gpu::create_image(context_.device, "orders " + std::to_string(i), size, VK_FORMAT_R32G32B32A32_SFLOAT, kUsage);
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
  gather.push_back(static_cast<uint32_t>((settings.integer("multiple_scattering.directions") + 15) / 16 * 16));
  gather.push_back(static_cast<uint32_t>(settings.integer("multiple_scattering.set")));
  gather.push_back(static_cast<uint32_t>((settings.integer("multiple_scattering.steps") + 3) / 4 * 4));
  gpu::Specialization close = variant();
  close.push_back(!published());

  const auto make = [&](gpu::ComputePipeline& pipeline, const std::string& shader, std::vector<gpu::Binding> bindings, const gpu::Specialization& constants) {
    pipeline = gpu::create_compute_pipeline(device, "09_multiple_scattering_lut/" + shader + ".comp", std::move(bindings), sizeof(NoPush), constants);
  };
  const auto make_set = [&](const gpu::ComputePipeline& pipeline) {
    gpu::DescriptorSet set = gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings);
    gpu::write_buffer(device, set, 0, kUniform, air_.buffer());
    return set;
  };
  make(first_, published() ? "published" : "first", {{0, kUniform}, {1, kImage}}, gather);
  first_set_ = make_set(first_);
  gpu::write_storage_image(device, first_set_, 1, orders_[kFirst]);
  if (!published()) {
    make(next_, "next", {{0, kUniform}, {1, kTable}, {2, kImage}, {3, kImage}}, gather);
    for (size_t from = 0; from < next_sets_.size(); ++from) {
      next_sets_[from] = make_set(next_);
      gpu::write_sampled_image(device, next_sets_[from], 1, orders_[from], sampler_);
      gpu::write_storage_image(device, next_sets_[from], 2, orders_[kFirst]);
      gpu::write_storage_image(device, next_sets_[from], 3, orders_[1 + from % 3]);
    }
  }
  make(close_, table_.format == VK_FORMAT_R32G32B32A32_SFLOAT ? "close_float" : "close_half", {{0, kUniform}, {1, kImage}, {2, kImage}, {3, kImage}, {4, kImage}}, close);
  close_set_ = make_set(close_);
  const int last = orders_gathered();
  for (int less = 0; less < 3; ++less) gpu::write_storage_image(device, close_set_, static_cast<uint32_t>(1 + less), orders_[place_of(std::max(last - less, 1))]);
  gpu::write_storage_image(device, close_set_, 4, table_);
  graph_.redo();
}
// [/rebuild]

// [record]
// The images of the orders are the pass's own: the graph sees the table they end in.
void MultipleScatteringLut::record(const app::Frame& frame) const {
  const uint32_t side = table_.size.width;
  const auto write = [&](const gpu::Image& image) { gpu::image_barrier(frame.commands, image.handle, kEarlierRead, gpu::kComputeWrite); };
  const auto read = [&](const gpu::Image& image) { gpu::image_barrier(frame.commands, image.handle, gpu::kComputeWrite, kAnyRead); };
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
