// Images and buffers that own their memory: one allocation each (few resources, simple accounting).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/gpu/device.hpp"

namespace welkin::gpu {

// Removes its entry from the device's account when the resource dies.
class AccountEntry {
 public:
  AccountEntry() = default;
  AccountEntry(const Device& device, const std::string& name, uint64_t bytes);
  AccountEntry(AccountEntry&& other) noexcept { std::swap(device_, other.device_), std::swap(name_, other.name_); }
  AccountEntry& operator=(AccountEntry&& other) noexcept {
    std::swap(device_, other.device_), std::swap(name_, other.name_);
    return *this;
  }
  ~AccountEntry();

 private:
  const Device* device_ = nullptr;
  std::string name_;
};

struct Image {
  Memory memory;       // freed last
  ImageHandle handle;
  ImageView view;
  VkExtent2D size{};
  VkFormat format = VK_FORMAT_UNDEFINED;
  AccountEntry account;
};

// A 2-D image in device memory, layout UNDEFINED. Throws if a side is 0 or beyond the device's limit.
Image create_image(const Device& device, const std::string& name, VkExtent2D size, VkFormat format, VkImageUsageFlags usage);

struct Buffer {
  Memory memory;
  BufferHandle handle;
  VkDeviceSize bytes = 0;
  void* mapped = nullptr;  // host-visible buffers stay mapped, and are coherent
  AccountEntry account;

  template <typename T>
  std::span<T> as() const { return {static_cast<T*>(mapped), static_cast<size_t>(bytes / sizeof(T))}; }
};

enum class Where { device, upload, readback };  // device memory; host-written; host-read (cached where there is such)

Buffer create_buffer(const Device& device, const std::string& name, VkDeviceSize bytes, VkBufferUsageFlags usage, Where where);

}  // namespace welkin::gpu
