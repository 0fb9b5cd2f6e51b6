// OpenEXR reading and writing. The one translation unit that includes tinyexr. File layout: OpenEXR 2 "File Layout".
#include "common/image/exr.hpp"

#include <tinyexr.h>

#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <string_view>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"

namespace welkin::image {
namespace {

constexpr size_t kMaxFile = size_t{5} << 30;
constexpr size_t kDeflateRatio = 1032;  // deflate's best: 258 bytes from 2 bits

// Reads little-endian values; running off the end is an Error.
struct Cursor {
  std::string_view bytes;
  const std::string& file;
  size_t at = 0;

  void require(bool good, const char* what) const {
    if (!good) fail("{}: EXR (byte {}): {}", file, at, what);
  }
  std::string_view take(size_t count) {
    require(count <= bytes.size() - at, "truncated or damaged");
    at += count;
    return bytes.substr(at - count, count);
  }
  template <typename T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string_view name() {
    const size_t end = std::min(bytes.find('\0', at), bytes.size());
    const std::string_view found = take(end - at);
    require(take(1) == std::string_view("", 1) && found.size() < 256, "truncated or damaged");
    return found;
  }
};

// Throws unless the file is one whose every length and offset tinyexr may trust.
void check_layout(std::string_view bytes, const std::string& file) {
  Cursor in{bytes, file};
  in.require(bytes.substr(0, 4) == "\x76\x2f\x31\x01", "not an EXR file");
  in.take(4);
  bool plain = (in.number<uint32_t>() & ~0x400u) == 2;  // version 2; of its flags only bit 10, long names
  std::map<std::string_view, std::string_view> attributes;
  for (std::string_view name = plain ? in.name() : ""; !name.empty(); name = in.name()) {
    plain = !in.name().empty() && plain && name != "type" && name != "chunkCount" && name != "tiles";
    const auto size = in.number<uint32_t>();
    in.require(attributes.emplace(name, in.take(size)).second && attributes.size() < 100,
               "attribute repeated, or too many");
  }
  in.require(plain, "tiled, deep or in several parts; accepted is one part of scan lines, version 2");
  const auto attribute = [&](const char* name, size_t size) {
    if (attributes[name].size() != size) fail("{}: EXR attribute '{}' is missing or of a wrong size", file, name);
    return attributes[name];
  };
  const int method = attribute("compression", 1)[0];
  in.require(method == TINYEXR_COMPRESSIONTYPE_NONE || method == TINYEXR_COMPRESSIONTYPE_ZIPS ||
                 method == TINYEXR_COMPRESSIONTYPE_ZIP,
             "unknown compression; accepted is none, ZIPS or ZIP");
  in.require(attribute("lineOrder", 1)[0] == 0, "lines do not run top to bottom");  // tinyexr would flip the picture

  std::array<int32_t, 4> box;  // min x, min y, max x, max y, inclusive
  std::memcpy(box.data(), attribute("dataWindow", sizeof box).data(), sizeof box);
  const int64_t width = int64_t{box[2]} - box[0] + 1, height = int64_t{box[3]} - box[1] + 1;
  if (std::min(width, height) < 1 || std::max(width, height) > kMaxImageSide)
    fail("{}: EXR of {}x{} pixels; accepted is 1 to {} a side", file, width, height, kMaxImageSide);
  in.require(std::abs(int64_t{box[0]}) < 1'000'000 && std::abs(int64_t{box[1]}) < 1'000'000, "its window is far away");

  Cursor list{attributes["channels"], file};
  size_t pixel_bytes = 0, channels = 0;
  for (std::string_view name = list.name(); !name.empty(); name = list.name(), ++channels) {
    const auto type = list.number<int32_t>();
    list.take(4);                                   // pLinear and three reserved bytes
    const auto sampling = list.number<uint64_t>();  // x and y, both 1
    in.require((type == TINYEXR_PIXELTYPE_HALF || type == TINYEXR_PIXELTYPE_FLOAT) && sampling == 0x1'0000'0001u,
               "accepted are half or float channels at full resolution");
    pixel_bytes += type == TINYEXR_PIXELTYPE_HALF ? 2 : 4;
  }
  in.require(channels >= 3 && channels <= 8 && list.at == list.bytes.size(),
             "its channel list is damaged, or not of 3 to 8");

  const int64_t lines = method == TINYEXR_COMPRESSIONTYPE_ZIP ? 16 : 1;
  for (int64_t y = 0; y < height; y += lines) {
    Cursor block{bytes, file, static_cast<size_t>(std::min<uint64_t>(in.number<uint64_t>(), bytes.size()))};
    const size_t full = static_cast<size_t>(std::min(lines, height - y) * width) * pixel_bytes;
    block.require(block.number<int32_t>() == box[1] + y, "a block of lines is damaged");
    const size_t length = block.number<uint32_t>();
    const bool packed = method != TINYEXR_COMPRESSIONTYPE_NONE && length <= full && full <= length * kDeflateRatio;
    block.require(block.take(length).size() == full || packed, "a block of lines is damaged");
  }
}

// Turns tinyexr's status into an Error; its message is often several lines, of which the first is kept.
void check(bool good, const std::string& file, const char* message) {
  if (good) return;
  const std::string text = message != nullptr ? message : "it cannot be decoded";
  FreeEXRErrorMessage(message);
  fail("{}: EXR: {}", file, text.substr(0, text.find('\n')));
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& picture) {
  const size_t count = size_t{picture.width} * picture.height;
  if (count == 0 || picture.width > kMaxImageSide || picture.height > kMaxImageSide || picture.pixels.size() != count)
    fail("EXR of {}x{} with {} pixels: expected 1 to {} a side", picture.width, picture.height, picture.pixels.size(),
         kMaxImageSide);
  std::vector<float> planes[3];
  unsigned char* pointers[3];
  EXRChannelInfo infos[3] = {};
  int types[] = {TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT, TINYEXR_PIXELTYPE_FLOAT};
  for (int c = 0; c < 3; ++c) {  // channels stand in alphabetical order
    infos[c].name[0] = "BGR"[c];
    for (const glm::vec4& pixel : picture.pixels) planes[c].push_back(pixel[2 - c]);
    pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
  }
  EXRHeader header;  // these two borrow the arrays above: not to be freed by tinyexr
  EXRImage image;
  InitEXRHeader(&header);
  InitEXRImage(&image);
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  header.num_channels = image.num_channels = 3;
  header.channels = infos;
  header.pixel_types = header.requested_pixel_types = types;
  image.width = static_cast<int>(picture.width);
  image.height = static_cast<int>(picture.height);
  image.images = pointers;

  unsigned char* memory = nullptr;
  const char* message = nullptr;
  const size_t size = SaveEXRImageToMemory(&image, &header, &memory, &message);
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(memory, &std::free);
  check(size != 0, path.string(), message);
  write_file_atomically(path, std::string_view(reinterpret_cast<const char*>(memory), size));
}

Image read_exr(const std::filesystem::path& path) {
  const std::string file = path.string(), bytes = read_file(path, kMaxFile);
  check_layout(bytes, file);
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  EXRHeader header;
  EXRImage image;
  InitEXRHeader(&header);
  InitEXRImage(&image);
  const std::unique_ptr<EXRHeader, decltype(&FreeEXRHeader)> header_owner(&header, &FreeEXRHeader);
  const std::unique_ptr<EXRImage, decltype(&FreeEXRImage)> image_owner(&image, &FreeEXRImage);
  EXRVersion version;
  const char* message = nullptr;
  check(ParseEXRVersionFromMemory(&version, data, bytes.size()) == TINYEXR_SUCCESS, file, nullptr);
  const bool parsed = ParseEXRHeaderFromMemory(&header, &version, data, bytes.size(), &message) == TINYEXR_SUCCESS;
  check(parsed, file, message);
  for (int c = 0; c < header.num_channels; ++c) header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
  image.num_channels = header.num_channels;  // where decoding fails, tinyexr frees as many planes as this says,
  const bool decoded = LoadEXRImageFromMemory(&image, &header, data, bytes.size(), &message) == TINYEXR_SUCCESS;
  if (!decoded) InitEXRImage(&image);  // and leaves pointers to them
  check(decoded, file, message);

  Image picture{static_cast<uint32_t>(image.width), static_cast<uint32_t>(image.height), {}};
  picture.pixels.assign(size_t{picture.width} * picture.height, glm::vec4(1.0f));
  unsigned found = 0;
  for (int c = 0; c < header.num_channels; ++c) {
    const std::string_view name = header.channels[c].name;
    const size_t component = name.size() == 1 ? std::string_view("RGB").find(name) : std::string_view::npos;
    if (component == std::string_view::npos) continue;
    found |= 1u << component;
    const auto* plane = reinterpret_cast<const float*>(image.images[c]);
    for (size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i][static_cast<int>(component)] = plane[i];
  }
  if (found != 7u) fail("{}: EXR lacks one of the channels R, G, B", file);
  return picture;
}

}  // namespace welkin::image
