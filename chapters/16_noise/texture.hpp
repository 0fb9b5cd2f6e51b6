// A texture of noise: what it is made from, how it is made on the device, and how kept words become one again.
//
// Making: "fill" computes every texel, "extent" finds each channel's range in two passes of a reduction, "mips"
// averages, "pack" normalises and rounds to the format. All of it is arithmetic without a choice of rounding, so that
// the words are the same on every device. They are copied into the image as they are.
#pragma once

#include <string>
#include <string_view>

#include "common/graph/graph.hpp"

namespace welkin {

// As shaders/16_noise/textures.glsl numbers them.
enum class NoiseKind { base, detail, curl, weather, alligator };

enum class TexelFormat { bits8, bits16, half };

struct TextureRecipe {
  std::string name;  // "noise base"
  NoiseKind kind = NoiseKind::base;
  uint32_t side = 128;  // texels, a power of two
  bool volume = true;   // side^3, or side^2
  int octaves = 3;
  uint32_t seed = 0;
  TexelFormat format = TexelFormat::bits8;

  bool is_signed() const { return kind == NoiseKind::curl; }
  uint32_t mips() const;  // down to one texel
  uint32_t side_of(uint32_t mip) const { return side >> mip; }
  uint32_t texel_bytes() const { return format == TexelFormat::bits8 ? 4 : 8; }
  uint64_t bytes_of(uint32_t mip) const;
  uint64_t bytes() const;  // of all mips
  VkFormat vk_format() const;
  graph::ImageInfo image_info() const;
  std::string text() const;  // all of the above in words that differ where the texture would
};

// Throws Error in one line if the device cannot sample the format between texels.
void check_filtered(const gpu::Device& device, const TextureRecipe& recipe);

// Memory for a texture's words, mip after mip, rows and slices tightly packed; and the image of them, in layout
// GENERAL, ready to be sampled.
gpu::Buffer staging_for(const gpu::Device& device, const TextureRecipe& recipe);
gpu::Image image_of(const gpu::Device& device, const TextureRecipe& recipe, gpu::Buffer&& words);

// Makes a texture with a graph of its own, which lives as long as this does: scratch is three to five times the
// texture.
class TextureMaker {
 public:
  // keep: also copies the words into memory that words() reads.
  TextureMaker(const gpu::Device& device, const TextureRecipe& recipe, bool keep);
  TextureMaker(const TextureMaker&) = delete;

  void record(const app::Frame& frame) { graph_.execute(frame); }  // all passes, however often they have run
  void run();                                                      // outside of frames, and waits
  const gpu::Image& image() const { return image_; }
  gpu::Image take_image() { return std::move(image_); }  // the end of this maker
  std::string_view words() const;                        // after run()
  double milliseconds() const { return milliseconds_; }  // of run(), by the device's clock

 private:
  struct Raw {
    graph::Resource finest, mips;  // rgba32f, the mips from the second level on
  };
  Raw add_raw();
  graph::Resource add_extent(graph::Resource finest);
  void add_words(const Raw& raw, graph::Resource extent, bool keep);

  const gpu::Device& device_;
  const TextureRecipe recipe_;
  gpu::Pipelines pipelines_;
  gpu::Image image_;
  gpu::Buffer words_;
  graph::Graph graph_;
  double milliseconds_ = 0.0;
};

}  // namespace welkin
