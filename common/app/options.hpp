// The one command line of every chapter, parsed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/app/chapter.hpp"
#include "common/gpu/instance.hpp"

namespace welkin::app {

enum class Golden { none, check, update };

struct Options {
  // device
  bool list_gpus = false;
  std::string gpu;
  gpu::Validation validation = gpu::Validation::off;
  bool require_gpu = false;
  // picture
  bool headless = false;
  VkExtent2D size{1280, 720};
  bool size_given = false;
  uint32_t frames = 0;  // 0: one picture headless, until closed in a window
  std::string scene;
  std::string view;
  std::string path;  // of the scene, or a scene file whose first path it is
  std::vector<std::pair<std::string, std::string>> set;
  uint32_t seed = 1;
  std::optional<double> time_s;
  // output
  std::string output;
  uint32_t supersample = 1;  // a headless picture is drawn as many times as large each way, and averaged
  std::string dump_what, dump_file;
  bool explain = false;
  // measure
  std::string bench, sweep, probe, probe_out, against;
  // tests
  Golden golden = Golden::none;
  bool survey = false;
  std::string inject;
};

// Parses argv for a chapter. Prints --help and returns false if that is all that was asked.
// Throws Error (Exit::usage) with one line for anything it does not accept.
bool parse_options(int argc, char** argv, const Chapter& chapter, Options& options);

}  // namespace welkin::app
