// The air in front of things: the march of chapter 11 against double quadrature to a distance (single scattering), and
// against chapter 09's march of whole rays (all orders).
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/11_parts.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

AirItem item_of(AirPart part, const SkyRay& ray, std::array<double, 4> c, double b_w = 0.0) {
  return {part, {ray.view[0], ray.view[1], ray.view[2], ray.altitude_km}, {ray.sun[0], ray.sun[1], ray.sun[2], b_w}, c};
}

// Rays that end on terrain: level and a little up or down, from the ground, a peak and an airliner; sun high and low.
std::vector<std::pair<SkyRay, double>> cases() {
  std::vector<std::pair<SkyRay, double>> list;
  for (const double altitude_km : {0.002, 3.0, 10.0})
    for (const double zenith_deg : {87.0, 90.0, 100.0})
      for (const double sun_deg : {25.0, 89.0})
        for (const double azimuth_deg : {10.0, 120.0})
          for (const double d_km : {0.05, 1.0, 10.0, 60.0}) {
            const double mu = std::cos(zenith_deg * 3.14159265358979323846 / 180.0), r = 6360.0 + altitude_km;
            const double end_km = std::sqrt(r * r + 2.0 * r * mu * d_km + d_km * d_km) - 6360.0;
            const double lowest_km = mu < 0.0 && -r * mu < d_km ? r * std::sqrt(1.0 - mu * mu) - 6360.0 : end_km;
            if (std::min(end_km, lowest_km) < 1e-4) continue;
            list.push_back({ray_from_degrees(altitude_km, zenith_deg, sun_deg, azimuth_deg), d_km});
          }
  return list;
}

struct Score {
  double radiance = 0.0, transmittance = 0.0;
};
// Largest relative error over all cases and channels, marched in slices that end at the case's distance.
// One Score for each march of (slices, samples).
std::vector<Score> scores(const reference::Planet& planet, const std::vector<std::pair<int, int>>& marches) {
  const auto list = cases();
  std::vector<AirItem> items;
  for (const auto& [slices, samples] : marches)
    for (const auto& [ray, d] : list)
      items.push_back(item_of(AirPart::march, ray, {d, double(slices), double(samples)}, 2.0));
  const std::vector<AirAnswer> answers = evaluate_air(planet, items);
  std::vector<Score> worst(marches.size());
  for (size_t i = 0; i < list.size(); ++i) {
    const Light truth = truth_to(planet, list[i].first, list[i].second);
    for (size_t m = 0; m < marches.size(); ++m)
      for (int k = 0; k < 3; ++k) {
        const AirAnswer& answer = answers[m * list.size() + i];
        if (truth.radiance[k] > 1e-7)
          worst[m].radiance = std::max(worst[m].radiance, std::abs(answer.radiance[k] / truth.radiance[k] - 1.0));
        worst[m].transmittance =
            std::max(worst[m].transmittance, std::abs(answer.transmittance[k] - truth.transmittance[k]));
      }
  }
  return worst;
}

}  // namespace

TEST_CASE("truth: the air up to a distance, against quadrature") {
  CHECK(cases().size() > 100);
  const std::vector<Score> earth = scores(reference::earth(), {{32, 2}, {8, 1}, {128, 2}});
  const Score &standard = earth[0], &coarse = earth[1], &fine = earth[2];
  CAPTURE(standard.radiance, standard.transmittance, coarse.radiance, fine.radiance, fine.transmittance);
  CHECK(standard.radiance < 0.002);
  CHECK(standard.transmittance < 1e-4);
  CHECK(coarse.radiance > 5.0 * standard.radiance);
  CHECK(fine.radiance < 0.001);
  const Score dense = scores(reference::dense_alien(), {{32, 2}}).front();
  CAPTURE(dense.radiance, dense.transmittance);
  CHECK(dense.radiance < 0.01);
  CHECK(dense.transmittance < 1e-4);
}

// A slice that ends at the last texel but is marched to the one before is the commonest fault of froxels.
TEST_CASE("truth: no segment is lost at the end") {
  // A homogeneous stretch: level, high up, 2 km: radiance grows by the same amount with every slice.
  const reference::Planet planet = reference::earth();
  const SkyRay ray = ray_from_degrees(3.0, 90.0, 25.0, 90.0);
  std::vector<AirItem> items;
  for (const int slices : {1, 2, 3, 8}) items.push_back(item_of(AirPart::march, ray, {2.0, double(slices), 2.0}, 1.0));
  const Light truth = truth_to(planet, ray, 2.0);
  for (const AirAnswer& answer : evaluate_air(planet, items))
    for (int k = 0; k < 3; ++k) {
      CAPTURE(answer.radiance[k] / truth.radiance[k] - 1.0);
      CHECK(std::abs(answer.radiance[k] / truth.radiance[k] - 1.0) < 2e-4);
      CHECK(std::abs(answer.transmittance[k] - truth.transmittance[k]) < 1e-6);
    }
}

// Errors of the first slice of a given length at places x in it; and of what its nearest texel holds, which a sampler
// gives.
struct FirstSlice {
  double radiance = 0.0, transmittance = 0.0, sampler = 0.0;
};
FirstSlice first_slice(const reference::Planet& planet, double length_km) {
  std::vector<AirItem> items, naive;
  std::vector<Light> truths;
  for (const double altitude_km : {0.002, 2.0})
    for (const double zenith_deg : {80.0, 90.0})
      for (const double x : {0.002, 0.25, 0.9, 1.0}) {
        const SkyRay ray = ray_from_degrees(altitude_km, zenith_deg, 60.0, 30.0);
        items.push_back(item_of(AirPart::first_slice, ray, {x, length_km, 0.0}));
        naive.push_back(item_of(AirPart::first_slice, ray, {x, length_km, 1.0}));
        truths.push_back(truth_to(planet, ray, length_km * x));
      }
  items.insert(items.end(), naive.begin(), naive.end());
  const std::vector<AirAnswer> answers = evaluate_air(planet, items);
  FirstSlice worst;
  for (size_t i = 0; i < truths.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      // The truth is a difference of two quadratures of 1e-8: with less light than this it has no digits left.
      if (truths[i].radiance[k] > 3e-6) {
        worst.radiance = std::max(worst.radiance, std::abs(answers[i].radiance[k] / truths[i].radiance[k] - 1.0));
        worst.sampler =
            std::max(worst.sampler, std::abs(answers[truths.size() + i].radiance[k] / truths[i].radiance[k] - 1.0));
      }
      worst.transmittance =
          std::max(worst.transmittance, std::abs(answers[i].transmittance[k] - truths[i].transmittance[k]));
    }
  return worst;
}

TEST_CASE("truth: anywhere inside the first slice") {
  // Of the default the first slice is 125 m long; with a linear distribution 4 km, in which aerosol thins by half.
  for (const bool dense : {false, true}) {
    const reference::Planet planet = dense ? reference::dense_alien() : reference::earth();
    const FirstSlice standard = first_slice(planet, 0.125), linear = first_slice(planet, 4.0);
    CAPTURE(dense, standard.radiance, standard.transmittance, standard.sampler, linear.radiance, linear.transmittance,
            linear.sampler);
    CHECK(standard.radiance < 0.01);  // seen: 0.4 %
    CHECK(standard.transmittance < 2e-5);
    CHECK(linear.radiance < 0.2);
    CHECK(linear.transmittance < 0.005);
    CHECK(standard.sampler > 2.5);
    CHECK(linear.sampler > 50.0);
  }
}

TEST_CASE("truth: with all orders the whole ray is chapter 09's march") {
  for (const uint32_t method : {0u, 2u}) {
    std::vector<AirItem> ours, theirs;
    for (const double altitude_km : {0.002, 3.0})
      for (const double zenith_deg : {0.0, 60.0, 85.0})
        for (const double sun_deg : {30.0, 85.0}) {
          const SkyRay ray = ray_from_degrees(altitude_km, zenith_deg, sun_deg, 40.0);
          ours.push_back(item_of(AirPart::to_the_end, ray, {0.0, 128.0, 2.0}, 1.0));
          theirs.push_back(item_of(AirPart::all_orders, ray, {}));
        }
    const std::vector<AirAnswer> a = evaluate_air(reference::earth(), ours, true, method),
                                 b = evaluate_air(reference::earth(), theirs, true, method);
    double radiance = 0.0, transmittance = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        radiance = std::max(radiance, std::abs(a[i].radiance[k] / b[i].radiance[k] - 1.0));
        transmittance = std::max(transmittance, std::abs(a[i].transmittance[k] - b[i].transmittance[k]));
      }
    CAPTURE(method, radiance, transmittance);
    CHECK(radiance < 0.002);
    CHECK(transmittance < 2e-4);
  }
}

TEST_CASE("truth: shadow takes its share of single scattering and nothing else") {
  const SkyRay ray = ray_from_degrees(0.5, 80.0, 60.0, 40.0);
  const std::vector<AirItem> items{item_of(AirPart::to_the_end, ray, {0.0, 64.0, 2.0}, 1.0),
                                   item_of(AirPart::to_the_end, ray, {0.0, 64.0, 2.0}, 0.25),
                                   item_of(AirPart::to_the_end, ray, {0.0, 64.0, 2.0}, 0.0)};
  const std::vector<AirAnswer> single = evaluate_air(reference::earth(), items),
                               all = evaluate_air(reference::earth(), items, true);
  for (int k = 0; k < 3; ++k) {
    CHECK(single[2].radiance[k] == 0.0);
    CHECK(single[1].radiance[k] == Approx(0.25 * single[0].radiance[k]).epsilon(1e-5));
    CHECK(all[2].radiance[k] > 0.0);
    CHECK(all[0].radiance[k] - all[2].radiance[k] == Approx(single[0].radiance[k]).epsilon(1e-4));
    CHECK(all[0].transmittance[k] == all[2].transmittance[k]);
  }
}
