// PNG pictures (ISO/IEC 15948) through stb: 8-bit RGBA, 16-bit RGB, and text chunks, which stb does not know.
//
// Readers accept any PNG of 1..16384 pixels a side. They check every chunk's length and CRC before a decoder sees a
// byte, so that a truncated or damaged file is one clear Error. 8-bit readers narrow 16-bit files and the reverse
// widens (v * 257). Text is limited to 1 MiB.
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
void write_png16(const std::filesystem::path& file, const Image16& picture, const TextChunks& text = {});

Image8 read_png8(const std::filesystem::path& file);
Image16 read_png16(const std::filesystem::path& file);

// The text stored under `key` (the first, if several); nothing if there is none. Error if the file is no sound PNG.
std::optional<std::string> read_png_text(const std::filesystem::path& file, const std::string& key);

}  // namespace welkin::image
