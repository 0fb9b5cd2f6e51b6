// The Vulkan instance: which layers watch us, and what they said.
#pragma once

#include <string>
#include <vector>

#include "common/gpu/vk.hpp"

namespace welkin::gpu {

enum class Validation { off, on, sync };  // sync: hazards between commands too

// Created first, destroyed last. Headless use names no window-system extension.
class Instance {
 public:
  // window_extensions: what the window library asks for; empty when headless.
  Instance(Validation validation, const std::vector<const char*>& window_extensions);
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  operator VkInstance() const { return instance_; }
  bool debug_names() const { return messenger_ != VK_NULL_HANDLE; }

  // Warnings and errors the validation layers reported so far, in order. A run that has any ends with exit code 3.
  const std::vector<std::string>& validation_messages() const { return messages_; }

 private:
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::vector<std::string> messages_;
};

}  // namespace welkin::gpu
