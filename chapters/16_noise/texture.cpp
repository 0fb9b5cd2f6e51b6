// Making textures of noise. See texture.hpp and docs/chapters/16_noise.md.
#include "chapters/16_noise/texture.hpp"

#include <bit>
#include <cmath>

namespace welkin {
namespace {

constexpr uint32_t kParts = 256;  // as in extent.glsl
constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

struct FillPush {
  int32_t octaves;
  float gain, full;
  int32_t seed;
};

void dispatch_over(const graph::Recorder& r, uint32_t side, bool volume) {
  r.dispatch((side + 7) / 8, (side + 7) / 8, volume ? side : 1);
}

VkBufferImageCopy region_of(const TextureRecipe& recipe, uint32_t mip, uint64_t offset) {
  const uint32_t side = recipe.side_of(mip);
  return {.bufferOffset = offset,
          .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1},
          .imageExtent = {side, side, recipe.volume ? side : 1}};
}

// The step after which the image is ready for whoever samples it.
graph::Step ready(graph::Resource image) {
  return {.accesses = {{image, gpu::kSampledRead}}, .record = [](const graph::Recorder&) {}};
}

double run_once(const gpu::Device& device, graph::Graph& graph) {
  const gpu::CommandPool pool = gpu::create_command_pool(device);
  gpu::Timer timer(device);
  const gpu::Image no_target;
  const CameraRays no_camera{};
  gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
    timer.begin_frame(commands);
    graph.execute({commands, no_target, no_camera, timer, 0, 0, 0.0});
  });
  double sum = 0.0;
  for (const gpu::PassTime& pass : timer.read()) sum += pass.milliseconds;
  return sum;
}

}  // namespace

uint32_t TextureRecipe::mips() const { return static_cast<uint32_t>(std::bit_width(side)); }

uint64_t TextureRecipe::bytes_of(uint32_t mip) const {
  const uint64_t s = side_of(mip);
  return s * s * (volume ? s : 1) * texel_bytes();
}

uint64_t TextureRecipe::bytes() const {
  uint64_t sum = 0;
  for (uint32_t mip = 0; mip < mips(); ++mip) sum += bytes_of(mip);
  return sum;
}

VkFormat TextureRecipe::vk_format() const {
  if (format == TexelFormat::half) return VK_FORMAT_R16G16B16A16_SFLOAT;
  if (format == TexelFormat::bits8) return is_signed() ? VK_FORMAT_R8G8B8A8_SNORM : VK_FORMAT_R8G8B8A8_UNORM;
  return is_signed() ? VK_FORMAT_R16G16B16A16_SNORM : VK_FORMAT_R16G16B16A16_UNORM;
}

graph::ImageInfo TextureRecipe::image_info() const {
  return {.size = {side, side}, .format = vk_format(), .depth = volume ? side : 0, .mips = mips(), .usage = kUsage};
}

std::string TextureRecipe::text() const {
  return fmt::format("kind {} side {}{} octaves {} seed {} format {}", static_cast<int>(kind), side,
                     volume ? "^3" : "^2", octaves, seed, static_cast<int>(format));
}

void check_filtered(const gpu::Device& device, const TextureRecipe& recipe) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical(), recipe.vk_format(), &properties);
  if ((properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) == 0)
    fail("{}: {} cannot filter textures of this format; noise.format = 8 and half always work", recipe.name,
         device.candidate().name);
}

// [upload]
// Cached memory: its checksum is read again, and what a device calls best for uploads is slow to read.
gpu::Buffer staging_for(const gpu::Device& device, const TextureRecipe& recipe) {
  return gpu::create_buffer(device, recipe.name + " words", recipe.bytes(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                            gpu::Where::readback);
}

gpu::Image image_of(const gpu::Device& device, const TextureRecipe& recipe, gpu::Buffer&& words) {
  const graph::ImageInfo info = recipe.image_info();
  gpu::Image image = gpu::create_image(device, recipe.name, info.size, info.format, info.usage, info.depth, info.mips);
  gpu::Pipelines pipelines(device);
  graph::Graph graph(device, pipelines);
  const graph::Resource from = graph.add_filled("words", std::move(words)), to = graph.import(recipe.name, &image);
  graph::Pass pass{.name = "upload"};
  pass.steps.push_back({.accesses = {{from, gpu::kTransferRead}, {to, gpu::kTransferWrite}},
                        .record = [&recipe, from, to](const graph::Recorder& r) {
                          std::vector<VkBufferImageCopy> regions;
                          uint64_t offset = 0;
                          for (uint32_t mip = 0; mip < recipe.mips(); offset += recipe.bytes_of(mip++))
                            regions.push_back(region_of(recipe, mip, offset));
                          vkCmdCopyBufferToImage(r.frame.commands, r.graph.buffer(from).handle,
                                                 r.graph.image(to).handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                                 static_cast<uint32_t>(regions.size()), regions.data());
                        }});
  pass.steps.push_back(ready(to));
  graph.add(std::move(pass));
  graph.set_output(to);
  graph.compile();
  run_once(device, graph);
  return image;
}
// [/upload]

TextureMaker::TextureMaker(const gpu::Device& device, const TextureRecipe& recipe, bool keep)
    : device_(device), recipe_(recipe), pipelines_(device), graph_(device, pipelines_) {
  const graph::ImageInfo info = recipe_.image_info();
  image_ = gpu::create_image(device, recipe_.name, info.size, info.format, info.usage, info.depth, info.mips);
  if (keep)
    words_ = gpu::create_buffer(device, recipe_.name + " words", recipe_.bytes(), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                gpu::Where::readback);
  const Raw raw = add_raw();
  add_words(raw, add_extent(raw.finest), keep);
  graph_.compile();
}

// [make]
// The finest level and the mips, as floats. 3-D also where the texture has one slice: the same shaders make both.
TextureMaker::Raw TextureMaker::add_raw() {
  const uint32_t side = recipe_.side, mips = recipe_.mips();
  const bool volume = recipe_.volume;
  const Raw raw{graph_.add_image(recipe_.name + " raw", {.size = {side, side}, .depth = volume ? side : 1}),
                graph_.add_image(recipe_.name + " raw mips",
                                 {.size = {side / 2, side / 2}, .depth = volume ? side / 2 : 1, .mips = mips - 1})};
  graph::Pass fill{.name = recipe_.name + " fill", .changed = [](const app::Frame&) { return true; }};
  // The sum of 1, g, g^2, …: of numbers exact in float, so that only the division rounds.
  const float gain = recipe_.is_signed() ? 0.25f : 0.5f;
  const float full = (1.0f - gain) / (1.0f - std::pow(gain, static_cast<float>(recipe_.octaves)));
  fill.steps.push_back({.shader = "16_noise/fill.comp",
                        .constants = {{"KIND", static_cast<int>(recipe_.kind)}},
                        .bindings = {{"raw", raw.finest}},
                        .record = [=, this](const graph::Recorder& r) {
                          r.push(FillPush{recipe_.octaves, gain, full, static_cast<int32_t>(recipe_.seed)});
                          dispatch_over(r, side, volume);
                        }});
  graph_.add(std::move(fill));
  graph::Pass average{.name = recipe_.name + " mips"};
  for (int mip = 0; mip + 1 < static_cast<int>(mips); ++mip) {
    graph::Binding finer{"finer", raw.finest};
    if (mip > 0) finer = {.name = "finer", .resource = raw.mips, .mip = mip - 1};
    average.steps.push_back({.shader = "16_noise/average.comp",
                             .bindings = {finer, {.name = "coarser", .resource = raw.mips, .mip = mip}},
                             .record = [=](const graph::Recorder& r) { dispatch_over(r, (side >> mip) / 2, volume); }});
  }
  graph_.add(std::move(average));
  return raw;
}

graph::Resource TextureMaker::add_extent(graph::Resource finest) {
  const graph::Resource parts = graph_.add_buffer(recipe_.name + " parts", {.bytes = kParts * 2 * sizeof(glm::vec4)}),
                        whole = graph_.add_buffer(recipe_.name + " extent", {.bytes = 2 * sizeof(glm::vec4)});
  graph::Pass pass{.name = recipe_.name + " extent"};
  pass.steps.push_back({.shader = "16_noise/extent_parts.comp",
                        .bindings = {{"raw", finest}, {"Parts", parts}},
                        .record = [](const graph::Recorder& r) { r.dispatch(kParts); }});
  pass.steps.push_back({.shader = "16_noise/extent_whole.comp",
                        .constants = {{"IS_SIGNED", recipe_.is_signed()}},
                        .bindings = {{"Parts", parts}, {"Whole", whole}},
                        .record = [](const graph::Recorder& r) { r.dispatch(1); }});
  graph_.add(std::move(pass));
  return whole;
}
// [/make]

// [words]
void TextureMaker::add_words(const Raw& raw, graph::Resource extent, bool keep) {
  graph::Pass pack{.name = recipe_.name + " pack"}, copy{.name = recipe_.name + " copy"};
  const graph::Resource image = graph_.import(recipe_.name, &image_),
                        kept = keep ? graph_.import(recipe_.name + " words", &words_) : 0;
  uint64_t offset = 0;
  for (uint32_t mip = 0; mip < recipe_.mips(); offset += recipe_.bytes_of(mip++)) {
    const uint32_t side = recipe_.side_of(mip);
    const graph::Resource words =  // a buffer for each mip: a device may bind no more than 128 MiB at once
        graph_.add_buffer(fmt::format("{} words {}", recipe_.name, mip), {.bytes = recipe_.bytes_of(mip)});
    graph::Binding source{"raw", raw.finest};
    if (mip > 0) source = {.name = "raw", .resource = raw.mips, .mip = static_cast<int>(mip) - 1};
    pack.steps.push_back(
        {.shader = "16_noise/pack.comp",
         .constants = {{"BITS", recipe_.format == TexelFormat::bits8 ? 8 : 16},
                       {"IS_SIGNED", recipe_.is_signed()},
                       {"IS_HALF", recipe_.format == TexelFormat::half}},
         .bindings = {source, {"Whole", extent}, {"Words", words}},
         .record = [side, volume = recipe_.volume](const graph::Recorder& r) { dispatch_over(r, side, volume); }});
    graph::Step step{.accesses = {{words, gpu::kTransferRead}, {image, gpu::kTransferWrite, static_cast<int>(mip)}},
                     .record = [=, this](const graph::Recorder& r) {
                       const VkBuffer from = r.graph.buffer(words).handle;
                       const VkBufferImageCopy region = region_of(recipe_, mip, 0);
                       vkCmdCopyBufferToImage(r.frame.commands, from, r.graph.image(image).handle,
                                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
                       const VkBufferCopy part{.dstOffset = offset, .size = recipe_.bytes_of(mip)};
                       if (keep) vkCmdCopyBuffer(r.frame.commands, from, words_.handle, 1, &part);
                     }};
    if (keep) step.accesses.push_back({kept, gpu::kTransferWrite});
    copy.steps.push_back(std::move(step));
  }
  copy.steps.push_back(ready(image));
  if (keep) copy.steps.back().accesses.push_back({kept, gpu::kHostRead});
  graph_.add(std::move(pack));
  graph_.add(std::move(copy));
  graph_.set_output(image);
}
// [/words]

void TextureMaker::run() { milliseconds_ = run_once(device_, graph_); }

std::string_view TextureMaker::words() const {
  return {static_cast<const char*>(words_.mapped), static_cast<size_t>(words_.bytes)};
}

}  // namespace welkin
