// The measuring modes: --bench, --sweep, --probe.
#include <fmt/chrono.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "common/app/progress.hpp"
#include "common/app/session.hpp"
#include "common/image/csv.hpp"
#include "common/image/display.hpp"
#include "common/measure/bench_json.hpp"
#include "common/measure/metrics.hpp"
#include "common/measure/sweep.hpp"
#include "common/scene/scene_knobs.hpp"

namespace welkin::app {
namespace {

constexpr uint32_t kWarmUp = 3;
constexpr uint32_t kRepeats = 20;
constexpr double kTimedSeconds = 3.0;    // no setting is repeated longer than this
constexpr double kWarmUpSeconds = 0.15;  // on hardware: an idle GPU takes a tenth of a second to raise its clock
constexpr VkExtent2D kSweepSize{320, 180};

std::string now_utc() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

struct Timings {
  std::vector<measure::PassTime> passes;
  measure::Spread gpu, wall, record;
};

// Warm-up (on hardware for kWarmUpSeconds at least), then repeated frames until `repeats` or kTimedSeconds; three
// frames are timed however long they take, if as many are asked for.
// For a path: its frames, repeated.
Timings time_frames(const Session& session, Renderer& renderer, uint32_t warm_up, uint32_t repeats) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  };
  const double wait = session.device.candidate().software ? 0.0 : kWarmUpSeconds;
  const Clock::time_point begin = Clock::now();
  for (uint32_t i = 0; i < warm_up || seconds_since(begin) < wait; ++i)
    draw_frame(session, renderer, session.options.path.empty() ? i : i % session.frame_count());
  std::vector<std::pair<std::string, std::vector<double>>> per_pass;  // one that skips frames keeps its own
  std::vector<double> gpu, wall, record;
  const Clock::time_point start = Clock::now();
  for (uint32_t i = 0; i < repeats; ++i) {
    const Clock::time_point before = Clock::now();
    draw_frame(session, renderer, session.options.path.empty() ? warm_up + i : (warm_up + i) % session.frame_count());
    wall.push_back(std::chrono::duration<double, std::milli>(Clock::now() - before).count());
    record.push_back(renderer.record_ms());
    double sum = 0.0;
    for (const gpu::PassTime& time : renderer.pass_times()) {
      auto same =
          std::find_if(per_pass.begin(), per_pass.end(), [&](const auto& pass) { return pass.first == time.name; });
      if (same == per_pass.end()) same = per_pass.insert(same, {time.name, {}});
      same->second.push_back(time.milliseconds);
      sum += time.milliseconds;
    }
    gpu.push_back(sum);
    if (i >= 2 && seconds_since(start) > kTimedSeconds) break;
  }
  Timings timings{.gpu = measure::spread(gpu), .wall = measure::spread(wall), .record = measure::spread(record)};
  for (const auto& [name, milliseconds] : per_pass) timings.passes.push_back({name, measure::spread(milliseconds)});
  return timings;
}

// The values of the knobs that are compiled into pipelines.
std::vector<double> pipeline_values(const std::vector<double>& values, const Settings& settings) {
  std::vector<double> compiled;
  for (size_t i = 0; i < values.size(); ++i)
    if (settings.knobs()[i].rebuilds) compiled.push_back(values[i]);
  return compiled;
}

// Settings that share their pipelines stand together: making one can take a second.
std::vector<std::vector<double>> ordered_by_pipeline(std::vector<std::vector<double>> ladder,
                                                     const Settings& settings) {
  std::stable_sort(ladder.begin(), ladder.end(), [&](const auto& a, const auto& b) {
    return pipeline_values(a, settings) < pipeline_values(b, settings);
  });
  return ladder;
}

// What the errors of a sweep are errors against: this program at its best.
Image draw_reference(OtherScene& other, Program& program, VkExtent2D size, uint32_t frame) {
  const Session& session = other.session;
  for (const auto& [name, text] : session.chapter.reference) other.settings.set(name, text);
  Renderer renderer(session.context, session.chapter, program, size);
  draw_up_to(session, renderer, frame);
  return renderer.picture();
}

std::string describe_reference(const Chapter& chapter) {
  std::string text;
  for (const auto& [name, value] : chapter.reference) text += (text.empty() ? "" : " ") + name + "=" + value;
  return text;
}

}  // namespace

Image draw_truth(const Session& session, const CameraPose& pose, VkExtent2D size, uint32_t seed) {
  const Truth& truth = *session.chapter.truth;
  Settings settings(truth.knobs);
  for (const auto& [name, text] : truth.settings) settings.set(name, text);
  const Context context{session.device, session.scene, settings, session.options.inject};
  const std::unique_ptr<Program> tracer = truth.make(context);
  const Chapter plain;
  Renderer renderer(context, plain, *tracer, size);
  for (uint32_t i = 0; i < truth.frames; ++i) renderer.draw(pose, session.scene.time_s, seed, i);
  return renderer.picture();
}

Exit run_bench(const Session& session) {
  const std::unique_ptr<Program> program = session.make_program();
  Renderer renderer(session.context, session.chapter, *program, session.options.size);
  const bool still = session.options.path.empty();
  const uint32_t repeats = session.options.frames > 0 || !still ? session.frame_count() : kRepeats;
  const Timings timings = time_frames(session, renderer, kWarmUp, repeats);
  const Shot last = session.shot(still ? 0 : static_cast<uint32_t>(kWarmUp + timings.wall.samples - 1) % repeats);
  const gpu::Candidate& device = session.device.candidate();
  measure::BenchResult result{session.chapter.name,
                              session.scene.name,
                              still ? session.scene.view(session.options.view).name : session.options.path,
                              device.name,
                              device.driver,
                              device.software,
                              renderer.size().width,
                              renderer.size().height,
                              {},
                              timings.passes,
                              timings.wall,
                              timings.record,
                              session.device.allocated_bytes(),
                              static_cast<int>(kWarmUp),
                              static_cast<int>(timings.wall.samples),
                              now_utc()};
  for (const Knob& knob : session.settings.knobs()) result.settings[knob.name] = session.settings.text(knob.name);
  if (!session.options.output.empty())
    write_output(session, session.options.output, last.pose, renderer.picture(), renderer.displayed());
  measure::write_bench(session.options.bench, result);
  fmt::print("{}", measure::bench_table(result));
  return Exit::ok;
}

Exit run_sweep(const Session& session) {
  must_have_standard_views(session);
  const VkExtent2D size = session.options.size_given ? session.options.size : kSweepSize;
  const gpu::Candidate& device = session.device.candidate();
  std::vector<measure::SweepRow> rows;
  const size_t rungs = measure::ladder_settings(session.settings).size();
  Progress progress("sweep", rungs * session.chapter.standard_views.size());
  for (const StandardView& standard : session.chapter.standard_views) {
    OtherScene other(session);
    other.load(standard);
    // The sun's disc is thousands of times brighter than the sky: in a mean of squares its few pixels are all there is.
    if (other.settings.has("sun.disc") && !other.settings.was_set("sun.disc")) {
      other.settings.set("sun.disc", "off");
      apply_scene_knobs(other.settings, other.scene);
    }
    const Settings base = other.settings;
    const std::vector<std::vector<double>> ladder = ordered_by_pipeline(measure::ladder_settings(base), base);
    const std::unique_ptr<Program> program = other.session.make_program();
    const float exposure = static_cast<float>(kBaseExposure * std::exp2(other.scene.post.exposure_ev));
    const auto display = [&](const glm::vec3& value) { return image::display(value, exposure); };

    const Image reference = draw_reference(other, *program, size, standard.frame);
    Renderer renderer(other.session.context, session.chapter, *program, size);

    for (const std::vector<double>& values : ladder) {
      other.settings = measure::with_values(base, values);
      const Timings timings = time_frames(other.session, renderer, 1, device.software ? 3 : kRepeats);
      if (standard.frames > 0) draw_up_to(other.session, renderer, standard.frame);
      measure::SweepRow row{.view = name_of(standard, '/'),
                            .gpu_ms = timings.gpu,
                            .wall_ms = timings.wall,
                            .bytes = session.device.allocated_bytes(),
                            .errors = measure::compare(renderer.picture(), reference, display)};
      for (const Knob& knob : session.chapter.knobs) row.values.push_back(other.settings.text(knob.name));
      for (const measure::PassTime& pass : timings.passes) row.passes.emplace_back(pass.name, pass.ms.median);
      rows.push_back(std::move(row));
      progress.step();
    }
  }
  measure::write_sweep_csv(session.options.sweep, session.chapter.knobs, rows,
                           {session.chapter.name, "standard views", device.name, device.driver, device.software,
                            size.width, size.height, describe_reference(session.chapter), now_utc()});
  fmt::print("{} settings x {} views -> {}\n", rungs, session.chapter.standard_views.size(), session.options.sweep);
  return Exit::ok;
}

namespace {

// The columns of a probe's rays: as seen from an altitude, or in the tangent frame of the scene's place.
const std::vector<std::string> kFromAltitude{"altitude_km", "view_zenith_deg", "sun_zenith_deg",
                                             "relative_azimuth_deg"};
const std::vector<std::string> kInTangentFrame{
    "east_km", "north_km", "up_km", "view_zenith_deg", "view_azimuth_deg", "sun_zenith_deg", "sun_azimuth_deg"};

// A number of a row within its range.
double probe_number(const Session& session, const CsvTable& table, const std::string& name, size_t row) {
  const bool azimuth = name.ends_with("azimuth_deg"),
             place = name == "east_km" || name == "north_km" || name == "up_km";
  const double low = place ? -kHighest_km : azimuth ? -360.0 : 0.0;
  const double high = place || name == "altitude_km" ? kHighest_km : azimuth ? 360.0 : 180.0;
  const double value = table.column(name)[row];
  if (!(value >= low && value <= high))
    fail("{}: row {}: {} is {:g}; accepted is {:g} to {:g}", session.options.probe, row + 1, name, value, low, high);
  return value;
}

// Both forms say the same of air that is alike everywhere: altitude and angles follow from the place.
ProbeRay probe_ray(const Session& session, const CsvTable& table, size_t row, bool tangent) {
  const auto number = [&](const char* name) { return probe_number(session, table, name, row); };
  const double zenith_deg = number("view_zenith_deg"), sun_zenith_deg = number("sun_zenith_deg");
  if (!tangent) {
    const double azimuth_deg = number("relative_azimuth_deg"), sun_deg = session.scene.sun.azimuth_deg;
    return {number("altitude_km"),
            zenith_deg,
            sun_zenith_deg,
            azimuth_deg,
            {0.0, 0.0, number("altitude_km")},
            direction_from(zenith_deg, sun_deg + azimuth_deg),
            direction_from(sun_zenith_deg, sun_deg)};
  }
  ProbeRay ray{.position_km = {number("east_km"), number("north_km"), number("up_km")},
               .direction = direction_from(zenith_deg, number("view_azimuth_deg")),
               .sun = direction_from(sun_zenith_deg, number("sun_azimuth_deg"))};
  const double radius_km = session.scene.planet.ground_radius_km;
  const CameraPose pose{.position_km = ray.position_km};
  ray.altitude_km = altitude_km(pose, radius_km);
  if (!(ray.altitude_km >= -1e-9 && ray.altitude_km <= kHighest_km))
    fail("{}: row {}: altitude {:g} km; accepted is a place from 0 to {:g} km above the ground", session.options.probe,
         row + 1, ray.altitude_km, kHighest_km);
  ray.altitude_km = std::max(ray.altitude_km, 0.0);
  const LocalFrame at = local_frame(pose, radius_km);
  const auto zenith_of = [&](const glm::dvec3& d) {
    return glm::degrees(std::atan2(glm::length(glm::cross(d, at.up)), glm::dot(d, at.up)));
  };
  const auto azimuth_of = [&](const glm::dvec3& d) {
    return glm::degrees(std::atan2(glm::dot(d, at.east), glm::dot(d, at.north)));
  };
  ray.view_zenith_deg = zenith_of(ray.direction), ray.sun_zenith_deg = zenith_of(ray.sun);
  ray.relative_azimuth_deg = azimuth_of(ray.direction) - azimuth_of(ray.sun);
  return ray;
}

}  // namespace

Exit run_probe(const Session& session) {
  const std::vector<std::string> header = read_csv(session.options.probe, {}).names;
  const bool tangent = std::find(header.begin(), header.end(), "east_km") != header.end();
  if (tangent && std::find(header.begin(), header.end(), "altitude_km") != header.end())
    fail("{}: columns east_km and altitude_km; accepted is one of two forms: {}; or {}", session.options.probe,
         fmt::join(kFromAltitude, ", "), fmt::join(kInTangentFrame, ", "));
  const std::vector<std::string>& inputs = tangent ? kInTangentFrame : kFromAltitude;
  const CsvTable table = read_csv(session.options.probe, inputs);
  std::vector<ProbeRay> rays;
  for (size_t row = 0; row < table.rows; ++row) rays.push_back(probe_ray(session, table, row, tangent));

  const std::vector<ProbeResult> results = session.make_program()->probe(rays);
  std::vector<std::string> names = inputs;
  for (const char* name :
       {"radiance_r", "radiance_g", "radiance_b", "transmittance_r", "transmittance_g", "transmittance_b"})
    names.push_back(name);
  if (session.chapter.stochastic)
    for (const char* name : {"standard_error_r", "standard_error_g", "standard_error_b"}) names.push_back(name);
  std::vector<std::vector<std::string>> rows(table.rows);
  for (size_t row = 0; row < table.rows; ++row) {
    for (const std::string& name : inputs)
      rows[row].push_back(table.fields[table.index(name)][row]);  // as they were written
    for (int c = 0; c < 3; ++c) rows[row].push_back(fmt::format("{:.9e}", results[row].radiance[c]));
    for (int c = 0; c < 3; ++c) rows[row].push_back(fmt::format("{:.9e}", results[row].transmittance[c]));
    for (int c = 0; session.chapter.stochastic && c < 3; ++c)
      rows[row].push_back(fmt::format("{:.9e}", results[row].standard_error[c]));
  }
  write_csv(session.options.probe_out,
            {fmt::format("{} scene {}, {} ({})", session.chapter.name, session.scene.name,
                         session.device.candidate().name, session.device.candidate().driver),
             "radiance for the scene's solar irradiance (1 unless it says otherwise), without the sun's disc"},
            names, rows);
  fmt::print("{} rays -> {}\n", table.rows, session.options.probe_out);
  return Exit::ok;
}

}  // namespace welkin::app
