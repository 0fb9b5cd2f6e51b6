// Writes the tables of errors on the page of chapter 10:
//   WELKIN_TABLE=docs/generated gpu_tests "[10_table]"
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/image/csv.hpp"
#include "tests/gpu/10_sky.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

std::vector<std::string> comments(const std::string& what) {
  return {what, "device: " + device().candidate().name, "driver: " + device().candidate().driver,
          "source: WELKIN_TABLE=docs/generated gpu_tests \"[10_table]\""};
}

}  // namespace

TEST_CASE("table of errors by altitude", "[.][10_table]") {
  const Scene scene = orders_scene("earth");

  std::vector<std::vector<std::string>> rows;
  for (const double altitude : {0.002, 1.0, 10.0, 20.0, 50.0, 99.0, 400.0}) {
    const std::vector<app::ProbeRay> rays = rays_from({altitude}, {20.0, 80.0, 91.0, 97.0}, 160, 110);
    const std::vector<app::ProbeResult> march = chapter_10_sky(scene, {{"sky_view.method", "march"}}, rays);
    for (const char* size : {"96x54", "192x108", "384x216"}) {
      const std::vector<double> errors = differences(
          rays, chapter_10_sky(scene, {{"sky_view.method", "table"}, {"sky_view.size", size}}, rays), march);
      rows.push_back({fmt::format("{:g}", altitude), size, fmt::format("{:.2g}", quantile(errors, 0.5)),
                      fmt::format("{:.2g}", quantile(errors, 0.95)), fmt::format("{:.2g}", quantile(errors, 0.99))});
    }
  }
  write_csv(table_directory() + "/10_altitudes.csv",
            comments("relative difference of the table's sky from the direct march: 4 suns (20, 80, 91, 97 degrees) x "
                     "160 rays, half of them close to the horizon, a quarter close to the sun"),
            {"altitude_km", "size", "median", "p95", "p99"}, rows);
}

TEST_CASE("table of errors against Monte Carlo", "[.][10_table]") {
  std::vector<std::vector<std::string>> rows;
  for (const auto& [file, name, phase] :
       {std::tuple{"multiple_scattering_earth_cs.csv", "earth", Phase::cornette_shanks},
        {"multiple_scattering_earth_hg.csv", "earth", Phase::henyey_greenstein},
        {"multiple_scattering_alien_cs.csv", "alien", Phase::cornette_shanks}})
    for (const char* method : {"auto", "march"}) {
      std::vector<OrderRow> over_ground;
      for (const OrderRow& row : order_rows(file))
        if (row.albedo == 0.3) over_ground.push_back(row);
      Scene planet = orders_scene(name);
      planet.medium("mie")->phase = phase;
      std::vector<app::ProbeRay> rays;
      for (const OrderRow& row : over_ground) rays.push_back(row.ray);
      const std::vector<app::ProbeResult> light = chapter_10_sky(planet, {{"sky_view.method", method}}, rays);
      std::vector<double> got;
      for (size_t i = 0; i < over_ground.size(); ++i) got.push_back(light[i].radiance[over_ground[i].channel]);
      for (const Rows which : {Rows::target, Rows::all}) {
        const OrderErrors errors = errors_of(over_ground, got, which);
        rows.push_back(
            {std::string(name) + (phase == Phase::cornette_shanks ? " (Cornette-Shanks)" : " (Henyey-Greenstein)"),
             which == Rows::target ? "target" : "all", method, std::to_string(errors.values.size()),
             fmt::format("{:.2g}", errors.quantile(0.5)), fmt::format("{:.2g}", errors.quantile(0.95)),
             fmt::format("{:.2g}", errors.quantile(1.0))});
      }
    }
  write_csv(
      table_directory() + "/10_monte_carlo.csv",
      comments("relative error against Monte Carlo, tests/data/multiple_scattering_*.csv, ground albedo 0.3, rows with "
               "a standard error below 1 %; target: sun above -4 degrees, rays more than 0.5 degrees from the horizon"),
      {"planet", "rows", "method", "count", "median", "p95", "worst"}, rows);
}

TEST_CASE("table of errors by the samples along a texel's ray", "[.][10_table]") {
  std::vector<std::vector<std::string>> lines;
  for (const char* steps : {"4", "8", "16", "32", "64"}) {
    std::vector<std::string> line{steps};
    for (const char* name : {"earth", "alien"}) {
      std::vector<OrderRow> rows = order_rows(fmt::format("multiple_scattering_{}_cs.csv", name));
      std::erase_if(rows, [](const OrderRow& row) { return row.albedo != 0.3; });
      Scene planet = orders_scene(name);
      planet.medium("mie")->phase = Phase::cornette_shanks;
      std::vector<app::ProbeRay> rays;
      for (const OrderRow& row : rows) rays.push_back(row.ray);
      const std::vector<app::ProbeResult> light = chapter_10_sky(planet, {{"sky_view.steps", steps}}, rays);
      std::vector<double> got;
      for (size_t i = 0; i < rows.size(); ++i) got.push_back(light[i].radiance[rows[i].channel]);
      const OrderErrors errors = errors_of(rows, got, Rows::target);
      for (const double share : {0.5, 0.95, 1.0}) line.push_back(fmt::format("{:.3g}", 100.0 * errors.quantile(share)));
    }
    lines.push_back(line);
  }
  write_csv(table_directory() + "/10_steps.csv",
            comments("relative error in percent of the sky by samples of the first order along a texel's ray: rows of "
                     "tests/data/multiple_scattering_*_cs.csv as in 10_monte_carlo.csv, target"),
            {"steps", "median_percent_earth", "p95_percent_earth", "worst_percent_earth", "median_percent_alien",
             "p95_percent_alien", "worst_percent_alien"},
            lines);
}
