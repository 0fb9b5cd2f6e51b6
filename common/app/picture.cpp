// Headless modes that end with a picture: the picture itself, --dump, --against, --explain.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "common/app/progress.hpp"
#include "common/app/session.hpp"
#include "common/image/average.hpp"
#include "common/image/display.hpp"
#include "common/image/exr.hpp"
#include "common/image/png.hpp"
#include "common/measure/bench_json.hpp"
#include "common/measure/metrics.hpp"

namespace welkin::app {
namespace {

constexpr VkExtent2D kHeadlessSize{1280, 720};

// "out/a.png", 7 -> "out/a_0007.png".
std::string numbered(const std::string& file, uint32_t frame) {
  const size_t dot = file.rfind('.');
  return fmt::format("{}_{:04}{}", file.substr(0, dot), frame, file.substr(dot));
}

void print_times(const Session& session, Renderer& renderer) {
  const gpu::Candidate& device = session.device.candidate();
  fmt::print("{:02} {} · scene {} · {}x{} · {} ({}{})\n", session.chapter.number, session.chapter.title,
             session.scene.name, renderer.size().width, renderer.size().height, device.name, device.driver,
             device.software ? ", software" : "");
  double total = 0.0;
  for (const gpu::PassTime& pass : renderer.pass_times()) {
    fmt::print("  {:<20} {:>10.3f} ms\n", pass.name, pass.milliseconds);
    total += pass.milliseconds;
  }
  fmt::print("  {:<20} {:>10.3f} ms   {} held\n", "total", total,
             measure::human_bytes(session.device.allocated_bytes()));
}

void explain(const Session& session, const Program& program, Renderer& renderer, uint64_t allocations_by_later_frames) {
  fmt::print("effects of scene {}:\n", session.scene.name);
  if (!session.chapter.sky)
    fmt::print("  none: this chapter draws no air\n");
  else
    for (const Constituent& effect : constituents(session.scene))
      fmt::print("  {:<14} {:<4} {}\n", effect.name, effect.on ? "on" : "off", effect.why);
  const bool draws_clouds =
      std::ranges::any_of(session.chapter.effects, [](const Effect& effect) { return effect.name == "clouds"; });
  if (!draws_clouds && (!session.scene.clouds.empty() || session.scene.weather))
    fmt::print("  {:<14} {:<4} {}\n", "clouds", "off", "in the scene, drawn from chapter 17 on");
  fmt::print("passes:\n");
  for (const gpu::PassTime& pass : renderer.pass_times())
    fmt::print("  {:<20} {:>10.3f} ms\n", pass.name, pass.milliseconds);
  fmt::print("{}", program.explain());
  fmt::print("declared:\n  passes {}\n  bytes {}\n", fmt::join(session.chapter.still_passes, ", "),
             session.chapter.extra_bytes);
  fmt::print("memory:\n");
  for (const gpu::Allocation& allocation : session.device.allocations())
    fmt::print("  {:<20} {:>12} bytes\n", allocation.name, allocation.bytes);
  fmt::print("  {:<20} {:>12} bytes\nallocations by frames after the first: {}\n", "total",
             session.device.allocated_bytes(), allocations_by_later_frames);
}

// How large a picture is drawn to be averaged to `size`; Error if the device has no such images.
VkExtent2D drawn_size(const Session& session, VkExtent2D size) {
  const uint32_t n = session.options.supersample, limit = session.device.limits().maxImageDimension2D;
  const VkExtent2D drawn{size.width * n, size.height * n};  // at most 8 * 16384
  if (n > 1 && std::max(drawn.width, drawn.height) > limit)
    fail("--supersample {} of {}x{} draws {}x{} pixels; accepted is up to {} a side on {}", n, size.width, size.height,
         drawn.width, drawn.height, limit, session.device.candidate().name);
  return drawn;
}

Exit compare_with(const Session& session, const Image& picture, const Image& reference) {
  const float exposure = static_cast<float>(kBaseExposure * std::exp2(session.scene.post.exposure_ev));
  const measure::Errors errors =
      measure::compare(picture, reference, [&](const glm::vec3& value) { return image::display(value, exposure); });
  fmt::print("against {}: {}\n", session.options.against, measure::describe(errors));
  return errors.finite() ? Exit::ok : Exit::mismatch;
}

}  // namespace

void draw_frame(const Session& session, Renderer& renderer, uint32_t index) {
  const Shot shot = session.shot(index);
  session.scene.time_s = shot.time_s;
  renderer.draw(shot.pose, shot.time_s, session.options.seed, index, shot.seconds);
}

size_t count_not_finite(const Image& picture) {
  size_t count = 0;
  for (const glm::vec4& pixel : picture.pixels)
    if (!std::isfinite(pixel.r) || !std::isfinite(pixel.g) || !std::isfinite(pixel.b)) ++count;
  return count;
}

void draw_up_to(const Session& session, Renderer& renderer, uint32_t frame) {
  for (uint32_t i = 0; i <= frame; ++i) draw_frame(session, renderer, i);
}

Exit run_picture(const Session& session) {
  const Options& options = session.options;
  std::optional<Image> reference;
  if (!options.against.empty()) reference = image::read_exr(options.against);  // said before the work is done
  const std::string file = options.output.empty() ? "out/" + session.chapter.name + ".png" : options.output;
  const bool writes =
      !options.output.empty() || (!options.explain && options.against.empty() && options.dump_what.empty());

  const std::unique_ptr<Program> program = session.make_program();
  // Drivers compile a shader at its first dispatch: a picture of one workgroup takes that out of the times shown.
  {
    Renderer small(session.context, session.chapter, *program, {8, 8});
    draw_frame(session, small, 0);
  }
  Renderer renderer(session.context, session.chapter, *program,
                    drawn_size(session, options.size_given ? options.size : kHeadlessSize));
  const uint32_t frames = std::max(session.frame_count(), options.explain ? 2u : 1u);
  uint64_t allocations = 0;
  const auto save = [&](uint32_t i) {
    if (options.output.empty()) std::filesystem::create_directories("out");
    write_output(session, options.path.empty() ? file : numbered(file, i), session.shot(i).pose,
                 image::averaged(renderer.picture(), options.supersample),
                 image::averaged(renderer.displayed(), options.supersample));
  };
  Progress progress("drawing", frames);
  for (uint32_t i = 0; i < frames; ++i) {
    const uint64_t before = session.device.allocation_count();
    draw_frame(session, renderer, i);
    if (i > 0) allocations += session.device.allocation_count() - before;
    if (writes && !options.path.empty()) save(i);
    progress.step();
  }

  const Image picture = image::averaged(renderer.picture(), options.supersample);
  const Image8 displayed = image::averaged(renderer.displayed(), options.supersample);
  const size_t not_finite = count_not_finite(picture);
  if (options.dump_what == "picture") image::write_exr(options.dump_file, picture);
  if (options.dump_what == "displayed") image::write_png8(options.dump_file, displayed);
  if (std::count(session.chapter.images.begin(), session.chapter.images.end(), options.dump_what) > 0) {
    const gpu::Image* image = program->image(options.dump_what);
    if (image == nullptr)
      fail("--dump {}: with this scene and these settings there is no such image", options.dump_what);
    const Image content = read_picture(session.device, gpu::create_command_pool(session.device), *image);
    if (options.dump_file.ends_with(".exr"))
      image::write_exr(options.dump_file, content);
    else
      image::write_png8(
          options.dump_file,
          image::to_display(content, static_cast<float>(kBaseExposure * std::exp2(session.scene.post.exposure_ev))));
  }
  if (writes && options.path.empty()) save(0);
  if (options.explain)
    explain(session, *program, renderer, allocations);
  else
    print_times(session, renderer);
  if (writes && options.path.empty()) fmt::print("wrote {}\n", file);
  if (writes && !options.path.empty()) fmt::print("wrote {} to {}\n", numbered(file, 0), numbered(file, frames - 1));
  if (writes && options.output.empty() && !session.chapter.try_next.empty())
    fmt::print("next: {}\n", session.chapter.try_next);
  const Exit compared = reference ? compare_with(session, picture, *reference) : Exit::ok;
  if (not_finite > 0) {
    std::fprintf(stderr, "%s: %zu pixels are not finite\n", session.chapter.name.c_str(), not_finite);
    return Exit::mismatch;
  }
  return compared;
}

}  // namespace welkin::app
