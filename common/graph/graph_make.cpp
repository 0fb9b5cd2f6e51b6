// What the frame graph makes: resources, pipelines, descriptor sets; and what it says of itself. See graph.hpp.
#include <algorithm>

#include "common/graph/graph.hpp"

namespace welkin::graph {
namespace {

VkPipelineStageFlags2 pipeline_stages(VkShaderStageFlags stages) {
  VkPipelineStageFlags2 result = 0;
  if ((stages & VK_SHADER_STAGE_COMPUTE_BIT) != 0) result |= VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  if ((stages & VK_SHADER_STAGE_VERTEX_BIT) != 0) result |= VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
  if ((stages & VK_SHADER_STAGE_FRAGMENT_BIT) != 0) result |= VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  return result;
}

bool is_image(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE || type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

gpu::Use use_of(const gpu::ShaderBinding& binding) {
  gpu::Use use{.stage = pipeline_stages(binding.stages)};
  if (is_image(binding.type)) use.layout = VK_IMAGE_LAYOUT_GENERAL;
  if (binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER)
    use.access = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
  else if (binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER)
    use.access = VK_ACCESS_2_UNIFORM_READ_BIT;
  else
    use.access = (binding.reads ? VK_ACCESS_2_SHADER_STORAGE_READ_BIT : 0) |
                 (binding.writes ? VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT : 0);
  return use;
}

}  // namespace

Graph::Graph(const gpu::Device& device, gpu::Pipelines& pipelines, const std::string& inject)
    : device_(&device), pipelines_(&pipelines), drops_barriers_(inject == "missing-barrier") {}

Resource Graph::hold(Held held) {
  held.owner = owner_;
  start_states(held);
  held_.emplace(next_, std::move(held));
  return next_++;
}

void Graph::start_states(Held& held) {
  const uint32_t mips = held.is_buffer ? 1 : std::max(held.info.mips, 1u);
  // What was filled before is visible to everybody.
  constexpr gpu::Use everybody{~VkPipelineStageFlags2{0}, ~VkAccessFlags2{0}, VK_IMAGE_LAYOUT_GENERAL};
  State first{};
  if (held.kind == Kind::filled)
    first = {.visible = {everybody},
             .readers = 1,
             .layout = held.is_buffer ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL};
  for (std::vector<State>& states : held.states) states.assign(mips, first);
}

Resource Graph::add_image(std::string name, ImageInfo info) { return hold({.name = std::move(name), .info = info}); }
Resource Graph::add_lasting_image(std::string name, ImageInfo info) {
  const Resource image = add_image(std::move(name), info);
  held_of(image).owner = kNobody;
  return image;
}

Resource Graph::add_history(std::string name, ImageInfo info) {
  return hold({.name = std::move(name), .kind = Kind::history, .info = info});
}
Resource Graph::add_buffer(std::string name, BufferInfo info) {
  return hold({.name = std::move(name), .kind = Kind::buffer, .is_buffer = true, .buffer_info = info});
}

Resource Graph::add_filled(std::string name, gpu::Image&& image) {
  Held held{.name = std::move(name), .kind = Kind::filled, .info = {.mips = image.mips}};
  held.own_images[0] = std::move(image);
  return hold(std::move(held));
}

Resource Graph::add_filled(std::string name, gpu::Buffer&& buffer) {
  return hold({.name = std::move(name), .kind = Kind::filled, .is_buffer = true, .own_buffer = std::move(buffer)});
}

Resource Graph::import(std::string name, const gpu::Image* image, gpu::Use between_frames) {
  Held held{.name = std::move(name), .kind = Kind::imported, .image = image, .between_frames = between_frames};
  if (image != nullptr) held.info.mips = image->mips;
  return hold(std::move(held));
}

Resource Graph::import(std::string name, const gpu::Buffer* buffer) {
  return hold({.name = std::move(name), .kind = Kind::imported, .is_buffer = true, .buffer = buffer});
}

void Graph::replace(Resource resource, const gpu::Image* image, gpu::Use between_frames) {
  Held& held = held_of(resource);
  held.kind = image != nullptr ? Kind::imported : Kind::image;
  held.image = image, held.between_frames = between_frames, held.own_images[0] = {};
  held.states[0].assign(held.states[0].size(), {});
  held.outdated = true, held.version = ++versions_;
}

Resource Graph::add_filled(std::string name, ImageInfo info, std::function<gpu::Image()> fill) {
  return hold({.name = std::move(name), .kind = Kind::filled, .info = info, .fill = std::move(fill)});
}

const gpu::Image* Graph::image_of(const Held& held, bool second) {
  return held.image != nullptr ? held.image : &held.own_images[second ? 1 : 0];
}

const gpu::Image& Graph::image(Resource resource) const {
  const Held& held = held_.at(resource);
  return *image_of(held, held.kind == Kind::history && parity() == 1);
}

const gpu::Buffer& Graph::buffer(Resource resource) const {
  const Held& held = held_.at(resource);
  return held.buffer != nullptr ? *held.buffer : held.own_buffer;
}

const gpu::Image* Graph::find_image(const std::string& name) const {
  for (const auto& [resource, held] : held_)
    if (held.name == name && !held.is_buffer && image(resource).handle != VK_NULL_HANDLE) return &image(resource);
  return nullptr;
}

// [reflect]
// What each step touches: its accesses, and what its shaders' bindings are bound to.
void Graph::reflect(Counted& counted) {
  counted.steps.resize(counted.pass.steps.size());
  for (size_t i = 0; i < counted.steps.size(); ++i) {
    const Step& step = counted.pass.steps[i];
    std::vector<Touch>& touches = counted.steps[i].touches;
    touches.clear();
    const auto add = [&](Resource resource, gpu::Use use, int mip, bool last_frame) {
      Held& held = held_of(resource);
      if (held.is_buffer) use.layout = VK_IMAGE_LAYOUT_UNDEFINED;  // a buffer has none
      const uint32_t mips = static_cast<uint32_t>(held.states[0].size());
      if (mip >= static_cast<int>(mips))
        fail("frame graph: pass '{}': '{}' has {} mips, and mip {} was bound", counted.pass.name, held.name, mips, mip);
      touches.push_back(
          {&held, use, mip == kAllMips ? 0 : static_cast<uint32_t>(mip), mip == kAllMips ? mips : 1, last_frame});
    };
    for (const Access& access : step.accesses) add(access.resource, access.use, access.mip, access.last_frame);
    if (step.shader.empty()) continue;
    const std::vector<gpu::ShaderBinding>& wanted = pipelines_->interface_of(step.shader).bindings;
    std::vector<std::string> names;
    for (const gpu::ShaderBinding& binding : wanted) {
      names.push_back(binding.name);
      if (binding.name == gpu::kViewBlock) continue;
      const auto bound = std::find_if(step.bindings.begin(), step.bindings.end(),
                                      [&](const Binding& b) { return b.name == binding.name; });
      if (bound == step.bindings.end())
        fail("frame graph: pass '{}': nothing is bound to '{}' of shader {}", counted.pass.name, binding.name,
             step.shader);
      add(bound->resource, use_of(binding), bound->mip, bound->last_frame);
    }
    for (const Binding& bound : step.bindings)
      if (std::find(names.begin(), names.end(), bound.name) == names.end())
        fail("frame graph: pass '{}': shader {} has no binding '{}'; it has {}", counted.pass.name, step.shader,
             bound.name, fmt::join(names, ", "));
  }
}
// [/reflect]

// [compile]
void Graph::compile(VkExtent2D picture_size) {
  order_.clear();
  for (const auto& counted : passes_) reflect(*counted);
  cull();
  if (device_ == nullptr) return;
  try {
    make_all(picture_size);
  } catch (...) {
    order_.clear();  // nothing half made is executed
    throw;
  }
}

void Graph::make_all(VkExtent2D picture_size) {
  std::vector<const Held*> used;
  size_t barriers = 0;
  for (Counted* counted : order_)
    for (const Made& step : counted->steps)
      for (const Touch& touch : step.touches) used.push_back(touch.held), barriers += touch.mips;
  const auto of_picture = [](const Held* held) {
    return (held->kind == Kind::image || held->kind == Kind::history) && held->info.size.width == 0;
  };
  if (picture_size.width == 0 && std::any_of(used.begin(), used.end(), of_picture))
    return order_.clear();  // it follows
  for (auto& [resource, held] : held_) {
    if (std::find(used.begin(), used.end(), &held) != used.end())
      allocate(held, picture_size);
    else if ((held.kind != Kind::filled && held.kind != Kind::imported) || held.fill)
      held.own_images = {}, held.own_buffer = {}, held.outdated = true;
  }
  for (const Counted* counted : order_)
    for (const Step& step : counted->pass.steps)
      if (!step.shader.empty()) pipelines_->begin(step.shader, step.constants);
  for (Counted* counted : order_) make(*counted);
  pipelines_->drop_unused();
  image_barriers_.reserve(barriers);
  buffer_barriers_.reserve(barriers);
}

// Makes what is not there yet, or has another size now.
void Graph::allocate(Held& held, VkExtent2D picture_size) {
  if (held.fill && held.own_images[0].handle == VK_NULL_HANDLE) {
    held.own_images[0] = held.fill();
    start_states(held);
    held.version = ++versions_;
  }
  if (held.kind == Kind::filled || held.kind == Kind::imported) return;
  if (held.is_buffer) {
    if (held.own_buffer.handle != VK_NULL_HANDLE) return;
    held.own_buffer =
        gpu::create_buffer(*device_, held.name, held.buffer_info.bytes, held.buffer_info.usage, held.buffer_info.where);
    held.states[0].assign(1, {});
    held.outdated = true;
    return;
  }
  const VkExtent2D size = held.info.size.width > 0 ? held.info.size : picture_size;
  for (size_t i = 0; i < (held.kind == Kind::history ? 2u : 1u); ++i) {
    gpu::Image& image = held.own_images[i];
    if (image.handle != VK_NULL_HANDLE && image.size.width == size.width && image.size.height == size.height) continue;
    image = {};  // the old one goes before the new one comes
    image = gpu::create_image(*device_, held.name, size, held.info.format, held.info.usage, held.info.depth,
                              held.info.mips, held.info.layers);
    held.states[i].assign(held.info.mips, {});
    held.outdated = true, held.written_frame = 0, held.version = ++versions_;
  }
}
// [/compile]

void Graph::make(Counted& counted) {
  for (size_t i = 0; i < counted.steps.size(); ++i) {
    const Step& step = counted.pass.steps[i];
    Made& made = counted.steps[i];
    if (step.shader.empty()) continue;
    const auto pipeline = pipelines_->get(step.shader, step.constants);
    made.alternates = std::any_of(step.bindings.begin(), step.bindings.end(),
                                  [&](const Binding& b) { return held_of(b.resource).kind == Kind::history; });
    const bool other_layout = made.pipeline != pipeline;
    made.pipeline = pipeline;
    if (pipeline->bindings.empty()) continue;
    std::vector<gpu::Binding> bindings;
    for (const gpu::ShaderBinding& binding : pipeline->bindings)
      bindings.push_back({binding.slot, binding.type, binding.stages});
    for (uint32_t parity = 0; parity < (made.alternates ? 2u : 1u); ++parity) {
      if (other_layout || made.sets[parity].handle == VK_NULL_HANDLE)
        made.sets[parity] = gpu::create_descriptor_set(*device_, pipeline->set_layout, bindings);
      write_set(step, made, parity);
    }
  }
}

void Graph::write_set(const Step& step, Made& made, uint32_t parity) {
  for (const gpu::ShaderBinding& wanted : made.pipeline->bindings) {
    const gpu::DescriptorSet& set = made.sets[parity];
    if (wanted.name == gpu::kViewBlock) {
      if (view_ == nullptr) fail("shader {}: there is no view block here", step.shader);
      gpu::write_buffer(*device_, set, wanted.slot, wanted.type, *view_, view_bytes_);
      continue;
    }
    const Binding& bound = *std::find_if(step.bindings.begin(), step.bindings.end(),
                                         [&](const Binding& b) { return b.name == wanted.name; });
    const Held& held = held_of(bound.resource);
    check_fit(step, wanted, held);
    if (held.is_buffer) {
      gpu::write_buffer(*device_, set, wanted.slot, wanted.type, buffer(bound.resource));
      continue;
    }
    const gpu::Image& image = *image_of(held, held.kind == Kind::history && (bound.last_frame != (parity == 1)));
    const VkImageView view = bound.mip != kAllMips && image.mips > 1 ? image.mip_views[static_cast<size_t>(bound.mip)]
                             : wanted.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE && image.mips > 1
                                 ? image.mip_views.front()
                                 : image.view;
    gpu::write_image_view(
        *device_, set, wanted.slot, wanted.type, view,
        wanted.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER ? sampler(bound.sampling) : VK_NULL_HANDLE);
  }
}

void Graph::check_fit(const Step& step, const gpu::ShaderBinding& wanted, const Held& held) const {
  const auto refuse = [&](const std::string& why) {
    fail("shader {}: '{}' is bound to '{}': {}", step.shader, wanted.name, held.name, why);
  };
  if (is_image(wanted.type) == held.is_buffer)
    refuse(held.is_buffer ? "an image is wanted, and this is a buffer" : "a buffer is wanted, and this is an image");
  if (held.is_buffer) {
    const uint64_t bytes = held.buffer != nullptr ? held.buffer->bytes : held.own_buffer.bytes;
    if (wanted.bytes > bytes) refuse(fmt::format("the block has {} bytes, the buffer {}", wanted.bytes, bytes));
    return;
  }
  const gpu::Image& image = *image_of(held, false);
  if (wanted.format != VK_FORMAT_UNDEFINED && wanted.format != image.format)
    refuse(fmt::format("the shader has format {}, the image {}", static_cast<int>(wanted.format),
                       static_cast<int>(image.format)));
  if (wanted.volume != (held.info.depth > 0 || image.depth > 1))
    refuse(wanted.volume ? "a 3-D image is wanted" : "a 2-D image is wanted, and this is 3-D");
}

VkSampler Graph::sampler(const Sampling& sampling) {
  gpu::Sampler& kept = samplers_[{static_cast<int>(sampling.u), static_cast<int>(sampling.v),
                                  static_cast<int>(sampling.filter), static_cast<int>(sampling.w)}];
  if (kept == VK_NULL_HANDLE) kept = gpu::create_sampler(*device_, sampling.u, sampling.v, sampling.filter, sampling.w);
  return kept;
}

std::string Graph::explain() const {
  std::string text = "frame graph:\n";
  for (const Counted* counted : order_)
    text += fmt::format("  {:<20} ran in {} of {} frames{}\n", counted->pass.name, counted->runs, frames_,
                        counted->runs < frames_ ? "; in the others nothing it depends on had changed" : "");
  for (const auto& counted : passes_)
    if (!counted->used) text += fmt::format("  {:<20} left out: nobody needs what it writes\n", counted->pass.name);
  for (const Barrier& barrier : barriers())
    text += fmt::format("  before {}: {} from {} to {}\n", barrier.pass, barrier.resource, describe(barrier.before),
                        describe(barrier.after));
  return text;
}

std::vector<std::string> Graph::order() const {
  std::vector<std::string> names;
  for (const Counted* counted : order_) names.push_back(counted->pass.name);
  return names;
}

std::vector<std::string> Graph::order(uint32_t owner) const {
  std::vector<std::string> names;
  for (const Counted* counted : order_)
    if (counted->owner == owner) names.push_back(counted->pass.name);
  return names;
}

std::vector<std::string> Graph::resources(uint32_t owner) const {
  std::vector<std::string> names;
  for (const auto& [resource, held] : held_)
    if (held.owner == owner && bytes_of(held) > 0) names.push_back(held.name);
  return names;
}

uint64_t Graph::bytes_of(const Held& held) {
  return held.own_images[0].account.bytes() + held.own_images[1].account.bytes() + held.own_buffer.account.bytes();
}

uint64_t Graph::bytes() const {
  uint64_t sum = 0;
  for (const auto& [resource, held] : held_) sum += bytes_of(held);
  return sum;
}

uint64_t Graph::runs(const std::string& pass) const {
  for (const auto& counted : passes_)
    if (counted->pass.name == pass) return counted->runs;
  return 0;
}

bool Graph::has_pass(uint32_t owner) const {
  return std::any_of(order_.begin(), order_.end(), [&](const Counted* counted) { return counted->owner == owner; }) ||
         std::any_of(held_.begin(), held_.end(), [&](const auto& entry) {
           return entry.second.owner == owner && entry.second.fill && bytes_of(entry.second) > 0;
         });
}

std::string describe(const gpu::Use& use) {
  std::string text;
  const auto bits = [&](auto value, std::initializer_list<std::pair<uint64_t, const char*>> names) {
    for (const auto& [bit, name] : names)
      if ((value & bit) != 0) text += (text.empty() ? "" : ", ") + std::string(name);
  };
  bits(use.stage, {{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute shader"},
                   {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex shader"},
                   {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment shader"},
                   {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "early depth test"},
                   {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "late depth test"},
                   {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "attachment output"},
                   {VK_PIPELINE_STAGE_2_COPY_BIT, "copy"},
                   {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"}});
  if (text.empty()) text = "nothing";
  bits(use.access, {{VK_ACCESS_2_SHADER_STORAGE_READ_BIT, "storage read"},
                    {VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, "storage write"},
                    {VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, "sampled read"},
                    {VK_ACCESS_2_UNIFORM_READ_BIT, "uniform read"},
                    {VK_ACCESS_2_TRANSFER_WRITE_BIT, "write"},
                    {VK_ACCESS_2_TRANSFER_READ_BIT, "read"},
                    {VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, "colour write"},
                    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT, "depth write"},
                    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, "depth read"}});
  switch (use.layout) {
    case VK_IMAGE_LAYOUT_UNDEFINED: break;  // a buffer, or content that is not needed
    case VK_IMAGE_LAYOUT_GENERAL: text += ", GENERAL"; break;
    case VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL: text += ", ATTACHMENT_OPTIMAL"; break;
    case VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL: text += ", READ_ONLY_OPTIMAL"; break;
    default: text += fmt::format(", layout {}", static_cast<int>(use.layout));
  }
  return text;
}

}  // namespace welkin::graph
