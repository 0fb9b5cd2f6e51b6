// The two-float arithmetic of chapter 03 as the device runs it, over a million pairs, against long double.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/harness.hpp"

using namespace welkin::test;

namespace {

struct Pairs {
  std::vector<float> inputs, outputs;
  size_t count = 1 << 20;
};

const Pairs& pairs() {
  static const Pairs all = [] {
    Pairs p;
    Random random(305);
    for (size_t i = 0; i < p.count; ++i) {
      const double a = random.log_uniform(1e-9, 1e12) * (random.next() % 2 ? 1.0 : -1.0);
      double b = random.log_uniform(1e-9, 1e12) * (random.next() % 2 ? 1.0 : -1.0);
      if (i % 4 == 0) b = -a * (1.0 + random.uniform(-1e-6, 1e-6));  // sums that cancel
      for (const double value : {a, b}) {
        const float high = float(value);
        p.inputs.push_back(high);
        p.inputs.push_back(i % 5 == 0 ? 0.0f : float(value - high));
      }
    }
    p.outputs = evaluate("tests/03_double_float.comp", p.inputs, 4, 13);
    return p;
  }();
  return all;
}

}  // namespace

TEST_CASE("double_float: two_sum and two_product are exact") {
  const Pairs& p = pairs();
  size_t sum = 0, product = 0;
  for (size_t i = 0; i < p.count; ++i) {
    const double a = p.inputs[4 * i], b = p.inputs[4 * i + 2];  // products of floats are exact in double
    const float* got = &p.outputs[13 * i];
    const long double exact = static_cast<long double>(a) + b;
    // The error of a sum of floats 48 bits apart or more is the smaller one, also exact in long double (64 bits).
    if (std::abs(std::log2(std::abs(a / b))) < 38.0 && static_cast<long double>(got[0]) + got[1] != exact) ++sum;
    if (static_cast<double>(got[2]) + got[3] != a * b) ++product;
  }
  CHECK(sum == 0);
  CHECK(product == 0);
}

TEST_CASE("double_float: +, *, / and sqrt are right to 2^-44") {
  const Pairs& p = pairs();
  long double worst[4] = {};
  size_t not_finite = 0;
  for (size_t i = 0; i < p.count; ++i) {
    const long double a = static_cast<long double>(p.inputs[4 * i]) + p.inputs[4 * i + 1];
    const long double b = static_cast<long double>(p.inputs[4 * i + 2]) + p.inputs[4 * i + 3];
    const float* got = &p.outputs[13 * i];
    for (int k = 0; k < 12; ++k) not_finite += !std::isfinite(got[k]);
    const long double exact[4] = {a + b, a * b, a / b, std::sqrt(std::abs(a))};
    for (int k = 0; k < 4; ++k) {
      if (exact[k] == 0.0L) continue;
      const long double value = static_cast<long double>(got[4 + 2 * k]) + got[5 + 2 * k];
      worst[k] = std::max(worst[k], std::abs((value - exact[k]) / exact[k]));
    }
  }
  CHECK(not_finite == 0);
  const double bound = 0x1p-44;  // a few roundings of 2^-48; the literature proves 2^-44 to 2^-46 for these algorithms
  CHECK(double(worst[0]) < bound);
  CHECK(double(worst[1]) < bound);
  CHECK(double(worst[2]) < bound);
  CHECK(double(worst[3]) < bound);
}
