// The tone curves as the shader computes them, against double code written from the published formulas as they are
// printed, and against values their authors state.
//
// Tolerances: results lie in 0..1 and float32 holds them to 6e-8; a driver's pow and exp may err by a few 1e-6. The
// worst measured is 5e-7. 1e-5 is a four-hundredth of a step of an 8-bit screen.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "tests/gpu/06_rig.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

using Rgb = std::array<double, 3>;
constexpr double kTolerance = 1e-5;
const char* const kNames[] = {"clamp", "reinhard", "aces_narkowicz", "aces_hill", "lottes", "uchimura", "uncharted2"};

double saturate(double x) { return std::clamp(x, 0.0, 1.0); }

double smoothstep(double from, double to, double x) {
  const double t = saturate((x - from) / (to - from));
  return t * t * (3 - 2 * t);
}

// Uchimura's slides, term by term.
double uchimura_printed(double x, double P, double a, double m, double l, double c, double b) {
  const double l0 = (P - m) * l / a, S0 = m + l0, S1 = m + a * l0, C2 = a * P / (P - S1), CP = -C2 / P;
  const double w0 = 1 - smoothstep(0, m, x), w2 = x < m + l0 ? 0 : 1, w1 = 1 - w0 - w2;
  const double T = m * std::pow(x / m, c) + b, S = P - (P - S1) * std::exp(CP * (x - S0)), L = m + a * (x - m);
  return T * w0 + L * w1 + S * w2;
}

double hable_printed(double x) {
  const double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
  return ((x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F)) - E / F;
}

double lottes_printed(double x) {
  const double a = 1.6, d = 0.977, hdrMax = 8.0, midIn = 0.18, midOut = 0.267;
  const double b = (-std::pow(midIn, a) + std::pow(hdrMax, a) * midOut) /
                   ((std::pow(hdrMax, a * d) - std::pow(midIn, a * d)) * midOut);
  const double c =
      (std::pow(hdrMax, a * d) * std::pow(midIn, a) - std::pow(hdrMax, a) * std::pow(midIn, a * d) * midOut) /
      ((std::pow(hdrMax, a * d) - std::pow(midIn, a * d)) * midOut);
  return std::pow(x, a) / (std::pow(x, a * d) * b + c);
}

double rrt_and_odt(double v) {
  return (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
}

double printed(int curve, double x) {
  switch (curve) {
    case 1: return saturate(x / (1 + x) * (1 + x / (4.0 * 4.0)));
    case 2: return saturate((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14));
    case 3: return saturate(rrt_and_odt(x));
    case 4: return saturate(lottes_printed(x));
    case 5: return uchimura_printed(x, 1, 1, 0.22, 0.4, 1.33, 0);
    case 6: return saturate(hable_printed(2 * x) / hable_printed(11.2));
    default: return saturate(x);
  }
}

Rgb times(const double (&m)[3][3], const Rgb& v) {
  Rgb out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[i] += m[i][j] * v[j];
  return out;
}

Rgb hill_printed(const Rgb& rgb) {
  const double in[3][3] = {{0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}};
  const double out[3][3] = {
      {1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}};
  Rgb v = times(in, rgb);
  for (double& c : v) c = saturate(rrt_and_odt(c));
  v = times(out, v);
  for (double& c : v) c = saturate(c);
  return v;
}

// Middle grey's gain from the printed curve alone, by bisection.
double gain_of(int curve) {
  double low = 0.0, high = 4.0;
  for (int i = 0; i < 100; ++i) (printed(curve, 0.5 * (low + high)) < 0.18 ? low : high) = 0.5 * (low + high);
  return low / 0.18;
}

std::vector<float> lights() {
  std::vector<float> all{0.0f, 1e-8f, 1e-6f, 0.18f, 1.0f, 4.0f, 5.6f, 8.0f, 11.2f, 65504.0f};
  for (int i = 0; i <= 20000; ++i) all.push_back(static_cast<float>(std::exp2(-24.0 + 40.0 * i / 20000.0)));
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Answer> curve_answers(int curve, const std::vector<float>& inputs) {
  std::vector<Item> items;
  for (float x : inputs) items.push_back({{0.0f, float(curve), x}});
  return evaluate_items(items);
}

}  // namespace

TEST_CASE("truth: every curve is what was published") {
  const std::vector<float> inputs = lights();
  for (int curve = 0; curve < 7; ++curve) {
    INFO(kNames[curve]);
    const std::vector<Answer> got = curve_answers(curve, inputs);
    const double gain = gain_of(curve);
    double worst = 0.0, worst_gained = 0.0;
    for (size_t i = 0; i < inputs.size(); ++i) {
      worst = std::max(worst, std::abs(got[i].out[0] - printed(curve, std::min<double>(inputs[i], 65504.0))));
      worst_gained =
          std::max(worst_gained, std::abs(got[i].out[1] - printed(curve, std::min(inputs[i] * gain, 65504.0))));
    }
    std::printf("%s: worst error %.1e, with its grey gain %.1e\n", kNames[curve], worst, worst_gained);
    CHECK(worst < kTolerance);
    CHECK(worst_gained < kTolerance);
  }
}

TEST_CASE("truth: every curve rises and stays between black and white") {
  const std::vector<float> inputs = lights();
  for (int curve = 0; curve < 7; ++curve) {
    INFO(kNames[curve]);
    const std::vector<Answer> got = curve_answers(curve, inputs);
    float before = 0.0f;
    for (const Answer& answer : got) {
      // Rounding may take back one part in 10^6 where a curve is nearly level; no more.
      REQUIRE(answer.out[1] >= before - 2e-6f);
      REQUIRE(answer.out[1] <= 1.0f);
      before = answer.out[1];
    }
    CHECK(got.front().out[1] == 0.0f);
    CHECK(got.back().out[1] > 0.99f);
  }
}

TEST_CASE("truth: values the authors state") {
  const auto at = [](int curve, float x) { return double(curve_answers(curve, {x}).front().out[0]); };
  CHECK(at(1, 4.0f) == Approx(1.0).margin(1e-6));     // Reinhard: the white point is white
  CHECK(at(2, 1.0f) == Approx(0.8).margin(0.005));    // Narkowicz: "1 on input maps to 0.8 on output"
  CHECK(at(3, 0.18f) == Approx(0.10).margin(0.01));   // ACES: an 18 % grey card at a tenth of the screen's white
  CHECK(at(4, 0.18f) == Approx(0.267).margin(1e-5));  // Lottes: mid_in to mid_out
  CHECK(at(4, 8.0f) == Approx(1.0).margin(2e-5));     // and the peak to 1
  for (float x : {0.22f, 0.3f, 0.4f, 0.5f})
    CHECK(at(5, x) == Approx(x).margin(1e-6));     // Uchimura: a line from m to m + l0
  CHECK(at(6, 5.6f) == Approx(1.0).margin(1e-6));  // Hable: white at 11.2, halved by the bias
  for (int curve = 0; curve < 7; ++curve) {        // ours: middle grey stays middle grey
    INFO(kNames[curve]);
    CHECK(curve_answers(curve, {0.18f}).front().out[1] == Approx(0.18).margin(1e-5));
  }
}

TEST_CASE("truth: Hill's fit on colours, through its wide primaries and back") {
  Random random(6);
  std::vector<Item> items;
  std::vector<Rgb> wanted;
  const double gain = gain_of(3);
  for (int i = 0; i < 20000; ++i) {
    Rgb rgb;
    for (double& c : rgb) c = float(random.log_uniform(1e-6, 1e4));
    items.push_back({{1.0f, 3.0f, float(rgb[0]), float(rgb[1]), float(rgb[2])}});
    wanted.push_back(hill_printed({rgb[0] * gain, rgb[1] * gain, rgb[2] * gain}));
  }
  const std::vector<Answer> got = evaluate_items(items);
  for (size_t i = 0; i < got.size(); ++i)
    for (int c = 0; c < 3; ++c) REQUIRE(got[i].out[c] == Approx(wanted[i][c]).margin(kTolerance));
  // Grey stays grey, although the fit mixes channels.
  for (float grey : {0.01f, 0.18f, 1.0f, 30.0f}) {
    const Answer answer = evaluate_items({{{1.0f, 3.0f, grey, grey, grey}}}).front();
    CHECK(std::abs(answer.out[0] - answer.out[1]) < 3e-5f);
    CHECK(std::abs(answer.out[2] - answer.out[1]) < 3e-5f);
  }
}

TEST_CASE("truth: there and back through xyY") {
  Random random(60);
  std::vector<Item> there;
  for (int i = 0; i < 20000; ++i)
    there.push_back({{3.0f, float(random.log_uniform(1e-7, 1e3)), float(random.log_uniform(1e-7, 1e3)),
                      float(random.log_uniform(1e-7, 1e3))}});
  std::vector<Item> back;
  for (const Answer& answer : evaluate_items(there))
    back.push_back({{4.0f, answer.out[0], answer.out[1], answer.out[2]}});
  const std::vector<Answer> got = evaluate_items(back);
  for (size_t i = 0; i < got.size(); ++i) {
    // The matrices are printed to seven digits, and a channel is a difference of terms of the size of the largest.
    const float largest = std::max({there[i].in[1], there[i].in[2], there[i].in[3]});
    for (int c = 0; c < 3; ++c) REQUIRE(std::abs(got[i].out[c] - there[i].in[1 + c]) < 8e-6f * largest);
  }
  const Answer white = evaluate_items({{{3.0f, 1.0f, 1.0f, 1.0f}}}).front();
  CHECK(white.out[0] == Approx(0.3127).margin(2e-4));  // D65
  CHECK(white.out[1] == Approx(0.3290).margin(2e-4));
  CHECK(white.out[2] == Approx(1.0).margin(1e-6));
}

TEST_CASE("truth: a colour no screen has keeps its luminance and its hue, and gives up saturation") {
  const auto luminance_of = [](const float* c) { return 0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2]; };
  Random random(66);
  std::vector<Item> items;
  for (int i = 0; i < 20000; ++i) {
    float c[3];
    for (float& channel : c) channel = float(random.log_uniform(1e-4, 1.0));
    const double scale = random.uniform(0.0, 1.0) / luminance_of(c);
    items.push_back({{8.0f, float(c[0] * scale), float(c[1] * scale), float(c[2] * scale)}});
  }
  const std::vector<Answer> got = evaluate_items(items);
  size_t moved = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    const float *in = items[i].in + 1, *out = got[i].out;
    REQUIRE(luminance_of(out) == Approx(luminance_of(in)).margin(2e-6));
    const double before = std::max({in[0], in[1], in[2]}), after = std::max({out[0], out[1], out[2]});
    REQUIRE(after <= 1.0 + 2e-6);
    REQUIRE(std::min({out[0], out[1], out[2]}) >= -1e-6f);
    if (before <= 1.0)
      for (int k = 0; k < 3; ++k) REQUIRE(out[k] == Approx(in[k]).margin(1e-6));
    if (before <= 1.0) continue;
    ++moved;
    CHECK(after == Approx(1.0).margin(2e-6));  // no further than it must
    // The same hue: differences between channels shrink by one factor.
    const double cross = double(out[0] - out[1]) * (in[1] - in[2]) - double(out[1] - out[2]) * (in[0] - in[1]);
    REQUIRE(std::abs(cross) < 2e-6 * before * before);
  }
  CHECK(moved > 1000);
}

TEST_CASE("truth: sRGB's curve") {
  std::vector<Item> items;
  for (int i = 0; i <= 4096; ++i) items.push_back({{5.0f, i / 4096.0f, 0.0f}});
  const std::vector<Answer> got = evaluate_items(items);
  for (size_t i = 0; i < got.size(); ++i) {
    const double x = i / 4096.0, expected = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
    REQUIRE(got[i].out[0] == Approx(expected).margin(1e-5));
    REQUIRE(got[i].out[1] == std::floor(255.0 * x + 0.5));  // no noise: to the nearest
  }
}
