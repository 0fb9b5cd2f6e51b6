// Ordering, culling, barriers and recording of the frame graph. See graph.hpp; what it makes is in graph_make.cpp.
#include "common/graph/graph.hpp"

#include <algorithm>

namespace welkin::graph {
namespace {

constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                                   VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT;
constexpr VkAccessFlags2 kReads = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT |
                                  VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
                                  VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;

bool writes(const gpu::Use& use) { return (use.access & kWrites) != 0; }
// An attachment that is cleared is not read: its load operation says so, the access mask does not.
bool only_reads(const gpu::Use& use) { return !writes(use) && (use.access & kReads) != 0; }

}  // namespace

void Recorder::push_bytes(const void* values, uint32_t bytes) const {
  if (bytes != pipeline->push_constant_bytes)
    fail("shader {}: its push constants are {} bytes, and {} were given", pipeline->shader,
         pipeline->push_constant_bytes, bytes);
  vkCmdPushConstants(frame.commands, pipeline->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, bytes, values);
}

void Recorder::dispatch(uint32_t groups_x, uint32_t groups_y, uint32_t groups_z) const {
  vkCmdDispatch(frame.commands, groups_x, groups_y, groups_z);
}

void Recorder::dispatch_over(VkExtent2D size) const { dispatch((size.width + 7) / 8, (size.height + 7) / 8); }

void Graph::add(Pass pass) {
  passes_.push_back(std::make_unique<Counted>());
  passes_.back()->pass = std::move(pass);
  passes_.back()->owner = owner_;
  passes_.back()->runs = past_runs_[passes_.back()->pass.name];
}

void Graph::set_output(Resource resource, bool output) { held_of(resource).output = output; }

void Graph::remove(uint32_t owner) {
  for (const auto& counted : passes_)
    if (counted->owner == owner) past_runs_[counted->pass.name] = counted->runs;
  std::erase_if(passes_, [&](const auto& counted) { return counted->owner == owner; });
  std::erase_if(held_, [&](const auto& entry) { return entry.second.owner == owner; });
  order_.clear();  // until compile()
}

Graph::Counted* Graph::writer_of(const Held& held) {
  for (const auto& counted : passes_)
    for (const Made& step : counted->steps)
      for (const Touch& touch : step.touches)
        if (touch.held == &held && writes(touch.use)) return counted.get();
  return nullptr;
}

// [check]
void Graph::check_accesses(const Counted& counted) {
  std::vector<const Held*> written;
  for (const Made& step : counted.steps)
    for (const Touch& touch : step.touches) {
      const std::string& name = touch.held->name;
      const auto clashes = [&](const Touch& other) {
        return &other != &touch && other.held == touch.held && other.last_frame == touch.last_frame &&
               (writes(other.use) || writes(touch.use)) && other.first_mip < touch.first_mip + touch.mips &&
               touch.first_mip < other.first_mip + other.mips;
      };
      if (std::any_of(step.touches.begin(), step.touches.end(), clashes))
        fail(
            "frame graph: pass '{}' names '{}' twice in a step; what it changes must be another resource than what it "
            "reads",
            counted.pass.name, name);
      const Counted* writer = writer_of(*touch.held);
      if (writer == nullptr && touch.held->kind != Kind::filled)
        fail("frame graph: pass '{}' reads '{}', which no pass writes", counted.pass.name, name);
      if (writes(touch.use) && writer != &counted)
        fail("frame graph: '{}' is written by '{}' and by '{}'; one pass writes a resource", name, writer->pass.name,
             counted.pass.name);
      if (writes(touch.use)) written.push_back(touch.held);
      if (only_reads(touch.use) && writer == &counted && !touch.last_frame &&
          std::count(written.begin(), written.end(), touch.held) == 0)
        fail("frame graph: pass '{}' reads '{}' before it has written it", counted.pass.name, name);
    }
}
// [/check]

// [cull]
void Graph::cull() {
  for (const auto& counted : passes_) check_accesses(*counted);
  // From the outputs back to what they need: whoever is not reached is left out.
  order_.clear();
  for (const auto& counted : passes_) counted->used = false;
  std::map<const Counted*, int> mark;
  for (auto& [resource, held] : held_) {
    if (!held.output) continue;
    Counted* writer = writer_of(held);
    if (writer == nullptr) fail("frame graph: '{}' is an output, and no pass writes it", held.name);
    visit(*writer, mark);
  }
  // Effects stand on those before them in the list: their passes run in its order, whichever was declared last.
  std::stable_sort(passes_.begin(), passes_.end(), [](const auto& a, const auto& b) { return a->owner < b->owner; });
  order_.clear();
  mark.clear();
  for (const auto& counted : passes_)
    if (counted->used) visit(*counted, mark);
  for (const auto& counted : passes_)
    if (!counted->used) counted->fresh = true;  // it will have missed what happens until it is needed again
}

// Depth first: a pass follows the writers of all it reads. mark: 0 not seen, 1 being visited, 2 placed.
void Graph::visit(Counted& counted, std::map<const Counted*, int>& mark) {
  if (mark[&counted] == 2) return;
  if (mark[&counted] == 1) fail("frame graph: pass '{}' needs its own result", counted.pass.name);
  mark[&counted] = 1;
  for (const Made& step : counted.steps)
    for (const Touch& touch : step.touches) {
      Counted* writer = touch.last_frame ? nullptr : writer_of(*touch.held);
      if (writer != nullptr && writer != &counted) visit(*writer, mark);
    }
  mark[&counted] = 2;
  counted.used = true;
  order_.push_back(&counted);
}
// [/cull]

// [depend]
bool Graph::depend(State& state, const gpu::Use& use, gpu::Use& before) {
  const bool new_layout = use.layout != state.layout;
  if (writes(use) || new_layout) {
    // After the last write, and after everybody who has read it since. A pure write after reads has nothing to make
    // visible.
    const bool visible = state.read_stages != 0 && (use.access & kReads) == 0;
    before = {state.written.stage | state.read_stages, visible ? VK_ACCESS_2_NONE : state.written.access, state.layout};
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

// Whoever looks at the image between frames has read it; with layout UNDEFINED nobody wants its content any more.
void Graph::touched_between_frames(Held& held) {
  if (held.between_frames.stage == 0) return;
  for (State& state : held.states[0]) {
    state.read_stages |= held.between_frames.stage;
    if (held.between_frames.layout == VK_IMAGE_LAYOUT_UNDEFINED) state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  }
}

std::vector<Barrier> Graph::barriers(int frame) const {
  Graph copy;  // of what barriers depend on; states as before a first frame
  std::map<const Held*, Held*> twin;
  for (const auto& [resource, held] : held_) {
    Held& mine = copy.held_[resource];
    mine.name = held.name, mine.kind = held.kind, mine.between_frames = held.between_frames;
    for (int i = 0; i < 2; ++i)
      mine.states[i].assign(held.states[i].size(), held.kind == Kind::filled ? held.states[i].front() : State{});
    twin[&held] = &mine;
  }
  std::vector<Barrier> derived;
  for (int i = 0; i <= frame; ++i, ++copy.frames_) {
    derived.clear();
    for (auto& [resource, held] : copy.held_) copy.touched_between_frames(held);
    for (const Counted* counted : order_)
      for (const Made& step : counted->steps)
        for (const Touch& touch : step.touches) {
          std::vector<State>& states = copy.states_of(*twin[touch.held], touch.last_frame);
          for (uint32_t mip = touch.first_mip; mip < touch.first_mip + touch.mips; ++mip) {
            gpu::Use before;
            if (depend(states[mip], touch.use, before))
              derived.push_back({counted->pass.name, touch.held->name, before, touch.use});
          }
        }
  }
  return derived;
}

// [barriers]
void Graph::record_barriers(const app::Frame& frame, const Made& made) {
  image_barriers_.clear();
  buffer_barriers_.clear();
  for (const Touch& touch : made.touches) {
    Held& held = *touch.held;
    const bool drop = drops_barriers_ && !writes(touch.use);
    std::vector<State>& states = states_of(held, touch.last_frame);
    for (uint32_t mip = touch.first_mip; mip < touch.first_mip + touch.mips; ++mip) {
      gpu::Use before;
      if (!depend(states[mip], touch.use, before) || drop) continue;
      if (held.is_buffer)
        buffer_barriers_.push_back({.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
                                    .srcStageMask = before.stage,
                                    .srcAccessMask = before.access,
                                    .dstStageMask = touch.use.stage,
                                    .dstAccessMask = touch.use.access,
                                    .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                    .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                    .buffer = held.buffer != nullptr ? held.buffer->handle : held.own_buffer.handle,
                                    .size = VK_WHOLE_SIZE});
      else {
        const gpu::Image& image = *image_of(held, &states == &held.states[1]);
        image_barriers_.push_back({.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                   .srcStageMask = before.stage,
                                   .srcAccessMask = before.access,
                                   .dstStageMask = touch.use.stage,
                                   .dstAccessMask = touch.use.access,
                                   .oldLayout = before.layout,
                                   .newLayout = touch.use.layout,
                                   .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                   .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                   .image = image.handle,
                                   .subresourceRange = {gpu::aspect_of(image.format), mip, 1, 0, image.layers}});
      }
    }
  }
  if (image_barriers_.empty() && buffer_barriers_.empty()) return;
  const VkDependencyInfo info{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                              .bufferMemoryBarrierCount = static_cast<uint32_t>(buffer_barriers_.size()),
                              .pBufferMemoryBarriers = buffer_barriers_.data(),
                              .imageMemoryBarrierCount = static_cast<uint32_t>(image_barriers_.size()),
                              .pImageMemoryBarriers = image_barriers_.data()};
  vkCmdPipelineBarrier2(frame.commands, &info);
}
// [/barriers]

// [must_run]
bool Graph::must_run(const Counted& counted, const app::Frame& frame) const {
  if (counted.fresh || (counted.pass.changed && counted.pass.changed(frame))) return true;
  for (const Made& step : counted.steps)
    for (const Touch& touch : step.touches)
      if (!touch.last_frame && (writes(touch.use) ? touch.held->outdated : touch.held->written_now)) return true;
  return false;
}
// [/must_run]

// [execute]
void Graph::execute(const app::Frame& frame, uint32_t view_offset) {
  for (auto& [resource, held] : held_) {
    held.written_now = false;
    held.last_valid = !cut_ && !held.outdated && frames_ > 0 && held.written_frame == frames_;
    touched_between_frames(held);
  }
  for (Counted* counted : order_) {
    if (!must_run(*counted, frame)) continue;
    if (counted->pass.needed && !counted->pass.needed(frame))
      counted->fresh = true;  // until somebody needs it
    else
      record(frame, view_offset, *counted);
  }
  ++frames_;
  cut_ = false;
}
// [/execute]

// [record]
void Graph::record(const app::Frame& frame, uint32_t view_offset, Counted& counted) {
  const bool timed = !counted.pass.times_itself;
  if (timed) frame.timer.begin_pass(frame.commands, counted.pass.name);
  for (size_t i = 0; i < counted.steps.size(); ++i) {
    const Made& made = counted.steps[i];
    const Step& step = counted.pass.steps[i];
    const Recorder recorder{frame, *this, made.pipeline.get()};
    if (step.when && !step.when(recorder)) continue;
    record_barriers(frame, made);
    if (made.pipeline != nullptr) {
      const VkDescriptorSet set = made.sets[made.alternates ? parity() : 0].handle;
      const bool views = std::any_of(made.pipeline->bindings.begin(), made.pipeline->bindings.end(),
                                     [](const gpu::ShaderBinding& b) { return b.name == gpu::kViewBlock; });
      vkCmdBindPipeline(frame.commands, VK_PIPELINE_BIND_POINT_COMPUTE, made.pipeline->handle);
      if (set != VK_NULL_HANDLE)
        vkCmdBindDescriptorSets(frame.commands, VK_PIPELINE_BIND_POINT_COMPUTE, made.pipeline->layout, 0, 1, &set,
                                views ? 1 : 0, &view_offset);
    }
    step.record(recorder);
    for (const Touch& touch : made.touches)
      if (writes(touch.use))
        touch.held->written_now = true, touch.held->outdated = false, touch.held->written_frame = frames_ + 1;
  }
  if (timed) frame.timer.end_pass(frame.commands);
  counted.fresh = false;
  ++counted.runs;
}
// [/record]

void Graph::redo() {
  for (const auto& counted : passes_) counted->fresh = true;
}

bool Graph::valid(Resource history) const { return held_.at(history).last_valid; }

void Graph::cut() { cut_ = true; }

}  // namespace welkin::graph
