// The window's images: swapchain, frames in flight, and the semaphores between the window system and us.
#pragma once

#include <array>
#include <vector>

#include "common/gpu/commands.hpp"
#include "common/gpu/timer.hpp"

namespace welkin {

inline constexpr uint32_t kFramesInFlight = 2;

// One frame the processor may prepare while the device still draws the one before.
struct FrameSlot {
  VkCommandBuffer commands = VK_NULL_HANDLE;
  gpu::Semaphore image_acquired;  // free again when this slot's frame has finished: one per frame in flight
  uint64_t finished_value = 0;    // the timeline reaches this when the device is done with the slot
  gpu::Timer timer;
};

class WindowSwapchain {
 public:
  WindowSwapchain(const gpu::Device& device, VkSurfaceKHR surface, VkExtent2D framebuffer);

  // Waits for every frame in flight, then makes the swapchain anew. A framebuffer of zero size must not get here.
  void recreate(VkExtent2D framebuffer);
  void wait_for_all_frames() const;
  // Waits for their presentation too: before anything it uses is destroyed, never in a frame.
  void wait_for_presentation() const noexcept;

  // Waits until this slot's earlier frame is finished and takes the next image. Returns nullptr if the swapchain is out
  // of date: recreate, then try again.
  FrameSlot* begin_frame(uint32_t& image_index);
  // Submits the slot's commands and presents. Returns false if the swapchain should be recreated.
  bool end_frame(FrameSlot& slot, uint32_t image_index);

  VkExtent2D size() const { return size_; }
  VkFormat format() const { return format_; }
  uint32_t image_count() const { return static_cast<uint32_t>(images_.size()); }
  VkImage image(uint32_t index) const { return images_[index]; }
  VkImageView view(uint32_t index) const { return views_[index]; }

 private:
  void create(VkExtent2D framebuffer, VkSwapchainKHR old);

  const gpu::Device& device_;
  VkSurfaceKHR surface_;
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  VkExtent2D size_{};
  gpu::Swapchain swapchain_;
  std::vector<VkImage> images_;
  std::vector<gpu::ImageView> views_;
  // Presentation waits on these, and tells nobody when it is done waiting: only the image coming back proves it. So
  // they belong to the images, not to the frames in flight.
  std::vector<gpu::Semaphore> render_finished_;
  gpu::Semaphore timeline_;
  uint64_t submitted_value_ = 0;
  gpu::CommandPool pool_;
  std::vector<FrameSlot> slots_;
  uint32_t next_slot_ = 0;
};

}  // namespace welkin
