// Chapter 18: phase functions of clouds against the tables, against the printed formulas in double, and against their
// own draws.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "chapters/04_air/phase.hpp"
#include "common/image/csv.hpp"
#include "tests/gpu/18_parts.hpp"
#include "tree.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

// The fit's printed formulas below 5 um, in double. Above, chapter 04 has them.
double small_droplet(double one_minus_nu, double diameter_um) {
  const double l = std::log(diameter_um), log_l = std::log(l);
  const double peak_g = 0.0604931 * log_l + 0.940256;
  const double body_g = 0.500411 - 0.081287 / (-2.0 * l + std::tan(l) + 1.27551);
  const double alpha = 7.30354 * l + 6.31675;
  const double weight = 0.026914 * (l - std::cos(5.68947 * (log_l - 0.0292149))) + 0.376475;
  return (1.0 - weight) * phase::henyey_greenstein(one_minus_nu, peak_g) +
         weight * phase::draine(one_minus_nu, body_g, alpha);
}

struct Moments {
  double integral = 0.0, mean_cosine = 0.0;
};

// Over the sphere, from values the shader computes at nodes: 1 - nu = exp(-u) and 1 + nu = exp(-u), u to 40, midpoints.
// In u the narrowest peak at either end is as wide as any.
std::vector<PartItem> sphere_nodes(const PartItem& like, int one_minus_at, int one_plus_at) {
  std::vector<PartItem> items;
  for (int i = 0; i < kSphereNodes; ++i) {
    const float end = std::exp(-(i + 0.5f) * 40.0f / kSphereNodes);
    for (const bool forward : {true, false}) {
      PartItem item = like;
      item[one_minus_at] = forward ? end : 2.0f - end;
      item[one_plus_at] = forward ? 2.0f - end : end;
      items.push_back(item);
    }
  }
  return items;
}

Moments sphere_moments(const std::vector<PartItem>& nodes, const std::vector<PartResult>& values, int one_minus_at) {
  Moments m;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const double end = std::exp(-(i / 2 + 0.5) * 40.0 / kSphereNodes);
    const double nu = i % 2 == 0 ? 1.0 - nodes[i][one_minus_at] : end - 1.0;
    const double weight = 2.0 * std::numbers::pi * values[i][0] * end * 40.0 / kSphereNodes;
    m.integral += weight;
    m.mean_cosine += weight * nu;
  }
  return m;
}

}  // namespace

TEST_CASE("18 truth: droplets integrate to 1 and have their mean cosine") {
  // 0.843, 0.864, 0.879, 0.891 at 5, 10, 20, 50 um, from the table of moments in full precision.
  const CsvTable table =
      read_csv(WELKIN_TEST_DATA "/phase_moments.csv", {"integral_over_sphere", "mean_cosine"}, {"name"});
  int found = 0;
  for (size_t row = 0; row < table.rows; ++row) {
    const std::string& name = table.text("name")[row];
    if (name.rfind("HGDraine_d", 0) != 0) continue;
    ++found;
    const float diameter = std::stof(name.substr(10));
    const std::vector<PartItem> nodes = sphere_nodes({kDroplet, diameter}, 2, 3);
    const std::vector<PartResult> values = parts(nodes);
    const Moments m = sphere_moments(nodes, values, 2);
    INFO(name);
    // The midpoint rule is exact to (40/4000)^2/24 = 4e-6; float32 adds 1e-6.
    CHECK(m.integral == Approx(1.0).margin(1e-5));
    CHECK(m.mean_cosine == Approx(table.column("mean_cosine")[row]).margin(1e-5));
    CHECK(values[0][1] == Approx(table.column("mean_cosine")[row]).margin(2e-6));
  }
  CHECK(found == 4);
}

TEST_CASE("18 truth: droplets of every size are the printed fit") {
  Random random(18);
  std::vector<PartItem> items;
  for (int i = 0; i < 200'000; ++i) {
    const float diameter = static_cast<float>(random.log_uniform(1.5, 50.0));
    const float x =
        static_cast<float>(random.next() % 2 == 0 ? random.uniform(0.0, 2.0) : random.log_uniform(1e-9, 2.0));
    items.push_back({kDroplet, diameter, x, 2.0f - x});
  }
  const std::vector<PartResult> results = parts(items);
  double worst = 0.0, worst_naive = 0.0;
  for (size_t i = 0; i < items.size(); ++i) {
    const double d = items[i][1], x = items[i][2];
    const double truth = d < 5.0 ? small_droplet(x, d) : phase::droplet(x, d);
    REQUIRE(std::isfinite(results[i][0]));
    worst = std::max(worst, std::abs(results[i][0] / truth - 1.0));
    const double peak = d < 5.0 ? phase::henyey_greenstein(x, 0.0604931 * std::log(std::log(d)) + 0.940256)
                                : phase::henyey_greenstein(x, std::exp(-0.0990567 / (d - 1.67154)));
    worst_naive = std::max(worst_naive, std::abs(results[i][6] / peak - 1.0));
  }
  WARN(fmt::format("largest relative error of the droplets' phase {:.1e}; of the peak by 1 + g^2 - 2 g nu {:.1e}",
                   worst, worst_naive));
  // 1 - g carries all its digits: forty roundings of 6e-8. The logarithm's own error (2e-6) grows where tan(log d)
  // does.
  CHECK(worst < 1e-5);
  CHECK(worst_naive > 0.01);  // what the printed form loses
}

TEST_CASE("18 truth: two lobes are the tables' and the printed formulas") {
  const char* const names[] = {"HG_0.85", "HG_m0.3", "Draine_g0.8_a0.5", "HGDraine_d5um", "HGDraine_d20um"};
  const CsvTable table = read_csv(WELKIN_TEST_DATA "/phase_functions.csv",
                                  {"angle_deg", names[0], names[1], names[2], names[3], names[4]});
  const std::array<PartItem, 3> lobes{PartItem{kPhase, 0, 0, 0.15f, 0, 1, 0, 0},
                                      PartItem{kPhase, 0, 0, 1.3f, 0, 1, 0, 0},
                                      PartItem{kPhase, 0, 0, 0.2f, 0.5f, 1, 0, 0}};
  for (size_t row = 0; row < table.rows; ++row) {
    const double half = table.column("angle_deg")[row] * std::numbers::pi / 360.0;
    const float one_minus = static_cast<float>(2.0 * std::sin(half) * std::sin(half)),
                one_plus = static_cast<float>(2.0 * std::cos(half) * std::cos(half));
    std::vector<PartItem> items;
    for (PartItem item : lobes) {
      item[1] = one_minus, item[2] = one_plus;
      items.push_back(item);
    }
    items.push_back({kDroplet, 5.0f, one_minus, one_plus});
    items.push_back({kDroplet, 20.0f, one_minus, one_plus});
    const std::vector<PartResult> results = parts(items);
    // 0.15f and 0.2f are off by 4e-8 of themselves; the peak at 20 um goes with (1 - g)^-2.
    for (int k = 0; k < 5; ++k) CHECK(results[k][0] == Approx(table.column(names[k])[row]).epsilon(5e-6));
  }
}

TEST_CASE("18 truth: turns of a cloud are drawn from its phase function") {
  const std::array<std::array<float, 5>, 5> phases{{{0.15f, 0, 0.15f, 0, 0},
                                                    {0.2f, 0, 1.3f, 0, 0.15f},
                                                    {0.05f, 0, 0.4f, 20.0f, 0.5f},
                                                    {0.002f, 0, 0.427f, 33.0f, 0.51f},
                                                    {1.6f, 3.0f, 1.0f, 1.0f, 0.3f}}};
  constexpr int kTurns = 1 << 17;
  for (const auto& lobes : phases) {
    PartItem turn{kTurn, 0, 0};
    PartItem value{kPhase, 0, 0};
    for (int k = 0; k < 5; ++k) turn[3 + k] = value[3 + k] = lobes[k];
    std::vector<PartItem> items(kTurns, turn);
    for (int i = 0; i < kTurns; ++i) items[i][1] = static_cast<float>(i);
    const std::vector<PartResult> turns = parts(items);
    double sums[3] = {}, squares[3] = {};
    for (const PartResult& t : turns) {
      REQUIRE(t[0] >= 0.0f);
      REQUIRE(std::abs(t[0] + t[1] - 2.0f) < 1e-6f);
      // Mean cosine and its square see the body, the share within 2.6 degrees (1 - nu < 1e-3) sees the peak.
      const double nu = 1.0 - t[0], values[3] = {nu, nu * nu, t[0] < 1e-3 ? 1.0 : 0.0};
      for (int k = 0; k < 3; ++k) sums[k] += values[k] / kTurns, squares[k] += values[k] * values[k] / kTurns;
    }
    const std::vector<PartItem> nodes = sphere_nodes(value, 1, 2);
    const std::vector<PartResult> values = parts(nodes);
    double expected[3] = {};
    for (size_t i = 0; i < nodes.size(); ++i) {
      const double end = std::exp(-(i / 2 + 0.5) * 40.0 / kSphereNodes);
      const double x = i % 2 == 0 ? end : 2.0 - end, nu = 1.0 - x;
      const double share = 2.0 * std::numbers::pi * values[i][0] * end * 40.0 / kSphereNodes;
      expected[0] += share * nu, expected[1] += share * nu * nu, expected[2] += x < 1e-3 ? share : 0.0;
    }
    INFO(fmt::format("lobes {} {} {} {} {}", lobes[0], lobes[1], lobes[2], lobes[3], lobes[4]));
    for (int k = 0; k < 3; ++k) {
      // Four standard errors, and the edge of the third within one node (1 %).
      const double error = std::sqrt(std::max(squares[k] - sums[k] * sums[k], 0.0) / kTurns);
      INFO(fmt::format("moment {}: {} of turns, {} of the phase", k, sums[k], expected[k]));
      CHECK(std::abs(sums[k] - expected[k]) < 4.0 * error + (k == 2 ? 0.01 * expected[k] : 1e-5));
    }
  }
}
