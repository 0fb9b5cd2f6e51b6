// The ray-sphere functions of chapter 03 as the device runs them, over more than a million rays each, against long
// double.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/03_truth.hpp"

using namespace welkin::test;

namespace {

constexpr size_t kCount = 1 << 20;
constexpr double kTwoPi = 6.283185307179586;

Ray random_direction(Random& random, double radius_km, double altitude_km, double shell_km) {
  const double z = random.uniform(-1.0, 1.0), azimuth = random.uniform(0.0, kTwoPi), s = std::sqrt(1.0 - z * z);
  return {float(radius_km), float(altitude_km), float(s * std::cos(azimuth)), float(s * std::sin(azimuth)),
          float(z),         float(shell_km)};
}

// Rays of every kind: anywhere, tangent to ground and top, on a boundary, vertical and level, other planets, inside the
// shell, no planet at all, below the ground.
std::vector<Ray> rays_of_every_kind() {
  Random random(303);
  std::vector<Ray> rays;
  rays.reserve(kCount);
  while (rays.size() < kCount) {
    const double altitude = random.log_uniform(1e-7, 5e5),
                 away = random.log_uniform(1e-9, 50.0) * (random.next() % 2 ? 1.0 : -1.0);
    rays.push_back(random_direction(random, kEarth_km, altitude, 0.0));
    rays.push_back(ray_past(random, kEarth_km, altitude, std::min(away, altitude)));
    rays.push_back(ray_past(random, kEarth_km, altitude, std::min(100.0 + away, altitude), 100.0));
    const double boundary = random.next() % 2 ? 100.0 : 0.0;
    rays.push_back(random_direction(random, kEarth_km, boundary, boundary));
    const float axes[][3] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {0.70710678f, 0.70710678f, 0}};
    const float* axis = axes[random.next() % 5];
    rays.push_back(
        {float(kEarth_km), float(random.next() % 8 ? altitude : boundary), axis[0], axis[1], axis[2], float(boundary)});
    const double radius = random.log_uniform(1e-3, 7e4);
    rays.push_back(
        random_direction(random, radius, radius * random.log_uniform(1e-6, 100.0), radius * random.uniform(0.0, 0.1)));
    rays.push_back(random_direction(random, kEarth_km, random.uniform(0.0, 100.0), 100.0));
    if (random.next() % 2)
      rays.push_back(random_direction(random, 0.0, random.next() % 2 ? altitude : 0.0, random.next() % 2 ? 0.0 : 1.0));
    else
      rays.push_back(random_direction(random, kEarth_km, -random.log_uniform(1e-6, 6000.0), 0.0));
  }
  return rays;
}

const std::vector<Ray>& all_rays() {
  static const std::vector<Ray> rays = rays_of_every_kind();
  return rays;
}

// What a form may be wrong by: relative to the distance, in km, and in the square of half the chord (km^2), which is
// the quantity under the root and so the only error that grows near a tangent.
struct Allowed {
  double relative, absolute_km, squared_km2;
};

Allowed robust_bound(const Ray& ray, const TrueChord& truth) {
  // 6e-8 per operation. Tangent altitude: from h and r mu^2 near the horizontal, from r sine elsewhere
  // (ray_sphere.glsl).
  const double h = std::abs(ray.altitude_km), R = ray.radius_km, r = R + ray.altitude_km, mu = double(truth.mu),
               sine = double(truth.sine);
  const double terms = std::abs(mu) < 0.5 ? h + r * mu * mu / (1.0 + sine) + ray.shell_km : r * sine + R + ray.shell_km;
  const double tangent_km = 3e-7 * terms;
  return {4e-7, 1e-20, 2.0 * (R + ray.shell_km + tangent_km) * tangent_km};
}

Allowed double_float_bound(const Ray& ray, const TrueChord&) {
  // 2^-46 per operation on squares as large as r^2; the result is rounded to a float once.
  const double r = double(ray.radius_km) + ray.altitude_km, shell = double(ray.radius_km) + ray.shell_km,
               scale = std::max(std::abs(r), shell);
  return {6.1e-8, 4e-14 * scale, 6e-14 * scale * scale};
}

// Number of rays whose chord is wrong by more than allowed.
template <typename Bound>
size_t count_wrong(const std::vector<Ray>& rays, const std::vector<FormChord>& found, Bound bound) {
  size_t wrong = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const TrueChord truth = true_chord(rays[i]);
    const Allowed allowed = bound(rays[i], truth);
    const long double radius = static_cast<long double>(rays[i].radius_km) + rays[i].shell_km;
    const long double r = static_cast<long double>(rays[i].radius_km) + rays[i].altitude_km;
    const long double squared = (radius - r * truth.sine) * (radius + r * truth.sine);  // negative: a miss
    const bool hit = found[i].enter_km >= 0.0f;
    if (hit != truth.hit) {
      // Only a ray within rounding of tangency, or a start within rounding of the shell, may be judged otherwise.
      const bool near =
          std::abs(squared) <= allowed.squared_km2 || std::abs((r - radius) * (r + radius)) <= allowed.squared_km2;
      if (!near) ++wrong;
      continue;
    }
    if (!hit) continue;
    const long double root = std::sqrt(std::max(squared, 0.0L));
    const long double slack = std::max(root - std::sqrt(std::max(squared - allowed.squared_km2, 0.0L)),
                                       std::sqrt(squared + allowed.squared_km2) - root);
    const auto good = [&](float value, long double exact) {
      return std::abs(value - exact) <= allowed.relative * exact + allowed.absolute_km + slack;
    };
    if (!good(found[i].enter_km, truth.enter_km) || !good(found[i].leave_km, truth.leave_km)) ++wrong;
  }
  return wrong;
}

}  // namespace

TEST_CASE("rays: every form answers every ray with finite distances in order") {
  const std::vector<Ray>& rays = all_rays();
  for (const Form form : {kNaive, kCameraRelative, kRobust, kDoubleFloat}) {
    INFO(kForms[form]);
    const std::vector<FormChord> found = run_form(form, rays);
    size_t not_finite = 0, out_of_order = 0, too_far = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const FormChord& c = found[i];
      if (!std::isfinite(c.enter_km) || !std::isfinite(c.leave_km) || !std::isfinite(c.ground_km)) ++not_finite;
      const bool miss = c.enter_km == -1.0f && c.leave_km == -1.0f,
                 hit = c.enter_km >= 0.0f && c.leave_km >= c.enter_km;
      if ((!miss && !hit) || !(c.ground_km == -1.0f || c.ground_km >= 0.0f)) ++out_of_order;
      // No chord ends farther than the far side of the shell; 1 % for the naive form's errors.
      const double farthest =
          std::abs(double(rays[i].radius_km) + rays[i].altitude_km) + rays[i].radius_km + rays[i].shell_km;
      if (c.leave_km > 1.01 * farthest) ++too_far;
    }
    CHECK(not_finite == 0);
    CHECK(out_of_order == 0);
    CHECK(too_far == 0);
  }
}

TEST_CASE("rays: the robust form is right to 4e-7 of the distance and of the tangent altitude's terms") {
  CHECK(count_wrong(all_rays(), run_form(kRobust, all_rays()), robust_bound) == 0);
}

TEST_CASE("rays: double-float is right to 2^-46 of the squares, rounded once") {
  CHECK(count_wrong(all_rays(), run_form(kDoubleFloat, all_rays()), double_float_bound) == 0);
}

TEST_CASE("rays: the same bound rejects the naive and the camera-relative form") {
  // The test of the test: forms known to be wrong are found to be wrong, often.
  CHECK(count_wrong(all_rays(), run_form(kNaive, all_rays()), robust_bound) > kCount / 10);
  CHECK(count_wrong(all_rays(), run_form(kCameraRelative, all_rays()), robust_bound) > kCount / 200);
}

TEST_CASE("rays: the scalar functions of ray_sphere.glsl against long double") {
  Random random(304);
  std::vector<float> inputs;
  for (size_t i = 0; i < kCount; ++i) {
    const double radius = i % 16 == 0 ? (i % 32 == 0 ? 0.0 : random.log_uniform(1e-3, 7e4)) : kEarth_km;
    const double altitude = i % 11 == 0 ? 0.0 : random.log_uniform(1e-7, 5e5);
    const double zenith =
        i % 3 == 0 ? 0.5 * kTwoPi / 2.0 + random.uniform(-0.05, 0.05) : random.uniform(0.0, kTwoPi / 2.0);
    const double t = i % 13 == 0 ? 0.0 : random.log_uniform(1e-6, 1e6);
    const double shell = i % 7 == 0 ? altitude : altitude + random.log_uniform(1e-6, 1e3);
    for (const double value : {radius, altitude, std::cos(zenith), std::sin(zenith), t, shell})
      inputs.push_back(float(value));
  }
  const std::vector<float> out = evaluate("tests/03_ray_sphere.comp", inputs, 6, 6);
  size_t not_finite = 0, along = 0, tangent = 0, chord = 0, inside = 0, outside = 0;
  for (size_t i = 0; i < kCount; ++i) {
    const float *in = &inputs[6 * i], *got = &out[6 * i];
    for (int k = 0; k < 6; ++k) not_finite += !std::isfinite(got[k]);
    const long double R = in[0], h = in[1], mu = in[2], t = in[4], shell = in[5], r = R + h;
    const long double r_t = std::sqrt(std::max(r * r + 2.0L * r * mu * t + t * t, 0.0L));
    // Near the planet's centre r(t) is the root of a difference; no ray that matters goes there.
    const bool deep = r_t < 0.5L * R;
    // 6e-8 per operation on h, on the climb's terms, and on r(t)^2, whose error from afar is much more than r(t)'s.
    const long double squares = r * r + t * (2.0L * r * std::abs(mu) + t), climb = t * (2.0L * r * mu + t),
                      sum = std::max(r_t + r, 1e-20L);
    const long double along_bound = 5e-7L * (h + t * (2.0L * r * std::abs(mu) + t) / sum) +
                                    2e-7L * squares / std::max(2.0L * r_t, 1e-20L) * std::abs(climb) / (sum * sum) +
                                    2e-15L;  // what long double knows of r(t) - R
    if (!deep && std::abs(got[0] - (r_t - R)) > along_bound) ++along;
    const bool level = std::abs(mu) < 0.5L;
    const long double sine = level ? std::sqrt(1.0L - mu * mu) : in[3];
    const long double tangent_terms = level ? h + r * mu * mu / (1.0L + sine) : r * sine + R;
    if (std::abs(got[1] - (r * sine - R)) > 3e-7L * tangent_terms + 1e-20L) ++tangent;
    const long double p = got[1], exact = std::sqrt(std::max((h - p) * (2.0L * R + h + p), 0.0L));
    if (std::abs(got[2] - exact) > 5e-7L * exact + 1e-20L) ++chord;
    const long double c = (shell - h) * (2.0L * R + shell + h), root = std::sqrt(r * r * mu * mu + c);
    const long double way = mu >= 0.0L ? (c > 0.0L ? c / (r * mu + root) : 0.0L) : root - r * mu;
    if (std::abs(got[3] - way) > 5e-7L * way + 1e-20L) ++inside;
    if (!(got[4] == -1.0f || got[4] >= 0.0f)) ++outside;
  }
  CHECK(not_finite == 0);
  CHECK(along == 0);    // 5e-7 of h and of the climb's two terms, and what r(t)^2 loses from afar
  CHECK(tangent == 0);  // 3e-7 of its terms: 2 m at worst around the Earth
  CHECK(chord == 0);    // 5e-7
  CHECK(inside == 0);   // 5e-7
  CHECK(outside == 0);
}
