// Writes the table of errors on the page of chapter 08:
//   WELKIN_TABLE=docs/generated/08_errors.csv gpu_tests "[08_table]"
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "common/image/csv.hpp"
#include "tests/gpu/08_look_up.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

TEST_CASE("table of errors of the transmittance table", "[.][08_table]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  std::vector<TruePath> truth[4];
  for (int planet = 0; planet < 2; ++planet) {
    truth[2 * planet] = path_rows(planet == 0 ? "transmittance_earth.csv" : "transmittance_alien.csv");
    truth[2 * planet + 1] = random_paths(planet == 0 ? reference::earth() : reference::dense_alien(), 8, 4000);
  }
  std::vector<std::vector<std::string>> rows;
  for (const char* mapping : {"published", "folded"})
    for (const char* stored : {"transmittance", "optical_depth", "mean_extinction"})
      for (const char* format : {"half", "float"})
        for (const auto& [width, height] : {std::pair{"256", "64"}, {"128", "128"}, {"256", "256"}, {"128", "512"}, {"256", "512"}}) {
          std::vector<std::string> row{mapping, stored, format, fmt::format("{} × {}", width, height)};
          for (int i = 0; i < 4; ++i)
            row.push_back(fmt::format("{:.2g}", worst_error(i < 2 ? "earth" : "alien",
                                                            {{"transmittance.mapping", mapping}, {"transmittance.stored", stored}, {"transmittance.format", format},
                                                             {"transmittance.width", width}, {"transmittance.height", height}},
                                                            truth[i])));
          rows.push_back(row);
        }
  write_csv(file,
            {"largest relative error of transmittances above 1e-4: on the rows of tests/data/transmittance_*.csv and on 4000 random paths; texels by chapter 05's closed form",
             "device: " + device().candidate().name, "driver: " + device().candidate().driver,
             "source: WELKIN_TABLE=docs/generated/08_errors.csv gpu_tests \"[08_table]\""},
            {"mapping", "stored", "format", "size", "earth", "earth_random", "alien", "alien_random"}, rows);
}
