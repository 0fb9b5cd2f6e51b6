// Writes the table of what stands in for higher orders, on the page of chapter 18: errors by optical thickness, and
// time.
//   WELKIN_TABLE=docs/generated/18_errors.csv gpu_tests "[18_table]"
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "common/image/csv.hpp"
#include "tests/gpu/18_clouds.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values.empty() ? NAN : values[std::min(values.size() - 1, static_cast<size_t>(q * values.size()))];
}

struct Rung {
  const char* name;
  CloudMarching marching;
};

}  // namespace

TEST_CASE("table of what stands in for higher orders", "[.][18_table]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  const std::vector<Rung> rungs = {
      {"order 1 alone", {.orders = 0}},
      {"2 octaves", {.orders = 1, .octaves = 2}},
      {"4 octaves", {.orders = 1, .octaves = 4}},
      {"8 octaves", {.orders = 1, .octaves = 8}},
      {"escape 2 x 2", {.orders = 2, .escape_samples = 2, .escape_directions = 2}},
      {"escape 4 x 3", {.orders = 2}},
      {"escape 4 x 9", {.orders = 2, .steps = 256, .light_samples = 32, .escape_samples = 9, .refresh = 5}}};
  std::vector<std::vector<std::string>> lines;
  for (const Rung& rung : rungs) {
    std::vector<double> errors[3], plain;
    double seconds = 0.0;
    for (const char* table : {"blob", "cumulus", "deck", "slab", "sphere"}) {
      const bool grid = table[0] == 'b' || table[0] == 'c' || table[0] == 'd';
      std::vector<CloudRow> rows = cloud_rows(table);
      std::erase_if(rows, [](const CloudRow& row) { return !(row.all > 0.0); });
      std::vector<CloudItem> items;
      for (const CloudRow& row : rows) items.push_back(row.item);
      const std::vector<double> lights = march_clouds(items, grid_of(table), rung.marching);
      for (size_t i = 0; i < rows.size(); ++i) {
        const double error = std::abs(lights[i] / rows[i].all - 1.0);
        if (grid)
          errors[rows[i].thickness < 1.0 ? 0 : rows[i].thickness < 20.0 ? 1 : 2].push_back(error);
        else
          plain.push_back(error);
      }
      if (!grid) continue;
      // The same rays ten times, when all is warm.
      std::vector<CloudItem> many;
      for (int n = 0; n < 10; ++n) many.insert(many.end(), items.begin(), items.end());
      const auto begin = std::chrono::steady_clock::now();
      march_clouds(many, grid_of(table), rung.marching);
      seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    std::vector<std::string> line{rung.name};
    for (const auto& by_thickness : errors)
      for (const double q : {0.5, 0.95}) line.push_back(fmt::format("{:.3g}", 100.0 * quantile(by_thickness, q)));
    line.push_back(fmt::format("{:.3g}", 100.0 * quantile(plain, 0.5)));
    line.push_back(fmt::format("{:.3g}", seconds));
    lines.push_back(line);
  }
  write_csv(
      file,
      {"relative error of the radiance of all orders over the rows of tests/data/cloud_{blob,cumulus,deck}.csv by "
       "largest vertical optical depth; slab and sphere: all rows of their tables; seconds: ten times the grids' "
       "rays",
       "device: " + device().candidate().name, "driver: " + device().candidate().driver,
       "source: WELKIN_TABLE=docs/generated/18_errors.csv gpu_tests \"[18_table]\""},
      {"rung", "median_percent_0.5", "p95_percent_0.5", "median_percent_10", "p95_percent_10", "median_percent_60",
       "p95_percent_60", "median_percent_slab_sphere", "seconds"},
      lines);
}
