// Writes the tables of errors on the page of chapter 08:
//   WELKIN_TABLE=docs/generated/08_errors.csv gpu_tests "[08_table]"
//   WELKIN_TABLE=docs/generated/08_texels.csv gpu_tests "[08_texels]"
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "common/image/csv.hpp"
#include "tests/gpu/08_look_up.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

const char* file() {
  const char* name = std::getenv("WELKIN_TABLE");
  REQUIRE(name != nullptr);
  return name;
}

// The errors of a table with these choices: on Earth's rows and random paths, then on the dense planet's.
std::vector<std::string> errors(const Choices& choices, Sampler sampler = Sampler::device) {
  static const std::vector<ReferencePath> truth[4]{
      path_rows("transmittance_earth.csv"), random_paths(reference::earth(), 8, 4000),
      path_rows("transmittance_alien.csv"), random_paths(reference::dense_alien(), 8, 4000)};
  std::vector<std::string> row;
  for (int i = 0; i < 4; ++i)
    row.push_back(fmt::format("{:.2g}", worst_error(i < 2 ? "earth" : "alien", choices, truth[i], sampler)));
  return row;
}

void write(const std::string& what, const std::string& tag, const std::vector<std::string>& header,
           const std::vector<std::vector<std::string>>& rows) {
  write_csv(file(),
            {"largest relative error of transmittances above 1e-4: on the rows of tests/data/transmittance_*.csv and "
             "on 4000 random paths; " +
                 what,
             "device: " + device().candidate().name, "driver: " + device().candidate().driver,
             fmt::format("source: WELKIN_TABLE=docs/generated/08_{}.csv gpu_tests \"[08_{}]\"",
                         tag == "table" ? "errors" : tag, tag)},
            header, rows);
}

}  // namespace

TEST_CASE("table of errors of the transmittance table", "[.][08_table]") {
  std::vector<std::vector<std::string>> rows;
  for (const char* mapping : {"published", "folded"})
    for (const char* stored : {"transmittance", "optical_depth", "mean_extinction"})
      for (const char* format : {"half", "float"})
        for (const auto& [width, height] :
             {std::pair{"256", "64"}, {"128", "128"}, {"256", "256"}, {"128", "512"}, {"256", "512"}}) {
          std::vector<std::string> row{mapping, stored, format, fmt::format("{} × {}", width, height)};
          const std::vector<std::string> numbers = errors({{"transmittance.mapping", mapping},
                                                           {"transmittance.stored", stored},
                                                           {"transmittance.format", format},
                                                           {"transmittance.width", width},
                                                           {"transmittance.height", height}});
          row.insert(row.end(), numbers.begin(), numbers.end());
          rows.push_back(row);
        }
  write("texels by chapter 05's closed form", "table",
        {"mapping", "stored", "format", "size", "earth", "earth_random", "alien", "alien_random"}, rows);
}

TEST_CASE("table of errors by how texels are filled and read", "[.][08_texels]") {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const char* filled, const char* read, const char* steps, Sampler sampler) {
    std::vector<std::string> row{filled, read};
    const std::vector<std::string> numbers = errors({{"transmittance.steps", steps}}, sampler);
    row.insert(row.end(), numbers.begin(), numbers.end());
    rows.push_back(row);
  };
  add("closed form", "the device's", "0", Sampler::device);
  add("closed form", "rounded to 1/256", "0", Sampler::coarse);
  for (const char* points : {"8", "16", "32", "64"})
    add((std::string(points) + " points").c_str(), "the device's", points, Sampler::device);
  write("the default table otherwise", "texels",
        {"texels_by", "weights", "earth", "earth_random", "alien", "alien_random"}, rows);
}
