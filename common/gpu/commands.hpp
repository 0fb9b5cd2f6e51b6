// Command buffers, the barrier that states all its facts, and the slow but simple copies used outside frames.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "common/gpu/resources.hpp"

namespace welkin::gpu {

// One side of a dependency: who touches the resource, how, and (for images) in which layout.
struct Use {
  VkPipelineStageFlags2 stage = VK_PIPELINE_STAGE_2_NONE;
  VkAccessFlags2 access = VK_ACCESS_2_NONE;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// The uses that occur, by name, so that a barrier reads "from compute_write to transfer_read".
inline constexpr Use kComputeWrite{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                   VK_IMAGE_LAYOUT_GENERAL};
inline constexpr Use kComputeRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                                  VK_IMAGE_LAYOUT_GENERAL};
inline constexpr Use kSampledRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                  VK_IMAGE_LAYOUT_GENERAL};
inline constexpr Use kUniformRead{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_UNIFORM_READ_BIT};
inline constexpr Use kTransferRead{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
inline constexpr Use kTransferWrite{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
// vkCmdUpdateBuffer is a transfer; which of the finer stages it belongs to, drivers and layers do not agree on.
inline constexpr Use kUpdate{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Use kHostRead{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};

// Everything `before` does to the image happens before, and is visible to, everything `after` does; the image changes
// from before.layout to after.layout (UNDEFINED before: the old content is not needed).
void image_barrier(VkCommandBuffer commands, VkImage image, Use before, Use after,
                   VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT);
void buffer_barrier(VkCommandBuffer commands, VkBuffer buffer, Use before, Use after);

CommandPool create_command_pool(const Device& device);
VkCommandBuffer allocate_commands(const Device& device, VkCommandPool pool);
void begin_commands(VkCommandBuffer commands);
void end_commands(VkCommandBuffer commands);

// Records, submits and waits: for set-up and instruments, never inside a frame.
void run_once(const Device& device, VkCommandPool pool, const std::function<void(VkCommandBuffer)>& record);

// Submits and waits on a fence for the one command buffer.
void submit_and_wait(const Device& device, VkCommandBuffer commands);

// Records a copy of a whole image in layout TRANSFER_SRC_OPTIMAL into a buffer, rows tightly packed.
void copy_image_to_buffer(VkCommandBuffer commands, const Image& image, const Buffer& buffer);

}  // namespace welkin::gpu
