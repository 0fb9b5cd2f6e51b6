// See 10_sky.hpp.
#include "tests/gpu/10_sky.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "chapters/08_transmittance_lut/transmittance_lut.hpp"
#include "chapters/10_sky_view_lut/sky.hpp"
#include "tests/gpu/harness.hpp"

namespace welkin::test {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

}  // namespace

std::vector<app::Effect> sky_effects() {
  return {air(), transmittance_table(), multiple_scattering_table(), sky_view(), sky()};
}

std::vector<app::ProbeResult> chapter_10_sky(const Scene& scene, const Choices& choices,
                                             const std::vector<app::ProbeRay>& rays) {
  Settings settings(app::knobs_of(sky_effects(), 10));
  for (const auto& [name, text] : choices) settings.set(name, text);
  const std::string no_fault;
  return probe_sky({device(), scene, settings, no_fault}, rays);
}

std::vector<double> differences(const std::vector<app::ProbeRay>& rays, const std::vector<app::ProbeResult>& ours,
                                const std::vector<app::ProbeResult>& theirs, double least) {
  std::map<std::pair<double, double>, double> brightest;
  const auto brightest_of = [&](size_t i) -> double& {
    return brightest[{rays[i].altitude_km, rays[i].sun_zenith_deg}];
  };
  for (size_t i = 0; i < rays.size(); ++i)
    for (int c = 0; c < 3; ++c) brightest_of(i) = std::max(brightest_of(i), theirs[i].radiance[c]);
  std::vector<double> values;
  for (size_t i = 0; i < rays.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (theirs[i].radiance[c] > least * brightest_of(i))
        values.push_back(std::abs(ours[i].radiance[c] / theirs[i].radiance[c] - 1.0));
  std::sort(values.begin(), values.end());
  return values;
}

double quantile(const std::vector<double>& sorted, double share) {
  return sorted.at(std::min(sorted.size() - 1, static_cast<size_t>(share * static_cast<double>(sorted.size()))));
}

std::vector<app::ProbeRay> rays_from(const std::vector<double>& altitudes_km, const std::vector<double>& suns_deg,
                                     size_t of_each, uint64_t seed) {
  Random random(seed);
  std::vector<app::ProbeRay> rays;
  for (const double h : altitudes_km)
    for (const double sun : suns_deg)
      for (size_t i = 0; i < of_each; ++i) {
        const double horizon = 180.0 - std::asin(6360.0 / (6360.0 + h)) / kDegree;
        double zenith = std::acos(random.uniform(-1.0, 1.0)) / kDegree, azimuth = random.uniform(0.0, 180.0);
        if (i % 4 == 1) zenith = horizon - random.log_uniform(1e-3, 20.0);
        if (i % 4 == 2) zenith = horizon + random.log_uniform(0.1, 20.0);
        if (i % 4 == 3) zenith = std::abs(sun + random.uniform(-8.0, 8.0)), azimuth = random.uniform(0.0, 12.0);
        rays.push_back({h, std::clamp(zenith, 0.0, 179.9), sun, azimuth});
      }
  return rays;
}

}  // namespace welkin::test
