// Accuracy against time: the combinations of the knobs' ladders, measured against a reference, as a CSV for `plot`.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/knobs.hpp"
#include "common/measure/metrics.hpp"
#include "common/measure/statistics.hpp"

namespace welkin::measure {

// One value per knob for each combination of the ladders, the last knob fastest. Knobs without a ladder, and those set
// explicitly (so that --set narrows a sweep), keep the value they have in `settings`. Where that would be more than
// kMostCombinations: the settings as they are, then every knob alone up its ladder.
inline constexpr size_t kMostCombinations = 300;
std::vector<std::vector<double>> ladder_settings(const Settings& settings);

Settings with_values(Settings settings, const std::vector<double>& values);  // one value per knob, in order

struct SweepRow {
  std::vector<std::string> values;  // one text per knob (Settings::text)
  std::string view;
  Spread gpu_ms, wall_ms;
  std::vector<std::pair<std::string, double>> passes;  // name, median in ms; of a pass that did not run, nothing
  uint64_t bytes = 0;
  Errors errors;
};

// What the numbers were measured on and against; written as comment lines.
struct SweepHeader {
  std::string chapter, scene, device, driver;
  bool software = false;
  uint32_t width = 0, height = 0;
  std::string reference;  // "view.steps=1024 light.steps=256", "path tracer, 4096 paths per pixel"
  std::string date;
};

// Columns: view, knob:NAME..., gpu_ms_median, gpu_ms_min, gpu_ms_max, wall_ms, pass_ms:NAME..., bytes, relative_rmse,
// max_relative, p99_relative, mean_bias, rmse_255, not_finite. A row with NaN or infinities has scores "nan".
void write_sweep_csv(const std::filesystem::path& file, const std::vector<Knob>& knobs,
                     const std::vector<SweepRow>& rows, const SweepHeader& header);

}  // namespace welkin::measure
