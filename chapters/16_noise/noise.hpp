// Chapter 16, noise: the textures that clouds are made of, as effects that later chapters name in their lists.
//
// Every texture tiles exactly, holds the same bits whichever device made it, has mips down to one texel, and is read
// with a sampler that repeats: graph::Sampling with u, v and w = gpu::Border::repeat. A texture that no needed pass
// reads is neither made nor allocated. What is made once is kept in the user's cache directory (noise_cache.hpp).
#pragma once

#include <vector>

#include "common/graph/effect.hpp"

namespace welkin {

// On the board after noise_textures(). Numbers are 0 ... 1, and both ends occur; those of `curl` are -1 ... 1.
//   base    3-D, 128^3: r Perlin-Worley; g, b, a inverted Worley of 8, 16, 32 cells a side
//   detail  3-D, 32^3: r, g, b inverted Worley of 2, 4, 8 cells a side; a their fBm
//   curl    2-D, 128^2: x, y, z a divergence-free displacement that does not change along z, in units of the longest
//           component there is; w its stream function
struct NoiseTextures {
  graph::Resource base, detail, curl;
};

// On the board after weather_texture().
//   map  2-D, 512^2: r coverage, g height of the tops, b type, a wetness; each 0 ... 1
struct WeatherTexture {
  graph::Resource map;
};

// On the board after alligator_texture(): the noise that voxel clouds are eroded with.
//   volume  3-D, 64^3: r, g, b alligator noise of 4, 8, 16 cells a side; a their fBm
struct AlligatorTexture {
  graph::Resource volume;
};

std::vector<Knob> noise_knobs();  // noise.*

app::Effect noise_textures();
app::Effect weather_texture();
app::Effect alligator_texture();

}  // namespace welkin
