// The command line, with CLI11 (whose header is slow to compile and so appears here only). See options.hpp.
#include <CLI/CLI.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <variant>

#include "common/app/options.hpp"
#include "common/error.hpp"
#include "common/image/image.hpp"
#include "common/scene/scene_knobs.hpp"

namespace welkin::app {
namespace {

constexpr uint32_t kMaximumSupersample = 8;

VkExtent2D parse_size(const std::string& text) {
  const size_t cross = text.find('x');
  double width = 0.0, height = 0.0;
  const bool numbers = cross != std::string::npos && parse_number(text.substr(0, cross), width) &&
                       parse_number(text.substr(cross + 1), height);
  const auto side = [](double v) { return v >= 1.0 && v <= kMaxImageSide && v == std::floor(v); };
  if (!numbers || !side(width) || !side(height))
    fail("--size {}: expected WIDTHxHEIGHT in whole pixels, each from 1 to {}, for example --size 1280x720", text,
         kMaxImageSide);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

// Which of the names it is: the first is 0.
int parse_choice(const char* option, const std::string& text, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) fail("{} {}: accepted is one of {}", option, text, fmt::join(names, ", "));
  return static_cast<int>(found - names.begin());
}

uint32_t parse_whole(const char* option, const std::string& text, double low, double high) {
  double value = 0.0;
  if (!parse_number(text, value) || value < low || value > high || value != std::floor(value))
    fail("{} {}: expected a whole number from {:.0f} to {:.0f}", option, text, low, high);
  return static_cast<uint32_t>(value);
}

std::string range_of(const Knob& knob) {
  if (!knob.choices.empty()) return fmt::format("{}", fmt::join(knob.choices, "|"));
  return fmt::format("{:g}..{:g}{}{}", knob.minimum, knob.maximum, knob.unit.empty() ? "" : " ", knob.unit);
}

std::string describe_knobs(const char* heading, const std::vector<Knob>& knobs) {
  std::string text = heading;
  for (const Knob& knob : knobs) {
    const std::string initial =
        knob.choices.empty() ? fmt::format("{:g}", knob.initial) : knob.choices.at(static_cast<size_t>(knob.initial));
    text += fmt::format("\n  {:<22} {} [{}; default {}]", knob.name, knob.meaning, range_of(knob), initial);
  }
  return text;
}

std::string footer(const Chapter& chapter) {
  std::string text = describe_knobs("Knobs (--set key=value):", chapter.knobs);
  if (chapter.knobs.empty()) text += " none in this chapter";
  if (chapter.sky) {
    Scene scene;
    scene.media.push_back({.kind = "mie", .phase = Phase::cornette_shanks, .g = 0.8});
    text += "\n" + describe_knobs("Of the scene (default: what the scene says; here the neutral values):",
                                  scene_knobs(scene, has_meter(chapter)));
  }
  return text +
         "\nExit codes: 0 ok, 1 mismatch, 2 usage or bad input, 3 validation message, 77 skipped (no Vulkan device).";
}

// What is text on the command line and something else in Options.
struct Texts {
  std::string size, validation, golden, frames, seed, time, supersample;
  std::vector<std::string> set, dump;
};

// An option: where in --help it stands, what its value is called there ("": it has none), where that goes, its meaning.
struct Row {
  const char *group, *name, *value;
  std::variant<bool*, std::string*, std::vector<std::string>*> target;
  std::string meaning;
};

std::vector<Row> rows(Options& options, Texts& texts, const Chapter& chapter) {
  const std::string images =
      fmt::format(", or an image (.exr, or .png as exposed): {}", fmt::join(chapter.images, ", "));
  return {
      {"device", "--list-gpus", "", &options.list_gpus, "List the Vulkan devices and stop"},
      {"device", "--gpu", "N|NAME", &options.gpu, "Device to use: its number in --list-gpus or part of its name"},
      {"device", "--validation", "off|on|sync", &texts.validation, "Validation layers: off, on, sync"},
      {"device", "--require-gpu", "", &options.require_gpu,
       "No Vulkan device is an error (exit 2), not a skip (exit 77)"},

      {"picture", "--headless", "", &options.headless, "Draw without a window, into a file"},
      {"picture", "--size", "WxH", &texts.size, "Picture size in pixels [1280x720]"},
      {"picture", "--frames", "N", &texts.frames,
       "Frames to draw, then stop [headless 1, of a path 24 a second; window: until closed]"},
      {"picture", "--scene", "NAME|FILE", &options.scene,
       fmt::format("Scene by name, .toml file, or a picture a chapter wrote [{}]", chapter.default_scene)},
      {"picture", "--view", "NAME", &options.view, "View of the scene [its first]"},
      {"picture", "--path", "NAME|FILE", &options.path,
       "Moving camera: a [[path]] of the scene, or the first of another scene file"},
      {"picture", "--set", "key=value", &texts.set, "Set a knob (repeatable)"},
      {"picture", "--seed", "N", &texts.seed, "Seed of everything random [1]"},
      {"picture", "--time", "T", &texts.time,
       "Seconds after the moment of the sun's angles: it moves 15 degrees an hour [the scene's]"},

      {"output", "--output", "FILE", &options.output,
       fmt::format("Write the (last) picture: .png displayed, .exr linear [out/{}.png]", chapter.name)},
      {"output", "--supersample", "N", &texts.supersample,
       "Draw the picture N times as large each way and average it, without a window [1]"},
      {"output", "--dump", "WHAT FILE", &texts.dump,
       "Write 'picture' (.exr), 'displayed' (.png), 'knobs' (.json)" + (chapter.images.empty() ? "" : images)},
      {"output", "--explain", "", &options.explain,
       "Say which effects are simulated, why, with passes, bytes and time"},

      {"measure", "--bench", "FILE.json", &options.bench, "Measure repeated frames and write JSON"},
      {"measure", "--sweep", "FILE.csv", &options.sweep,
       "Measure error against time over the knobs' ladders and write CSV"},
      {"measure", "--probe", "RAYS.csv", &options.probe,
       "Rays to evaluate: altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg"},
      {"measure", "--probe-out", "FILE.csv", &options.probe_out, "Where the rays' radiance and transmittance go"},
      {"measure", "--against", "FILE.exr", &options.against, "Print the errors of the picture against this one"},

      {"tests", "--golden", "check|update", &texts.golden,
       "Compare the standard views with the goldens, or write them anew"},
      {"tests", "--survey", "", &options.survey,
       "Draw every shipped scene, view and odd sizes, small, and say what is wrong"},
      {"tests", "--inject", "FAULT", &options.inject,
       "Plant a fault: nan, missing-barrier, wrong-constant, missing-feature"},
  };
}

void add_options(CLI::App& cli, const std::vector<Row>& all) {
  for (const Row& row : all) {
    cli.option_defaults()->group(row.group);
    if (bool* const* flag = std::get_if<bool*>(&row.target))
      cli.add_flag(row.name, **flag, row.meaning);
    else if (std::string* const* text = std::get_if<std::string*>(&row.target))
      cli.add_option(row.name, **text, row.meaning)->type_name(row.value);
    else
      cli.add_option(row.name, *std::get<2>(row.target), row.meaning)->type_name(row.value);
  }
  cli.get_option("--set")->allow_extra_args(false);
  cli.get_option("--dump")->expected(2);
}

// False if --help is all that was asked.
bool parse_line(CLI::App& cli, int argc, char** argv) {
  try {
    cli.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << cli.help();
    return false;
  } catch (const CLI::ParseError& error) {
    std::string line = error.what();
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    fail("{}; see {} --help", line, cli.get_name());
  }

  for (const CLI::Option* option : cli.get_options())
    for (const std::string& value : option->results())
      if (value.empty()) fail("{}: the value is empty; see {} --help", option->get_name(), cli.get_name());
  return true;
}

void check_combination(const Options& options, const Texts& texts) {
  const int modes = !options.bench.empty() + !options.sweep.empty() + !options.probe.empty() + !texts.golden.empty() +
                    options.survey + options.list_gpus +
                    (options.explain || !options.against.empty() || !texts.dump.empty());
  if (modes > 1)
    fail(
        "one thing at a time: --list-gpus, --bench, --sweep, --probe, --golden, --survey, or a picture with --explain, "
        "--dump, --against");
  const bool other_view = !options.scene.empty() || !options.view.empty() || !options.path.empty() ||
                          !texts.size.empty() || !texts.seed.empty() || !texts.time.empty() || !texts.frames.empty() ||
                          !options.output.empty();
  if ((!texts.golden.empty() || options.survey) && other_view)
    fail(
        "--golden and --survey draw views of their own and write none: without --scene, --view, --path, --size, "
        "--seed, "
        "--time, --frames, --output");
  if (!texts.golden.empty() && (!texts.set.empty() || (texts.golden == "update" && !options.inject.empty())))
    fail("--golden draws the standard views as they are: without --set, and --golden update without --inject");
}

// From texts to options, each checked by itself.
void take_texts(Options& options, const Texts& texts) {
  if (!texts.size.empty()) options.size = parse_size(texts.size), options.size_given = true;
  if (!texts.frames.empty()) options.frames = parse_whole("--frames", texts.frames, 1, 1000000);
  if (!texts.supersample.empty()) {
    options.supersample = parse_whole("--supersample", texts.supersample, 1, kMaximumSupersample);
    options.headless = true;
    if (options.list_gpus || !options.bench.empty() || !options.sweep.empty() || !options.probe.empty() ||
        !texts.golden.empty() || options.survey)
      fail("--supersample is for pictures: not with --list-gpus, --bench, --sweep, --probe, --golden or --survey");
  }
  if (!texts.seed.empty()) options.seed = parse_whole("--seed", texts.seed, 0, 2147483647);
  if (!texts.time.empty() && (!parse_number(texts.time, options.time_s.emplace()) || std::abs(*options.time_s) > 1e9))
    fail("--time {}: expected seconds from -1e9 to 1e9", texts.time);
  if (!options.path.empty() && !options.view.empty())
    fail("--path {} beside --view {}: one of the two", options.path, options.view);
  if (!texts.validation.empty())
    options.validation = gpu::Validation(parse_choice("--validation", texts.validation, {"off", "on", "sync"}));
  if (!texts.golden.empty())
    options.golden = parse_choice("--golden", texts.golden, {"check", "update"}) ? Golden::update : Golden::check;
  if (!options.inject.empty())
    parse_choice("--inject", options.inject, {"nan", "missing-barrier", "wrong-constant", "missing-feature"});
  for (const std::string& assignment : texts.set) options.set.push_back(split_assignment(assignment));
}

void take_dump(const Chapter& chapter, Options& options, const std::vector<std::string>& dump) {
  if (dump.empty()) return;
  std::vector<std::string> known{"picture", "displayed", "knobs"};
  known.insert(known.end(), chapter.images.begin(), chapter.images.end());
  parse_choice("--dump", dump[0], known);
  options.dump_what = dump[0], options.dump_file = dump[1];
  const std::string extension = dump[0] == "knobs" ? ".json" : dump[0] == "displayed" ? ".png" : ".exr";
  const bool shown = dump[0] != "picture" && extension == ".exr" && options.dump_file.ends_with(".png");
  if (!options.dump_file.ends_with(extension) && !shown)
    fail("--dump {} {}: the name must end in {}", dump[0], dump[1], extension);
}

// Where results go is looked at before the work is done, not after.
void check_files(const Options& options) {
  for (const std::string& file : {options.output, options.dump_file, options.bench, options.sweep, options.probe_out}) {
    if (file.empty()) continue;
    const std::filesystem::path target(file), parent = target.has_parent_path() ? target.parent_path() : ".";
    std::error_code ignored;
    if (!std::filesystem::is_directory(parent, ignored))
      fail("cannot write '{}': no directory '{}'", file, parent.string());
    if (std::filesystem::is_directory(target, ignored)) fail("cannot write '{}': it is a directory", file);
  }
  if (options.probe.empty() != options.probe_out.empty()) fail("--probe RAYS.csv and --probe-out FILE.csv go together");
  if (!options.output.empty() && !options.output.ends_with(".png") && !options.output.ends_with(".exr"))
    fail("--output {}: the name must end in .png or .exr", options.output);
}

}  // namespace

bool parse_options(int argc, char** argv, const Chapter& chapter, Options& options) {
  CLI::App cli{fmt::format("Welkin {:02}: {}\n{}", chapter.number, chapter.title, chapter.whats_new), chapter.name};
  cli.footer(footer(chapter));
  Texts texts;
  add_options(cli, rows(options, texts, chapter));
  if (!parse_line(cli, argc, argv)) return false;
  check_combination(options, texts);
  take_texts(options, texts);
  take_dump(chapter, options, texts.dump);
  check_files(options);
  return true;
}

}  // namespace welkin::app
