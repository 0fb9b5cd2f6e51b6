// Ordering, culling and barriers of the frame graph. See graph.hpp.
#include "common/graph/graph.hpp"

#include <algorithm>

namespace welkin::graph {
namespace {

constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;
constexpr size_t kNobody = ~size_t{0};

bool writes(const gpu::Use& use) { return (use.access & kWrites) != 0; }

}  // namespace

Resource Graph::hold(Held held) {
  resources_.push_back(std::move(held));
  return static_cast<Resource>(resources_.size() - 1);
}

Resource Graph::add(std::string name, const gpu::Image& image, gpu::Use outside) {
  return hold({.name = std::move(name), .image = &image, .outside = outside});
}
Resource Graph::add(std::string name, const gpu::Buffer& buffer) {
  return hold({.name = std::move(name), .buffer = &buffer});
}

void Graph::replace(Resource resource, const gpu::Image& image) {
  resources_[resource].image = &image;
  resources_[resource].state = {};
  resources_[resource].outdated = true;
}

void Graph::add(Pass pass) { passes_.push_back({std::move(pass)}); }
void Graph::want(Resource resource) { resources_[resource].wanted = true; }

// A buffer has no layout, whatever the use says.
gpu::Use Graph::use_of(const Access& access) const {
  gpu::Use use = access.use;
  if (resources_[access.resource].buffer != nullptr) use.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  return use;
}

size_t Graph::writer_of(Resource resource) const {
  for (size_t i = 0; i < passes_.size(); ++i)
    for (const Access& access : passes_[i].pass.accesses)
      if (access.resource == resource && writes(access.use)) return i;
  return kNobody;
}

// [compile]
void Graph::compile() {
  for (const Counted& counted : passes_)
    for (const Access& access : counted.pass.accesses) {
      const std::string& name = resources_[access.resource].name;
      const auto same = [&](const Access& other) { return other.resource == access.resource; };
      if (std::count_if(counted.pass.accesses.begin(), counted.pass.accesses.end(), same) > 1)
        fail("frame graph: pass '{}' names '{}' twice; what it changes must be another resource than what it reads",
             counted.pass.name, name);
      const size_t writer = writer_of(access.resource);
      if (writer == kNobody) fail("frame graph: pass '{}' reads '{}', which no pass writes", counted.pass.name, name);
      if (writes(access.use) && &passes_[writer] != &counted)
        fail("frame graph: '{}' is written by '{}' and by '{}'; one pass writes a resource", name,
             passes_[writer].pass.name, counted.pass.name);
    }
  // From what is wanted back to what that needs: whoever is not reached is left out.
  order_.clear();
  for (Counted& counted : passes_) counted.needed = false;
  std::vector<int> mark(passes_.size(), 0);
  for (Resource resource = 0; resource < resources_.size(); ++resource) {
    if (!resources_[resource].wanted) continue;
    if (writer_of(resource) == kNobody)
      fail("frame graph: '{}' is wanted, and no pass writes it", resources_[resource].name);
    visit(writer_of(resource), mark);
  }
  image_barriers_.reserve(resources_.size());
  buffer_barriers_.reserve(resources_.size());
}

// Depth first: a pass follows the writers of all it reads. mark: 0 not seen, 1 being visited, 2 placed.
void Graph::visit(size_t index, std::vector<int>& mark) {
  if (mark[index] == 2) return;
  if (mark[index] == 1) fail("frame graph: pass '{}' needs its own result", passes_[index].pass.name);
  mark[index] = 1;
  for (const Access& access : passes_[index].pass.accesses)
    if (!writes(access.use)) visit(writer_of(access.resource), mark);
  mark[index] = 2;
  passes_[index].needed = true;
  order_.push_back(index);
}
// [/compile]

std::vector<Barrier> Graph::barriers(int frame) const {
  std::vector<Held> held = resources_;
  for (Held& one : held) one.state = {};
  std::vector<Barrier> derived;
  for (int i = 0; i <= frame; ++i) {
    derived.clear();
    for (Held& one : held) touched_outside(one);
    for (const size_t index : order_)
      for (const Access& access : passes_[index].pass.accesses) {
        gpu::Use before;
        if (depend(held[access.resource].state, use_of(access), before))
          derived.push_back({passes_[index].pass.name, held[access.resource].name, before, access.use});
      }
  }
  return derived;
}

// [depend]
bool Graph::depend(State& state, const gpu::Use& use, gpu::Use& before) {
  const bool new_layout = use.layout != state.layout;
  if (writes(use) || new_layout) {
    // After the last write, and after everybody who has read it since. A read leaves nothing to make visible.
    before = {state.written.stage | state.read_stages, state.read_stages == 0 ? state.written.access : VK_ACCESS_2_NONE,
              state.layout};
    // A layout is changed by the barrier itself, a write that later reads must see.
    const bool needed = before.stage != 0 || new_layout;
    if (writes(use))
      state = {.written = use, .layout = use.layout};
    else
      state = {.written = {use.stage, VK_ACCESS_2_NONE, use.layout},
               .read_stages = use.stage,
               .visible = {use},
               .readers = 1,
               .layout = use.layout};
    return needed;
  }
  state.read_stages |= use.stage;
  const auto covers = [&](const gpu::Use& seen) {
    return (use.stage & ~seen.stage) == 0 && (use.access & ~seen.access) == 0;
  };
  if (std::any_of(state.visible.begin(), state.visible.end(), covers)) return false;
  before = {state.written.stage, state.written.access, state.layout};
  state.visible[state.readers++ % state.visible.size()] = use;
  return true;
}
// [/depend]

void Graph::record_barriers(const app::Frame& frame, const Pass& pass) {
  image_barriers_.clear();
  buffer_barriers_.clear();
  for (const Access& access : pass.accesses) {
    Held& held = resources_[access.resource];
    if (writes(access.use)) held.written_now = true, held.outdated = false;
    gpu::Use before;
    if (!depend(held.state, use_of(access), before)) continue;
    if (drops_barriers_ && !writes(access.use)) continue;
    if (held.image != nullptr)
      image_barriers_.push_back({.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                 .srcStageMask = before.stage,
                                 .srcAccessMask = before.access,
                                 .dstStageMask = access.use.stage,
                                 .dstAccessMask = access.use.access,
                                 .oldLayout = before.layout,
                                 .newLayout = access.use.layout,
                                 .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                 .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                 .image = held.image->handle,
                                 .subresourceRange = {gpu::aspect_of(held.image->format), 0, 1, 0, 1}});
    else
      buffer_barriers_.push_back({.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
                                  .srcStageMask = before.stage,
                                  .srcAccessMask = before.access,
                                  .dstStageMask = access.use.stage,
                                  .dstAccessMask = access.use.access,
                                  .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                  .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                  .buffer = held.buffer->handle,
                                  .size = VK_WHOLE_SIZE});
  }
  if (image_barriers_.empty() && buffer_barriers_.empty()) return;
  const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .bufferMemoryBarrierCount = static_cast<uint32_t>(buffer_barriers_.size()),
                              .pBufferMemoryBarriers = buffer_barriers_.data(),
                              .imageMemoryBarrierCount = static_cast<uint32_t>(image_barriers_.size()),
                              .pImageMemoryBarriers = image_barriers_.data()};
  vkCmdPipelineBarrier2(frame.commands, &info);
}

// Whoever looks at the image between frames has read it; with layout UNDEFINED nobody wants its content any more.
void Graph::touched_outside(Held& held) {
  if (held.outside.stage == 0) return;
  held.state.read_stages |= held.outside.stage;
  if (held.outside.layout == VK_IMAGE_LAYOUT_UNDEFINED) held.state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
}

bool Graph::must_run(const Counted& counted, const app::Frame& frame) const {
  if (all_again_ || (counted.pass.changed && counted.pass.changed(frame))) return true;
  return std::any_of(counted.pass.accesses.begin(), counted.pass.accesses.end(), [&](const Access& access) {
    const Held& held = resources_[access.resource];
    return writes(access.use) ? held.outdated : held.written_now;
  });
}

// [execute]
void Graph::execute(const app::Frame& frame) {
  for (Held& held : resources_) {
    held.written_now = false;
    touched_outside(held);
  }
  for (const size_t index : order_) {
    Counted& counted = passes_[index];
    if (!must_run(counted, frame)) continue;
    if (counted.pass.idle && counted.pass.idle(frame)) {
      for (const Access& access : counted.pass.accesses) resources_[access.resource].outdated |= writes(access.use);
      continue;
    }
    record_barriers(frame, counted.pass);
    const gpu::TimedPass timed(frame.timer, frame.commands, counted.pass.name);
    counted.pass.record(frame);
    ++counted.runs;
  }
  all_again_ = false;
  ++frames_;
}
// [/execute]

std::string Graph::explain() const {
  std::string text = "frame graph:\n";
  for (const size_t index : order_) {
    const Counted& counted = passes_[index];
    text += fmt::format("  {:<20} ran in {} of {} frames{}\n", counted.pass.name, counted.runs, frames_,
                        counted.runs < frames_ ? "; in the others nothing it depends on had changed" : "");
  }
  for (const Counted& counted : passes_)
    if (!counted.needed) text += fmt::format("  {:<20} left out: nobody needs what it writes\n", counted.pass.name);
  for (const Barrier& barrier : barriers())
    text += fmt::format("  before {}: {} from {} to {}\n", barrier.pass, barrier.resource, describe(barrier.before),
                        describe(barrier.after));
  return text;
}

std::vector<std::string> Graph::order() const {
  std::vector<std::string> names;
  for (const size_t index : order_) names.push_back(passes_[index].pass.name);
  return names;
}

uint64_t Graph::runs(const std::string& pass) const {
  for (const Counted& counted : passes_)
    if (counted.pass.name == pass) return counted.runs;
  fail("frame graph: no pass '{}'", pass);
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
