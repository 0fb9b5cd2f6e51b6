// Swapchain and frames in flight. See swapchain.hpp.
#include "chapters/02_window/swapchain.hpp"

#include <algorithm>

namespace welkin {
namespace {

gpu::Semaphore create_semaphore(const gpu::Device& device, VkSemaphoreType type) {
  const VkSemaphoreTypeCreateInfo kind{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, .semaphoreType = type};
  const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &kind};
  VkSemaphore semaphore = VK_NULL_HANDLE;
  gpu::check(vkCreateSemaphore(device, &info, nullptr, &semaphore), "vkCreateSemaphore");
  return {device, semaphore};
}

// 8-bit UNORM: the display pass has applied the sRGB curve already, an SRGB format would apply it twice.
VkSurfaceFormatKHR choose_format(VkPhysicalDevice device, VkSurfaceKHR surface) {
  uint32_t count = 0;
  gpu::check(vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, nullptr),
             "vkGetPhysicalDeviceSurfaceFormatsKHR");
  std::vector<VkSurfaceFormatKHR> formats(count);
  gpu::check(vkGetPhysicalDeviceSurfaceFormatsKHR(device, surface, &count, formats.data()),
             "vkGetPhysicalDeviceSurfaceFormatsKHR");
  for (const VkSurfaceFormatKHR& format : formats)
    if ((format.format == VK_FORMAT_B8G8R8A8_UNORM || format.format == VK_FORMAT_R8G8B8A8_UNORM) &&
        format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR)
      return format;
  fail("the window offers none of the formats B8G8R8A8_UNORM, R8G8B8A8_UNORM: use --headless");
}

}  // namespace

WindowSwapchain::WindowSwapchain(const gpu::Device& device, VkSurfaceKHR surface, VkExtent2D framebuffer)
    : device_(device),
      surface_(surface),
      timeline_(create_semaphore(device, VK_SEMAPHORE_TYPE_TIMELINE)),
      pool_(gpu::create_command_pool(device)) {
  VkBool32 supported = VK_FALSE;
  gpu::check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queue_family(), surface, &supported),
             "vkGetPhysicalDeviceSurfaceSupportKHR");
  if (!supported)
    fail("{} cannot show pictures in this window: use --headless, or another --gpu", device.candidate().name);
  for (uint32_t i = 0; i < kFramesInFlight; ++i)
    slots_.push_back({gpu::allocate_commands(device, pool_), create_semaphore(device, VK_SEMAPHORE_TYPE_BINARY), 0,
                      gpu::Timer(device)});
  create(framebuffer, VK_NULL_HANDLE);
}

// [create]
void WindowSwapchain::create(VkExtent2D framebuffer, VkSwapchainKHR old) {
  VkSurfaceCapabilitiesKHR can;
  gpu::check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &can),
             "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  const VkSurfaceFormatKHR format = choose_format(device_.physical(), surface_);
  format_ = format.format;
  // Some window systems dictate the size; others leave it to us (0xFFFFFFFF) within bounds.
  size_ = can.currentExtent.width != ~0u
              ? can.currentExtent
              : VkExtent2D{std::clamp(framebuffer.width, can.minImageExtent.width, can.maxImageExtent.width),
                           std::clamp(framebuffer.height, can.minImageExtent.height, can.maxImageExtent.height)};
  const uint32_t most = can.maxImageCount == 0 ? ~0u : can.maxImageCount;  // 0: no limit
  const VkSwapchainCreateInfoKHR info{.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
                                      .surface = surface_,
                                      .minImageCount = std::min(can.minImageCount + 1, most),
                                      .imageFormat = format.format,
                                      .imageColorSpace = format.colorSpace,
                                      .imageExtent = size_,
                                      .imageArrayLayers = 1,
                                      .imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                      .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
                                      .preTransform = can.currentTransform,
                                      .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
                                      .presentMode = VK_PRESENT_MODE_FIFO_KHR,  // the one mode every driver has
                                      .clipped = VK_TRUE,
                                      .oldSwapchain = old};
  VkSwapchainKHR handle = VK_NULL_HANDLE;
  gpu::check(vkCreateSwapchainKHR(device_, &info, nullptr, &handle), "vkCreateSwapchainKHR");
  swapchain_ = gpu::Swapchain(device_, handle);

  uint32_t count = 0;
  gpu::check(vkGetSwapchainImagesKHR(device_, handle, &count, nullptr), "vkGetSwapchainImagesKHR");
  images_.resize(count);
  gpu::check(vkGetSwapchainImagesKHR(device_, handle, &count, images_.data()), "vkGetSwapchainImagesKHR");
  views_.clear();
  render_finished_.clear();
  for (VkImage image : images_) {
    const VkImageViewCreateInfo view_info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                          .image = image,
                                          .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                          .format = format_,
                                          .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    VkImageView view = VK_NULL_HANDLE;
    gpu::check(vkCreateImageView(device_, &view_info, nullptr, &view), "vkCreateImageView");
    views_.emplace_back(device_, view);
    render_finished_.push_back(create_semaphore(device_, VK_SEMAPHORE_TYPE_BINARY));
  }
}
// [/create]

void WindowSwapchain::recreate(VkExtent2D framebuffer) {
  wait_for_presentation();
  const gpu::Swapchain old = std::move(swapchain_);
  views_.clear();
  create(framebuffer, old);
}

void WindowSwapchain::wait_for_all_frames() const {
  const VkSemaphoreWaitInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                 .semaphoreCount = 1,
                                 .pSemaphores = timeline_.address(),
                                 .pValues = &submitted_value_};
  gpu::check(vkWaitSemaphores(device_, &info, UINT64_MAX), "vkWaitSemaphores");
}

void WindowSwapchain::wait_for_presentation() const noexcept {
  // The timeline tells of our commands only. Presentation may still wait on the images' semaphores; the queue being
  // idle is what says that it does not. A lost device ends the wait too: whoever uses it next hears of that.
  vkQueueWaitIdle(device_.queue());
}

// [begin_frame]
FrameSlot* WindowSwapchain::begin_frame(uint32_t& image_index) {
  FrameSlot& slot = slots_[next_slot_];
  const VkSemaphoreWaitInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                 .semaphoreCount = 1,
                                 .pSemaphores = timeline_.address(),
                                 .pValues = &slot.finished_value};
  gpu::check(vkWaitSemaphores(device_, &info, UINT64_MAX), "vkWaitSemaphores");
  const VkResult result =
      vkAcquireNextImageKHR(device_, swapchain_, UINT64_MAX, slot.image_acquired, VK_NULL_HANDLE, &image_index);
  if (result == VK_ERROR_OUT_OF_DATE_KHR) return nullptr;
  gpu::check(result, "vkAcquireNextImageKHR");
  next_slot_ = (next_slot_ + 1) % kFramesInFlight;
  return &slot;
}
// [/begin_frame]

// [end_frame]
bool WindowSwapchain::end_frame(FrameSlot& slot, uint32_t image_index) {
  slot.finished_value = ++submitted_value_;
  const VkSemaphoreSubmitInfo wait{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                   .semaphore = slot.image_acquired,
                                   .stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT};
  const std::array<VkSemaphoreSubmitInfo, 2> signals{
      VkSemaphoreSubmitInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                            .semaphore = render_finished_[image_index],
                            .stageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT},
      VkSemaphoreSubmitInfo{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                            .semaphore = timeline_,
                            .value = submitted_value_,
                            .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT}};
  const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                           .commandBuffer = slot.commands};
  const VkSubmitInfo2 submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .waitSemaphoreInfoCount = 1,
                             .pWaitSemaphoreInfos = &wait,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos = &commands,
                             .signalSemaphoreInfoCount = static_cast<uint32_t>(signals.size()),
                             .pSignalSemaphoreInfos = signals.data()};
  gpu::check(vkQueueSubmit2(device_.queue(), 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit2");

  const VkPresentInfoKHR present{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                 .waitSemaphoreCount = 1,
                                 .pWaitSemaphores = render_finished_[image_index].address(),
                                 .swapchainCount = 1,
                                 .pSwapchains = swapchain_.address(),
                                 .pImageIndices = &image_index};
  const VkResult result = vkQueuePresentKHR(device_.queue(), &present);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) return false;
  gpu::check(result, "vkQueuePresentKHR");
  return true;
}
// [/end_frame]

}  // namespace welkin
