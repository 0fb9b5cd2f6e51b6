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
  AccountEntry(AccountEntry&& other) noexcept { *this = std::move(other); }
  AccountEntry& operator=(AccountEntry&& other) noexcept {
    std::swap(device_, other.device_), std::swap(id_, other.id_), std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~AccountEntry();
  uint64_t bytes() const { return bytes_; }

 private:
  const Device* device_ = nullptr;
  uint64_t id_ = 0, bytes_ = 0;
};

struct Image {
  Memory memory;  // freed last
  ImageHandle handle;
  ImageView view;
  VkExtent2D size{};
  uint32_t depth = 1;  // slices of a 3-D image
  uint32_t mips = 1, layers = 1;
  std::vector<ImageView> mip_views;  // one a mip, if there are several: a storage image is one mip
  VkFormat format = VK_FORMAT_UNDEFINED;
  AccountEntry account;
};

// An image in device memory, layout UNDEFINED: 2-D, or 3-D of `depth` slices if that is above 0, with mips and layers.
// Throws if a side is 0 or beyond the device's limit. Depth formats get a depth view, all others a colour view.
Image create_image(const Device& device, const std::string& name, VkExtent2D size, VkFormat format,
                   VkImageUsageFlags usage, uint32_t depth = 0, uint32_t mips = 1, uint32_t layers = 1);

// What of an image a view or a barrier is about.
VkImageAspectFlags aspect_of(VkFormat format);

// How a shader reads between texels, and at the borders: the last texel, or around to the first.
enum class Border { clamp, repeat };
Sampler create_sampler(const Device& device, Border u = Border::clamp, Border v = Border::clamp,
                       VkFilter filter = VK_FILTER_LINEAR, Border w = Border::clamp);

struct Buffer {
  Memory memory;
  BufferHandle handle;
  VkDeviceSize bytes = 0;
  void* mapped = nullptr;  // host-visible buffers stay mapped, and are coherent
  AccountEntry account;

  template <typename T>
  std::span<T> as() const {
    return {static_cast<T*>(mapped), static_cast<size_t>(bytes / sizeof(T))};
  }
};

// Device memory; host-written; host-read (cached where there is such); host-written every frame (device-local where
// there is).
enum class Where { device, upload, readback, stream };

Buffer create_buffer(const Device& device, const std::string& name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                     Where where);

}  // namespace welkin::gpu
