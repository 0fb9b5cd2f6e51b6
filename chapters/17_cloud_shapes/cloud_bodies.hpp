// The clouds of a scene as the block that shaders read: numbers worked out in double, once. CPU.
#pragma once

#include <vector>

#include "common/scene/scene.hpp"
#include "shaders/interop/cloud.h"

namespace welkin {

// All bodies of a scene: those it says, and those of its [weather].
std::vector<Cloud> bodies_of(const Scene& scene);
// The bodies of a preset of [weather].
std::vector<Cloud> preset_bodies(const Weather& weather);

// A phase function as weight Draine(g, alpha) + (1 - weight) Draine(second_g, second_alpha); alpha 0 is
// Henyey-Greenstein.
struct PhaseMixture {
  double weight = 1.0, g = 0.0, alpha = 0.0, second_g = 0.0, second_alpha = 0.0;
};
PhaseMixture phase_of(const Cloud& cloud);
// The fit of Jendersie and d'Eon 2023 to Mie scattering by water droplets; domain 1.5 to 50 um.
PhaseMixture droplet_phase(double diameter_um);

// Everything but what is in files: the grids' corners and largest densities are filled in by clouds.cpp.
interop::CloudBlock make_cloud_block(const std::vector<Cloud>& bodies, const Planet& planet);
int kinds_of(const std::vector<Cloud>& bodies);  // bits of interop/cloud.h

}  // namespace welkin
