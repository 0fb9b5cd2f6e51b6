// How far a picture, or any list of numbers, is from its reference.
//
// With a = ours, r = reference, over all N values (three per pixel; alpha takes no part):
//   relative RMSE   sqrt(mean((a - r)^2) / mean(r^2))
//   relative error  |a - r| / max(|r|, 1e-3 mean|r|) for each value; reported: its maximum and 99th percentile.
//                   The floor keeps a black corner from deciding the score: below a thousandth of the mean, errors
//                   count relative to that thousandth.
//   mean bias       (mean a - mean r) / mean|r|, positive where ours is too bright
//   RMSE on 0..255  sqrt(mean((255 d(a) - 255 d(r))^2)) of display values, not rounded to whole levels
// A reference that is zero everywhere scores 0 where ours is zero too, else infinity.
// NaN and infinities are counted, and a comparison that has any scores NaN throughout: never "good but for some
// pixels".
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "common/image/image.hpp"

namespace welkin::measure {

struct Errors {
  size_t values = 0;
  size_t not_finite = 0;  // in ours
  size_t not_finite_reference = 0;
  double relative_rmse = 0.0;
  double max_relative = 0.0;
  double p99_relative = 0.0;
  double mean_bias = 0.0;
  double rmse_255 = 0.0;  // pictures only; 0 for plain numbers

  bool finite() const { return not_finite == 0 && not_finite_reference == 0; }
};

using Display = std::function<glm::vec3(const glm::vec3& radiance)>;  // linear radiance to 0..1

// Error with Exit::mismatch if sizes differ, with Exit::usage if there is nothing to compare.
Errors compare(std::span<const double> ours, std::span<const double> reference);
Errors compare(const Image& ours, const Image& reference, const Display& display);

std::string describe(const Errors& errors);  // one line

}  // namespace welkin::measure
