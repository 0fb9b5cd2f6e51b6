// What the frame graph says of itself: passes, barriers, bytes, in words and in numbers. See graph.hpp.
#include <algorithm>
#include <set>

#include "common/graph/graph.hpp"

namespace welkin::graph {

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

size_t Graph::pipelines() const {
  std::set<const gpu::NamedPipeline*> bound;
  for (const Counted* counted : order_)
    for (const Made& made : counted->steps)
      if (made.pipeline) bound.insert(made.pipeline.get());
  return bound.size();
}

bool Graph::serves(uint32_t owner) const {
  const auto touches_its = [owner](const Touch& touch) { return touch.held->owner == owner; };
  return std::any_of(order_.begin(), order_.end(), [&](const Counted* counted) {
    return counted->owner == owner || std::any_of(counted->steps.begin(), counted->steps.end(), [&](const Made& made) {
             return std::any_of(made.touches.begin(), made.touches.end(), touches_its);
           });
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
