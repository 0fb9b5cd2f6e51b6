// What is handed on as JSON: a benchmark (what ran where, how long each pass took, how many bytes it holds), and the
// knobs of a chapter.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/knobs.hpp"
#include "common/measure/statistics.hpp"

namespace welkin::measure {

struct PassTime {
  std::string name;
  Spread ms;  // GPU timestamps
};

struct BenchResult {
  std::string chapter, scene, view, device, driver;
  bool software = false;  // a driver that computes on the CPU: its times say nothing about a GPU
  uint32_t width = 0, height = 0;
  std::map<std::string, std::string> settings;  // knob, value as text
  std::vector<PassTime> passes;
  Spread wall_ms;               // one frame as the CPU sees it: recorded, submitted, finished
  Spread record_ms;             // of that, what the CPU takes to record its commands
  uint64_t bytes = 0;           // device memory held
  int warmup = 0, repeats = 0;  // frames run before the timing, and timed
  std::string date;             // ISO 8601, UTC
};

double gpu_ms(const BenchResult& result);  // sum of the passes' medians

void write_bench(const std::filesystem::path& file, const BenchResult& result);  // JSON, atomically
BenchResult read_bench(const std::filesystem::path& file);  // Error naming the file and what is missing or wrong

// For people: device, one line per pass, wall time, total, memory. Ends with a line break.
std::string bench_table(const BenchResult& result);

std::string human_bytes(uint64_t bytes);  // "12.3 MiB"

// {"chapter": …, "knobs": [the members of Knob]}, from which the book's tables are woven; values of a choice are
// indices into its names.
void write_knobs_json(const std::filesystem::path& file, const std::string& chapter, const std::vector<Knob>& knobs);

}  // namespace welkin::measure
