// Error metrics, in double. See metrics.hpp for the definitions.
#include "common/measure/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "common/measure/statistics.hpp"

namespace welkin::measure {
namespace {

double ratio(double part, double whole) {
  if (whole > 0.0) return part / whole;
  return part == 0.0 ? 0.0 : std::copysign(std::numeric_limits<double>::infinity(), part);
}

std::vector<double> values(const Image& image) {
  std::vector<double> out;
  out.reserve(image.pixels.size() * 3);
  for (const glm::vec4& p : image.pixels) out.insert(out.end(), {p.r, p.g, p.b});
  return out;
}

}  // namespace

Errors compare(std::span<const double> ours, std::span<const double> reference) {
  if (ours.size() != reference.size())
    throw Error(Exit::mismatch,
                fmt::format("{} values cannot be compared with a reference of {}", ours.size(), reference.size()));
  if (ours.empty()) fail("nothing to compare: no values");
  Errors e;
  e.values = ours.size();
  const auto not_finite = [](double v) { return !std::isfinite(v); };
  e.not_finite = static_cast<size_t>(std::count_if(ours.begin(), ours.end(), not_finite));
  e.not_finite_reference = static_cast<size_t>(std::count_if(reference.begin(), reference.end(), not_finite));
  if (!e.finite()) {
    e.relative_rmse = e.max_relative = e.p99_relative = e.mean_bias = e.rmse_255 =
        std::numeric_limits<double>::quiet_NaN();
    return e;
  }
  double difference = 0.0, difference2 = 0.0, magnitude = 0.0, reference2 = 0.0;
  for (size_t i = 0; i < ours.size(); ++i) {
    const double d = ours[i] - reference[i];
    difference += d;
    difference2 += d * d;
    magnitude += std::abs(reference[i]);
    reference2 += reference[i] * reference[i];
  }
  e.relative_rmse = std::sqrt(ratio(difference2, reference2));
  e.mean_bias = ratio(difference, magnitude);
  const double floor = 1e-3 * magnitude / static_cast<double>(ours.size());
  std::vector<double> relative(ours.size());
  for (size_t i = 0; i < ours.size(); ++i)
    relative[i] = ratio(std::abs(ours[i] - reference[i]), std::max(std::abs(reference[i]), floor));
  e.max_relative = *std::max_element(relative.begin(), relative.end());
  e.p99_relative = percentile(std::move(relative), 0.99);
  return e;
}

Errors compare(const Image& ours, const Image& reference, const Display& display) {
  if (ours.width != reference.width || ours.height != reference.height || ours.pixels.size() != reference.pixels.size())
    throw Error(Exit::mismatch, fmt::format("a picture of {}x{} cannot be compared with a reference of {}x{}",
                                            ours.width, ours.height, reference.width, reference.height));
  Errors e = compare(values(ours), values(reference));
  if (!e.finite()) return e;
  double sum = 0.0;
  for (size_t i = 0; i < ours.pixels.size(); ++i) {
    const glm::dvec3 d(display(glm::vec3(ours.pixels[i])) - display(glm::vec3(reference.pixels[i])));
    sum += d.x * d.x + d.y * d.y + d.z * d.z;
  }
  e.rmse_255 = 255.0 * std::sqrt(sum / static_cast<double>(e.values));
  return e;
}

std::string describe(const Errors& e) {
  if (!e.finite())
    return fmt::format("{} of {} values are NaN or infinite (in the reference: {}): no score", e.not_finite, e.values,
                       e.not_finite_reference);
  return fmt::format(
      "relative RMSE {:.3g}, relative error 99 % below {:.3g}, at most {:.3g}, bias {:+.3g}, RMSE on 0-255 {:.3g}",
      e.relative_rmse, e.p99_relative, e.max_relative, e.mean_bias, e.rmse_255);
}

}  // namespace welkin::measure
