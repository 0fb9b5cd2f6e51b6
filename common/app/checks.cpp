// The modes that check: --golden compares the standard views with recorded pictures, --survey draws everything else
// small.
#include <algorithm>
#include <cstdio>

#include "common/app/session.hpp"
#include "common/gpu/shader_file.hpp"
#include "common/image/atomic_file.hpp"
#include "common/image/display.hpp"
#include "common/image/exr.hpp"
#include "common/image/png.hpp"
#include "common/measure/compare.hpp"
#include "common/measure/metrics.hpp"

namespace welkin::app {
namespace {

constexpr VkExtent2D kGoldenSize{128, 72}, kSurveySize{32, 18};
// How far another driver may be from a golden: see docs/hard_cases.md for the measured differences this leaves room
// for.
constexpr double kGoldenRelativeRmse = 2e-3;
constexpr double kGoldenP99 = 5e-3;

// Expected, got and their difference in one picture beside the build's shaders, for people to look at.
void show_difference(const std::string& name, const Image& expected, const Image& got) {
  const std::filesystem::path directory = gpu::shader_directory().parent_path() / "golden",
                              file = directory / (name + ".png");
  std::error_code error;
  std::filesystem::create_directories(directory, error);  // what stands in the way is said by writing
  const float exposure = measure::choose_exposure(expected), gain = measure::choose_gain(expected, got, exposure);
  image::write_png8(file, measure::side_by_side(expected, got, exposure, gain));
  fmt::print("golden {}: expected, got, difference x {:g}: {}\n", name, gain, file.string());
}

// One program shown one view after another, as a window would: what it compiled for one serves the next.
struct Shown {
  OtherScene other;
  std::unique_ptr<Program> program;
  std::unique_ptr<Renderer> renderer;
  explicit Shown(const Session& session) : other(session) {}

  Renderer& show(const StandardView& view, VkExtent2D size) {
    other.load(view);
    if (program)
      program->rebuild();
    else
      program = other.session.make_program();
    renderer = std::make_unique<Renderer>(other.session.context, other.session.chapter, *program, size);
    draw_up_to(other.session, *renderer, view.frame);
    return *renderer;
  }
};

// What the survey found: a line for each picture.
struct Findings {
  size_t pictures = 0, wrong = 0;
  void add(const std::string& picture, const std::string& fault) {
    ++pictures;
    if (!fault.empty()) ++wrong, fmt::print("survey {}: {}\n", picture, fault);
  }
};

std::string finite_fault(const Image& picture) {
  const size_t count = count_not_finite(picture);
  return count > 0 ? fmt::format("{} pixel{} not finite", count, count == 1 ? " is" : "s are") : std::string();
}

void survey_scenes(Shown& shown, Findings& findings) {
  for (const std::string& name : shipped_scenes())
    for (const View& view : load_scene(name, scenes_directory()).views) {
      const StandardView standard{name, view.name};
      findings.add(name_of(standard, '/'), finite_fault(shown.show(standard, kSurveySize).picture()));
    }
}

// After all scenes and other sizes a program draws what a fresh one does, to the bit.
void survey_sizes(const Session& session, Shown& shown, Findings& findings) {
  const StandardView view{"sunset", "wide"};
  for (const VkExtent2D size : {VkExtent2D{1, 1}, VkExtent2D{1, 33}, VkExtent2D{129, 65}}) {
    const std::string name = fmt::format("{} {}x{}", name_of(view, '/'), size.width, size.height);
    findings.add(name, finite_fault(shown.show(view, size).picture()));
    if (size.height != 65) continue;
    Shown fresh(session);
    const Image again = fresh.show(view, size).picture(), picture = shown.renderer->picture();
    const bool same = std::ranges::equal(picture.pixels, again.pixels);
    findings.add(name + " by a fresh program", same ? "" : "not the same bits");
  }
}

std::vector<std::string> names_of(const std::vector<gpu::PassTime>& times) {
  std::vector<std::string> names;
  for (const gpu::PassTime& time : times) names.push_back(time.name);
  return names;
}

// Each medium left out: another picture, the same passes, and not a byte more.
void survey_media(Shown& shown, Findings& findings) {
  const StandardView view{"noon", "horizon"};
  Renderer& whole = shown.show(view, kSurveySize);
  // Frame 0 also ran passes that run only on a change; frame 1 is the steady state.
  draw_frame(shown.other.session, whole, 1);
  const Image picture = whole.picture();
  const std::vector<std::string> passes = names_of(whole.pass_times());
  const uint64_t bytes = shown.other.session.device.allocated_bytes();
  const Scene scene = shown.other.scene;
  const bool dark = std::ranges::all_of(picture.pixels, [](const glm::vec4& p) { return p.r + p.g + p.b == 0.0f; });
  for (const Medium& medium : scene.media) {
    shown.other.scene = scene;
    std::erase_if(shown.other.scene.media, [&](const Medium& other) { return other.kind == medium.kind; });
    shown.program->rebuild();
    for (const uint32_t frame : {0u, 1u}) draw_frame(shown.other.session, whole, frame);
    const Image without = whole.picture();
    std::string fault = finite_fault(without);
    if (!dark && std::ranges::equal(without.pixels, picture.pixels)) fault = "is the same picture";
    if (names_of(whole.pass_times()) != passes) fault = "has other passes";
    if (shown.other.session.device.allocated_bytes() > bytes) fault = "holds more bytes";
    findings.add(fmt::format("{} without {}", name_of(view, '/'), medium.kind), fault);
  }
}

}  // namespace

// [golden]
Exit run_golden(const Session& session) {
  must_have_standard_views(session);
  const std::filesystem::path directory = gpu::source_directory() / "tests" / "data" / "golden";
  // The device's name belongs to it: a software driver's tells the width of the processor's vectors.
  const std::string driver = session.device.candidate().name + ", " + session.device.candidate().driver;
  Exit result = Exit::ok;
  Shown shown(session);
  for (const StandardView& standard : session.chapter.standard_views) {
    const std::string name = fmt::format("{:02}_{}", session.chapter.number, name_of(standard, '_'));
    const std::filesystem::path file = directory / (name + ".exr"), recorded = directory / (name + ".driver");
    const bool exists = std::filesystem::exists(file);
    if (!exists && session.options.golden == Golden::check) {
      fmt::print("golden {}: missing; look at the picture, then --golden update\n", name);
      result = Exit::mismatch;
      continue;
    }
    const Image picture = shown.show(standard, kGoldenSize).picture();
    if (exists) {
      // Bit for bit on the driver that made it; elsewhere arithmetic differs in the last places.
      const bool same_driver = std::filesystem::exists(recorded) && read_file(recorded, 4096) == driver + "\n";
      const Image golden = image::read_exr(file);
      const measure::Errors errors =
          measure::compare(picture, golden, [](const glm::vec3& v) { return image::display(v, kBaseExposure); });
      const bool identical = errors.finite() && errors.max_relative == 0.0;
      const bool close =
          errors.finite() && errors.relative_rmse <= kGoldenRelativeRmse && errors.p99_relative <= kGoldenP99;
      const bool good = same_driver ? identical : close;
      fmt::print("golden {}: {} ({}; {})\n", name,
                 identical ? "identical"
                 : good    ? "close"
                           : "DIFFERS",
                 measure::describe(errors), same_driver ? "driver of the golden" : "another driver");
      if (!good && session.options.golden == Golden::check) {
        show_difference(name, golden, picture);
        result = Exit::mismatch;
      }
    }
    if (session.options.golden == Golden::update) {
      std::filesystem::create_directories(directory);
      image::write_exr(file, picture);
      write_file_atomically(recorded, driver + "\n");
      fmt::print("golden {}: written\n", name);
    }
  }
  return result;
}
// [/golden]

// Which views of which scenes are finite does not depend on their size, so they are small: a survey of all takes
// seconds.
Exit run_survey(const Session& session) {
  Shown shown(session);
  Findings findings;
  survey_scenes(shown, findings);
  survey_sizes(session, shown, findings);
  if (session.chapter.sky) survey_media(shown, findings);
  fmt::print("survey: {} pictures, {} wrong\n", findings.pictures, findings.wrong);
  return findings.wrong > 0 ? Exit::mismatch : Exit::ok;
}

}  // namespace welkin::app
