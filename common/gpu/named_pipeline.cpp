// Pipelines by the names in their shaders. See named_pipeline.hpp.
#include "common/gpu/named_pipeline.hpp"

#include <algorithm>
#include <bit>

#include "common/gpu/shader_file.hpp"

namespace welkin::gpu {
namespace {

uint32_t bits_of(const Constant& constant) {
  if (const bool* flag = std::get_if<bool>(&constant.value)) return *flag;
  if (const int* number = std::get_if<int>(&constant.value)) return static_cast<uint32_t>(*number);
  return std::bit_cast<uint32_t>(std::get<float>(constant.value));
}

const char* type_name(size_t type) { return type == 0 ? "bool" : type == 1 ? "int" : "float"; }

// Of the constants those this shader has.
SpecializationMap specialize(const std::string& shader, const ShaderInterface& interface, const Constants& constants) {
  SpecializationMap map;
  for (const Constant& constant : constants) {
    const auto found = std::find_if(interface.constants.begin(), interface.constants.end(),
                                    [&](const ShaderConstant& c) { return c.name == constant.name; });
    if (found == interface.constants.end()) {
      if (constant.shared) continue;
      std::vector<std::string> names;
      for (const ShaderConstant& c : interface.constants) names.push_back(c.name);
      fail("shader {}: no constant '{}'; it has {}", shader, constant.name,
           names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")));
    }
    if (constant.value.index() != static_cast<size_t>(found->type))
      fail("shader {}: constant '{}' is of type {}, and a {} was given", shader, constant.name,
           type_name(static_cast<size_t>(found->type)), type_name(constant.value.index()));
    map.add(found->id, bits_of(constant));
  }
  return map;
}

}  // namespace

Constants joined(Constants first, const Constants& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

const Pipelines::Stage& Pipelines::stage(const std::string& shader) {
  const auto found = stages_.find(shader);
  if (found != stages_.end()) return found->second;
  std::vector<uint32_t> words = load_spirv(shader);
  ShaderInterface interface = reflect(words, shader);
  return stages_.emplace(shader, Stage{std::move(words), std::move(interface)}).first->second;
}

const ShaderInterface& Pipelines::interface_of(const std::string& shader) { return stage(shader).interface; }

void Pipelines::forget() {
  made_.clear();  // waits for those being made, which read the stages
  stages_.clear();
}

const Pipelines::Making& Pipelines::begin(const std::string& shader, const Constants& constants) {
  const Stage& stage_read = stage(shader);
  const SpecializationMap special = specialize(shader, stage_read.interface, constants);
  std::string key = shader;
  for (size_t i = 0; i < special.values.size(); ++i)
    key += fmt::format(" {}={}", special.entries[i].constantID, special.values[i]);
  const auto found = made_.find(key);
  if (found != made_.end()) return found->second;
  const auto make_it = [this, &stage_read, shader, special] { return make(shader, stage_read, special); };
  return made_.emplace(key, std::async(std::launch::async, make_it)).first->second;
}

std::shared_ptr<const NamedPipeline> Pipelines::get(const std::string& shader, const Constants& constants) {
  const Making making = begin(shader, constants);
  try {
    return making.get();
  } catch (...) {  // the next time it is tried again
    made_.clear();
    throw;
  }
}

void Pipelines::drop_unused() {
  if (made_.size() < kept_) return;
  std::erase_if(made_, [](const auto& made) { return made.second.get().use_count() == 1; });
}

std::shared_ptr<const NamedPipeline> Pipelines::make(const std::string& shader, const Stage& read,
                                                     const SpecializationMap& special) const {
  NamedPipeline pipeline{
      .shader = shader, .bindings = read.interface.bindings, .push_constant_bytes = read.interface.push_constant_bytes};
  std::vector<Binding> slots;
  for (ShaderBinding& binding : pipeline.bindings) {
    if (binding.name == kViewBlock) binding.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
    slots.push_back({binding.slot, binding.type, binding.stages});
  }
  ComputePipeline made =
      create_compute_pipeline(device_, shader, read.words, slots, pipeline.push_constant_bytes, special);
  pipeline.set_layout = std::move(made.set_layout);
  pipeline.layout = std::move(made.layout);
  pipeline.handle = std::move(made.handle);
  return std::make_shared<const NamedPipeline>(std::move(pipeline));
}

}  // namespace welkin::gpu
