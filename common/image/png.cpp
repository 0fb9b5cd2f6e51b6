// PNG encoding, decoding and chunk walking. The one translation unit that holds stb's implementations.
#include "common/image/png.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace welkin::image {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
constexpr size_t kMaxFile = size_t{1} << 30;  // stb counts in int
constexpr size_t kMaxText = size_t{1} << 20;
constexpr size_t kDeflateRatio = 1032;  // deflate's best: 258 bytes from 2 bits

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};
using Bytes = std::unique_ptr<unsigned char, Free>;

uint32_t crc32(std::string_view bytes) {  // PNG annex D; stb's reads only, whatever its signature says
  auto* data = reinterpret_cast<unsigned char*>(const_cast<char*>(bytes.data()));
  return stbiw__crc32(data, static_cast<int>(bytes.size()));
}

void put32(std::string& out, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(value >> shift & 0xFFu));
}

uint32_t get32(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes[at + i]);
  return value;
}

void put_chunk(std::string& out, std::string_view type, std::string_view data) {
  put32(out, static_cast<uint32_t>(data.size()));
  const size_t start = out.size();
  out.append(type).append(data);
  put32(out, crc32(std::string_view(out).substr(start)));
}

// ASCII goes into tEXt, which every tool shows; anything else into iTXt, which is UTF-8.
void put_text(std::string& out, const std::string& key, const std::string& text) {
  const auto ascii = [](char c) { return static_cast<uint8_t>(c) < 0x80; };
  const auto printable = [](char c) { return c > ' ' && c <= '~'; };
  if (key.empty() || key.size() > 79 || !std::all_of(key.begin(), key.end(), printable))
    fail("PNG text key '{}': expected 1 to 79 printable ASCII characters", key);
  if (text.size() > kMaxText || text.find('\0') != text.npos)
    fail("PNG text '{}': expected at most {} bytes without NUL, got {}", key, kMaxText, text.size());
  const bool plain = std::all_of(text.begin(), text.end(), ascii);
  const std::string header(plain ? 1 : 5, '\0');  // iTXt: not compressed, method 0, no language, no translated key
  put_chunk(out, plain ? "tEXt" : "iTXt", key + header + text);
}

// Filters one row by Paeth's predictor (PNG clause 9.4), which suits smooth pictures in every direction.
void filter_row(const uint8_t* row, const uint8_t* above, size_t bytes, size_t step, std::string& out) {
  out.push_back(4);
  for (size_t i = 0; i < bytes; ++i) {
    const int a = i >= step ? row[i - step] : 0, b = above ? above[i] : 0, c = i >= step && above ? above[i - step] : 0;
    const int pa = std::abs(b - c), pb = std::abs(a - c), pc = std::abs(a + b - 2 * c);
    out.push_back(static_cast<char>(row[i] - (pa <= pb && pa <= pc ? a : pb <= pc ? b : c)));
  }
}

// raw: rows of width * channels * depth / 8 bytes, big endian.
std::string encode(size_t width, size_t height, size_t channels, size_t depth, const std::vector<uint8_t>& raw,
                   const TextChunks& text) {
  const size_t step = channels * depth / 8, stride = width * step;
  if (std::min(width, height) < 1 || std::max(width, height) > kMaxImageSide || height * (stride + 1) > kMaxFile)
    fail("PNG of {}x{}: expected 1 to {} pixels a side and at most 1 GiB", width, height, kMaxImageSide);
  if (raw.size() != height * stride)
    fail("PNG of {}x{}: {} bytes of pixels where {} are needed", width, height, raw.size(), height * stride);
  std::string filtered;
  filtered.reserve(height * (stride + 1));
  for (size_t y = 0; y < height; ++y)
    filter_row(&raw[y * stride], y > 0 ? &raw[(y - 1) * stride] : nullptr, stride, step, filtered);
  int length = 0;
  auto* data = reinterpret_cast<unsigned char*>(filtered.data());
  const Bytes packed(stbi_zlib_compress(data, static_cast<int>(filtered.size()), &length, 8));
  if (!packed) fail("PNG of {}x{}: out of memory", width, height);

  std::string out(kSignature), header;
  put32(header, static_cast<uint32_t>(width));
  put32(header, static_cast<uint32_t>(height));
  header += {static_cast<char>(depth), static_cast<char>(channels == 4 ? 6 : 2), 0, 0, 0};
  put_chunk(out, "IHDR", header);
  for (const auto& [key, value] : text) put_text(out, key, value);
  put_chunk(out, "IDAT", {reinterpret_cast<const char*>(packed.get()), static_cast<size_t>(length)});
  put_chunk(out, "IEND", {});
  return out;
}

struct Chunk {
  std::string_view type, data;  // into the file's bytes
};

// All chunks up to and with IEND. What follows IEND is ignored, as decoders do.
std::vector<Chunk> chunks(std::string_view bytes, const std::string& file) {
  if (bytes.substr(0, 8) != kSignature) fail("{}: not a PNG file", file);
  std::vector<Chunk> found;
  for (size_t at = 8; found.empty() || found.back().type != "IEND"; at += 12 + found.back().data.size()) {
    const size_t room = bytes.size() - at, length = room < 12 ? room : get32(bytes, at);
    if (room < 12 || length > room - 12) fail("{}: PNG is truncated or damaged in the chunk at byte {}", file, at);
    const std::string_view covered = bytes.substr(at + 4, length + 4);
    if (get32(bytes, at + 8 + length) != crc32(covered))
      fail("{}: PNG is damaged: the chunk at byte {} has a wrong CRC", file, at);
    found.push_back({covered.substr(0, 4), covered.substr(4)});
    for (const char c : found.back().type)  // stb would repeat it, whatever it is, in its message
      if (!std::isalpha(static_cast<unsigned char>(c))) fail("{}: PNG is damaged in the chunk at byte {}", file, at);
  }
  if (found[0].type != "IHDR" || found[0].data.size() != 13) fail("{}: PNG does not begin with a header", file);
  return found;
}

struct Decoded {
  uint32_t width, height;
  Bytes pixels;
};

Decoded decode(const std::filesystem::path& path, int channels, int depth) {
  const std::string file = path.string(), bytes = read_file(path, kMaxFile);
  const auto all = chunks(bytes, file);
  const uint32_t width = get32(all[0].data, 0), height = get32(all[0].data, 4);
  if (std::min(width, height) < 1 || std::max(width, height) > kMaxImageSide)
    fail("{}: PNG of {}x{} pixels; accepted is 1 to {} a side", file, width, height, kMaxImageSide);
  // A header that claims more than its data can hold is refused before memory is asked for.
  size_t packed = 0;
  for (const Chunk& chunk : all) packed += chunk.type == "IDAT" ? chunk.data.size() : 0;
  if (size_t{width} * height / 8 > packed * kDeflateRatio)
    fail("{}: PNG of {}x{} pixels has only {} bytes of data", file, width, height, packed);
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  int w, h, n;
  void* pixels = depth == 16 ? static_cast<void*>(stbi_load_16_from_memory(data, size, &w, &h, &n, channels))
                             : stbi_load_from_memory(data, size, &w, &h, &n, channels);
  if (!pixels) fail("{}: PNG cannot be decoded: {}", file, stbi_failure_reason());
  return {width, height, Bytes(static_cast<unsigned char*>(pixels))};
}

}  // namespace

std::string encode_png8(const Image8& picture, const TextChunks& text) {
  return encode(picture.width, picture.height, 4, 8, picture.rgba, text);
}

void write_png8(const std::filesystem::path& file, const Image8& picture, const TextChunks& text) {
  write_file_atomically(file, encode_png8(picture, text));
}

void write_png16(const std::filesystem::path& file, const Image16& picture, const TextChunks& text) {
  std::vector<uint8_t> raw;
  raw.reserve(picture.rgb.size() * 2);
  for (const uint16_t v : picture.rgb) raw.insert(raw.end(), {static_cast<uint8_t>(v >> 8), static_cast<uint8_t>(v)});
  write_file_atomically(file, encode(picture.width, picture.height, 3, 16, raw, text));
}

Image8 read_png8(const std::filesystem::path& file) {
  const Decoded d = decode(file, 4, 8);
  return {d.width, d.height, {d.pixels.get(), d.pixels.get() + size_t{d.width} * d.height * 4}};
}

Image16 read_png16(const std::filesystem::path& file) {
  const Decoded d = decode(file, 3, 16);
  const auto* values = reinterpret_cast<const uint16_t*>(d.pixels.get());
  return {d.width, d.height, {values, values + size_t{d.width} * d.height * 3}};
}

std::optional<std::string> read_png_text(const std::filesystem::path& path, const std::string& key) {
  const std::string file = path.string(), bytes = read_file(path, kMaxFile);
  for (const auto& [type, data] : chunks(bytes, file)) {
    if ((type != "tEXt" && type != "iTXt") || data.substr(0, data.find('\0')) != key) continue;
    size_t start = key.size() + 1, least = start;
    if (type == "iTXt") {  // compression flag and method, language NUL, translated key NUL
      least += 4;
      if (data.size() < least || data[start] != 0) fail("{}: PNG text '{}' is damaged or compressed", file, key);
      start = data.find('\0', data.find('\0', start + 2) + 1) + 1;  // npos + 1 is 0: caught below
    }
    if (start < least || start > data.size()) fail("{}: PNG text '{}' is damaged", file, key);
    if (data.size() - start > kMaxText) fail("{}: PNG text '{}' is larger than {} bytes", file, key, kMaxText);
    return std::string(data.substr(start));
  }
  return std::nullopt;
}

}  // namespace welkin::image
