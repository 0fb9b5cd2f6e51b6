// The parts of chapter 07, one by one, with what goes wrong in their place.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/07_paths.hpp"
#include "tests/gpu/harness.hpp"
#include "tests/reference/quadrature.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

enum What { kRandom, kAccumulate, kTurn, kMajorant, kSunlight };
using Item = std::array<float, 8>;

std::vector<Item> parts(const std::vector<Item>& items, Phase phase = kHenyeyGreenstein,
                        Tracking tracking = kClosedForm) {
  std::vector<float> inputs;
  for (const Item& item : items) inputs.insert(inputs.end(), item.begin(), item.end());
  const std::vector<float> out = evaluate("tests/07_parts.comp", inputs, 8, 8,
                                          {1, 1, 1, static_cast<uint32_t>(phase), static_cast<uint32_t>(tracking)});
  std::vector<Item> results(items.size());
  for (size_t i = 0; i < items.size(); ++i) std::copy_n(&out[8 * i], 8, results[i].begin());
  return results;
}

// The hash as it is published (Jarzynski and Olano 2020, listing of pcg4d), written a second time.
std::array<uint32_t, 4> pcg4d(std::array<uint32_t, 4> v) {
  for (uint32_t& x : v) x = x * 1664525u + 1013904223u;
  const auto mix = [&] { v[0] += v[1] * v[3], v[1] += v[2] * v[0], v[2] += v[0] * v[1], v[3] += v[1] * v[2]; };
  mix();
  for (uint32_t& x : v) x ^= x >> 16;
  mix();
  return v;
}

}  // namespace

TEST_CASE("random numbers are the published hash and uniform") {
  std::vector<Item> items;
  constexpr int kCount = 1 << 16;
  for (int i = 0; i < kCount; ++i) items.push_back({kRandom, float(i % 256), float(i / 256), 3.0f, float(i % 3)});
  const std::vector<Item> results = parts(items);
  double mean[4] = {}, square[4] = {}, neighbours = 0.0, lanes = 0.0;
  int buckets[64] = {};
  for (int i = 0; i < kCount; ++i) {
    const std::array<uint32_t, 4> bits = pcg4d({uint32_t(i % 256), uint32_t(i / 256), 3u, uint32_t(i % 3)});
    for (int k = 0; k < 4; ++k) {
      REQUIRE(results[i][k] == std::min(static_cast<float>((double(bits[k] >> 8) + 0.5) * 0x1p-24),
                                        0.99999994f));  // the same bits on every device
      mean[k] += results[i][k] - 0.5;
      square[k] += (results[i][k] - 0.5) * (results[i][k] - 0.5);
    }
    ++buckets[static_cast<int>(results[i][0] * 64.0f)];
    lanes += (results[i][0] - 0.5) * (results[i][1] - 0.5);
    if (i > 0) neighbours += (results[i][0] - 0.5) * (results[i - 1][0] - 0.5);
  }
  const double limit = 4.5 * std::sqrt(kCount / 12.0);  // standard deviation of such a sum: sqrt(n / 12)
  for (double sum : mean) CHECK(std::abs(sum) < limit);
  for (double sum : square) CHECK(std::abs(sum / kCount - 1.0 / 12.0) < 4.5 * std::sqrt(1.0 / 180.0 / kCount));
  CHECK(std::abs(neighbours) < 4.5 * std::sqrt(double(kCount)) / 12.0);
  CHECK(std::abs(lanes) < 4.5 * std::sqrt(double(kCount)) / 12.0);
  double chi2 = 0.0;
  for (int count : buckets) chi2 += std::pow(count - kCount / 64.0, 2) / (kCount / 64.0);
  CHECK(chi2 > 30.0);  // 63 degrees of freedom: 63 +- 11
  CHECK(chi2 < 110.0);
}

// Frames of a million samples must not stop counting. 60,000 terms a loop: a driver ends longer ones.
TEST_CASE("hard: a million tiny terms are not lost") {
  // The shader's loop starts from an empty sum: a term this small beside a sum of 2^20 terms is what the last turn
  // sees.
  const float term = 1.2345678e-6f;
  const int terms = 60000;
  const Item result = parts({{kAccumulate, term, float(terms)}})[0];
  const double careful = result[0] / double(term) - 1.0, plain = result[4] / (double(term) * terms) - 1.0;
  CAPTURE(careful, plain, result[3]);
  CHECK(std::abs(careful) < 1e-7);
  CHECK(std::abs(plain) > 1e-5);   // seen: 1e-4
  CHECK(result[3] < 1e-4 * term);  // equal terms have no spread
}

// Moments of what is drawn against quadrature of the phase function over nu, for every choice and both signs of g.
TEST_CASE("turns are drawn from the phase functions") {
  struct Case {
    bool mie;
    Phase phase;
    float g, second_g, shape;
  };
  constexpr int kCount = 1 << 15;
  Random random(3);
  for (const Case& one : {Case{false, kHenyeyGreenstein, 0.8f, 0, 0}, Case{true, kHenyeyGreenstein, 0.8f, 0, 0},
                          Case{true, kHenyeyGreenstein, 0.0f, 0, 0}, Case{true, kHenyeyGreenstein, -0.5f, 0, 0},
                          Case{true, kHenyeyGreenstein, 0.999f, 0, 0}, Case{true, kCornetteShanks, 0.8f, 0, 1},
                          Case{true, kCornetteShanks, -0.7f, 0, 1}, Case{true, kDraine, 0.5f, 0, 5.0f},
                          Case{true, kDoubleHg, 0.9f, -0.4f, 0.3f}}) {
    std::vector<Item> items;
    for (int i = 0; i < kCount; ++i)
      items.push_back({kTurn, one.mie ? 1.0f : 0.0f, float(random.uniform(0, 1)), float(random.uniform(0, 1)),
                       float(random.uniform(-1, 1)), one.g, one.second_g, one.shape});
    const std::vector<Item> results = parts(items, one.phase);
    double sums[2] = {}, squares[2] = {};
    for (const Item& r : results) {
      REQUIRE(r[0] >= 0.0f);
      REQUIRE(std::abs(r[0] + r[1] - 2.0f) < 1e-6f);
      REQUIRE(std::abs(r[2] - r[0]) < 2e-6f + 1e-4f * r[0]);  // the direction makes the turn that was drawn
      REQUIRE(std::abs(r[3] - 1.0f) < 1e-6f);
      const double nu = 1.0 - r[0];
      const double values[2] = {nu, nu * nu};
      for (int k = 0; k < 2; ++k) sums[k] += values[k] / kCount, squares[k] += values[k] * values[k] / kCount;
    }
    double expected[2] = {}, norm = 0.0;
    constexpr int kNodes = 400000;  // midpoint in an angle that resolves g = 0.999
    for (int i = 0; i < kNodes; ++i) {
      const double theta = 3.14159265358979324 * std::pow((i + 0.5) / kNodes, 2.0),
                   dtheta = 3.14159265358979324 * 2.0 * (i + 0.5) / kNodes / kNodes;
      const double nu = std::cos(theta);
      double p = reference::rayleigh_phase(nu);
      if (one.mie) {
        if (one.phase == kHenyeyGreenstein) p = reference::henyey_greenstein(nu, one.g);
        if (one.phase == kCornetteShanks) p = reference::cornette_shanks(nu, one.g);
        if (one.phase == kDraine) p = reference::draine(nu, one.g, one.shape);
        if (one.phase == kDoubleHg)
          p = reference::henyey_greenstein(nu, one.g) * (1.0 - one.shape) +
              reference::henyey_greenstein(nu, one.second_g) * one.shape;
      }
      const double share = p * 2.0 * 3.14159265358979324 * std::sin(theta) * dtheta;
      norm += share, expected[0] += share * nu, expected[1] += share * nu * nu;
    }
    REQUIRE(norm == Approx(1.0).epsilon(1e-4));
    CAPTURE(one.mie, one.phase, one.g, sums[0], expected[0], sums[1], expected[1]);
    for (int k = 0; k < 2; ++k)
      CHECK(std::abs(sums[k] - expected[k]) <
            4.0 * std::sqrt(std::max(squares[k] - sums[k] * sums[k], 0.0) / kCount) + 1e-5);
  }
}

// A majorant that dips below the density makes too few collisions, and nothing else would tell.
TEST_CASE("hard: the exponential majorant is never below the air") {
  Random random(11);
  std::vector<Item> items;
  for (int i = 0; i < 200000; ++i) {
    const double mu = i % 3 == 0   ? random.uniform(-1.0, 1.0)
                      : i % 3 == 1 ? random.uniform(-0.2, 0.2)
                                   : random.uniform(-0.02, 0.02);
    items.push_back({kMajorant, float(i % 5 == 0 ? random.log_uniform(5e-4, 1.0) : random.uniform(0.0, 100.0)),
                     float(mu),
                     i % 2   ? 8.0f
                     : i % 4 ? 1.2f
                             : 18.4f,
                     float(random.uniform(0.0, 1.0))});
  }
  const std::vector<Item> results = parts(items);
  double lowest = 1e9, ratio = 0.0;
  for (size_t i = 0; i < items.size(); ++i) {
    const double over = results[i][0] / double(results[i][1]);
    if (results[i][1] < 1e-30f) continue;
    CAPTURE(items[i][1], items[i][2], items[i][3], items[i][4], results[i][0], results[i][1]);
    REQUIRE(over > 1.0 - 2e-5);  // rounding of the exponents
    lowest = std::min(lowest, over);
    // How tight: the share of collisions that are real, by columns, where the column of air is known.
    if (items[i][3] == 8.0f && results[i][3] > 0.01f) ratio = std::max(ratio, results[i][3] / double(results[i][4]));
  }
  CAPTURE(lowest, ratio);
  CHECK(ratio < 1.6);  // at most three drawn collisions in eight are not real
  CHECK(ratio > 1.0);
}

// The mean of random numbers that is the sun's transmittance, by every way of tracking, against quadrature in double.
TEST_CASE("truth: tracked transmittance is the integral") {
  const Tracking tracking = GENERATE(kNaive, kShells, kExponential, kClosedForm);
  std::vector<Item> items;
  std::vector<std::pair<double, double>> places;
  for (double altitude : {0.0005, 5.0, 30.0})
    for (double mu : {1.0, 0.5, 0.1, 0.0})
      for (int block = 0; block < 256; ++block) {
        items.push_back({kSunlight, float(altitude), float(mu), float(items.size()), 8.0f});
        if (block == 0) places.push_back({altitude, mu});
      }
  const std::vector<Item> results = parts(items, kHenyeyGreenstein, tracking);
  ZScores z;
  for (size_t place = 0; place < places.size(); ++place) {
    const reference::Rgb expected =
        reference::transmittance_to_top(reference::earth(), places[place].first, places[place].second);
    for (int c = 0; c < 3; ++c) {
      double sum = 0.0, squares = 0.0;
      for (int block = 0; block < 256; ++block) {
        const Item& r = results[place * 256 + block];
        REQUIRE(r[3] == 1.0f);
        sum += r[c] / 2048.0, squares += r[4 + c] / 2048.0;
      }
      const double error = std::sqrt(std::max(squares - sum * sum, 0.0) / 2047.0);
      CAPTURE(tracking, places[place].first, places[place].second, c, sum, error, expected[c]);
      // Where hardly anything arrives, ratio tracking is a product of many small numbers and one large one in
      // thousands.
      if (expected[c] < 2e-3) {
        CHECK(std::abs(sum - expected[c]) < 2e-3);
        continue;
      }
      z.values.push_back((sum - expected[c]) / std::sqrt(error * error + 1e-9 * expected[c] * expected[c]));
      CHECK(std::abs(z.values.back()) < 4.0);
    }
  }
  CHECK(z.rms() < 1.4);
}
