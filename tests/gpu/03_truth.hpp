// What a ray around a planet really meets, in long double (64 bits of mantissa) for the exact float inputs that the
// shader gets; and how far each form of chapter 03 is from that. Lengths in km unless a name ends in _m.
#pragma once

#include <string>
#include <vector>

#include "tests/gpu/harness.hpp"

namespace welkin::test {

inline constexpr const char* kForms[] = {"naive", "camera_relative", "robust", "double_float"};
enum Form : uint32_t { kNaive, kCameraRelative, kRobust, kDoubleFloat };
inline constexpr double kEarth_km = 6360.0;
inline constexpr double kMoon_km = 378000.0;  // altitude of a camera at the Moon's mean distance from the centre, about

// An item of shaders/03_rays.comp.
struct Ray {
  float radius_km, altitude_km, x, y, z, shell_km;
};

struct TrueChord {
  bool hit;                        // some part of the ray lies inside the shell
  long double enter_km, leave_km;  // of the line, even where it misses by less than rounding (then the tangent point)
  long double depth_km;            // shell - tangent altitude: how far the line dips below it; negative: passes above
  long double root_km;             // half of the line's chord
  long double mu, sine;
};
TrueChord true_chord(const Ray& ray);

struct FormChord {
  float enter_km, leave_km, ground_km;
};
std::vector<FormChord> run_form(Form form, const std::vector<Ray>& rays);

// A ray from an altitude whose line has its tangent point at another altitude (at most that), going down, any azimuth.
// The direction is rounded to float32, so the tangent altitude is only about that: ask true_chord for the exact one.
Ray ray_past(Random& random, double radius_km, double altitude_km, double tangent_altitude_km, double shell_km = 0.0);

// How wrong a form is for a camera at one altitude above the Earth's ground.
struct FormErrors {
  double horizon_percent = 0.0;  // farthest ground it finds, against the distance of the horizon
  double limb_m = 0.0;   // largest |tangent altitude| of a ray it takes for a hit and that misses, or the reverse
  double steep_m = 0.0;  // largest error of the distance to the ground, rays well inside the disc
  double steep_relative = 0.0;
};
FormErrors measure_form(Form form, double altitude_km);

}  // namespace welkin::test
