// plot.py, run as users run it: the front and the slope of a sweep whose answer is known. Needs python3 and gnuplot.
// WELKIN_SOURCE_DIRECTORY names the tree's root (a compile definition); the working directory is tried without it.
#include <sys/wait.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>

#include "common/image/atomic_file.hpp"
#include "temporary.hpp"
#include "tree.hpp"

#ifndef WELKIN_SOURCE_DIRECTORY
#define WELKIN_SOURCE_DIRECTORY "."
#endif

using namespace welkin;
using Catch::Matchers::Contains;

namespace {

struct Outcome {
  int code;
  std::string text;
};

Outcome plot(const std::string& arguments) {
  std::FILE* pipe = ::popen(("python3 '" WELKIN_SOURCE_DIRECTORY "/docs/plot.py' " + arguments + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  std::string text;
  std::array<char, 4096> buffer;
  while (const size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe)) text.append(buffer.data(), got);
  const int status = ::pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}

const std::string kHead =
    "# chapter: 05\n# scene: sunset\n# device: `id` \"GPU\"\n# driver: d 1\n# software driver: yes\n# resolution: "
    "640x360\n"
    "view,knob:view.steps,gpu_ms_median,wall_ms,relative_rmse\n";

}  // namespace

TEST_CASE("plot: a second-order method buys a factor of four", "[curves]") {
  const TemporaryDirectory dir;
  std::string csv = kHead;
  for (int steps = 8; steps <= 128; steps *= 2)  // error = 6.4 / steps^2; the second view is half as bad
    for (const double share : {1.0, 0.5})
      csv += (share == 1.0 ? "east," : "west,") + std::to_string(steps) + "," + std::to_string(steps * 0.1) + ",9," +
             std::to_string(share * 6.4 / steps / steps) + "\n";
  csv += "east,999,5,9,0.9\nwest,999,5,9,0.9\n";  // slow and bad: on no front
  write_file_atomically(dir / "s.csv", csv);
  const std::string files = "'" + (dir / "s.csv").string() + "' '" + (dir / "s.svg").string() + "'";
  const Outcome out = plot(files);
  INFO(out.text);
  REQUIRE(out.code == 0);
  CHECK_THAT(out.text, Contains("6 settings, 5 on the Pareto front"));
  CHECK_THAT(out.text, Contains("A factor of two in time buys 4 times less error on average from 0.8 to 12.8 ms (4 "
                                "times at the cheap end, 4 times at the dear end)"));
  const std::string first = read_file(dir / "s.svg", 1 << 20);
  CHECK_THAT(first, Contains("software driver") && Contains("640x360") && Contains("d 1") && !Contains("GNUPLOT 5") &&
                        Contains("view.steps=8"));
  CHECK(first.find("uid=") == std::string::npos);  // text from a file is never run
  REQUIRE(plot(files).code == 0);
  CHECK(read_file(dir / "s.svg", 1 << 20) == first);
  CHECK(std::distance(std::filesystem::directory_iterator(dir.path), {}) == 2);
}

TEST_CASE("plot: bad input is one line and exit 2, and nothing is written", "[curves]") {
  const TemporaryDirectory dir;
  const auto refused = [&](const std::string& csv, const std::string& message) {
    write_file_atomically(dir / "s.csv", csv);
    const Outcome out = plot("'" + (dir / "s.csv").string() + "'");
    CHECK(out.code == 2);
    CHECK_THAT(out.text, Contains(message));
    CHECK(std::count(out.text.begin(), out.text.end(), '\n') == 1);
    CHECK_FALSE(std::filesystem::exists(dir / "s.svg"));
  };
  refused("", "column 'view' is missing");
  refused(kHead, "no rows");
  refused("view,gpu_ms_median\na,1\n", "'wall_ms' is missing");
  refused(kHead + "east,8,1,1\n", "s.csv:8: 4 fields");
  refused(kHead + "east,8,x,1,1\n", "s.csv:8: gpu_ms_median 'x' is not a number");
  refused(kHead + "east,8,1,1,nan\n", "NaN or infinite");
  refused(kHead + "east,8,1,1,0\n", "above zero");
  refused(kHead + "east,8,1,1,1\nwest,8,1,1,1\neast,16,1,1,1\n", "incomplete");
  refused(std::string("view\xff\xfe\n"), "plot: ");
  CHECK(plot("'" + (dir / "none.csv").string() + "'").code == 2);
  write_file_atomically(dir / "s.csv", kHead + "east,8,1,1,1\n");
  CHECK(plot("'" + (dir / "s.csv").string() + "' '" + (dir / "no/dir.svg").string() + "'").code == 2);
}
