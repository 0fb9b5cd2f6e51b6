// The hard cases of chapter 03: what breaks, by how much, and what holds. The figures stand in docs/hard_cases.md.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "common/app/camera.hpp"
#include "tests/gpu/03_truth.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr float kEarth = 6360.0f;

FormChord one(Form form, const Ray& ray) { return run_form(form, {ray}).front(); }

// Rays from one altitude in every direction that does not go down, and the form's longest way inside a shell there.
double longest_false_chord(Form form, float altitude_km, float shell_km) {
  Random random(306);
  std::vector<Ray> rays{{kEarth, altitude_km, 1, 0, 0, shell_km}, {kEarth, altitude_km, 0, 0, 1, shell_km}};
  for (int i = 0; i < 100000; ++i) {
    const double mu = random.log_uniform(1e-9, 1.0), azimuth = random.uniform(0.0, 6.283185307179586),
                 s = std::sqrt(1.0 - mu * mu);
    rays.push_back(
        {kEarth, altitude_km, float(s * std::sin(azimuth)), float(s * std::cos(azimuth)), float(mu), shell_km});
  }
  double longest = -1.0;
  for (const FormChord& chord : run_form(form, rays)) longest = std::max(longest, double(chord.leave_km));
  return longest;
}

// c = o·o - R_s^2 of the naive form, in float32, for a camera at an altitude above each of 100 000 random places.
std::vector<float> naive_c(float altitude_km, float shell_km) {
  Random random(307);
  std::vector<float> all(100000);
  for (float& c : all) {
    const double z = random.uniform(-1.0, 1.0), longitude = random.uniform(0.0, 6.283185307179586),
                 s = std::sqrt(1.0 - z * z);
    const float r = kEarth + altitude_km, R = kEarth + shell_km;
    const float x = float(s * std::cos(longitude)) * r, y = float(s * std::sin(longitude)) * r, up = float(z) * r;
    const float xx = x * x, yy = y * y, zz = up * up, RR = R * R, sum = xx + yy, oo = sum + zz;  // one rounding each
    c = oo - RR;
  }
  return all;
}

template <typename Predicate>
double share(const std::vector<float>& values, Predicate predicate) {
  return double(std::count_if(values.begin(), values.end(), predicate)) / double(values.size());
}

// The figures of the naive form are those of one driver's rounding; what holds must hold on every one.
bool on_lavapipe() { return device().candidate().name.find("llvmpipe") != std::string::npos; }

}  // namespace

TEST_CASE("hard: the horizon seen from 0.5 m") {
  // c = r^2 - R^2 is 6.36 km^2; floats near 4e7 are 4 apart, so the naive c is a multiple of 4. Above Zagreb it is 8.
  // Another driver rounds elsewhere and gets another multiple: 4 on an NVIDIA H200, a horizon 21 % too near.
  const double naive = measure_form(kNaive, 0.0005).horizon_percent;
  if (on_lavapipe()) CHECK(naive == Approx(12.15).margin(0.5));
  CHECK(std::abs(naive) > 10.0);
  CHECK(std::abs(measure_form(kRobust, 0.0005).horizon_percent) < 0.01);
  CHECK(measure_form(kNaive, 0.002).horizon_percent == Approx(-2.9).margin(0.7));
  CHECK(std::abs(measure_form(kRobust, 0.002).horizon_percent) < 0.01);
}

TEST_CASE("hard: the naive horizon depends on where on Earth one stands") {
  const std::vector<float> c = naive_c(0.0005f, 0.0f);                              // exactly: 6.36
  CHECK(share(c, [](float v) { return v >= 8.0f; }) == Approx(0.59).margin(0.03));  // horizon 12 % too far, or more
  CHECK(share(c, [](float v) { return v == 4.0f; }) == Approx(0.35).margin(0.03));  // 21 % too near
  CHECK(share(c, [](float v) { return v <= 0.0f; }) == Approx(0.05).margin(0.02));  // no horizon: as if on the ground
}

TEST_CASE("hard: the ground below one's feet, from 0.5 m") {
  const Ray down{kEarth, 0.0005f, 0, 0, -1, 0};
  CHECK(one(kRobust, down).ground_km == Approx(0.0005).epsilon(3e-7));
  CHECK(one(kDoubleFloat, down).ground_km == Approx(0.0005).epsilon(3e-7));
  // -b - sqrt(b^2 - c) near 6360 comes in steps of 0.49 m: the answer is 0, 0.49 m or 0.98 m.
  const FormErrors naive = measure_form(kNaive, 0.0005), relative = measure_form(kCameraRelative, 0.0005),
                   robust = measure_form(kRobust, 0.0005);
  CHECK(naive.steep_m > 0.4);
  CHECK(relative.steep_m > 0.4);
  CHECK(robust.steep_m < 1e-6);
}

TEST_CASE("hard: the limb seen from 36 000 km") {
  const FormErrors naive = measure_form(kNaive, 36000.0), robust = measure_form(kRobust, 36000.0);
  CHECK(naive.limb_m > (on_lavapipe() ? 35.0 : 10.0));  // 55 m there, 22 m on an NVIDIA H200
  CHECK(naive.limb_m < 75.0);
  CHECK(robust.limb_m < 1.0);
}

TEST_CASE("hard: the limb seen from the Moon") {
  const FormErrors naive = measure_form(kNaive, kMoon_km), robust = measure_form(kRobust, kMoon_km);
  CHECK(naive.limb_m > 2000.0);
  CHECK(naive.limb_m < 5500.0);
  CHECK(naive.steep_m > 4000.0);
  CHECK(robust.limb_m < 1.0);
  CHECK(robust.steep_m < 80.0);  // floats near 378 000 km are 31 m apart
}

TEST_CASE("hard: rays that graze the ground from every altitude") {
  // The robust form may take a ray for a hit only if it misses by less than 3e-7 of the radius, and nearer the ground
  // by much less: 3e-7 of what the ray dips.
  for (const double altitude_km : {0.0005, 2.0, 100.0, 400.0, 36000.0, kMoon_km}) {
    INFO(altitude_km);
    CHECK(measure_form(kRobust, altitude_km).limb_m < std::min(1.9, 3e-7 * 2000.0 * altitude_km + 1e-6));
    CHECK(measure_form(kDoubleFloat, altitude_km).limb_m < 0.01);
  }
}

TEST_CASE("hard: standing exactly on the ground") {
  for (const Form form : {kNaive, kCameraRelative, kRobust, kDoubleFloat}) {
    INFO(kForms[form]);
    CHECK(one(form, {kEarth, 0, 0, 0, 1, 0}).ground_km == -1.0f);
    CHECK(one(form, {kEarth, 0, 1, 0, 0, 0}).ground_km == -1.0f);
  }
  CHECK(one(kRobust, {kEarth, 0, 0, 0, -1, 0}).ground_km == 0.0f);
  CHECK(one(kRobust, {kEarth, 0, 0.6f, 0, -0.8f, 0}).ground_km == 0.0f);
  // Rays that leave the ground meet it no more. The naive c is 0 at few places; where it is -4 or less, a level ray
  // runs 2 km below the ground first.
  CHECK(longest_false_chord(kRobust, 0.0f, 0.0f) == -1.0);
  CHECK(longest_false_chord(kNaive, 0.0f, 0.0f) > 0.001);
  CHECK(share(naive_c(0.0f, 0.0f), [](float v) { return v <= -4.0f; }) == Approx(0.17).margin(0.03));
}

TEST_CASE("hard: exactly on the top of the atmosphere") {
  CHECK(longest_false_chord(kRobust, 100.0f, 100.0f) == -1.0);
  CHECK(longest_false_chord(kNaive, 100.0f, 100.0f) > 0.001);
  // Level rays that cross 2 km of air, or more, that is not there.
  CHECK(share(naive_c(100.0f, 100.0f), [](float v) { return v <= -4.0f; }) == Approx(0.17).margin(0.03));
  // Down, it enters at once and leaves on the far side.
  const FormChord through = one(kRobust, {kEarth, 100, 0, 0, -1, 100});
  CHECK(through.enter_km == 0.0f);
  CHECK(through.leave_km == Approx(12920.0).epsilon(1e-6));
}

TEST_CASE("hard: a camera below the ground stands on it") {
  for (const Form form : {kNaive, kCameraRelative, kRobust, kDoubleFloat}) {
    INFO(kForms[form]);
    for (const float altitude_km : {-0.0005f, -1.0f, -6360.0f}) {
      CHECK(one(form, {kEarth, altitude_km, 0, 0, 1, 0}).ground_km == -1.0f);
      CHECK(one(form, {kEarth, altitude_km, 1, 0, 0, 0}).ground_km == -1.0f);
      CHECK(one(form, {kEarth, altitude_km, 0, 0, -1, 0}).ground_km >= 0.0f);
      CHECK(one(form, {kEarth, altitude_km, 0, 0, -1, 0}).ground_km < 0.0006f);
    }
  }
}

TEST_CASE("hard: no planet at all") {
  for (const Form form : {kNaive, kCameraRelative, kRobust, kDoubleFloat}) {
    INFO(kForms[form]);
    for (const float altitude_km : {0.0f, 1.0f, 378000.0f})
      for (const float z : {-1.0f, 0.0f, 1.0f}) {
        const FormChord chord = one(form, {0.0f, altitude_km, z == 0.0f ? 1.0f : 0.0f, 0.0f, z, 0.0f});
        CHECK(std::isfinite(chord.enter_km));
        CHECK(std::isfinite(chord.leave_km));
        CHECK(chord.leave_km <= 1.001f * altitude_km);
      }
  }
}

TEST_CASE("hard: the altitude of a point along a ray") {
  // A level ray from 0.5 m, a metre … 10 km on: length(p) - R comes in steps of 0.49 m.
  std::vector<float> inputs;
  for (int i = 0; i < 100000; ++i)
    for (const float value : {kEarth, 0.0005f, 0.0f, 1.0f, 0.001f + 0.0001f * float(i), 0.0f}) inputs.push_back(value);
  const std::vector<float> out = evaluate("tests/03_ray_sphere.comp", inputs, 6, 6);
  double robust_m = 0.0, naive_m = 0.0;
  for (size_t i = 0; i < inputs.size() / 6; ++i) {
    const long double r = 6360.0L + inputs[6 * i + 1], t = inputs[6 * i + 4],
                      exact = inputs[6 * i + 1] + t * t / (std::sqrt(r * r + t * t) + r);
    robust_m = std::max(robust_m, 1000.0 * double(std::abs(out[6 * i] - exact)));
    naive_m = std::max(naive_m, 1000.0 * double(std::abs(out[6 * i + 5] - exact)));
  }
  CHECK(naive_m > 0.24);
  CHECK(naive_m < 0.75);
  CHECK(robust_m < 2e-6);
}

TEST_CASE("hard: the altitude of a point near the ground, followed from the Moon") {
  // r(t)^2 is a difference of squares of 384 000 km. The same point followed from where the ray enters the air holds.
  Random random(308);
  std::vector<float> from_moon, from_entry;
  std::vector<double> exact_moon, exact_entry;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray = ray_past(random, kEarth_km, kMoon_km, random.uniform(1.0, 50.0), 100.0);
    const TrueChord chord = true_chord(ray);
    const double share = random.uniform(0.0, 1.0), sine = double(chord.sine);
    const double r = double(kEarth) + ray.altitude_km, mu = -std::sqrt((1.0 - sine) * (1.0 + sine)),
                 t = double(chord.enter_km) + share * 2.0 * double(chord.root_km);
    for (const double v : {double(kEarth), double(ray.altitude_km), mu, sine, t, 0.0}) from_moon.push_back(float(v));
    const long double ft = float(t), fmu = float(mu);
    exact_moon.push_back(double(std::sqrt(r * r + 2.0L * r * fmu * ft + ft * ft) - 6360.0L));
    const double entry_mu = -double(chord.root_km) / 6460.0, on = share * 2.0 * double(chord.root_km);
    for (const double v : {double(kEarth), 100.0, entry_mu, std::sqrt(1.0 - entry_mu * entry_mu), on, 0.0})
      from_entry.push_back(float(v));
    const long double fon = float(on), femu = float(entry_mu);
    exact_entry.push_back(double(std::sqrt(6460.0L * 6460.0L + 2.0L * 6460.0L * femu * fon + fon * fon) - 6360.0L));
  }
  const std::vector<float> moon = evaluate("tests/03_ray_sphere.comp", from_moon, 6, 6),
                           entry = evaluate("tests/03_ray_sphere.comp", from_entry, 6, 6);
  double moon_m = 0.0, entry_m = 0.0;
  for (size_t i = 0; i < exact_moon.size(); ++i) {
    moon_m = std::max(moon_m, 1000.0 * std::abs(moon[6 * i] - exact_moon[i]));
    entry_m = std::max(entry_m, 1000.0 * std::abs(entry[6 * i] - exact_entry[i]));
  }
  INFO("from the Moon " << moon_m << " m, from the entry point " << entry_m << " m");
  CHECK(moon_m > 500.0);  // measured: 1.6 km
  CHECK(entry_m < 0.1);   // measured: 24 mm
}

TEST_CASE("hard: an fma that rounds twice") {
  // The exact error of a product is a b - fl(a b). Vulkan allows fma() to round the product first; then it finds 0.
  Random random(309);
  std::vector<float> inputs;
  for (int i = 0; i < 100000; ++i)
    for (const double value : {random.uniform(1.0, 2.0), 0.0, random.uniform(1.0, 2.0), 0.0})
      inputs.push_back(float(value));
  const std::vector<float> out = evaluate("tests/03_double_float.comp", inputs, 4, 13);
  size_t split_wrong = 0, fma_wrong = 0;
  for (size_t i = 0; i < inputs.size() / 4; ++i) {
    const double exact = double(inputs[4 * i]) * inputs[4 * i + 2];
    split_wrong += double(out[13 * i + 2]) + out[13 * i + 3] != exact;
    fma_wrong += double(out[13 * i + 2]) + out[13 * i + 12] != exact;
  }
  INFO("fma() loses the error of " << fma_wrong << " of 100000 products on this driver");
  CHECK(split_wrong == 0);  // on every driver; what fma() does is the driver's choice
}

TEST_CASE("hard: directions through a 600x telescope") {
  // 60 degrees / 600 = 0.1 degrees over 1080 rows: a pixel is 1.6e-6 rad. Rounding a direction to float32 costs up to
  // 6e-8 rad; the shader adds its own.
  Random random(310);
  std::vector<float> inputs;
  std::vector<glm::dvec3> exact;
  const int width = 1920, height = 1080;
  for (int i = 0; i < 1 << 20; ++i) {
    const app::CameraPose pose{
        .azimuth_deg = random.uniform(0.0, 360.0), .elevation_deg = random.uniform(-89.0, 89.0), .fov_deg = 0.1};
    const Scene scene;
    const CameraRays rays = app::camera_rays(pose, scene, 0.0, {width, height}, 1, 0);
    const int px = int(random.next() % width), py = int(random.next() % height);
    for (const glm::vec3& v : {rays.right, rays.up, rays.forward})
      for (int k = 0; k < 3; ++k) inputs.push_back(v[k]);
    for (const int v : {width, height, px, py}) inputs.push_back(float(v));
    const glm::dvec3 forward = app::direction_from(90.0 - pose.elevation_deg, pose.azimuth_deg),
                     right = app::direction_from(90.0, pose.azimuth_deg + 90.0);
    const double scale = std::tan(glm::radians(pose.fov_deg) / 2.0);
    const double x = (px + 0.5) / width * 2.0 - 1.0, y = (py + 0.5) / height * 2.0 - 1.0;
    exact.push_back(
        glm::normalize(forward + right * (x * scale * width / height) - glm::cross(right, forward) * (y * scale)));
  }
  const std::vector<float> out = evaluate("tests/03_camera.comp", inputs, 13, 3);
  const double pixel = 2.0 * std::tan(glm::radians(0.05)) / height;
  double worst = 0.0, worst_length = 0.0;
  for (size_t i = 0; i < exact.size(); ++i) {
    const glm::dvec3 got(out[3 * i], out[3 * i + 1], out[3 * i + 2]);
    worst = std::max(worst, glm::length(glm::cross(got, exact[i])) / glm::length(got));
    worst_length = std::max(worst_length, std::abs(glm::length(got) - 1.0));
  }
  INFO("worst " << worst << " rad, " << worst / pixel << " of a pixel; length off by " << worst_length);
  CHECK(worst < 2.5e-7);
  CHECK(worst / pixel < 0.15);  // measured: 0.08
  CHECK(worst_length < 3e-7);
}
