// PNG pictures (ISO/IEC 15948) through lodepng: 8-bit RGBA with text chunks, and 16-bit height maps.
//
// Readers accept files of up to 1 GiB and 1..16384 pixels a side. They check every chunk's length and CRC, and the size
// that the header claims, before pixels are decoded: a truncated, damaged or hostile file is one clear Error and takes
// no more memory than its pixels. Text is limited to 1 MiB, compressed or not.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/image/image.hpp"

namespace welkin::image {

using TextChunks = std::vector<std::pair<std::string, std::string>>;  // key (1..79 ASCII characters), UTF-8 text

std::string encode_png8(const Image8& picture, const TextChunks& text = {});  // the file's bytes
void write_png8(const std::filesystem::path& file, const Image8& picture, const TextChunks& text = {});

Image8 read_png8(const std::filesystem::path& file);    // any PNG: widened to RGBA, 16 bits narrowed to the high byte
Image16 read_png16(const std::filesystem::path& file);  // 16-bit grayscale and nothing else

// The text stored under `key` (the first, if several), whether in a tEXt, zTXt or iTXt chunk; nothing if there is
// none.
std::optional<std::string> read_png_text(const std::filesystem::path& file, const std::string& key);

}  // namespace welkin::image
