// Metrics: a known error gives the known score. Tolerances are rounding of double sums (1e-12) or float inputs (1e-6).
#include "common/measure/metrics.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "common/image/display.hpp"
#include "common/measure/statistics.hpp"

using namespace welkin;
using namespace welkin::measure;

namespace {
const double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
const Display kIdentity = [](const glm::vec3& v) { return v; };
Image flat(glm::vec4 value, uint32_t width = 4, uint32_t height = 3) {
  return {width, height, std::vector<glm::vec4>(size_t{width} * height, value)};
}
Errors errors(std::vector<double> ours, std::vector<double> reference) { return measure::compare(ours, reference); }
}  // namespace

TEST_CASE("ten per cent too bright everywhere scores 0.1", "[metrics]") {
  const Errors e = measure::compare(flat(glm::vec4(1.1f, 1.1f, 1.1f, 0.0f)), flat(glm::vec4(1.0f)), kIdentity);
  CHECK(e.values == 36);
  CHECK(e.finite());
  for (const double score : {e.relative_rmse, e.max_relative, e.p99_relative, e.mean_bias})
    CHECK(score == Approx(0.1).epsilon(1e-6));
  CHECK(e.rmse_255 == Approx(25.5).epsilon(1e-6));
  CHECK(measure::compare(flat(glm::vec4(0.9f)), flat(glm::vec4(1.0f)), kIdentity).mean_bias ==
        Approx(-0.1).epsilon(1e-6));
  const Errors same = measure::compare(flat(glm::vec4(0.3f)), flat(glm::vec4(0.3f)), kIdentity);
  for (const double score : {same.relative_rmse, same.max_relative, same.p99_relative, same.mean_bias, same.rmse_255})
    CHECK(score == 0.0);
}

TEST_CASE("relative RMSE, bias and maximum by hand", "[metrics]") {
  const Errors e = errors({1, 2, 5}, {1, 4, 4});  // differences 0, -2, 1; r^2: 1 + 16 + 16
  CHECK(e.relative_rmse == Approx(std::sqrt(5.0 / 33.0)).epsilon(1e-12));
  CHECK(e.mean_bias == Approx(-1.0 / 9.0).epsilon(1e-12));
  CHECK(e.max_relative == Approx(0.5).epsilon(1e-12));
  CHECK(e.p99_relative == Approx(0.5 - 0.02 * 0.25).epsilon(1e-12));  // between 0.25 and 0.5, at 0.98 of the way
}

TEST_CASE("the scale of radiance does not change a relative score", "[metrics]") {
  const Errors a = errors({1, 2, 5}, {1, 4, 4}), b = errors({1e-12, 2e-12, 5e-12}, {1e-12, 4e-12, 4e-12});
  CHECK(a.relative_rmse == Approx(b.relative_rmse).epsilon(1e-12));
  CHECK(a.max_relative == Approx(b.max_relative).epsilon(1e-12));
  CHECK(a.p99_relative == Approx(b.p99_relative).epsilon(1e-12));
}

TEST_CASE("near-black values count against a thousandth of the mean", "[metrics]") {
  CHECK(errors({2.001, 1e-6}, {2.0, 0.0}).max_relative ==
        Approx(1e-3).epsilon(1e-9));                      // floor 1e-3: 1e-6 / 1e-3 and 5e-4
  CHECK(errors({0, 1e-9}, {0, 0}).max_relative == kInf);  // any light where the reference is black throughout
  CHECK(errors({0, 1e-9}, {0, 0}).relative_rmse == kInf);
  CHECK(errors({0, 0}, {0, 0}).relative_rmse == 0.0);
  CHECK(errors({0, 0}, {0, 0}).p99_relative == 0.0);
}

TEST_CASE("one bad value in a hundred moves the maximum, not the percentile", "[metrics]") {
  std::vector<double> ours(1000, 1.0), reference(1000, 1.0);
  ours[17] = 3.0;
  const Errors e = errors(ours, reference);
  CHECK(e.max_relative == Approx(2.0));
  CHECK(e.p99_relative == 0.0);
  for (size_t i = 0; i < 50; ++i) ours[i] = 3.0;
  CHECK(errors(ours, reference).p99_relative == Approx(2.0));
}

TEST_CASE("NaN and infinity are counted and leave no score", "[metrics]") {
  std::vector<double> ours(1000, 1.0), reference(1000, 1.0);
  ours[3] = kNan;
  ours[4] = -kInf;
  Errors e = errors(ours, reference);
  CHECK_FALSE(e.finite());
  CHECK(e.not_finite == 2);
  CHECK(e.not_finite_reference == 0);
  for (const double score : {e.relative_rmse, e.max_relative, e.p99_relative, e.mean_bias}) CHECK(std::isnan(score));
  CHECK(describe(e).find("2 of 1000 values are NaN or infinite") != std::string::npos);
  e = errors(reference, ours);
  CHECK(e.not_finite == 0);
  CHECK(e.not_finite_reference == 2);
  CHECK_FALSE(e.relative_rmse <= 1e9);  // no threshold can be met
  Image broken = flat(glm::vec4(1.0f));
  broken.pixels[5].g = NAN;
  CHECK(std::isnan(measure::compare(broken, flat(glm::vec4(1.0f)), kIdentity).rmse_255));
  broken = flat(glm::vec4(1.0f));
  broken.pixels[5].a = NAN;  // alpha takes no part
  CHECK(measure::compare(broken, flat(glm::vec4(1.0f)), kIdentity).relative_rmse == 0.0);
}

TEST_CASE("sizes must match", "[metrics]") {
  try {
    measure::compare(flat(glm::vec4(1.0f), 3, 4), flat(glm::vec4(1.0f), 4, 3), kIdentity);
    FAIL("accepted 3x4 against 4x3");
  } catch (const Error& error) {
    CHECK(error.exit_code == Exit::mismatch);
    CHECK(std::string(error.what()).find("3x4") != std::string::npos);
  }
  CHECK_THROWS_AS(errors({1, 2}, {1}), Error);
  CHECK_THROWS_AS(errors({}, {}), Error);
}

TEST_CASE("medians and percentiles", "[metrics]") {
  CHECK(median({3, 1, 2}) == 2.0);
  CHECK(median({4, 1, 2, 3}) == 2.5);
  CHECK(median({7}) == 7.0);
  CHECK(std::isnan(median({})));
  CHECK(std::isnan(median({1, kNan, 2})));
  std::vector<double> ramp;
  for (int i = 100; i >= 0; --i) ramp.push_back(i);
  for (const double p : {0.0, 0.25, 0.5, 0.99, 0.995, 1.0})
    CHECK(percentile(ramp, p) == Approx(100.0 * p).epsilon(1e-12));
  CHECK(percentile({1, kInf, kInf}, 0.9) == kInf);
  const Spread s = spread({3, 1, 2});
  CHECK((s.median == 2.0 && s.minimum == 1.0 && s.maximum == 3.0 && s.samples == 3));
}

TEST_CASE("the display transform's known points", "[metrics]") {
  CHECK(image::srgb_encode(0.0f) == 0.0f);
  CHECK(image::srgb_encode(1.0f) == Approx(1.0f).epsilon(1e-6));
  CHECK(image::srgb_encode(0.2140411f) == Approx(0.5f).epsilon(1e-6));        // IEC 61966-2-1: sRGB 0.5
  CHECK(image::srgb_encode(0.0031308f) == Approx(0.0404500f).epsilon(1e-4));  // the two branches meet
  CHECK(image::display(glm::vec3(std::log(2.0f)), 1.0f).r == Approx(image::srgb_encode(0.5f)).epsilon(1e-6));
  CHECK(image::display(glm::vec3(1e-9f), 1.0f).g == Approx(12.92e-9f).epsilon(1e-5));  // expm1 keeps the dark end
  CHECK(image::quantise(NAN) == 0);
  CHECK(image::quantise(-1.0f) == 0);
  CHECK(image::quantise(2.0f) == 255);
  CHECK(image::quantise(0.5f) == 128);
}
