// See harness.hpp.
#include "tests/gpu/harness.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

namespace welkin::test {
namespace {

struct Machine {
  gpu::Instance instance{gpu::Validation::off, {}};
  gpu::Device device{instance, gpu::choose_device(gpu::list_devices(instance), ""), false};
  std::map<std::pair<std::string, gpu::Specialization>, gpu::ComputePipeline>
      pipelines;  // making one takes up to a second
};

Machine& machine() {
  static const std::unique_ptr<Machine> machine = [] {
    try {
      return std::make_unique<Machine>();
    } catch (const Error& error) {
      if (error.exit_code != Exit::skipped) throw;
      std::fprintf(stderr, "skipped: %s\n", error.what());
      std::_Exit(static_cast<int>(Exit::skipped));
    }
  }();
  return *machine;
}

const gpu::ComputePipeline& pipeline_of(const std::string& shader, const gpu::Specialization& specialization,
                                        bool has_table) {
  gpu::ComputePipeline& pipeline = machine().pipelines[{shader, specialization}];
  const size_t count = has_table ? 3 : 2;  // storage buffers: inputs, outputs, table
  if (pipeline.bindings.size() != count) {
    std::vector<gpu::Binding> bindings;
    for (uint32_t slot = 0; slot < count; ++slot) bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
    pipeline = gpu::create_compute_pipeline(device(), shader, bindings, sizeof(uint32_t), specialization);
  }
  return pipeline;
}

}  // namespace

const gpu::Device& device() { return machine().device; }

std::vector<float> evaluate(const std::string& shader, const std::vector<float>& inputs, size_t inputs_per_item,
                            size_t outputs_per_item, const gpu::Specialization& specialization,
                            const std::vector<float>& table) {
  const uint32_t count = static_cast<uint32_t>(inputs.size() / inputs_per_item);
  const gpu::ComputePipeline& pipeline = pipeline_of(shader, specialization, !table.empty());
  const gpu::DescriptorSet set = gpu::create_descriptor_set(device(), pipeline.set_layout, pipeline.bindings);
  const gpu::Buffer in = gpu::create_buffer(device(), "inputs", inputs.size() * sizeof(float),
                                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload);
  const gpu::Buffer out = gpu::create_buffer(device(), "outputs", count * outputs_per_item * sizeof(float),
                                             VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback);
  std::memcpy(in.mapped, inputs.data(), inputs.size() * sizeof(float));
  gpu::write_buffer(device(), set, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, in);
  gpu::write_buffer(device(), set, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, out);
  gpu::Buffer shared;
  if (!table.empty()) {
    shared = gpu::create_buffer(device(), "table", table.size() * sizeof(float), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                gpu::Where::upload);
    std::memcpy(shared.mapped, table.data(), table.size() * sizeof(float));
    gpu::write_buffer(device(), set, 2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, shared);
  }
  const gpu::CommandPool pool = gpu::create_command_pool(device());
  gpu::run_once(device(), pool, [&](VkCommandBuffer commands) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set.handle, 0, nullptr);
    vkCmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof count, &count);
    vkCmdDispatch(commands, (count + 63) / 64, 1, 1);
    gpu::buffer_barrier(commands, out.handle, gpu::kComputeWrite, gpu::kHostRead);
  });
  std::vector<float> outputs(count * outputs_per_item);
  std::memcpy(outputs.data(), out.mapped, outputs.size() * sizeof(float));
  return outputs;
}

std::string table_directory() {
  const char* path = std::getenv("WELKIN_TABLE");
  if (path == nullptr) throw std::runtime_error("WELKIN_TABLE names no directory");
  return path;
}

uint32_t Random::next() {
  const uint64_t old = state_;
  state_ = old * 6364136223846793005ull + 1442695040888963407ull;
  const uint32_t mixed = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
  const uint32_t turn = static_cast<uint32_t>(old >> 59);
  return (mixed >> turn) | (mixed << ((32 - turn) & 31));
}

double Random::log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

}  // namespace welkin::test
