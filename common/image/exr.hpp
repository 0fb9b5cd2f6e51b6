// OpenEXR pictures through tinyexr: linear radiance, float32.
//
// write_exr writes single-part scan lines, ZIP. read_exr accepts single-part scan-line files of 1..16384 pixels a side,
// half or float channels R, G, B and up to five others, which are ignored, uncompressed or ZIP/ZIPS; it checks the
// whole layout (header, channel list, offset table, each block's line and length) before tinyexr, which trusts its
// input, sees the file.
#pragma once

#include <filesystem>

#include "common/image/image.hpp"

namespace welkin::image {

void write_exr(const std::filesystem::path& file, const Image& picture);

Image read_exr(const std::filesystem::path& file);  // alpha is 1: that of the file is ignored

}  // namespace welkin::image
