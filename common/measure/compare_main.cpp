// welkin_compare A.exr B.exr A.json B.json [--truth T.exr] --out DIRECTORY
// Writes compare_A_B_SCENE_VIEW.png, .md and .html there, named by what the benchmarks say was drawn, and prints where.
// `./welkin compare` makes the inputs and calls this.
#include <CLI/CLI.hpp>
#include <cctype>

#include "common/error.hpp"
#include "common/image/exr.hpp"
#include "common/measure/compare.hpp"

int main(int argc, char** argv) {
  using namespace welkin;
  CLI::App app("Compares two chapters' pictures of the same view.", "welkin_compare");
  std::string a, b, a_json, b_json, truth_file, directory;
  app.add_option("a.exr", a, "first picture, linear radiance")->required();
  app.add_option("b.exr", b, "second picture, the same size")->required();
  app.add_option("a.json", a_json, "benchmark of the first")->required();
  app.add_option("b.json", b_json, "benchmark of the second")->required();
  app.add_option("--truth", truth_file, "reference picture");
  app.add_option("--out", directory, "where the pictures and the report go")->required();
  try {
    app.parse(argc, argv);
    const auto side = [](const std::string& exr, const std::string& json) {
      measure::BenchResult bench = measure::read_bench(json);
      return measure::Side{bench.chapter, image::read_exr(exr), bench};
    };
    std::optional<Image> truth;
    if (!truth_file.empty()) truth = image::read_exr(truth_file);
    const measure::Side first = side(a, a_json), second = side(b, b_json);
    std::string name = fmt::format("compare_{}_{}_{}_{}", first.name, second.name, first.bench.scene, first.bench.view);
    for (char& c : name)  // a scene of one's own may be called anything
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') c = '_';
    const std::string out = directory + "/" + name;
    const std::string title =
        fmt::format("{} and {}, scene {}, view {}", first.name, second.name, first.bench.scene, first.bench.view);
    measure::write_comparison(out, title, first, second, truth);
    fmt::print("{0}.png\n{0}.md\n{0}.html\n", out);
    return static_cast<int>(Exit::ok);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const std::exception& error) {
    fmt::print(stderr, "welkin_compare: {}\n", error.what());
    const auto* ours = dynamic_cast<const Error*>(&error);
    return static_cast<int>(ours != nullptr ? ours->exit_code : Exit::usage);
  }
}
