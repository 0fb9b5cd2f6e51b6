// Writes the tables of errors on the page of chapter 09:
//   WELKIN_TABLE=docs/generated/09_errors.csv gpu_tests "[09_table]"
//   WELKIN_TABLE=docs/generated/09_error_map.csv gpu_tests "[09_map]"
//   WELKIN_TABLE=docs/generated/09_aureole.csv gpu_tests "[09_aureole]"
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>

#include "common/image/csv.hpp"
#include "tests/gpu/09_sky.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

struct Table {
  const char* scene;
  std::vector<OrderRow> rows;
};
std::vector<Table> tables() {
  return {{"earth", order_rows("multiple_scattering_earth_cs.csv")},
          {"alien", order_rows("multiple_scattering_alien_cs.csv")}};
}

std::string percent(double error) {
  return error < 0.0995 ? fmt::format("{:.2g}", 100.0 * error) : fmt::format("{:.0f}", 100.0 * error);
}

}  // namespace

TEST_CASE("table of errors of the methods", "[.][09_table]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  const std::string prefix = "multiple_scattering.";
  const std::vector<std::pair<std::string, Choices>> variants{
      {"single scattering only", {{"orders", "1"}}},
      {"published (64 Fibonacci directions; even map)",
       {{prefix + "method", "published"}, {prefix + "directions", "64"}, {prefix + "map", "published"}}},
      {"isotropic (as many orders as the air asks for)", {{prefix + "method", "isotropic"}}},
      {"moments (as many orders as the air asks for: the default)", {}},
      {"… 3 orders", {{prefix + "iterations", "3"}}},
      {"… 10 orders", {{prefix + "iterations", "10"}}},
      {"… 40 orders", {{prefix + "iterations", "40"}}},
      {"… 4 samples along a direction", {{prefix + "steps", "4"}}},
      {"… 16 samples along a direction", {{prefix + "steps", "16"}}},
      {"… 16 directions", {{prefix + "directions", "16"}}},
      {"… 64 directions", {{prefix + "directions", "64"}}},
      {"… 32 directions of the set horizon", {{prefix + "set", "horizon"}}},
      {"… 64 directions of the set horizon", {{prefix + "set", "horizon"}, {prefix + "directions", "64"}}},
      {"… 256 directions and 32 samples", {{prefix + "directions", "256"}, {prefix + "steps", "32"}}},
      {"… 64 texels a side", {{prefix + "size", "64"}}},
      {"… 8 samples along the view", {{prefix + "view_steps", "8"}}}};
  std::vector<std::vector<std::string>> lines;
  std::vector<Table> all = tables();  // one ground albedo: each needs its own table
  for (Table& table : all) std::erase_if(table.rows, [](const OrderRow& row) { return row.albedo != 0.3; });
  for (const auto& [name, choices] : variants) {
    std::vector<std::string> line{name};
    for (const Table& table : all) {
      const OrderErrors errors =
          errors_of(table.rows, sky_of_rows(table.scene, Phase::cornette_shanks, choices, table.rows), Rows::target);
      for (double share : {0.5, 0.95, 1.0}) line.push_back(percent(errors.quantile(share)));
    }
    lines.push_back(line);
  }
  write_csv(file,
            {"relative error of the radiance on the rows of tests/data/multiple_scattering_{earth,alien}_cs.csv with a "
             "standard error "
             "below 1 % over a ground of albedo 0.3, sun above -4 degrees, more than 0.5 degrees from the horizon",
             "device: " + device().candidate().name, "driver: " + device().candidate().driver,
             "source: WELKIN_TABLE=docs/generated/09_errors.csv gpu_tests \"[09_table]\""},
            {"variant", "median_percent_earth", "p95_percent_earth", "worst_percent_earth", "median_percent_alien",
             "p95_percent_alien", "worst_percent_alien"},
            lines);
}

TEST_CASE("map of errors over altitude and sun", "[.][09_map]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  std::vector<std::vector<std::string>> lines;
  for (const Table& table : tables()) {
    std::map<std::pair<double, double>, std::array<std::vector<double>, 2>> cells;
    const Choices published{{"multiple_scattering.method", "published"},
                            {"multiple_scattering.directions", "64"},
                            {"multiple_scattering.map", "published"}};
    for (int method = 0; method < 2; ++method) {
      const std::vector<double> got =
          sky_of_rows(table.scene, Phase::cornette_shanks, method == 0 ? published : Choices{}, table.rows);
      for (size_t i = 0; i < got.size(); ++i) {
        const OrderRow& row = table.rows[i];
        if (!(row.all > 0.0) || row.all_error > 0.02 * row.all || row.near_horizon) continue;
        cells[{row.ray.altitude_km, row.ray.sun_zenith_deg}][method].push_back(std::abs(got[i] / row.all - 1.0));
      }
    }
    for (auto& [place, errors] : cells) {
      std::vector<std::string> line{table.scene, fmt::format("{:g}", place.first), fmt::format("{:g}", place.second),
                                    fmt::format("{}", errors[0].size())};
      for (std::vector<double>& one : errors) {
        std::sort(one.begin(), one.end());
        line.push_back(percent(one[one.size() / 2])), line.push_back(percent(one.back()));
      }
      lines.push_back(line);
    }
  }
  write_csv(file,
            {"relative error of the radiance per altitude and sun: median and worst of the rows there (standard error "
             "below 2 %, more than 0.5 degrees from the horizon)",
             "device: " + device().candidate().name,
             "source: WELKIN_TABLE=docs/generated/09_error_map.csv gpu_tests \"[09_map]\""},
            {"planet", "altitude_km", "sun_zenith_deg", "rows", "published_median_percent", "published_worst_percent",
             "moments_median_percent", "moments_worst_percent"},
            lines);
}

TEST_CASE("table of the aureole", "[.][09_aureole]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  std::vector<std::vector<std::string>> lines;
  for (const char* name : {"earth", "alien"})
    for (const Aureole& one : aureole(name, "524288")) {
      std::vector<std::string> line{name, fmt::format("{:g}", one.angle_deg)};
      for (int c = 0; c < 3; ++c) line.push_back(fmt::format("{:.2g}", 100.0 * one.error[c]));
      line.push_back(fmt::format("{:.1g}", 100.0 * std::fmax(one.noise[0], std::fmax(one.noise[1], one.noise[2]))));
      lines.push_back(line);
    }
  write_csv(file,
            {"error of chapter 09 above a sun 45 degrees high, against chapter 07's paths, in percent; noise: one "
             "standard error of the worst channel",
             "device: " + device().candidate().name,
             "source: WELKIN_TABLE=docs/generated/09_aureole.csv gpu_tests \"[09_aureole]\""},
            {"planet", "angle_deg", "red_percent", "green_percent", "blue_percent", "noise_percent"}, lines);
}
