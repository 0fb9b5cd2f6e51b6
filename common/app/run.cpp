// main() of every chapter: from the command line to the mode asked for, and from any Error to one line and an exit
// code.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "common/app/session.hpp"
#include "common/gpu/shader_file.hpp"
#include "common/image/atomic_file.hpp"
#include "common/image/exr.hpp"
#include "common/image/png.hpp"
#include "common/measure/bench_json.hpp"
#include "common/scene/one_line.hpp"
#include "common/scene/path.hpp"
#include "common/scene/scene_knobs.hpp"

namespace welkin::app {
namespace {

bool display_announced() {
  const auto set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  return set("DISPLAY") || set("WAYLAND_DISPLAY");
}

void print_devices(const std::vector<gpu::Candidate>& candidates) {
  for (size_t i = 0; i < candidates.size(); ++i)
    fmt::print("{} {} ({}){}{}\n", i, candidates[i].name, candidates[i].driver,
               candidates[i].software ? " software" : "",
               candidates[i].lacks.empty() ? "" : fmt::format(" lacks {}", fmt::join(candidates[i].lacks, ", ")));
}

// Adds one of another scene, unless it is there.
template <typename One>
void bring(std::vector<One>& list, const One& one, const std::string& from) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const One& other) { return other.name == one.name; });
  if (found == list.end())
    list.push_back(one);
  else if (!(*found == one))
    fail("--path {}: this scene has another '{}': accepted are names of their own", from, one.name);
}

// Brings the first path of another scene file, and the views that it passes, into this one. Returns its name.
std::string bring_path(const std::string& file, Scene& scene) {
  const Scene other = load_scene(file, scenes_directory());
  const Path& path = other.path("");
  for (const std::string& name : path.views) bring(scene.views, other.view(name), file);
  bring(scene.paths, path, file);
  if (!path.moment_s.empty() && !scene.sun.latitude_deg)
    fail("--path {}: path '{}' has moment_s and scene '{}' no latitude: {}", file, path.name, scene.name,
         kNeedsLatitude);
  return path.name;
}

Exit run_mode(const Chapter& chapter, Options& options) {
  const bool instrument = !options.bench.empty() || !options.sweep.empty() || !options.probe.empty() ||
                          options.golden != Golden::none || options.survey || options.explain ||
                          !options.against.empty() || !options.dump_what.empty();
  Scene scene;
  Settings settings;
  load_scene_and_settings(chapter, options.scene.empty() ? chapter.default_scene : options.scene, options.set,
                          options.time_s, scene, settings);
  if (options.path.ends_with(".toml") || options.path.ends_with(".png")) options.path = bring_path(options.path, scene);
  if (!options.path.empty()) scene.path(options.path);
  scene.view(options.view);  // an unknown view is said before any device is looked for
  if (options.dump_what == "knobs") {
    measure::write_knobs_json(options.dump_file, chapter.name, settings.knobs());
    return Exit::ok;
  }

  // [devices]
  const bool windowed = chapter.window && !options.headless && !instrument && !options.list_gpus && display_announced();
  const std::unique_ptr<WindowSystem> window_system = windowed ? chapter.window() : nullptr;
  gpu::Instance instance(options.validation,
                         windowed ? window_system->vulkan_extensions() : std::vector<const char*>{});
  const std::vector<gpu::Candidate> candidates = gpu::list_devices(instance, options.inject);
  if (options.list_gpus) {
    print_devices(candidates);
    return Exit::ok;
  }
  gpu::Device device(instance, gpu::choose_device(candidates, options.gpu), windowed);
  // [/devices]

  Session session{chapter, options, scene, settings, instance, device, {device, scene, settings, options.inject}};
  Exit result = Exit::ok;
  if (options.golden != Golden::none)
    result = run_golden(session);
  else if (options.survey)
    result = run_survey(session);
  else if (!options.probe.empty())
    result = run_probe(session);
  else if (!options.sweep.empty())
    result = run_sweep(session);
  else if (!options.bench.empty())
    result = run_bench(session);
  else if (windowed)
    result = window_system->show(session);
  else
    result = run_picture(session);

  if (result == Exit::ok && !instance.validation_messages().empty()) {
    std::fprintf(stderr, "%s: %zu validation message(s)\n", chapter.name.c_str(),
                 instance.validation_messages().size());
    result = Exit::validation;
  }
  return result;
}

}  // namespace

std::filesystem::path scenes_directory() { return gpu::source_directory() / "chapters" / "scenes"; }

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator i(scenes_directory(), error), end; !error && i != end; i.increment(error))
    if (i->path().extension() == ".toml") names.push_back(i->path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

void load_scene_and_settings(const Chapter& chapter, const std::string& scene_name,
                             const std::vector<std::pair<std::string, std::string>>& set, std::optional<double> time_s,
                             Scene& scene, Settings& settings) {
  scene = load_scene(scene_name, scenes_directory());
  std::vector<Knob> knobs = chapter.knobs;
  if (chapter.sky) knobs = joined(std::move(knobs), scene_knobs(scene, has_meter(chapter)));
  settings = Settings(std::move(knobs));
  // A picture of another chapter may carry knobs this one lacks: the scene's are hints, the command line's are orders.
  for (const auto& [name, text] : scene.settings)
    if (settings.has(name)) settings.set(name, text);
  for (const auto& [name, text] : set) settings.set(name, text);
  apply_scene_knobs(settings, scene);
  scene.time_s = time_s.value_or(scene.time_s);
  if (scene.time_s != 0.0 && chapter.sky && !scene.sun.latitude_deg)
    fail("--time {}: scene '{}' has no latitude: {}", scene.time_s, scene.name, kNeedsLatitude);
}

OtherScene::OtherScene(const Session& from)
    : options(from.options), session{from.chapter,
                                     options,
                                     scene,
                                     settings,
                                     from.instance,
                                     from.device,
                                     {from.device, scene, settings, options.inject}} {}

void OtherScene::load(const StandardView& view) {
  (view.frames > 0 ? options.path : options.view) = view.view;
  (view.frames > 0 ? options.view : options.path).clear();
  options.frames = view.frames;
  load_scene_and_settings(session.chapter, view.scene, options.set, options.time_s, scene, settings);
}

std::string name_of(const StandardView& view, char between) {
  const std::string frame = view.frames > 0 ? fmt::format("_{}_of_{}", view.frame, view.frames) : "";
  return fmt::format("{}{}{}{}", view.scene, between, view.view, frame);
}

void must_have_standard_views(const Session& session) {
  if (session.chapter.standard_views.empty()) fail("{} has no standard views to measure", session.chapter.name);
}

uint32_t Session::frame_count() const {
  if (options.frames > 0 || options.path.empty()) return std::max(options.frames, 1u);
  const Path& path = scene.path(options.path);
  return static_cast<uint32_t>(std::clamp(24.0 * (path.time_s.back() - path.time_s.front()), 1.0, 1e6)) + 1;
}

Shot Session::shot(uint32_t index) const {
  const double radius_km = scene.planet.ground_radius_km;
  if (options.path.empty()) return {pose_of(scene.view(options.view), radius_km), scene.time_s, kHeadlessFrameSeconds};
  const Path& path = scene.path(options.path);
  const double begin_s = path.time_s.front(), seconds = path.time_s.back() - begin_s;
  const double step_s = seconds / std::max(frame_count() - 1, 1u);
  const PathPoint point = point_on(scene, path, begin_s + std::min(index * step_s, seconds));
  return {pose_of(point.view, radius_km), point.moment_s, step_s};
}

std::string restoring_text(const Session& session, const CameraPose& pose, const std::filesystem::path& directory) {
  Scene scene = session.scene;
  std::erase_if(scene.views, [](const View& view) { return view.name == kRestoredView; });
  scene.views.insert(scene.views.begin(), view_of(pose, scene.planet.ground_radius_km));
  std::erase_if(scene.paths,
                [](const Path& path) { return std::count(path.views.begin(), path.views.end(), kRestoredView) > 0; });
  scene.settings.clear();
  for (const Knob& knob : session.chapter.knobs)
    if (session.settings.was_set(knob.name)) scene.settings.emplace_back(knob.name, session.settings.text(knob.name));
  each_file(scene, [&](std::string& file) { file = portable_path(file, directory); });
  const std::string text = write_scene(scene);
  if (!(parse_scene(text, "the scene of this picture") == scene))
    fail("this scene cannot be restored from what is written of it");
  return text;
}

void write_output(const Session& session, const std::string& file, const CameraPose& pose, const Image& picture,
                  const Image8& displayed) {
  if (file.ends_with(".exr")) return image::write_exr(file, picture);
  image::write_png8(file, displayed,
                    {{"welkin.scene", restoring_text(session, pose, std::filesystem::path(file).parent_path())},
                     {"welkin.chapter", session.chapter.name}});
}

bool has_meter(const Chapter& chapter) {
  return std::any_of(chapter.effects.begin(), chapter.effects.end(),
                     [](const Effect& effect) { return effect.name == "exposure"; });
}

std::unique_ptr<Program> make_program(const Chapter& chapter, const Context& context) {
  if (chapter.make) return chapter.make(context);
  return std::make_unique<Composition>(context, chapter.effects, chapter.probe);
}

int run(int argc, char** argv, Chapter chapter) {
  if (!chapter.effects.empty()) chapter.knobs = knobs_of(chapter.effects, chapter.number);
  bool require_gpu = false;
  try {
    Options options;
    if (!parse_options(argc, argv, chapter, options)) return static_cast<int>(Exit::ok);
    require_gpu = options.require_gpu;
    const Exit result = run_mode(chapter, options);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) fail("standard output cannot be written");
    return static_cast<int>(result);
  } catch (const Error& error) {
    const bool skipped = error.exit_code == Exit::skipped && !require_gpu;
    std::fprintf(stderr, "%s: %s%s\n", chapter.name.c_str(), skipped ? "skipped: " : "",
                 one_line(error.what()).c_str());
    return static_cast<int>(error.exit_code == Exit::skipped && require_gpu ? Exit::usage : error.exit_code);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", chapter.name.c_str(), one_line(error.what()).c_str());
    return static_cast<int>(Exit::usage);
  }
}

}  // namespace welkin::app
