// What lodepng is asked, and what it is not trusted with: see png.hpp.
#include "common/image/png.hpp"

#include <lodepng.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"

namespace welkin::image {
namespace {

constexpr size_t kMaxFile = size_t{1} << 30;
constexpr size_t kMaxText = size_t{1} << 20;
constexpr int kDeflateLevel = 4;        // half the time of the usual 6 for a tenth more bytes
constexpr size_t kDeflateRatio = 1032;  // deflate's best: 258 bytes from 2 bits

// A file in memory, its header read, each of its chunks whole. What follows IEND is ignored, as decoders do.
struct Png {
  std::string name, bytes;
  lodepng::State state;
  uint32_t width = 0, height = 0;
  std::vector<size_t> chunks;  // where they begin, up to and with IEND

  explicit Png(const std::filesystem::path& file) : name(file.string()), bytes(read_file(file, kMaxFile)) {
    if (!bytes.starts_with("\x89PNG\r\n\x1a\n")) fail("{}: not a PNG file", name);
    const unsigned error = lodepng_inspect(&width, &height, &state, at(0), bytes.size());
    constexpr unsigned kNoSize = 93;  // lodepng's number for a width or height of 0
    if ((error == 0 || error == kNoSize) && (std::min(width, height) < 1 || std::max(width, height) > kMaxImageSide))
      fail("{}: PNG of {}x{} pixels; accepted is 1 to {} a side", name, width, height, kMaxImageSide);
    check(error, "PNG");
    for (size_t byte = 8; chunks.empty() || type(chunks.back()) != "IEND"; byte = chunks.back() + 12 + length(byte)) {
      if (bytes.size() - byte < 12 || length(byte) > bytes.size() - byte - 12)
        fail("{}: PNG is truncated or damaged in the chunk at byte {}", name, byte);
      if (lodepng_chunk_check_crc(at(byte)) != 0)
        fail("{}: PNG is damaged: the chunk at byte {} has a wrong CRC", name, byte);
      chunks.push_back(byte);
    }
  }

  const unsigned char* at(size_t byte) const { return reinterpret_cast<const unsigned char*>(bytes.data()) + byte; }
  size_t length(size_t chunk) const { return lodepng_chunk_length(at(chunk)); }
  std::string_view type(size_t chunk) const { return std::string_view(bytes).substr(chunk + 4, 4); }
  void check(unsigned error, const std::string& what) const {
    if (error != 0) fail("{}: {} is damaged: {}", name, what, lodepng_error_text(error));
  }

  // The pixels in a format of ours. lodepng asks for memory by what the header says and inflates all there is: neither
  // may be beyond what an honest file of this size holds.
  std::vector<uint8_t> decode(LodePNGColorType colour, unsigned bits) {
    const size_t honest = lodepng_get_raw_size(width, height, &state.info_png.color);
    if (honest > bytes.size() * kDeflateRatio)
      fail("{}: PNG of {}x{} pixels has only {} bytes of data", name, width, height, bytes.size());
    state.decoder.zlibsettings.max_output_size = honest + 16 * size_t{height} + 64;  // rows begin with a filter's byte
    state.decoder.read_text_chunks = 0;
    state.info_raw.colortype = colour, state.info_raw.bitdepth = bits;
    std::vector<uint8_t> pixels;
    check(lodepng::decode(pixels, width, height, state, at(0), bytes.size()), "PNG");
    return pixels;
  }
};

// ASCII goes into tEXt, which every tool shows; anything else into iTXt, which is UTF-8.
void add_text(LodePNGInfo& info, const std::string& key, const std::string& text) {
  const auto printable = [](char c) { return c > ' ' && c <= '~'; };
  const auto ascii = [](char c) { return static_cast<uint8_t>(c) < 0x80; };
  if (key.empty() || key.size() > 79 || !std::all_of(key.begin(), key.end(), printable))
    fail("PNG text key '{}': expected 1 to 79 printable ASCII characters", key);
  if (text.size() > kMaxText || text.find('\0') != text.npos)
    fail("PNG text '{}': expected at most {} bytes without NUL, got {}", key, kMaxText, text.size());
  if (std::all_of(text.begin(), text.end(), ascii))
    lodepng_add_text(&info, key.c_str(), text.c_str());
  else
    lodepng_add_itext(&info, key.c_str(), "", "", text.c_str());
}

// Deflates by zlib, which takes a tenth of the time of lodepng's own. lodepng frees what malloc() gave.
unsigned deflate_by_zlib(unsigned char** out, size_t* out_size, const unsigned char* in, size_t in_size,
                         const LodePNGCompressSettings*) {
  uLongf size = compressBound(static_cast<uLong>(in_size));
  *out = static_cast<unsigned char*>(std::malloc(size));
  if (*out == nullptr) return 83;                                          // lodepng's number for no memory
  compress2(*out, &size, in, static_cast<uLong>(in_size), kDeflateLevel);  // the bound makes it succeed
  *out_size = size;
  return 0;
}

}  // namespace

std::string encode_png8(const Image8& picture, const TextChunks& text) {
  const uint32_t width = picture.width, height = picture.height;
  if (std::min(width, height) < 1 || std::max(width, height) > kMaxImageSide)
    fail("PNG of {}x{}: expected 1 to {} pixels a side", width, height, kMaxImageSide);
  if (const size_t needed = size_t{width} * height * 4; picture.rgba.size() != needed)
    fail("PNG of {}x{}: {} bytes of pixels where {} are needed", width, height, picture.rgba.size(), needed);
  lodepng::State state;            // RGBA of 8 bits, in and out
  state.encoder.auto_convert = 0;  // whatever smaller format the pixels would fit
  state.encoder.text_compression = 0;
  state.encoder.zlibsettings.custom_zlib = deflate_by_zlib;
  for (const auto& [key, value] : text) add_text(state.info_png, key, value);
  std::vector<uint8_t> out;
  if (const unsigned error = lodepng::encode(out, picture.rgba, width, height, state); error != 0)
    fail("PNG of {}x{}: {}", width, height, lodepng_error_text(error));
  return {out.begin(), out.end()};
}

void write_png8(const std::filesystem::path& file, const Image8& picture, const TextChunks& text) {
  write_file_atomically(file, encode_png8(picture, text));
}

Image8 read_png8(const std::filesystem::path& file) {
  Png png(file);
  std::vector<uint8_t> pixels = png.decode(LCT_RGBA, 8);
  return {png.width, png.height, std::move(pixels)};
}

Image16 read_png16(const std::filesystem::path& file) {
  Png png(file);
  const LodePNGColorMode& colour = png.state.info_png.color;
  if (colour.colortype != LCT_GREY || colour.bitdepth != 16)
    fail("{}: {} bits a sample, {}, where 16-bit grayscale is read", png.name, colour.bitdepth,
         colour.colortype == LCT_GREY ? "grayscale" : "not grayscale alone");
  const std::vector<uint8_t> raw = png.decode(LCT_GREY, 16);  // big endian
  Image16 heights{png.width, png.height, std::vector<uint16_t>(raw.size() / 2)};
  for (size_t i = 0; i < heights.gray.size(); ++i)
    heights.gray[i] = static_cast<uint16_t>(raw[2 * i] << 8 | raw[2 * i + 1]);
  return heights;
}

std::optional<std::string> read_png_text(const std::filesystem::path& file, const std::string& key) {
  Png png(file);
  png.state.decoder.max_text_size = kMaxText;
  const LodePNGInfo& info = png.state.info_png;
  for (const size_t chunk : png.chunks) {
    if (png.type(chunk) != "tEXt" && png.type(chunk) != "zTXt" && png.type(chunk) != "iTXt") continue;
    if (png.bytes.compare(chunk + 8, key.size() + 1, key + '\0') != 0) continue;
    png.check(lodepng_inspect_chunk(&png.state, chunk, png.at(0), png.bytes.size()), "text '" + key + "' of the PNG");
    const std::string text = info.text_num > 0 ? info.text_strings[0] : info.itext_strings[0];
    if (text.size() > kMaxText) fail("{}: PNG text '{}' is larger than {} bytes", png.name, key, kMaxText);
    return text;
  }
  return std::nullopt;
}

}  // namespace welkin::image
