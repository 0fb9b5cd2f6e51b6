// Functions of chapter 18 on the device: tests/gpu/shaders/18_parts.comp over arrays.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <vector>

#include "tests/gpu/harness.hpp"

namespace welkin::test {

// Which function an item names in its first float; the shader says what follows.
enum Part { kPhase, kDroplet, kTurn, kExponentialIntegrals, kPowder, kOctaves, kOptics };

using PartItem = std::array<float, 12>;
using PartResult = std::array<float, 8>;

constexpr int kSphereNodes = 4000;

inline std::vector<PartResult> parts(const std::vector<PartItem>& items) {
  std::vector<float> inputs(items.size() * 12);
  std::memcpy(inputs.data(), items.data(), inputs.size() * sizeof(float));
  const std::vector<float> outputs = evaluate("tests/18_parts.comp", inputs, 12, 8);
  std::vector<PartResult> results(items.size());
  std::memcpy(results.data(), outputs.data(), outputs.size() * sizeof(float));
  return results;
}

}  // namespace welkin::test
