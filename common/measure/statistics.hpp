// Medians and percentiles of small samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace welkin::measure {

// The value below which a fraction 0..1 of the sample lies, interpolated linearly between order statistics (position
// fraction * (n - 1), as NumPy's default). NaN for an empty sample or one that holds a NaN. Takes a copy: it reorders.
inline double percentile(std::vector<double> sample, double fraction) {
  if (sample.empty() || std::any_of(sample.begin(), sample.end(), [](double v) { return std::isnan(v); }))
    return std::numeric_limits<double>::quiet_NaN();
  const double position = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(sample.size() - 1);
  const auto below = sample.begin() + static_cast<std::ptrdiff_t>(position);
  std::nth_element(sample.begin(), below, sample.end());
  const double low = *below, weight = position - std::floor(position);
  if (weight == 0.0) return low;
  const double high = *std::min_element(below + 1, sample.end());
  return high == low ? low : low + weight * (high - low);  // equal infinities stay infinite
}

inline double median(std::vector<double> sample) { return percentile(std::move(sample), 0.5); }

// Median, extremes and size of repeated timings.
struct Spread {
  double median = 0.0, minimum = 0.0, maximum = 0.0;
  size_t samples = 0;
};

inline Spread spread(const std::vector<double>& sample) {
  if (sample.empty()) return {};
  const auto [low, high] = std::minmax_element(sample.begin(), sample.end());
  return {median(sample), *low, *high, sample.size()};
}

}  // namespace welkin::measure
