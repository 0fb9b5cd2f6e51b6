// Vulkan's C API, a result check, and the one template all owned handles are made of.
#pragma once

#include <vulkan/vulkan.h>

#include <utility>

#include "common/error.hpp"

namespace welkin::gpu {

const char* result_name(VkResult result);

// Throws an Error naming the call and the result unless the call succeeded.
void check(VkResult result, const char* call);

// Owns one device-level handle: destroyed once, moved but never copied. A moved-from Handle is empty.
template <typename T, auto Destroy>
class Handle {
 public:
  using Raw = T;
  Handle() = default;
  Handle(VkDevice device, T handle) : device_(device), handle_(handle) {}
  Handle(Handle&& other) noexcept { swap(other); }
  Handle& operator=(Handle&& other) noexcept {
    Handle(std::move(other)).swap(*this);
    return *this;
  }
  ~Handle() {
    if (handle_ != VK_NULL_HANDLE) Destroy(device_, handle_, nullptr);
  }
  operator T() const { return handle_; }
  const T* address() const { return &handle_; }

 private:
  void swap(Handle& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
  }
  VkDevice device_ = VK_NULL_HANDLE;
  T handle_ = VK_NULL_HANDLE;
};

using ImageHandle = Handle<VkImage, vkDestroyImage>;
using Sampler = Handle<VkSampler, vkDestroySampler>;
using ImageView = Handle<VkImageView, vkDestroyImageView>;
using BufferHandle = Handle<VkBuffer, vkDestroyBuffer>;
using Memory = Handle<VkDeviceMemory, vkFreeMemory>;
using ShaderModule = Handle<VkShaderModule, vkDestroyShaderModule>;
using SetLayout = Handle<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using DescriptorPool = Handle<VkDescriptorPool, vkDestroyDescriptorPool>;
using PipelineLayout = Handle<VkPipelineLayout, vkDestroyPipelineLayout>;
using PipelineHandle = Handle<VkPipeline, vkDestroyPipeline>;
using CommandPool = Handle<VkCommandPool, vkDestroyCommandPool>;
using QueryPool = Handle<VkQueryPool, vkDestroyQueryPool>;
using Semaphore = Handle<VkSemaphore, vkDestroySemaphore>;
using Fence = Handle<VkFence, vkDestroyFence>;
using RenderPass = Handle<VkRenderPass, vkDestroyRenderPass>;
using Framebuffer = Handle<VkFramebuffer, vkDestroyFramebuffer>;
using Swapchain = Handle<VkSwapchainKHR, vkDestroySwapchainKHR>;

// What every vkCreate… function of a device does: it makes a handle from a description. `call` is its name, for
// check().
template <typename Owner, typename Create, typename Info>
Owner create(VkDevice device, Create* function, const Info& info, const char* call) {
  typename Owner::Raw handle = VK_NULL_HANDLE;
  check(function(device, &info, nullptr, &handle), call);
  return Owner(device, handle);
}

}  // namespace welkin::gpu
