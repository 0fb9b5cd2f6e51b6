// Runs a shader function over arrays on the device: tests/gpu/shaders/NAME.comp reads inputs_per_item floats per item
// from binding 0 and writes outputs_per_item floats to binding 1, 64 items a workgroup, `count` as push constant.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/gpu/commands.hpp"
#include "common/gpu/pipeline.hpp"

namespace welkin::test {

// One device for all tests of a program. A machine without any Vulkan device skips: the process ends with 77.
const gpu::Device& device();

// Items evaluated in one call: inputs.size() / inputs_per_item. Returns that many times outputs_per_item floats.
// `table`: what all items read, at binding 2, where the shader has one.
std::vector<float> evaluate(const std::string& shader, const std::vector<float>& inputs, size_t inputs_per_item,
                            size_t outputs_per_item, const gpu::Specialization& specialization = {},
                            const std::vector<float>& table = {});

// The directory that $WELKIN_TABLE names, for tables of the book. Throws without it.
std::string table_directory();

// Reproducible uniform random numbers (PCG-XSH-RR 64/32): the same on every compiler, unlike std distributions.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed * 2 + 1) { next(); }
  uint32_t next();
  double uniform(double low, double high) { return low + (high - low) * (next() * 0x1p-32); }
  double log_uniform(double low, double high);  // 0 < low < high

 private:
  uint64_t state_;
};

}  // namespace welkin::test
