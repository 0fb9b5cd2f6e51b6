// Interpolation along a path. See path.hpp. Between two views a cubic with slopes after M. Steffen (A simple method for
// monotonic interpolation in one dimension, Astronomy & Astrophysics 239, 1990); at both ends the slope is 0.
#include "common/scene/path.hpp"

#include <algorithm>
#include <cmath>

#include "common/scene/fields.hpp"

namespace welkin {
namespace {

constexpr double kMetre_km = 0.001;

// The views between which `time` lies: i and i + 1.
size_t before(const std::vector<double>& times, double time) {
  return static_cast<size_t>(std::upper_bound(times.begin() + 1, times.end() - 1, time) - times.begin()) - 1;
}

// Value at `time` of the monotone cubic through (times[i], values[i]); `time` lies between the first and the last.
double smooth(const std::vector<double>& times, const std::vector<double>& values, double time) {
  const auto rate = [&](size_t i) { return (values[i + 1] - values[i]) / (times[i + 1] - times[i]); };
  const auto slope = [&](size_t i) {
    if (i == 0 || i + 1 == times.size()) return 0.0;
    const double last = times[i] - times[i - 1], next = times[i + 1] - times[i], a = rate(i - 1), b = rate(i);
    if (a * b <= 0.0) return 0.0;
    const double mean = std::abs(a * next + b * last) / (last + next);
    return std::copysign(std::min({2.0 * std::abs(a), 2.0 * std::abs(b), mean}), a);
  };
  const size_t i = before(times, time);
  const double span = times[i + 1] - times[i], u = (time - times[i]) / span, v = 1.0 - u;
  // Written as a difference, so that equal values give exactly that value: passes that wait for a still camera see one.
  return values[i] + (values[i + 1] - values[i]) * u * u * (1.0 + 2.0 * v) +
         span * u * v * (v * slope(i) - u * slope(i + 1));
}

}  // namespace

PathPoint point_on(const Scene& scene, const Path& path, double time_s) {
  const double time = std::clamp(time_s, path.time_s.front(), path.time_s.back());
  std::vector<View> views;
  for (const std::string& name : path.views) views.push_back(scene.view(name));
  const auto key = std::find(path.time_s.begin(), path.time_s.end(), time);
  PathPoint point{.view = key == path.time_s.end() ? views[0] : views[static_cast<size_t>(key - path.time_s.begin())],
                  .moment_s = path.moment_s.empty() ? scene.time_s : smooth(path.time_s, path.moment_s, time)};
  point.view.name = path.name;
  if (key != path.time_s.end()) return point;
  const auto along = [&](const auto& value_of) {
    std::vector<double> values;
    for (const View& view : views) values.push_back(value_of(view));
    return smooth(path.time_s, values, time);
  };
  for (double View::*field : {&View::east_km, &View::north_km, &View::elevation_deg, &View::fov_deg})
    point.view.*field = along([&](const View& view) { return view.*field; });
  const auto height = [](const View& view) { return std::log(view.altitude_km + kMetre_km); };
  const size_t i = before(path.time_s, time);
  const auto [low_km, high_km] = std::minmax({views[i].altitude_km, views[i + 1].altitude_km});
  point.view.altitude_km = std::clamp(std::exp(along(height)) - kMetre_km, low_km, high_km);
  double azimuth_deg = views[0].azimuth_deg;  // of each view the one next to that before
  point.view.azimuth_deg = turned(
      along([&](const View& view) { return azimuth_deg += std::remainder(view.azimuth_deg - azimuth_deg, 360.0); }));
  return point;
}

}  // namespace welkin
