// Benchmarks as JSON, ladders, the sweep's table and the comparison report.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <set>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "common/image/csv.hpp"
#include "common/image/png.hpp"
#include "common/measure/bench_json.hpp"
#include "common/measure/compare.hpp"
#include "common/measure/sweep.hpp"
#include "temporary.hpp"

using namespace welkin;
using namespace welkin::measure;
using Catch::Matchers::Contains;

namespace {

BenchResult bench(const std::string& chapter) {
  return {chapter,
          "sunset",
          "east",
          "llvmpipe <x> | \"256\" bits",
          "Mesa 22.3.6",
          true,
          640,
          360,
          {{"view.steps", "32"}, {"rule", "midpoint"}},
          {{"sky", {1.5, 1.25, 3.0, 9}}, {"display", {0.25, 0.125, 0.5, 9}}},
          {2.0, 1.75, 4.0, 9},
          {0.25, 0.125, 0.5, 9},
          5'000'000'000,
          3,
          9,
          "2026-06-21T10:30:00Z"};
}

Image flat(float value) { return {8, 5, std::vector<glm::vec4>(40, glm::vec4(value, value, value, 1.0f))}; }

Knob knob(const std::string& name, double initial, std::vector<double> ladder, double maximum = 1.0) {
  Knob made;
  made.name = name;
  made.initial = initial;
  made.ladder = std::move(ladder);
  made.maximum = maximum;
  return made;
}

Settings knobs() {
  Knob rule = knob("rule", 0, {0, 1});
  rule.choices = {"left", "midpoint"};
  return Settings({knob("view.steps", 32, {8, 32, 128}, 1024), knob("mie.g", 0.8, {}), rule});
}

}  // namespace

TEST_CASE("a benchmark comes back from its JSON as it was", "[report]") {
  const TemporaryDirectory dir;
  const BenchResult wrote = bench("05");
  write_bench(dir / "b.json", wrote);
  const BenchResult read = read_bench(dir / "b.json");
  CHECK((read.chapter == "05" && read.scene == "sunset" && read.view == "east" && read.device == wrote.device &&
         read.driver == wrote.driver));
  CHECK((read.software && read.width == 640 && read.height == 360 && read.bytes == 5'000'000'000 && read.warmup == 3 &&
         read.repeats == 9));
  CHECK(read.settings == wrote.settings);
  CHECK(read.date == wrote.date);
  REQUIRE(read.passes.size() == 2);
  CHECK((read.passes[0].name == "sky" && read.passes[1].name == "display"));
  CHECK((read.passes[0].ms.median == 1.5 && read.passes[0].ms.minimum == 1.25 && read.passes[0].ms.maximum == 3.0 &&
         read.passes[0].ms.samples == 9));
  CHECK((read.wall_ms.maximum == 4.0 && read.record_ms.minimum == 0.125));
  CHECK(gpu_ms(read) == 1.75);
  const std::string text = read_file(dir / "b.json", 10000), table = bench_table(read);
  for (const char* key : {"\"median_ms\": 1.5", "\"min_ms\": 1.25", "\"max_ms\": 3.0", "\"wall_ms\""})
    CHECK_THAT(text, Contains(key));
  for (const char* part : {"sky", "1.500", "wall time", "GPU total 1.750 ms", "4.66 GiB", "software driver", "640x360"})
    CHECK_THAT(table, Contains(part));

  for (const char* bad : {"", "{", "[]", "null", "{\"chapter\": 5}", "{\"chapter\": \"05\"}"}) {
    write_file_atomically(dir / "bad.json", std::string_view(bad));
    CHECK_THROWS_WITH(read_bench(dir / "bad.json"), Contains("bad.json: not a benchmark"));
  }
  CHECK_THROWS_WITH(read_bench(dir / "none.json"), Contains("none.json"));
  CHECK((human_bytes(12) == "12 B" && human_bytes(1536) == "1.5 KiB" && human_bytes(3 << 20) == "3.0 MiB"));
}

TEST_CASE("ladders multiply out; knobs without one, or set by hand, stay", "[report]") {
  Settings settings = knobs();
  const auto all = ladder_settings(settings);
  REQUIRE(all.size() == 6);
  CHECK(all.front() == std::vector<double>{8, 0.8, 0});
  CHECK(all[1] == std::vector<double>{8, 0.8, 1});
  CHECK(all.back() == std::vector<double>{128, 0.8, 1});
  CHECK(std::set<std::vector<double>>(all.begin(), all.end()).size() == 6);
  CHECK(with_values(settings, all[1]).text("rule") == "midpoint");
  CHECK(with_values(settings, all[1]).integer("view.steps") == 8);
  settings.set("rule", "left");
  CHECK(ladder_settings(settings).size() == 3);
  CHECK(ladder_settings(Settings{}).size() == 1);
  CHECK_THROWS_AS(with_values(settings, {1}), Error);
  std::vector<Knob> many;
  for (int i = 0; i < 64; ++i) many.push_back(knob("k" + std::to_string(i), 0, {0, 1}));
  // Too many to multiply out (2^64): the settings as they are, and every knob alone.
  const auto alone = ladder_settings(Settings(many));
  REQUIRE(alone.size() == 65);
  CHECK(alone.front() == std::vector<double>(64, 0.0));
  for (size_t i = 0; i < 64; ++i)
    CHECK((alone[i + 1][i] == 1.0 && std::count(alone[i + 1].begin(), alone[i + 1].end(), 1.0) == 1));
}

TEST_CASE("a sweep's table has its columns, its source and no hidden NaN", "[report]") {
  const TemporaryDirectory dir;
  SweepRow row{{"8", "0.8", "left"}, "east", {1.5, 1, 2, 5}, {3, 2, 4, 5}, {{"sky", 1.25}}, 4096, {}};
  row.errors.relative_rmse = 0.125;
  SweepRow broken = row;
  broken.errors = measure::compare(std::vector<double>{NAN}, std::vector<double>{1.0});
  write_sweep_csv(dir / "s.csv", knobs().knobs(), {row, broken},
                  {"05", "sunset", "GPU, X", "driver 1", true, 640, 360, "view.steps=1024", "2026"});
  const std::string text = read_file(dir / "s.csv", 10000);
  for (const char* line : {"# device: GPU, X\n", "# driver: driver 1\n", "# software driver: yes\n",
                           "# resolution: 640x360\n", "# reference: view.steps=1024\n"})
    CHECK_THAT(text, Contains(line));
  CHECK_THAT(text, Contains("view,knob:view.steps,knob:mie.g,knob:rule,gpu_ms_median,gpu_ms_min,gpu_ms_max,wall_ms,"
                            "pass_ms:sky,bytes,relative_rmse,"
                            "max_relative,p99_relative,mean_bias,rmse_255,not_finite\neast,8,0.8,left,1.5,1,2,3,1.25,"
                            "4096,0.125,0,0,0,0,0\n"));
  CHECK_THROWS_WITH(read_csv(dir / "s.csv", {}, {"view", "knob:rule"}),
                    Contains(":11:") && Contains("'nan' is not a finite number"));
}

TEST_CASE("a pass that a setting leaves out took 0 ms", "[report]") {
  const TemporaryDirectory dir;
  SweepRow without{{"8", "0.8", "left"}, "east", {1.5, 1, 2, 5}, {3, 2, 4, 5}, {{"sky", 1.25}}, 4096, {}};
  SweepRow with = without;
  with.passes = {{"table", 0.5}, {"sky", 1.5}};
  write_sweep_csv(dir / "s.csv", knobs().knobs(), {without, with}, {});
  const CsvTable table = read_csv(dir / "s.csv", {"pass_ms:sky", "pass_ms:table"}, {"view", "knob:rule"});
  CHECK(table.column("pass_ms:sky") == std::vector<double>{1.25, 1.5});
  CHECK(table.column("pass_ms:table") == std::vector<double>{0.0, 0.5});
}

TEST_CASE("the colour scale's luminance rises throughout", "[report]") {
  double last = -1.0;
  for (int i = 0; i <= 100; ++i) {
    const auto c = scale_colour(static_cast<float>(i) / 100.0f);
    const double luminance = 0.2126 * std::pow(c[0] / 255.0, 2.2) + 0.7152 * std::pow(c[1] / 255.0, 2.2) +
                             0.0722 * std::pow(c[2] / 255.0, 2.2);
    CHECK(luminance > last);
    last = luminance;
  }
  CHECK(scale_colour(-1.0f) == scale_colour(0.0f));
  CHECK(scale_colour(9.0f) == std::array<uint8_t, 3>{253, 231, 37});
}

TEST_CASE("the side-by-side picture holds A, B and their difference", "[report]") {
  CHECK(choose_exposure(flat(0.5f)) == Approx(4.6f));
  CHECK(choose_exposure(flat(0.0f)) == 1.0f);
  const Image a = flat(0.5f);
  Image b = a;
  b.pixels[9] = glm::vec4(0.0f, 0.5f, 0.5f, 1.0f);  // x 1, y 1
  b.pixels[10].g = NAN;
  const Image8 out = side_by_side(a, b, 4.6f, 1.0f);
  CHECK((out.width == 32 && out.height == 5 && out.rgba.size() == 640));
  const auto at = [&](size_t x, size_t y) {
    return std::vector<int>(&out.rgba[(y * 32 + x) * 4], &out.rgba[(y * 32 + x) * 4] + 3);
  };
  const int shown = static_cast<int>(std::lround(255.0 * (1.055 * std::pow(1.0 - std::exp(-2.3), 1 / 2.4) - 0.055)));
  CHECK(at(0, 0) == std::vector<int>(3, shown));
  CHECK(at(12 + 1, 1) == std::vector<int>{0, shown, shown});
  CHECK(at(8, 2) == std::vector<int>(3, 255));            // the gap
  CHECK(at(24, 0) == std::vector<int>{68, 1, 84});        // no difference
  CHECK(at(24 + 2, 1) == std::vector<int>{255, 0, 255});  // not finite
  const auto expected = scale_colour(static_cast<float>(shown) / 255.0f);
  CHECK(std::abs(at(24 + 1, 1)[1] - int(expected[1])) <= 1);  // the map is made before the picture is rounded to 8 bits
  CHECK(choose_gain(a, a, 4.6f) == 1000.0f);
  CHECK(choose_gain(a, flat(0.0f), 4.6f) == 1.0f);
}

TEST_CASE("the report states errors, times, exposure and gain, and stands alone", "[report]") {
  const TemporaryDirectory dir;
  const Side a{"05_a", flat(1.1f), bench("05_a")}, b{"10_b", flat(1.0f), bench("10_b")};
  write_comparison(dir / "compare", "A & <B>", a, b, flat(1.0f));
  const std::string html = read_file(dir / "compare.html", 100000), markdown = read_file(dir / "compare.md", 100000);
  CHECK(image::read_png8(dir / "compare.png").width == 32);
  CHECK_THAT(html, Contains("data:image/png;base64,iVBORw0KGgo") && !Contains("<x>") && !Contains("src=\"compare"));
  CHECK_THAT(markdown, Contains("(compare.png)"));
  for (const std::string& page : {html, markdown})
    CHECK_THAT(page, Contains("0.1") && Contains("1.500") && Contains("4.66 GiB") && Contains("exp(-2.3 L)") &&
                         Contains("the truth") && Contains("software driver"));
  try {
    write_comparison(dir / "other", "x", a, {"b", {1, 1, {glm::vec4(1.0f)}}, bench("b")}, std::nullopt);
    FAIL("accepted different sizes");
  } catch (const Error& error) {
    CHECK(error.exit_code == Exit::mismatch);
  }
  CHECK_FALSE(std::filesystem::exists(dir / "other.png"));
}
