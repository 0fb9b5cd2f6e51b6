// Shared by chapter 10's tests: the chapter's probe for any scene and settings.
#pragma once

#include <vector>

#include "common/graph/composition.hpp"
#include "tests/gpu/09_sky.hpp"

namespace welkin::test {

// The effects that draw chapter 10's sky, without exposure and display.
std::vector<app::Effect> sky_effects();

std::vector<app::ProbeResult> chapter_10_sky(const Scene& scene, const Choices& choices,
                                             const std::vector<app::ProbeRay>& rays);

// Relative differences per channel of two results for the same rays, in ascending order. Radiances of the second below
// `least` times the brightest ray of the same altitude and sun are left out.
std::vector<double> differences(const std::vector<app::ProbeRay>& rays, const std::vector<app::ProbeResult>& ours,
                                const std::vector<app::ProbeResult>& theirs, double least = 1e-6);
double quantile(const std::vector<double>& sorted, double share);

// Random rays for these altitudes and suns: in all directions, close to the horizon on both sides, close to the sun.
std::vector<app::ProbeRay> rays_from(const std::vector<double>& altitudes_km, const std::vector<double>& suns_deg,
                                     size_t of_each, uint64_t seed);

}  // namespace welkin::test
