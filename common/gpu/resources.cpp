// Image and buffer creation. See resources.hpp.
#include "common/gpu/resources.hpp"

#include <algorithm>

namespace welkin::gpu {
namespace {

Memory allocate(const Device& device, const VkMemoryRequirements& needs, VkMemoryPropertyFlags properties,
                const std::string& name) {
  const std::optional<uint32_t> type = device.memory_type(needs.memoryTypeBits, properties);
  if (!type) fail("{} offers no memory type with properties {:#x}", device.candidate().name, properties);
  const VkMemoryAllocateInfo info{
      .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = *type};
  VkDeviceMemory memory = VK_NULL_HANDLE;
  const VkResult result = vkAllocateMemory(device, &info, nullptr, &memory);
  if (result != VK_SUCCESS)
    fail("{} of {:.1f} MiB does not fit: {} ({} in use)", name, static_cast<double>(needs.size) / 1048576.0,
         result_name(result), device.allocated_bytes());
  return Memory(device, memory);
}

}  // namespace

AccountEntry::AccountEntry(const Device& device, const std::string& name, uint64_t bytes)
    : device_(&device), id_(++device.allocation_count()), bytes_(bytes) {
  device.allocations().push_back({name, bytes, id_});
}

AccountEntry::~AccountEntry() {
  if (device_ != nullptr) std::erase_if(device_->allocations(), [&](const Allocation& a) { return a.id == id_; });
}

// [image]
static ImageView create_view(const Device& device, const Image& image, VkImageViewType type, uint32_t first_mip,
                             uint32_t mips) {
  const VkImageViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = image.handle,
                                   .viewType = type,
                                   .format = image.format,
                                   .subresourceRange = {aspect_of(image.format), first_mip, mips, 0, image.layers}};
  return create<ImageView>(device, vkCreateImageView, info, "vkCreateImageView");
}

Image create_image(const Device& device, const std::string& name, VkExtent2D size, VkFormat format,
                   VkImageUsageFlags usage, uint32_t depth, uint32_t mips, uint32_t layers) {
  const uint32_t limit = depth > 0 ? device.limits().maxImageDimension3D : device.limits().maxImageDimension2D;
  if (size.width == 0 || size.height == 0 || size.width > limit || size.height > limit || depth > limit)
    fail("{}: {}x{}x{} texels; each side must be 1 to {} on {}", name, size.width, size.height, std::max(depth, 1u),
         limit, device.candidate().name);
  Image image{.size = size, .depth = std::max(depth, 1u), .mips = mips, .layers = layers, .format = format};

  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = depth > 0 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {size.width, size.height, image.depth},
                               .mipLevels = mips,
                               .arrayLayers = layers,
                               .samples = VK_SAMPLE_COUNT_1_BIT,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = usage,
                               .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
  image.handle = create<ImageHandle>(device, vkCreateImage, info, "vkCreateImage");

  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, image.handle, &needs);
  image.memory = allocate(device, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, name);
  check(vkBindImageMemory(device, image.handle, image.memory, 0), "vkBindImageMemory");

  const VkImageViewType type = depth > 0    ? VK_IMAGE_VIEW_TYPE_3D
                               : layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                            : VK_IMAGE_VIEW_TYPE_2D;
  image.view = create_view(device, image, type, 0, mips);
  for (uint32_t mip = 0; mips > 1 && mip < mips; ++mip)
    image.mip_views.push_back(create_view(device, image, type, mip, 1));
  image.account = AccountEntry(device, name, needs.size);
  device.set_name(VK_OBJECT_TYPE_IMAGE, image.handle, name);
  return image;
}
// [/image]

VkImageAspectFlags aspect_of(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D16_UNORM ? VK_IMAGE_ASPECT_DEPTH_BIT
                                                                         : VK_IMAGE_ASPECT_COLOR_BIT;
}

Sampler create_sampler(const Device& device, Border u, Border v, VkFilter filter, Border w) {
  const auto mode = [](Border border) {
    return border == Border::clamp ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE : VK_SAMPLER_ADDRESS_MODE_REPEAT;
  };
  const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                 .magFilter = filter,
                                 .minFilter = filter,
                                 .addressModeU = mode(u),
                                 .addressModeV = mode(v),
                                 .addressModeW = mode(w),
                                 .maxLod = VK_LOD_CLAMP_NONE};
  return create<Sampler>(device, vkCreateSampler, info, "vkCreateSampler");
}

Buffer create_buffer(const Device& device, const std::string& name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                     Where where) {
  Buffer buffer{.bytes = bytes};
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = std::max<VkDeviceSize>(bytes, 4),
                                .usage = usage,
                                .sharingMode = VK_SHARING_MODE_EXCLUSIVE};
  buffer.handle = create<BufferHandle>(device, vkCreateBuffer, info, "vkCreateBuffer");

  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, buffer.handle, &needs);
  VkMemoryPropertyFlags properties = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  if (where != Where::device) properties = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  // Reading write-combined memory is very slow: cached memory where the device has it. What is written every frame lies
  // best in the device's own.
  VkMemoryPropertyFlags better = 0;
  if (where == Where::readback) better = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  if (where == Where::stream) better = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  if (better != 0 && device.memory_type(needs.memoryTypeBits, properties | better)) properties |= better;
  buffer.memory = allocate(device, needs, properties, name);
  check(vkBindBufferMemory(device, buffer.handle, buffer.memory, 0), "vkBindBufferMemory");
  if (where != Where::device)
    check(vkMapMemory(device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped), "vkMapMemory");
  buffer.account = AccountEntry(device, name, needs.size);
  device.set_name(VK_OBJECT_TYPE_BUFFER, buffer.handle, name);
  return buffer;
}

}  // namespace welkin::gpu
