// The air on the device: the uniform block "Air" of every shader that marches through it, as an effect.
#pragma once

#include "chapters/04_air/air.hpp"
#include "common/graph/effect.hpp"

namespace welkin {

// On the board: the block, and the constants of shaders/04_air/variant.glsl for every shader that includes it.
struct AirBlock {
  graph::Resource block;
  gpu::Constants constants;
};

// The scene's air as it is written into the block. --inject wrong-constant: red Rayleigh scattering 10 % too strong.
interop::Atmosphere air_of_device(const app::Context& context);

gpu::Constants air_constants(const Scene& scene);
// The same as text, for the key of an effect whose shaders have these constants.
std::string air_key(const Scene& scene);

// Pass "air": writes the block, when it differs from what is there.
app::Effect air();

}  // namespace welkin
