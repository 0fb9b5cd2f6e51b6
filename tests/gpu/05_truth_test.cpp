// Chapter 05's march against the tables of tests/data: double-precision quadrature that shares nothing with the shader.
// A value is scored where it is above 1e-6 of the sky's maximum for its camera and sun (see sky_maxima); the numbers of
// scored values are asserted, so that the tests cannot shrink in silence.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/05_rays.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

struct Table {
  reference::Planet planet;
  std::vector<TruthRow> rows;
  std::vector<SkyRay> rays;
};

const Table& table(bool alien) {
  const auto load = [](const char* file, const reference::Planet& planet) {
    Table loaded{planet, truth_rows(file, planet), {}};
    for (const TruthRow& row : loaded.rows) loaded.rays.push_back(row.ray);
    return loaded;
  };
  static const Table earth_table = load("single_scattering_earth.csv", reference::earth());
  static const Table alien_table = load("single_scattering_alien.csv", reference::dense_alien());
  return alien ? alien_table : earth_table;
}

struct Score {
  Errors radiance;
  double transmittance_relative = 0.0;  // where it is above 1e-6
  double transmittance_absolute = 0.0;
};

Score score(const Table& truth, const March& march) {
  const std::vector<Light> lights = march_rays(truth.planet, truth.rays, march);
  Score result;
  for (size_t i = 0; i < lights.size(); ++i) {
    const TruthRow& row = truth.rows[i];
    reference::Rgb expected = march.phase == kCornetteShanks ? row.cornette_shanks : row.henyey_greenstein;
    for (int k = 0; k < 3; ++k) {
      expected[k] += march.albedo * row.ground1[k];
      const double difference = std::abs(lights[i].transmittance[k] - row.transmittance[k]);
      result.transmittance_absolute = std::fmax(result.transmittance_absolute, difference >= 0.0 ? difference : 1e30);
      if (row.transmittance[k] > 1e-6)
        result.transmittance_relative = std::fmax(result.transmittance_relative, difference / row.transmittance[k]);
    }
    result.radiance.add(lights[i].radiance, expected, 1e-6 * row.sky_maximum);
  }
  return result;
}

March with(Rule rule, int view_steps, int light_steps) {
  return {.view_steps = view_steps, .light_steps = light_steps, .rule = rule, .albedo = 0.3};
}

double worst(const Table& truth, Rule rule, int view_steps, int light_steps) {
  return score(truth, with(rule, view_steps, light_steps)).radiance.maximum();
}

}  // namespace

TEST_CASE("truth: the tables are whole") {
  CHECK(table(false).rows.size() == 1643);
  CHECK(table(true).rows.size() == 75);
}

// The promise is 1 %. Seen: 0.14 % on Earth, 0.06 % on the dense planet, 99 % of the values within 0.04 %.
TEST_CASE("truth: default steps hold 1 % on every row") {
  const bool alien = GENERATE(false, true);
  const Phase phase = GENERATE(kHenyeyGreenstein, kCornetteShanks);
  const double albedo = GENERATE(0.3, 1.0);
  const Table& truth = table(alien);
  const Score result = score(truth, {.phase = phase, .albedo = albedo});
  CAPTURE(alien, phase, albedo, result.radiance.maximum());
  // Brighter ground lifts a few more rows over the floor.
  const size_t scored = alien ? (albedo < 1.0 ? 141 : 143) : 4342;
  CHECK(result.radiance.values.size() >= scored);
  CHECK(result.radiance.maximum() < 0.01);
  CHECK(result.radiance.quantile(0.99) < 1e-3);
  CHECK(result.radiance.quantile(0.5) < 1e-4);
  // Transmittance has a quadrature of its own: float32's rounding is what is left. Seen: 4e-5 and 2.3e-4.
  CHECK(result.transmittance_relative < 1e-3);
  CHECK(result.transmittance_absolute < 1e-4);
}

TEST_CASE("truth: a cheaper rung is worse, a dearer one better") {
  const Table& truth = table(false);
  const double cheap = worst(truth, kAdapted, 16, 8), standard = worst(truth, kAdapted, 32, 8),
               dear = worst(truth, kAdapted, 64, 16);
  CAPTURE(cheap, standard, dear);
  CHECK(cheap < 0.2);      // seen: 12 %
  CHECK(cheap > 0.02);     // half the steps are not enough, whatever the promise says of the default
  CHECK(standard < 0.01);  // seen: 0.14 %
  CHECK(dear < 0.001);     // seen: 0.034 %
  CHECK(cheap > 10.0 * standard);
  CHECK(standard > 2.0 * dear);
}

TEST_CASE("truth: at the default's steps every other rule misses 1 %") {
  const Table& truth = table(false);
  for (Rule rule : {kLeft, kMidpoint, kOffset03, kNonuniform, kGaussLegendre}) {
    CAPTURE(rule);
    CHECK(worst(truth, rule, 32, 8) > 0.1);
  }
}

// Steps grow fourfold both ways. A rule of first order gains a factor of four at best, of second order sixteen; the
// shadow's edge inside a segment costs every fixed rule its order on some rows, so the worst row is asked for less.
TEST_CASE("truth: every rule converges") {
  const bool alien = GENERATE(false, true);
  const Table& truth = table(alien);
  struct Bound {
    Rule rule;
    double median_gain;  // from 16 x 16 to 64 x 64, and again to 240 x 240
    double worst;        // at 240 x 240
  };
  for (const Bound& bound : {Bound{kLeft, 3.0, 0.3}, Bound{kMidpoint, 8.0, 0.02}, Bound{kOffset03, 3.0, 0.1},
                             Bound{kNonuniform, 8.0, 0.02}, Bound{kGaussLegendre, 3.0, 0.02}}) {
    const Errors coarse = score(truth, with(bound.rule, 16, 16)).radiance;
    const Errors middle = score(truth, with(bound.rule, 64, 64)).radiance;
    const Errors fine = score(truth, with(bound.rule, 240, 240)).radiance;
    UNSCOPED_INFO("rule " << bound.rule << " alien " << alien << ": worst " << coarse.maximum() << " "
                          << middle.maximum() << " " << fine.maximum() << ", median " << coarse.quantile(0.5) << " "
                          << middle.quantile(0.5) << " " << fine.quantile(0.5));
    CHECK(fine.maximum() < bound.worst);
    CHECK(coarse.maximum() > middle.maximum());
    CHECK(middle.maximum() > fine.maximum());
    CHECK(coarse.quantile(0.5) > bound.median_gain * middle.quantile(0.5));
  }
  const double adapted = worst(truth, kAdapted, 128, 32);
  CAPTURE(adapted);
  CHECK(adapted < 6e-4);  // seen: 3.3e-4, the rounding of float32 and of the closed forms
}

// lavapipe ends every loop of an invocation after 65,535 turns in all, without a word: the rest of the ray is missing.
TEST_CASE("hard: more loop turns than the software driver takes") {
  const Table& truth = table(false);
  const double allowed = worst(truth, kMidpoint, 1000, 60), too_many = worst(truth, kMidpoint, 1024, 256);
  CAPTURE(allowed, too_many);
  CHECK(allowed < 0.006);  // seen: 0.4 %
  if (device().candidate().name.find("llvmpipe") != std::string::npos) CHECK(too_many > 0.5);
  // What the book's sweeps and comparisons take for the truth must be below the limit.
  const double reference = worst(truth, kAdapted, 256, 32);
  CAPTURE(reference);
  CHECK(reference < 6e-4);
}

// However many samples, their segments cover the path once: a constant source over it gives the path's length.
TEST_CASE("truth: the segments of every rule tile the ray") {
  std::vector<Part> parts;
  struct Place {
    int rule, i, n;
  };
  std::vector<Place> places;
  for (int rule = kLeft; rule <= kGaussLegendre; ++rule)
    for (int n : {1, 2, 3, 4, 7, 8, 16, 32, 100, 1024})
      for (int i = 0; i < n && (rule != kGaussLegendre || n % 4 == 0); ++i) {
        parts.push_back({{Part::kSegment, float(rule), float(i), float(n)}});
        places.push_back({rule, i, n});
      }
  const auto results = evaluate_parts(parts);
  double covered = 0.0;
  for (size_t k = 0; k < parts.size(); ++k) {
    const auto [rule, i, n] = places[k];
    const double sample = results[k][0], width = results[k][1];
    CAPTURE(rule, i, n, sample, width);
    if (i == 0) covered = 0.0;
    // Each sample lies in its own segment; for the Gauss rule the segments are its weights.
    REQUIRE(sample >= covered - 1e-6);
    REQUIRE(sample <= covered + width + 1e-6);
    REQUIRE(width > 0.0);
    covered += width;
    if (i == n - 1) REQUIRE(covered == Approx(1.0).epsilon(2e-6));  // a thousand float32 widths, each to 6e-8
  }
}
