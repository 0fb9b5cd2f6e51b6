// Benchmarks to and from JSON, and as tables. The one translation unit that includes nlohmann/json.
#include "common/measure/bench_json.hpp"

#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"

namespace welkin {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Knob, name, unit, meaning, minimum, maximum, initial, choices, ladder)
}

namespace welkin::measure {

using Json = nlohmann::json;

// Found by nlohmann/json through the argument's namespace.
void to_json(Json& json, const Spread& s) {
  json = {{"median_ms", s.median}, {"min_ms", s.minimum}, {"max_ms", s.maximum}, {"samples", s.samples}};
}
void from_json(const Json& json, Spread& s) {
  s = {json.at("median_ms"), json.at("min_ms"), json.at("max_ms"), json.at("samples")};
}
void to_json(Json& json, const PassTime& pass) {
  json = pass.ms;
  json["name"] = pass.name;
}
void from_json(const Json& json, PassTime& pass) { pass = {json.at("name"), json}; }
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BenchResult, chapter, scene, view, device, driver, software, width, height, settings,
                                   passes, wall_ms, record_ms, bytes, warmup, repeats, date)

double gpu_ms(const BenchResult& result) {
  double sum = 0.0;
  for (const PassTime& pass : result.passes) sum += pass.ms.median;
  return sum;
}

void write_bench(const std::filesystem::path& file, const BenchResult& result) {
  write_file_atomically(file, Json(result).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

BenchResult read_bench(const std::filesystem::path& file) {
  const std::string text = read_file(file, size_t{16} << 20);
  try {
    return Json::parse(text).get<BenchResult>();
  } catch (const Json::exception& error) {
    fail("{}: not a benchmark written by --bench: {}", file.string(), error.what());
  }
}

std::string human_bytes(uint64_t bytes) {
  if (bytes < 1024) return fmt::format("{} B", bytes);
  const double kib = static_cast<double>(bytes) / 1024.0;
  if (kib < 1024.0) return fmt::format("{:.1f} KiB", kib);
  return kib < 1048576.0 ? fmt::format("{:.1f} MiB", kib / 1024.0) : fmt::format("{:.2f} GiB", kib / 1048576.0);
}

std::string bench_table(const BenchResult& r) {
  std::string out =
      fmt::format("{}, scene {}, view {}, {}x{}\n{}, {}{}\n", r.chapter, r.scene, r.view, r.width, r.height, r.device,
                  r.driver, r.software ? " (software driver: these times say nothing about a GPU)" : "");
  size_t wide = 9;
  for (const PassTime& pass : r.passes) wide = std::max(wide, pass.name.size());
  out += fmt::format("  {:<{}} {:>10} {:>10} {:>10}\n", "pass", wide, "median ms", "min", "max");
  const auto line = [&](const std::string& name, const Spread& s) {
    out += fmt::format("  {:<{}} {:>10.3f} {:>10.3f} {:>10.3f}\n", name, wide, s.median, s.minimum, s.maximum);
  };
  for (const PassTime& pass : r.passes) line(pass.name, pass.ms);
  line("wall time", r.wall_ms);
  line("recording", r.record_ms);
  return out + fmt::format("  GPU total {:.3f} ms, {} held; {} frames timed after {} to warm up\n", gpu_ms(r),
                           human_bytes(r.bytes), r.repeats, r.warmup);
}

void write_knobs_json(const std::filesystem::path& file, const std::string& chapter, const std::vector<Knob>& knobs) {
  write_file_atomically(file, Json{{"chapter", chapter}, {"knobs", knobs}}.dump(2) + "\n");
}

}  // namespace welkin::measure
