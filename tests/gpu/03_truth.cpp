// See 03_truth.hpp.
#include "tests/gpu/03_truth.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace welkin::test {

TrueChord true_chord(const Ray& ray) {
  const long double x = ray.x, y = ray.y, z = ray.z, size = std::sqrt(x * x + y * y + z * z);
  const long double r = static_cast<long double>(ray.radius_km) + ray.altitude_km;
  const long double radius = static_cast<long double>(ray.radius_km) + ray.shell_km;
  TrueChord chord{};
  chord.mu = z / size;
  chord.sine = std::sqrt(x * x + y * y) / size;
  chord.depth_km = radius - r * chord.sine;
  chord.root_km = std::sqrt(std::max((radius - r * chord.sine) * (radius + r * chord.sine), 0.0L));
  const long double middle = -r * chord.mu;
  // c / q as in the shader, because that is exact for a start on the shell too; here with 11 digits to spare.
  const long double c = (r - radius) * (r + radius);
  if (c <= 0.0L) {  // inside or on the shell
    chord.hit = c < 0.0L || chord.mu < 0.0L;
    chord.leave_km = chord.mu < 0.0L ? middle + chord.root_km : c == 0.0L ? 0.0L : -c / (chord.root_km - middle);
    return chord;
  }
  chord.hit = chord.mu < 0.0L && chord.depth_km >= 0.0L;
  chord.enter_km = middle + chord.root_km > 0.0L ? c / (middle + chord.root_km) : 0.0L;
  chord.leave_km = middle + chord.root_km;
  return chord;
}

std::vector<FormChord> run_form(Form form, const std::vector<Ray>& rays) {
  std::vector<float> inputs(rays.size() * 6);
  std::memcpy(inputs.data(), rays.data(), inputs.size() * sizeof(float));
  const std::vector<float> outputs = evaluate("tests/03_rays.comp", inputs, 6, 3, {form});
  std::vector<FormChord> chords(rays.size());
  std::memcpy(chords.data(), outputs.data(), outputs.size() * sizeof(float));
  return chords;
}

Ray ray_past(Random& random, double radius_km, double altitude_km, double tangent_altitude_km, double shell_km) {
  const double r = radius_km + altitude_km, b = std::clamp(radius_km + tangent_altitude_km, 0.0, r);
  const double sine = r > 0.0 ? b / r : 0.0, mu = r > 0.0 ? -std::sqrt((r - b) * (r + b)) / r : -1.0;
  const double azimuth = random.uniform(0.0, 6.283185307179586);
  return {static_cast<float>(radius_km),
          static_cast<float>(altitude_km),
          static_cast<float>(sine * std::sin(azimuth)),
          static_cast<float>(sine * std::cos(azimuth)),
          static_cast<float>(mu),
          static_cast<float>(shell_km)};
}

FormErrors measure_form(Form form, double altitude_km) {
  Random random(301);
  std::vector<Ray> rays;
  const size_t per_kind = 200000;
  // Past the limb at up to 20 km above and below it, but never above the camera: half of them within a micrometre …
  // a kilometre on a logarithmic scale, because the horizon is found by the last hit, half evenly within `reach`.
  const double reach = std::max(1e-3, 20.0 * std::min(altitude_km / kMoon_km, 1.0));
  for (size_t i = 0; i < per_kind; ++i) {
    const double from_limb = i % 4 < 2 ? random.log_uniform(1e-11, 1.0) : random.uniform(0.0, reach);
    rays.push_back(
        ray_past(random, kEarth_km, altitude_km, i % 2 == 0 ? -from_limb : std::min(from_limb, altitude_km)));
  }
  for (size_t i = 0; i < per_kind; ++i)  // steeply down: tangent point anywhere in the inner 90 % of the radius
    rays.push_back(ray_past(random, kEarth_km, altitude_km, kEarth_km * (random.uniform(0.0, 0.9) - 1.0)));
  for (Ray& ray : rays) ray.altitude_km = static_cast<float>(altitude_km);

  const std::vector<FormChord> found = run_form(form, rays);
  FormErrors errors;
  double farthest = 0.0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const TrueChord truth = true_chord(rays[i]);
    const bool hit = found[i].ground_km >= 0.0f;
    if (i < per_kind) {
      if (hit) farthest = std::max(farthest, static_cast<double>(found[i].ground_km));
      if (hit != truth.hit)
        errors.limb_m = std::max(errors.limb_m, static_cast<double>(std::abs(truth.depth_km)) * 1000.0);
    } else {
      const double error = hit ? static_cast<double>(std::abs(found[i].ground_km - truth.enter_km)) : INFINITY;
      errors.steep_m = std::max(errors.steep_m, error * 1000.0);
      errors.steep_relative = std::max(errors.steep_relative, error / static_cast<double>(truth.enter_km));
    }
  }
  const double h = static_cast<float>(altitude_km);
  errors.horizon_percent = 100.0 * (farthest / std::sqrt(h * (2.0 * kEarth_km + h)) - 1.0);
  return errors;
}

}  // namespace welkin::test
