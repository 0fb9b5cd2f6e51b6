// Writes the table of errors on the page of chapter 05:
//   WELKIN_TABLE=docs/generated/05_errors.csv gpu_tests "[05_table]"
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "common/image/csv.hpp"
#include "tests/gpu/05_rays.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

TEST_CASE("table of errors of the rules", "[.][05_table]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  const char* const names[] = {"left", "midpoint", "offset_0.3", "nonuniform", "gauss_legendre", "adapted"};
  const reference::Planet planets[] = {reference::earth(), reference::dense_alien()};
  const std::vector<TruthRow> tables[] = {truth_rows("single_scattering_earth.csv", planets[0]),
                                          truth_rows("single_scattering_alien.csv", planets[1])};
  std::vector<std::vector<std::string>> rows;
  for (int rule = kLeft; rule <= kAdapted; ++rule)
    for (const auto& [view_steps, light_steps] : {std::pair{8, 4}, {16, 8}, {32, 8}, {64, 16}, {128, 32}}) {
      std::vector<std::string> row{names[rule], fmt::format("{} × {}", view_steps, light_steps)};
      for (int planet = 0; planet < 2; ++planet) {
        std::vector<SkyRay> rays;
        for (const TruthRow& truth : tables[planet]) rays.push_back(truth.ray);
        const std::vector<Light> lights = march_rays(
            planets[planet], rays,
            {.view_steps = view_steps, .light_steps = light_steps, .rule = static_cast<Rule>(rule), .albedo = 0.3});
        Errors errors;
        for (size_t i = 0; i < lights.size(); ++i) {
          reference::Rgb expected = tables[planet][i].henyey_greenstein;
          for (int k = 0; k < 3; ++k) expected[k] += 0.3 * tables[planet][i].ground1[k];
          errors.add(lights[i].radiance, expected, 1e-6 * tables[planet][i].sky_maximum);
        }
        for (double error : {errors.maximum(), errors.quantile(0.99), errors.quantile(0.5)})
          row.push_back(error < 0.995 ? fmt::format("{:.2g}", 100.0 * error) : fmt::format("{:.0f}", 100.0 * error));
      }
      rows.push_back(row);
    }
  write_csv(file,
            {"relative error of the radiance on the rows of tests/data/single_scattering_*.csv above 1e-6 of the sky's "
             "maximum",
             "device: " + device().candidate().name, "driver: " + device().candidate().driver,
             "source: WELKIN_TABLE=docs/generated/05_errors.csv gpu_tests \"[05_table]\""},
            {"rule", "steps", "worst_percent_earth", "p99_percent_earth", "median_percent_earth", "worst_percent_alien",
             "p99_percent_alien", "median_percent_alien"},
            rows);
}
