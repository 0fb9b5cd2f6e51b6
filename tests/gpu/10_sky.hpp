// What chapter 10's tests share: the chapter's own probe for any scene and settings.
#pragma once

#include <vector>

#include "common/graph/composition.hpp"
#include "tests/gpu/09_sky.hpp"

namespace welkin::test {

// Those that draw chapter 10's sky, without meter and display.
std::vector<app::Effect> sky_effects();

std::vector<app::ProbeResult> view_of(const Scene& scene, const Choices& choices,
                                      const std::vector<app::ProbeRay>& rays);

// Relative differences per channel of two answers to the same rays, where the second is above `least` of its group's
// brightest: rays that share altitude and sun. In order of size.
std::vector<double> differences(const std::vector<app::ProbeRay>& rays, const std::vector<app::ProbeResult>& ours,
                                const std::vector<app::ProbeResult>& theirs, double least = 1e-6);
double quantile(const std::vector<double>& sorted, double share);

// Rays of every kind from these altitudes and suns: anywhere, close to the horizon on both sides, close to the sun.
std::vector<app::ProbeRay> rays_from(const std::vector<double>& altitudes_km, const std::vector<double>& suns_deg,
                                     size_t of_each, uint64_t seed);

}  // namespace welkin::test
