// Shows the displayed picture in the window's image, texel for pixel, by one triangle and dynamic rendering.
#pragma once

#include "common/gpu/commands.hpp"
#include "common/gpu/pipeline.hpp"

namespace welkin {

class PresentPass {
 public:
  PresentPass(const gpu::Device& device, VkFormat format);
  void set_image(const gpu::Device& device, const gpu::Image& displayed);
  // `displayed` was written by compute and is in GENERAL; `target` comes out in COLOR_ATTACHMENT_OPTIMAL.
  void record(VkCommandBuffer commands, const gpu::Image& displayed, VkImage target, VkImageView target_view,
              VkExtent2D size) const;

 private:
  gpu::SetLayout set_layout_;
  gpu::PipelineLayout layout_;
  gpu::PipelineHandle pipeline_;
  gpu::DescriptorSet set_;
};

}  // namespace welkin
