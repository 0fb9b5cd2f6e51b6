// Where tone curves and colour spaces divide 0 by 0: named cases, the naive form beside the one that holds.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/gpu/06_rig.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
}  // namespace

TEST_CASE("hard: curves of what is not a light") {
  const std::vector<float> black{0.0f, -0.0f, -1.0f, -65504.0f, -kInf, kNan}, white{65504.0f, 1e20f, 3e38f, kInf};
  for (int curve = 0; curve < 7; ++curve) {
    INFO("curve " << curve);
    std::vector<Item> items{{{0.0f, float(curve), 1e-8f}}, {{1.0f, float(curve), kInf, kNan, -1.0f}}};
    for (float x : black) items.push_back({{0.0f, float(curve), x}});
    for (float x : white) items.push_back({{0.0f, float(curve), x}});
    const std::vector<Answer> got = evaluate_items(items);
    CHECK(got[0].out[1] >= 0.0f);
    CHECK(got[0].out[1] < 1e-7f);
    for (int c = 0; c < 3; ++c) CHECK((got[1].out[c] >= 0.0f && got[1].out[c] <= 1.0f));
    for (size_t i = 0; i < black.size(); ++i) CHECK(got[2 + i].out[1] == 0.0f);
    for (size_t i = 0; i < white.size(); ++i) {
      CHECK(got[8 + i].out[1] > 0.99f);
      CHECK(got[8 + i].out[1] <= 1.0f);
      CHECK(got[8 + i].out[1] == got[8].out[1]);
    }
  }
}

TEST_CASE("hard: Uchimura without a toe, without a shoulder, without either") {
  const std::vector<float> lights{0.0f, 1e-8f, 0.1f, 0.4f, 0.9f, 1.0f, 2.0f, 65504.0f};
  std::vector<Item> items;
  for (float x : lights) {  // x, p, a, m, l, c, b
    items.push_back({{2.0f, x, 1, 1, 0, 0.4f, 1.33f, 0}});
    items.push_back({{2.0f, x, 1, 1, 0.22f, 1, 1.33f, 0}});
    items.push_back({{2.0f, x, 1, 1, 0, 1, 1.33f, 0}});
    items.push_back({{2.0f, x, 1, 1.7f, 0.22f, 1, 1.33f, 0}});
    items.push_back({{2.0f, x, 1, 1, 0.22f, 0.999999f, 1.33f, 0}});
  }
  const std::vector<Answer> got = evaluate_items(items);
  for (size_t i = 0; i < lights.size(); ++i) {
    const double x = lights[i], clipped = std::min(x, 1.0);
    const auto at = [&](size_t which) { return double(got[5 * i + which].out[0]); };
    INFO("x = " << x);
    // m = 0: a line a x up to l, then the shoulder. As printed x/m is 0/0 or infinite, and smoothstep(0, 0, x)
    // undefined.
    const double line_end = 0.4f, shoulder = 1.0 - (1.0 - line_end) * std::exp(-(x - line_end) / (1.0 - line_end));
    CHECK(at(0) == Approx(x < line_end ? x : shoulder).margin(2e-6));
    // l = 1: no shoulder; the line runs to the peak and stays there. As printed C2 divides by p - s1 = 0.
    const bool in_toe = x > 0.0 && x < 0.22;
    if (!in_toe) CHECK(at(1) == Approx(clipped).margin(2e-6));
    CHECK(at(2) == Approx(clipped).margin(2e-6));
    CHECK(std::isfinite(at(3)));
    // l just short of 1: the limit is approached, not jumped over.
    if (!in_toe) CHECK(at(4) == Approx(clipped).margin(1e-5));
  }
}

TEST_CASE("hard: Hable's curve of faint light") {
  // Starlight under a noon exposure: x = 1e-7. Two numbers near 1/15 are subtracted as printed.
  double naive = 0.0, held = 0.0;
  for (float x : {1e-8f, 1e-7f, 1e-6f, 1e-5f, 1e-4f}) {
    const Answer got = evaluate_items({{{0.0f, 6.0f, x}}}).front();
    const double expected = x * (0.042 * x + 0.005) / (0.3 * (x * (0.15 * double(x) + 0.50) + 0.06));
    held = std::max(held, std::abs(got.out[2] / expected - 1.0));
    naive = std::max(naive, std::abs(got.out[3] / expected - 1.0));
  }
  std::printf("Hable for x of 1e-8 to 1e-4: as printed wrong by up to %.0f %%, over one fraction %.1e\n", 100.0 * naive,
              held);
  CHECK(held < 1e-6);
  CHECK(naive > 0.5);
}

TEST_CASE("hard: xyY of black, of what is no colour, of almost nothing") {
  const auto there = [](float r, float g, float b) { return evaluate_items({{{3.0f, r, g, b}}}).front(); };
  const auto back = [](float x, float y, float Y) { return evaluate_items({{{4.0f, x, y, Y}}}).front(); };
  const Answer black = there(0, 0, 0);
  CHECK(black.out[0] == Approx(0.3127));  // and not 0/0
  CHECK(black.out[1] == Approx(0.3290));
  CHECK(black.out[2] == 0.0f);
  for (const Answer& answer : {back(black.out[0], black.out[1], 0.0f), back(0, 0, 0), back(0.3f, 0, 1),
                               there(kNan, 0, 0), back(kNan, kNan, kNan)})
    for (int c = 0; c < 3; ++c) CHECK(std::isfinite(answer.out[c]));
  const Answer faint = there(1e-28f, 2e-28f, 3e-28f);
  const Answer again = back(faint.out[0], faint.out[1], faint.out[2]);
  CHECK(again.out[0] == Approx(1e-28f).epsilon(1e-4));
  CHECK(again.out[2] == Approx(3e-28f).epsilon(1e-4));
}

TEST_CASE("hard: a picture of black through xyY is black") {
  DisplayRig rig({7, 5}, {{"display.space", "xyY"}, {"display.curve", "compare"}, {"exposure.mode", "manual"}});
  rig.set_picture(flat_picture(7, 5, glm::vec3(0.0f)));
  rig.draw(0, 0.0);
  const Image8 displayed = rig.displayed();
  for (size_t i = 0; i < displayed.rgba.size(); ++i) REQUIRE(int(displayed.rgba[i]) == (i % 4 == 3 ? 255 : 0));
}
