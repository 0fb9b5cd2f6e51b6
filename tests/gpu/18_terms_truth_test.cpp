// Chapter 18: exponential integrals against a table in full precision, and the published terms (powder, octaves, optics
// of droplets) against what they claim.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "chapters/04_air/phase.hpp"
#include "common/image/csv.hpp"
#include "tests/gpu/18_parts.hpp"
#include "tree.hpp"

using namespace welkin;
using namespace welkin::test;

TEST_CASE("18 truth: exponential integrals are the table's") {
  const CsvTable table = read_csv(WELKIN_TEST_DATA "/exponential_integrals.csv", {"x", "E1", "E2", "E3"});
  REQUIRE(table.rows == 18);
  std::vector<PartItem> items;
  for (const double x : table.column("x")) items.push_back({kExponentialIntegrals, static_cast<float>(x)});
  const std::vector<PartResult> results = parts(items);
  for (size_t i = 0; i < items.size(); ++i) {
    const double row[] = {table.column("x")[i], table.column("E1")[i], table.column("E2")[i], table.column("E3")[i]};
    // x itself is rounded to float: exp(-x) moves by 6e-8 x.
    const double rounding = 1e-7 * row[0] + 1e-6;
    INFO(fmt::format("x {}: {} {} {}", row[0], results[i][0], results[i][1], results[i][2]));
    CHECK(results[i][0] == Approx(row[1]).epsilon(rounding));
    CHECK(results[i][1] == Approx(row[2]).epsilon(5.0 * rounding));
    // 1 - x exp(x) E2 is 2/x of its terms: a digit is lost for each factor 10 of x.
    CHECK(results[i][2] == Approx(row[3]).epsilon(row[0] > 10.0 ? 2e-4 : 5.0 * rounding));
    CHECK(results[i][4] == Approx(0.5 * row[2]).epsilon(5.0 * rounding));
  }
}

TEST_CASE("18 truth: five terms of the series turn black past an optical depth of 2") {
  const std::vector<PartResult> at = parts({{kExponentialIntegrals, 0.5f},
                                            {kExponentialIntegrals, 1.5f},
                                            {kExponentialIntegrals, 2.0f},
                                            {kExponentialIntegrals, 3.0f},
                                            {kExponentialIntegrals, 0.0f},
                                            {kExponentialIntegrals, 200.0f}});
  CHECK(at[0][3] == Approx(at[0][1]).epsilon(1e-4));  // right where clouds are thin
  CHECK(at[1][3] < 0.96f * at[1][1]);                 // dark by 5 % already
  CHECK(at[2][3] == Approx(0.0139).margin(1e-4));     // 0.0375 is right
  CHECK(at[3][3] == Approx(-0.356).margin(1e-3));     // 0.0106 is right
  CHECK(at[4][1] == 1.0f);                            // the limits
  CHECK(at[4][2] == 0.5f);
  CHECK(at[5][1] == 0.0f);
  CHECK(at[5][2] == 0.0f);
}

TEST_CASE("18 truth: powder depends on the optical depth alone, as published on the step") {
  // Two steps of half the length end at the same optical depth. Published, each step's factor is that of half the
  // density.
  const std::vector<PartResult> coarse = parts({{kPowder, 1.0f, 10.0f, 0.1f, 1.0f}});
  const std::vector<PartResult> fine = parts({{kPowder, 1.0f, 10.0f, 0.05f, 1.0f}});
  CHECK(coarse[0][0] == fine[0][0]);
  CHECK(coarse[0][0] == Approx(1.0 - std::exp(-2.0)).epsilon(1e-6));
  CHECK(coarse[0][1] / fine[0][1] > 1.3f);
  CHECK(parts({{kPowder, 0.0f, 1.0f, 1.0f, 1.0f}})[0][0] == 0.0f);
  CHECK(parts({{kPowder, 3.0f, 1.0f, 1.0f, 0.0f}})[0][0] == 1.0f);  // left out
}

TEST_CASE("18 truth: octaves scale g and sum as printed") {
  const double g = 0.85, a = 0.5, b = 0.4, c = 0.6;
  for (const int count : {1, 2, 4, 8})
    for (const float one_minus : {0.0f, 0.01f, 0.7f, 2.0f})
      for (const float tau : {0.0f, 0.3f, 5.0f}) {
        double truth = 0.0;
        for (int i = 0; i < count; ++i)
          truth += std::pow(b, i) * phase::henyey_greenstein(one_minus, std::pow(c, i) * g) *
                   std::exp(-std::pow(a, i) * tau);
        const PartItem item{kOctaves, float(count), one_minus, 0.15f,    0,  0.15f, 0,
                            0,        float(a),     float(b),  float(c), tau};
        CHECK(parts({item})[0][0] == Approx(truth).epsilon(5e-6));
      }
  // Scaling the cosine in place of g leaves 0.20 of the light at a factor of 0.5 (chapter 04 has the integral). The
  // second octave alone, as the difference of two sums, integrates to b.
  double integral = 0.0;
  std::vector<PartItem> items;
  constexpr int kNodes = 2000;
  for (int i = 0; i < kNodes; ++i)
    for (const int count : {1, 2})
      items.push_back(
          {kOctaves, float(count), 2.0f * (i + 0.5f) / kNodes, 0.2f, 0, 0.2f, 0, 0, 1.0f, 0.5f, 0.5f, 0.0f});
  const std::vector<PartResult> results = parts(items);
  for (int i = 0; i < kNodes; ++i)
    integral += 2.0 * std::numbers::pi * (results[2 * i + 1][0] - results[2 * i][0]) * 2.0 / kNodes;
  CHECK(integral == Approx(0.5).epsilon(1e-4));
}

TEST_CASE("18 truth: rain clouds do not absorb visible light") {
  // 0.3 g/m^3 in droplets of 10 um: 45 per km.
  const PartResult fair = parts({{kOptics, 0.3f, 10.0f}})[0];
  CHECK(fair[0] == Approx(45.0).epsilon(1e-6));
  CHECK(fair[5] == Approx(4.76e-7).epsilon(0.01));  // 550 nm
  // Drizzle of 100 um: ten times the absorption per scattering, and still nothing. Light of diffuse transmission t
  // through a thick layer has been scattered of the order of tau times: the mean number of scatterings in a
  // conservative slab of optical depth 100 is below 300, so it loses 300 times 4.8e-6, a seventh of a percent. What
  // makes rain clouds dark is their depth.
  const PartResult rain = parts({{kOptics, 1.0f, 100.0f}})[0];
  CHECK(rain[5] < 1e-5);
  CHECK(1.0 - std::pow(1.0 - rain[5], 300.0) < 0.002);
  CHECK(rain[0] == Approx(15.0).epsilon(1e-6));  // the same water in larger drops is thinner
  CHECK(rain[4] > rain[5]);
  CHECK(rain[5] > rain[6]);  // water is blue
}
