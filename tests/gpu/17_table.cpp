// Writes the table of errors on the page of chapter 17:
//   WELKIN_TABLE=docs/generated gpu_tests "[17_table]"
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "common/image/csv.hpp"
#include "tests/gpu/17_clouds.hpp"

using namespace welkin;
using namespace welkin::test;

TEST_CASE("table of errors of grids", "[.][17_table]") {
  const std::string directory = table_directory();
  std::vector<std::vector<std::string>> rows;
  for (const char* name : {"blob", "cumulus", "deck"})
    for (const auto& [rung, knobs] :
         {std::pair<std::string, std::vector<std::pair<std::string, std::string>>>{"exact", {{"cloud.grid", "exact"}}},
          {"1 step a cell", {{"cloud.grid_steps", "1"}}},
          {"2 steps a cell", {{"cloud.grid_steps", "2"}}},
          {"4 steps a cell", {{"cloud.grid_steps", "4"}}},
          {"1 step a cell in bytes", {{"cloud.grid_format", "bytes"}, {"cloud.grid_steps", "1"}}}}) {
      const GridScore score = grid_score(name, knobs);
      rows.push_back({name, rung, fmt::format("{}", score.rows), fmt::format("{:.2g}", score.median_depth),
                      fmt::format("{:.2g}", score.worst_depth), fmt::format("{:.2g}", score.worst_t)});
    }
  write_csv(directory + "/17_truth.csv",
            {"relative errors of optical depths along the rays of tests/data/cloud_*.csv, and the largest error of T",
             "device: " + device().candidate().name, "driver: " + device().candidate().driver,
             "source: WELKIN_TABLE=docs/generated gpu_tests \"[17_table]\""},
            {"grid", "rung", "rays", "median", "worst", "worst_t"}, rows);
}
