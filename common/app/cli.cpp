// The command line, with CLI11 (whose header is slow to compile and so appears here only). See options.hpp.
#include <CLI/CLI.hpp>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "common/app/options.hpp"
#include "common/error.hpp"
#include "common/scene/scene_knobs.hpp"

namespace welkin::app {
namespace {

constexpr uint32_t kMaximumSide = 16384;
constexpr uint32_t kMaximumSupersample = 8;

VkExtent2D parse_size(const std::string& text) {
  const size_t cross = text.find('x');
  double width = 0.0, height = 0.0;
  const bool numbers = cross != std::string::npos && parse_number(text.substr(0, cross), width) &&
                       parse_number(text.substr(cross + 1), height);
  const auto side = [](double v) {
    return v >= 1.0 && v <= kMaximumSide && v == static_cast<double>(static_cast<uint32_t>(v));
  };
  if (!numbers || !side(width) || !side(height))
    fail("--size {}: expected WIDTHxHEIGHT in whole pixels, each from 1 to {}, for example --size 1280x720", text,
         kMaximumSide);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

template <typename T>
T parse_choice(const char* option, const std::string& text, const std::vector<std::pair<std::string, T>>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) {
    if (name == text) return value;
    names.push_back(name);
  }
  fail("{} {}: accepted is one of {}", option, text, fmt::join(names, ", "));
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

void add_device_options(CLI::App& cli, Options& options, Texts& texts) {
  cli.option_defaults()->group("device");
  cli.add_flag("--list-gpus", options.list_gpus, "List the Vulkan devices and stop");
  cli.add_option("--gpu", options.gpu, "Device to use: its number in --list-gpus or part of its name")
      ->type_name("N|NAME");
  cli.add_option("--validation", texts.validation, "Validation layers: off, on, sync")->type_name("off|on|sync");
  cli.add_flag("--require-gpu", options.require_gpu, "No Vulkan device is an error (exit 2), not a skip (exit 77)");
}

void add_picture_options(CLI::App& cli, Options& options, Texts& texts, const Chapter& chapter) {
  cli.option_defaults()->group("picture");
  cli.add_flag("--headless", options.headless, "Draw without a window, into a file");
  cli.add_option("--size", texts.size, "Picture size in pixels [1280x720]")->type_name("WxH");
  cli.add_option("--frames", texts.frames,
                 "Frames to draw, then stop [headless 1, of a path 24 a second; window: until closed]")
      ->type_name("N");
  cli.add_option("--scene", options.scene,
                 fmt::format("Scene by name, .toml file, or a picture a chapter wrote [{}]", chapter.default_scene))
      ->type_name("NAME|FILE");
  cli.add_option("--view", options.view, "View of the scene [its first]")->type_name("NAME");
  cli.add_option("--path", options.path, "Moving camera: a [[path]] of the scene, or the first of another scene file")
      ->type_name("NAME|FILE");
  cli.add_option("--set", texts.set, "Set a knob (repeatable)")->type_name("key=value")->allow_extra_args(false);
  cli.add_option("--seed", texts.seed, "Seed of everything random [1]")->type_name("N");
  cli.add_option("--time", texts.time,
                 "Seconds after the moment of the sun's angles: it moves 15 degrees an hour [the scene's]")
      ->type_name("T");
}

void add_output_options(CLI::App& cli, Options& options, Texts& texts, const Chapter& chapter) {
  cli.option_defaults()->group("output");
  cli.add_option("--output", options.output,
                 "Write the (last) picture: .png displayed, .exr linear [out/" + chapter.name + ".png]")
      ->type_name("FILE");
  cli.add_option("--supersample", texts.supersample,
                 "Draw the picture N times as large each way and average it, without a window [1]")
      ->type_name("N");
  cli.add_option("--dump", texts.dump,
                 "Write 'picture' (.exr), 'displayed' (.png), 'knobs' (.json)" +
                     (chapter.images.empty() ? std::string()
                                             : fmt::format(", or an image (.exr, or .png as exposed): {}",
                                                           fmt::join(chapter.images, ", "))))
      ->type_name("WHAT FILE")
      ->expected(2);
  cli.add_flag("--explain", options.explain, "Say which effects are simulated, why, with passes, bytes and time");
}

void add_measure_options(CLI::App& cli, Options& options) {
  cli.option_defaults()->group("measure");
  cli.add_option("--bench", options.bench, "Measure repeated frames and write JSON")->type_name("FILE.json");
  cli.add_option("--sweep", options.sweep, "Measure error against time over the knobs' ladders and write CSV")
      ->type_name("FILE.csv");
  cli.add_option("--probe", options.probe,
                 "Rays to evaluate: altitude_km,view_zenith_deg,sun_zenith_deg,relative_azimuth_deg")
      ->type_name("RAYS.csv");
  cli.add_option("--probe-out", options.probe_out, "Where the rays' radiance and transmittance go")
      ->type_name("FILE.csv");
  cli.add_option("--against", options.against, "Print the errors of the picture against this one")
      ->type_name("FILE.exr");
}

void add_test_options(CLI::App& cli, Options& options, Texts& texts) {
  cli.option_defaults()->group("tests");
  cli.add_option("--golden", texts.golden, "Compare the standard views with the goldens, or write them anew")
      ->type_name("check|update");
  cli.add_option("--inject", options.inject,
                 "Plant a fault: nan, missing-barrier, graph-barrier, wrong-constant, missing-feature")
      ->type_name("FAULT");
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
                    options.list_gpus + (options.explain || !options.against.empty() || !texts.dump.empty());
  if (modes > 1)
    fail(
        "one thing at a time: --list-gpus, --bench, --sweep, --probe, --golden, or a picture with --explain, --dump, "
        "--against");
  if (!texts.golden.empty() && (!texts.set.empty() || (texts.golden == "update" && !options.inject.empty())))
    fail("--golden draws the standard views as they are: without --set, and --golden update without --inject");
}

uint32_t parse_whole(const char* option, const std::string& text, double low, double high) {
  double value = 0.0;
  if (!parse_number(text, value) || value < low || value > high || value != std::floor(value))
    fail("{} {}: expected a whole number from {:.0f} to {:.0f}", option, text, low, high);
  return static_cast<uint32_t>(value);
}

// From texts to options, each checked by itself.
void take_texts(const CLI::App& cli, Options& options, const Texts& texts) {
  if (!texts.size.empty()) options.size = parse_size(texts.size), options.size_given = true;
  if (cli.count("--size") > 0 && texts.size.empty()) parse_size(texts.size);
  if (cli.count("--frames") > 0) options.frames = parse_whole("--frames", texts.frames, 1, 1000000);
  if (cli.count("--supersample") > 0) {
    options.supersample = parse_whole("--supersample", texts.supersample, 1, kMaximumSupersample);
    options.headless = true;
    if (options.list_gpus || !options.bench.empty() || !options.sweep.empty() || !options.probe.empty() ||
        !texts.golden.empty())
      fail("--supersample is for pictures: not with --list-gpus, --bench, --sweep, --probe or --golden");
  }
  if (cli.count("--seed") > 0) options.seed = parse_whole("--seed", texts.seed, 0, 2147483647);
  if (cli.count("--time") > 0 &&
      (!parse_number(texts.time, options.time_s.emplace()) || std::abs(*options.time_s) > 1e9))
    fail("--time {}: expected seconds from -1e9 to 1e9", texts.time);
  if (!options.path.empty() && !options.view.empty())
    fail("--path {} beside --view {}: one of the two", options.path, options.view);
  if (cli.count("--validation") > 0)
    options.validation = parse_choice<gpu::Validation>(
        "--validation", texts.validation,
        {{"off", gpu::Validation::off}, {"on", gpu::Validation::on}, {"sync", gpu::Validation::sync}});
  if (cli.count("--golden") > 0)
    options.golden =
        parse_choice<Golden>("--golden", texts.golden, {{"check", Golden::check}, {"update", Golden::update}});
  if (cli.count("--inject") > 0)
    parse_choice<int>(
        "--inject", options.inject,
        {{"nan", 0}, {"missing-barrier", 0}, {"graph-barrier", 0}, {"wrong-constant", 0}, {"missing-feature", 0}});
  for (const std::string& assignment : texts.set) options.set.push_back(split_assignment(assignment));
}

void take_dump(const Chapter& chapter, Options& options, const std::vector<std::string>& dump) {
  if (dump.empty()) return;
  std::vector<std::pair<std::string, int>> known{{"picture", 0}, {"displayed", 0}, {"knobs", 0}};
  for (const std::string& image : chapter.images) known.emplace_back(image, 0);
  parse_choice<int>("--dump", dump[0], known);
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
  add_device_options(cli, options, texts);
  add_picture_options(cli, options, texts, chapter);
  add_output_options(cli, options, texts, chapter);
  add_measure_options(cli, options);
  add_test_options(cli, options, texts);
  if (!parse_line(cli, argc, argv)) return false;
  check_combination(options, texts);
  take_texts(cli, options, texts);
  take_dump(chapter, options, texts.dump);
  check_files(options);
  return true;
}

}  // namespace welkin::app
