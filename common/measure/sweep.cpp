// Ladders multiplied out, and the table of a sweep. See sweep.hpp.
#include "common/measure/sweep.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "common/image/csv.hpp"

namespace welkin::measure {

std::vector<std::vector<double>> ladder_settings(const Settings& settings) {
  std::vector<std::vector<double>> rungs;
  size_t product = 1;
  for (const Knob& knob : settings.knobs()) {
    const bool climbs = !knob.ladder.empty() && !settings.was_set(knob.name);
    rungs.push_back(climbs ? knob.ladder : std::vector<double>{settings.number(knob.name)});
    product = std::min(product * rungs.back().size(), kMostCombinations + 1);
  }
  if (product <= kMostCombinations) {
    std::vector<std::vector<double>> all(product, std::vector<double>(rungs.size()));
    for (size_t i = 0; i < product; ++i)
      for (size_t knob = rungs.size(), rest = i; knob-- > 0; rest /= rungs[knob].size())
        all[i][knob] = rungs[knob][rest % rungs[knob].size()];
    return all;
  }
  std::vector<std::vector<double>> all(1);
  for (const Knob& knob : settings.knobs()) all.front().push_back(settings.number(knob.name));
  for (size_t knob = 0; knob < rungs.size(); ++knob)
    for (const double rung : rungs[knob]) {
      if (rung == all.front()[knob]) continue;
      all.push_back(all.front());
      all.back()[knob] = rung;
    }
  return all;
}

Settings with_values(Settings settings, const std::vector<double>& values) {
  const std::vector<Knob> knobs = settings.knobs();
  if (values.size() != knobs.size()) fail("{} values for {} knobs", values.size(), knobs.size());
  for (size_t i = 0; i < knobs.size(); ++i) settings.set_number(knobs[i].name, values[i]);
  return settings;
}

void write_sweep_csv(const std::filesystem::path& file, const std::vector<Knob>& knobs,
                     const std::vector<SweepRow>& rows, const SweepHeader& header) {
  std::vector<std::string> names = {"view"};
  for (const Knob& knob : knobs) names.push_back("knob:" + knob.name);
  names.insert(names.end(), {"gpu_ms_median", "gpu_ms_min", "gpu_ms_max", "wall_ms"});
  std::vector<std::string> passes;  // that any row has; a setting that leaves one out spends 0 ms on it
  for (const SweepRow& row : rows)
    for (const auto& pass : row.passes)
      if (std::find(passes.begin(), passes.end(), pass.first) == passes.end()) passes.push_back(pass.first);
  for (const std::string& pass : passes) names.push_back("pass_ms:" + pass);
  names.insert(names.end(),
               {"bytes", "relative_rmse", "max_relative", "p99_relative", "mean_bias", "rmse_255", "not_finite"});

  std::vector<std::vector<std::string>> lines;
  for (const auto& [values, view, gpu, wall, measured, bytes, e] : rows) {
    std::vector<std::string> line = {view};
    const auto add = [&](double number) { line.push_back(csv_number(number)); };
    line.insert(line.end(), values.begin(), values.end());
    for (const double ms : {gpu.median, gpu.minimum, gpu.maximum, wall.median}) add(ms);
    for (const std::string& pass : passes) {
      const auto found =
          std::find_if(measured.begin(), measured.end(), [&](const auto& one) { return one.first == pass; });
      add(found == measured.end() ? 0.0 : found->second);
    }
    line.push_back(fmt::format("{}", bytes));
    for (const double score : {e.relative_rmse, e.max_relative, e.p99_relative, e.mean_bias, e.rmse_255}) add(score);
    line.push_back(fmt::format("{}", e.not_finite + e.not_finite_reference));
    lines.push_back(std::move(line));
  }
  const std::vector<std::string> comments = {"chapter: " + header.chapter,
                                             "scene: " + header.scene,
                                             "device: " + header.device,
                                             "driver: " + header.driver,
                                             std::string("software driver: ") + (header.software ? "yes" : "no"),
                                             fmt::format("resolution: {}x{}", header.width, header.height),
                                             "reference: " + header.reference,
                                             "date: " + header.date};
  write_csv(file, comments, names, lines);
}

}  // namespace welkin::measure
