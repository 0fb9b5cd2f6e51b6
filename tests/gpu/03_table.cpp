// Writes the table of measured errors that the page of chapter 03 shows:
//   WELKIN_TABLE=docs/generated/03_errors.csv gpu_tests "[03_table]"
// and checks it the way the page reads it: what fails, and what holds.
#include <catch2/catch.hpp>
#include <cstdlib>

#include "common/image/csv.hpp"
#include "tests/gpu/03_truth.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

std::string percent(double value) {
  const std::string text = fmt::format("{:+.2f}", value);
  return text == "-0.00" || text == "+0.00" ? "0.00" : text;  // below what 400 000 rays resolve
}

}  // namespace

TEST_CASE("table of errors of the ray-sphere forms", "[.][03_table]") {
  const char* file = std::getenv("WELKIN_TABLE");
  REQUIRE(file != nullptr);
  const std::vector<std::pair<std::string, double>> cameras = {
      {"0.5 m", 0.0005}, {"2 m", 0.002},         {"2 km", 2.0},         {"100 km", 100.0},
      {"400 km", 400.0}, {"36 000 km", 36000.0}, {"the Moon", kMoon_km}};
  std::vector<std::vector<std::string>> rows;
  for (const auto& [name, altitude_km] : cameras) {
    for (const Form form : {kNaive, kCameraRelative, kRobust, kDoubleFloat}) {
      const FormErrors e = measure_form(form, altitude_km);
      rows.push_back({name, fmt::format("{:g}", altitude_km), kForms[form], percent(e.horizon_percent),
                      fmt::format("{:.3g}", e.limb_m), fmt::format("{:.3g}", e.steep_m),
                      fmt::format("{:.3g}", e.steep_relative)});
    }
  }
  const gpu::Candidate& on = device().candidate();
  write_csv(file,
            {"device: " + on.name, "driver: " + on.driver,
             "source: WELKIN_TABLE=docs/generated/03_errors.csv gpu_tests \"[03_table]\", 400 000 rays per row against "
             "long double"},
            {"camera", "altitude_km", "form", "horizon_percent", "limb_m", "steep_m", "steep_relative"}, rows);
  CHECK(rows.size() == 28);
}
