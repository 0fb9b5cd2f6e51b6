// The present pass. See present.hpp.
#include "chapters/02_window/present.hpp"

namespace welkin {
namespace {

constexpr gpu::Use kFragmentRead{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                                 VK_IMAGE_LAYOUT_GENERAL};
// The acquire semaphore is waited for at this stage: starting the layout change from it orders the two.
constexpr gpu::Use kAcquired{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT};
constexpr gpu::Use kColourWrite{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};

const std::vector<gpu::Binding> kBindings{{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_SHADER_STAGE_FRAGMENT_BIT}};

}  // namespace

PresentPass::PresentPass(const gpu::Device& device, VkFormat format)
    : set_layout_(gpu::create_set_layout(device, kBindings)),
      layout_(gpu::create_pipeline_layout(device, set_layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0)),
      pipeline_(
          gpu::create_graphics_pipeline(device, "02_window/present.vert", "02_window/present.frag", layout_, format)),
      set_(gpu::create_descriptor_set(device, set_layout_, kBindings)) {}

void PresentPass::set_image(const gpu::Device& device, const gpu::Image& displayed) {
  gpu::write_storage_image(device, set_, 0, displayed);
}

// [record]
void PresentPass::record(VkCommandBuffer commands, const gpu::Image& displayed, VkImage target, VkImageView target_view,
                         VkExtent2D size) const {
  gpu::image_barrier(commands, displayed.handle, gpu::kComputeWrite, kFragmentRead);
  gpu::image_barrier(commands, target, kAcquired, kColourWrite);
  const VkRenderingAttachmentInfo colour{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                         .imageView = target_view,
                                         .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                         .loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,  // the triangle covers every pixel
                                         .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  const VkRect2D area{{0, 0}, size};
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = area,
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &colour};
  vkCmdBeginRendering(commands, &rendering);
  const VkViewport viewport{0.0f, 0.0f, static_cast<float>(size.width), static_cast<float>(size.height), 0.0f, 1.0f};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &area);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &set_.handle, 0, nullptr);
  vkCmdDraw(commands, 3, 1, 0, 0);
  vkCmdEndRendering(commands);
}
// [/record]

}  // namespace welkin
