// Command recording helpers. See commands.hpp.
#include "common/gpu/commands.hpp"

namespace welkin::gpu {

// [barrier]
void image_barrier(VkCommandBuffer commands, VkImage image, Use before, Use after, VkImageAspectFlags aspect) {
  const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                      .srcStageMask = before.stage,
                                      .srcAccessMask = before.access,
                                      .dstStageMask = after.stage,
                                      .dstAccessMask = after.access,
                                      .oldLayout = before.layout,
                                      .newLayout = after.layout,
                                      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                      .image = image,
                                      .subresourceRange = {aspect, 0, 1, 0, 1}};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &info);
}
// [/barrier]

void buffer_barrier(VkCommandBuffer commands, VkBuffer buffer, Use before, Use after) {
  const VkBufferMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
                                       .srcStageMask = before.stage,
                                       .srcAccessMask = before.access,
                                       .dstStageMask = after.stage,
                                       .dstAccessMask = after.access,
                                       .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .buffer = buffer,
                                       .offset = 0,
                                       .size = VK_WHOLE_SIZE};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .bufferMemoryBarrierCount = 1, .pBufferMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &info);
}

CommandPool create_command_pool(const Device& device) {
  const VkCommandPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                     .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                     .queueFamilyIndex = device.queue_family()};
  return create<CommandPool>(device, vkCreateCommandPool, info, "vkCreateCommandPool");
}

VkCommandBuffer allocate_commands(const Device& device, VkCommandPool pool) {
  const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                         .commandPool = pool,
                                         .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                         .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device, &info, &commands), "vkAllocateCommandBuffers");
  return commands;
}

void begin_commands(VkCommandBuffer commands) {
  const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
}

void end_commands(VkCommandBuffer commands) { check(vkEndCommandBuffer(commands), "vkEndCommandBuffer"); }

// [submit]
void submit_and_wait(const Device& device, VkCommandBuffer commands) {
  const VkFenceCreateInfo fence_info{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  const Fence fence = create<Fence>(device, vkCreateFence, fence_info, "vkCreateFence");
  const VkCommandBufferSubmitInfo buffer{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                         .commandBuffer = commands};
  const VkSubmitInfo2 submit{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &buffer};
  check(vkQueueSubmit2(device.queue(), 1, &submit, fence), "vkQueueSubmit2");
  check(vkWaitForFences(device, 1, fence.address(), VK_TRUE, UINT64_MAX), "vkWaitForFences");
}
// [/submit]

void run_once(const Device& device, VkCommandPool pool, const std::function<void(VkCommandBuffer)>& record) {
  VkCommandBuffer commands = allocate_commands(device, pool);
  begin_commands(commands);
  record(commands);
  end_commands(commands);
  submit_and_wait(device, commands);
  vkFreeCommandBuffers(device, pool, 1, &commands);
}

void copy_image_to_buffer(VkCommandBuffer commands, const Image& image, const Buffer& buffer) {
  const VkBufferImageCopy2 region{.sType = VK_STRUCTURE_TYPE_BUFFER_IMAGE_COPY_2,
                                  .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                  .imageExtent = {image.size.width, image.size.height, 1}};
  const VkCopyImageToBufferInfo2 copy{.sType = VK_STRUCTURE_TYPE_COPY_IMAGE_TO_BUFFER_INFO_2,
                                      .srcImage = image.handle,
                                      .srcImageLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                      .dstBuffer = buffer.handle,
                                      .regionCount = 1,
                                      .pRegions = &region};
  vkCmdCopyImageToBuffer2(commands, &copy);
}

}  // namespace welkin::gpu
