// The Vulkan device: which one and why, its one queue, its memory types, and an account of what was allocated.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/gpu/instance.hpp"

namespace welkin::gpu {

class Pipelines;

// What is known of a physical device before it is used.
struct Candidate {
  VkPhysicalDevice handle = VK_NULL_HANDLE;
  std::string name;
  std::string driver;              // name and version, as it stands beside every measurement
  bool software = false;           // the processor pretends to be a GPU (lavapipe)
  std::vector<std::string> lacks;  // what Welkin wants and the device does not offer; empty: usable
};

// Every device of the instance, in the driver's order. inject_fault "missing-feature" marks all as lacking one.
std::vector<Candidate> list_devices(VkInstance instance, const std::string& inject_fault = {});

// The device asked for (a number of the list or part of a name; empty: the first usable of discrete, integrated,
// virtual, software). Throws Error with what was wanted, what was offered and which page to read.
const Candidate& choose_device(const std::vector<Candidate>& candidates, const std::string& wanted);

struct Allocation {
  std::string name;
  uint64_t bytes = 0;
  uint64_t id = 0;  // names need not be unique, these are
};

class Device {
 public:
  Device(const Instance& instance, const Candidate& candidate, bool swapchain);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  operator VkDevice() const { return device_; }
  VkPhysicalDevice physical() const { return candidate_.handle; }
  const Candidate& candidate() const { return candidate_; }
  VkQueue queue() const { return queue_; }
  uint32_t queue_family() const { return queue_family_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  uint32_t timestamp_bits() const { return timestamp_bits_; }

  // Index of a memory type among `type_bits` with all `properties`, if there is one.
  std::optional<uint32_t> memory_type(uint32_t type_bits, VkMemoryPropertyFlags properties) const;

  // Gives a handle the name that validation messages and debuggers show. Does nothing without validation.
  void set_name(VkObjectType type, const void* handle, const std::string& name) const;

  // The device's named pipelines: every graph asks here, so that programs of one process share what they have compiled.
  Pipelines& pipelines() const { return *pipelines_; }

  // Live allocations by resource name, kept by Image and Buffer.
  std::vector<Allocation>& allocations() const { return allocations_; }
  uint64_t allocated_bytes() const;
  // How many allocations there have ever been: a frame that makes one shows here.
  uint64_t& allocation_count() const { return allocation_count_; }

 private:
  Candidate candidate_;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t queue_family_ = 0;
  uint32_t timestamp_bits_ = 0;
  VkPhysicalDeviceLimits limits_{};
  VkPhysicalDeviceMemoryProperties memory_{};
  PFN_vkSetDebugUtilsObjectNameEXT set_name_ = nullptr;
  std::unique_ptr<Pipelines> pipelines_;
  mutable std::vector<Allocation> allocations_;
  mutable uint64_t allocation_count_ = 0;
};

}  // namespace welkin::gpu
