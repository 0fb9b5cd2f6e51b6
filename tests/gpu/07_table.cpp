// Writes the tables on the page of chapter 07:
//   WELKIN_TABLE=docs/generated/07_tracking.csv gpu_tests "[07_tracking_table]"
//   WELKIN_TABLE=docs/generated/07_truth.csv gpu_tests "[07_all_rows]"
//   WELKIN_TABLE=docs/generated/07_orders.csv gpu_tests "[07_orders_table]"
//   WELKIN_TABLE=docs/generated/07_drift.csv gpu_tests "[07_drift_table]"
//   WELKIN_TABLE=docs/generated/07_unfound.csv gpu_tests "[07_unfound_table]"
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "common/image/csv.hpp"
#include "tests/gpu/07_paths.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

// From the grass up, level and down; from 60 km along the limb and down; under three suns.
std::vector<PathRay> table_rays(int orders) {
  std::vector<PathRay> rays;
  for (const auto& [altitude, zenith] :
       {std::pair{0.0005, 30.0}, {0.0005, 80.0}, {0.0005, 120.0}, {60.0, 97.0}, {60.0, 120.0}})
    for (double sun : {30.0, 75.0, 88.0})
      rays.push_back({.ray = ray_from_degrees(altitude, zenith, sun, 60.0),
                      .albedo = {0.3, 0.3, 0.3},
                      .orders = orders,
                      .seed = static_cast<uint32_t>(rays.size() + 1)});
  return rays;
}

struct Speed {
  double paths_per_s = 0.0;
  double variance = 0.0;  // relative, of one path, mean over rays and channels
};

// Making the pipeline takes as long as a million paths: what a small call takes is subtracted from what a large one
// takes.
Speed measure(bool alien, const PathVariant& variant, int orders) {
  const bool software = device().candidate().name.find("llvmpipe") != std::string::npos;
  const reference::Planet planet = alien ? reference::dense_alien() : reference::earth();
  const std::vector<PathRay> rays = table_rays(orders);
  const bool naive = variant.tracking == kNaive;
  const int blocks = (software ? 1 : 16) * (naive ? 8192 : 2048), paths = naive ? 1 : 8;
  std::vector<PathMean> means;
  const auto seconds = [&](int count) {
    const auto start = std::chrono::steady_clock::now();
    means = trace(planet, rays, variant, count, paths);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  seconds(8);
  const double small = seconds(8), large = seconds(blocks);
  const double n = double(blocks) * paths;
  Speed speed{(n - 8.0 * paths) * rays.size() / (large - small), 0.0};
  for (const PathMean& mean : means)
    for (int c = 0; c < 3; ++c) speed.variance += std::pow(mean.error[c] / mean.mean[c], 2) * n / (3.0 * rays.size());
  return speed;
}

std::vector<std::string> origin(const char* what, const char* tag) {
  return {what, "device: " + device().candidate().name, "driver: " + device().candidate().driver,
          fmt::format("source: WELKIN_TABLE=docs/generated/{}.csv gpu_tests \"[{}_table]\"", tag, tag)};
}

}  // namespace

TEST_CASE("table of trackings", "[.][07_tracking_table]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  std::vector<std::vector<std::string>> rows;
  for (const bool alien : {false, true}) {
    double naive = 0.0;
    for (const Tracking tracking : {kNaive, kShells, kExponential, kClosedForm})
      for (const bool hero : {false, true}) {
        const Speed speed = measure(alien, {.tracking = tracking, .hero = hero}, 0);
        const double seconds = speed.variance * 1e4 / speed.paths_per_s;  // to 1 % of one ray
        if (tracking == kNaive && !hero) naive = seconds;
        const char* const names[] = {"naive", "shells", "exponential", "closed_form"};
        rows.push_back({alien ? "alien" : "earth", names[tracking], hero ? "hero" : "one_channel",
                        fmt::format("{:.3g}", speed.paths_per_s / 1e3),
                        fmt::format("{:.3g}", speed.paths_per_s / 1e3 * (hero ? 3 : 1)),
                        fmt::format("{:.2g}", speed.variance), fmt::format("{:.3g}", seconds * 1e3),
                        fmt::format("{:.2g}", naive / seconds)});
      }
  }
  write_csv(file,
            origin("paths of all orders on 15 rays; time for a standard error of 1 % of a ray, relative to naive",
                   "07_tracking"),
            {"planet", "tracking", "spectral", "thousand_paths_per_s", "thousand_channels_per_s", "variance_of_a_path",
             "ms_to_1_percent", "gain"},
            rows);
}

TEST_CASE("table of orders", "[.][07_orders_table]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  std::vector<std::vector<std::string>> rows;
  for (const bool alien : {false, true})
    for (const int orders : kOrders) {
      const Speed speed = measure(alien, {}, orders);
      rows.push_back({alien ? "alien" : "earth", orders == 0 ? "all" : fmt::format("{}", orders),
                      fmt::format("{:.3g}", speed.paths_per_s / 1e3), fmt::format("{:.2g}", speed.variance),
                      fmt::format("{:.3g}", speed.variance * 1e7 / speed.paths_per_s)});
    }
  write_csv(file, origin("paths of the default tracking on 15 rays", "07_orders"),
            {"planet", "orders", "thousand_paths_per_s", "variance_of_a_path", "ms_to_1_percent"}, rows);
}

// WELKIN_BLOCKS: blocks of eight paths per row.
TEST_CASE("all rows of all tables, all orders", "[.][07_all_rows]") {
  const char *const file = std::getenv("WELKIN_TABLE"), *const given = std::getenv("WELKIN_BLOCKS");
  const int blocks = given ? std::atoi(given) : 1024;
  std::vector<std::vector<std::string>> lines;
  for (const OrdersTable& table : kTables)
    for (int order = 0; order < 5; ++order) {
      ZScores z;
      score_rows(table, 0, 1, order, blocks, {.phase = table.phase}, z);
      lines.push_back({table.file, kOrders[order] == 0 ? "all" : fmt::format("{}", kOrders[order]),
                       fmt::format("{}", z.values.size()), fmt::format("{:.4f}", z.share_within_3()),
                       fmt::format("{:.3f}", z.rms()), fmt::format("{:.3f}", z.mean())});
      fmt::print("{}\n", fmt::join(lines.back(), " "));
      std::fflush(stdout);
      CHECK(z.share_within_3() >= 0.99);
    }
  if (file)
    write_csv(file,
              {fmt::format("z = difference / combined standard error; {} paths a row", 8 * blocks),
               "device: " + device().candidate().name, "driver: " + device().candidate().driver,
               "source: WELKIN_TABLE=docs/generated/07_truth.csv gpu_tests \"[07_all_rows]\""},
              {"table", "orders", "rows", "within_3", "rms_z", "mean_z"}, lines);
}

// Is a mean z of -0.1 a bias? The light of a path is a skewed variable: a mean that is too low comes with a standard
// error that is too small, and the quotient's mean is below 0, by skewness / (2 sqrt(n)). A bias of the mean would stay
// where the error is taken from all runs, and grow as sqrt(n).
TEST_CASE("table of the mean score's drift", "[.][07_drift_table]") {
  const char *const file = std::getenv("WELKIN_TABLE"), *const given = std::getenv("WELKIN_BLOCKS");
  const int blocks = given ? std::atoi(given) : 1024;
  constexpr int kRuns = 16, kTogether = 4;
  std::vector<std::vector<std::string>> lines;
  for (const OrdersTable& table : kTables) {
    if (table.alien) continue;
    std::vector<OrdersRow> rows = orders_rows(table.file);
    std::erase_if(rows, [&](const OrdersRow& row) { return row.radiance[1] < kDark; });
    if (rows.size() > 500) {  // as many as the other table has
      std::vector<OrdersRow> some;
      for (size_t i = 0; i < rows.size(); i += 3) some.push_back(rows[i]);
      rows = std::move(some);
    }
    std::vector<std::vector<PathMean>> runs;
    for (int run = 0; run < kRuns; ++run) {
      std::vector<PathRay> rays;
      for (const OrdersRow& row : rows) {
        rays.push_back(row.ray);
        rays.back().orders = 2;
        rays.back().seed += 5000u * static_cast<uint32_t>(run + 1);
      }
      runs.push_back(trace(planet_of(false), rays, {.phase = table.phase}, blocks, 8));
      fmt::print("{} run {}\n", table.file, run);
      std::fflush(stdout);
    }
    // Groups of 1 or 4 runs; each row's error from the group itself, or from all runs.
    struct Drift {
      double mean = 0.0, spread = 0.0;  // spread: of the mean from group to group
    };
    const auto drift = [&](int together, bool from_all) {
      std::vector<double> groups(kRuns / together, 0.0);
      for (size_t i = 0; i < rows.size(); ++i) {
        const int c = rows[i].channel;
        double all = 0.0;
        for (const auto& run : runs) all += run[i].error[c] * run[i].error[c] / kRuns;
        for (int first = 0; first < kRuns; first += together) {
          double mean = 0.0, square = 0.0;
          for (int k = first; k < first + together; ++k)
            mean += runs[k][i].mean[c] / together, square += runs[k][i].error[c] * runs[k][i].error[c] / together;
          groups[first / together] +=
              score(mean, std::sqrt((from_all ? all : square) / together), rows[i].radiance[1], rows[i].error[1]) /
              double(rows.size());
        }
      }
      Drift found;
      for (const double group : groups) found.mean += group / double(groups.size());
      for (const double group : groups)
        found.spread += (group - found.mean) * (group - found.mean) / double(groups.size() - 1);
      found.spread = std::sqrt(found.spread);
      return found;
    };
    for (const int together : {1, kTogether}) {
      const Drift own = drift(together, false), pooled = drift(together, true);
      lines.push_back({table.file, fmt::format("{}", 8 * blocks * together), fmt::format("{}", kRuns / together),
                       fmt::format("{:.3f}", own.mean), fmt::format("{:.3f}", pooled.mean),
                       fmt::format("{:.3f}", own.spread), fmt::format("{:.3f}", std::sqrt(1.0 / double(rows.size())))});
    }
    for (const auto& line : lines) fmt::print("{}\n", fmt::join(line, " "));
  }
  if (file)
    write_csv(
        file,
        {fmt::format("mean of z over the rows of a table, order 2, in {} runs with random numbers of their own; z = "
                     "difference / combined standard error",
                     kRuns),
         "device: " + device().candidate().name, "driver: " + device().candidate().driver,
         "source: WELKIN_TABLE=docs/generated/07_drift.csv gpu_tests \"[07_drift_table]\""},
        {"table", "paths", "runs", "mean_z_own_error", "mean_z_error_of_all", "spread_of_runs", "expected_spread"},
        lines);
}

// What the page says of light that no flight finds, from one place.
TEST_CASE("table of light that no flight finds", "[.][07_unfound_table]") {
  const char* const file = std::getenv("WELKIN_TABLE");
  const UnfoundLight light = unfound_light();
  std::vector<std::vector<std::string>> rows;
  for (const bool spread : {false, true})
    for (const int blocks : {1024, 16384, 262144}) {
      const PathMean mean = trace(reference::dense_alien(), {light.ray}, {.spread = spread}, blocks, 2)[0];
      rows.push_back({spread ? "flights and collisions put anywhere" : "flights alone", fmt::format("{}", 2 * blocks),
                      fmt::format("{:.3g}", 100.0 * mean.mean[2] / light.expected),
                      fmt::format("{:.2g}", 100.0 * mean.error[2] / light.expected)});
      fmt::print("{}\n", fmt::join(rows.back(), " "));
    }
  if (file)
    write_csv(file,
              {"blue light of the dense planet's dusk, scattered once, in % of the quadrature's",
               "device: " + device().candidate().name, "driver: " + device().candidate().driver,
               "source: WELKIN_TABLE=docs/generated/07_unfound.csv gpu_tests \"[07_unfound_table]\""},
              {"paths_are", "paths", "radiance_percent", "standard_error_percent"}, rows);
}
