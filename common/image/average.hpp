// A picture drawn too large, made small: each pixel becomes the mean of n x n, which anti-aliases whatever was drawn.
#pragma once

#include "common/image/image.hpp"

namespace welkin::image {

// Both sides must be multiples of n >= 1. Linear radiance is averaged as it is; display values in the linear light of
// the display (IEC 61966-2-1), rounded to nearest.
Image averaged(const Image& picture, uint32_t n);
Image8 averaged(const Image8& picture, uint32_t n);

}  // namespace welkin::image
