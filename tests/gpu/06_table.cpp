// Writes the tables on the page of chapter 06 into a directory:
//   WELKIN_TABLE=docs/generated gpu_tests "[06_table]"
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "chapters/05_single_scattering/single_scattering.hpp"
#include "common/app/session.hpp"
#include "common/graph/composition.hpp"
#include "common/image/atomic_file.hpp"
#include "common/image/csv.hpp"
#include "tests/gpu/06_rig.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

struct Shot {
  const char* scene;
  const char* view;
};
constexpr Shot kViews[] = {
    {"noon", "horizon"}, {"sunset", "sun"}, {"twilight", "glow"}, {"orbit", "limb"}, {"alien", "horizon"}};
constexpr VkExtent2D kSize{1920, 1080};
using Knobs = std::vector<std::pair<std::string, std::string>>;

app::Chapter chapter_06() { return {.number = 6, .sky = true, .knobs = march_knobs()}; }

// The linear picture of a view, drawn by chapter 05, and the scene's post section.
std::pair<Image, Post> picture_of(const Shot& wanted, VkExtent2D size) {
  const app::Chapter chapter = chapter_06();
  Scene scene;
  Settings settings;
  const std::string inject;
  app::load_scene_and_settings(chapter, wanted.scene, {{"view.steps", "64"}}, {}, scene, settings);
  const app::Context context{device(), scene, settings, inject};
  app::Composition program(context, {air(), single_scattering()});
  app::Renderer renderer(context, chapter, program, size);
  renderer.draw(app::pose_of(scene.view(wanted.view), scene.planet.ground_radius_km), 0.0, 0, 0);
  return {renderer.picture(), scene.post};
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

std::vector<std::string> notes(VkExtent2D size, const std::string& what) {
  return {what,
          "device: " + device().candidate().name,
          "driver: " + device().candidate().driver,
          fmt::format("software driver: {}", device().candidate().software ? "yes" : "no"),
          fmt::format("resolution: {}x{}", size.width, size.height),
          "source: WELKIN_TABLE=docs/generated gpu_tests \"[06_table]\""};
}

double encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace

TEST_CASE("tables of the meter: exposures of the standard views, and what a stride saves and loses", "[.][06_table]") {
  const char* directory = std::getenv("WELKIN_TABLE");
  REQUIRE(directory != nullptr);
  std::vector<std::vector<std::string>> exposures, rows;
  std::vector<std::unique_ptr<DisplayRig>> rigs;
  std::vector<double> exact;
  for (const Shot& view : kViews) {
    const auto [picture, post] = picture_of(view, kSize);
    rigs.push_back(std::make_unique<DisplayRig>(kSize, Knobs{{"exposure.stride", "1"}}, post));
    rigs.back()->set_picture(picture);
    rigs.back()->draw(0, 0.0);
    const ExposureState state = rigs.back()->state();
    exact.push_back(state.exposure);
    const Image8 shown = rigs.back()->displayed();
    size_t white = 0, black = 0;
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
      const uint8_t* p = &shown.rgba[4 * i];
      white += std::min({p[0], p[1], p[2]}) >= 254;
      black += std::max({p[0], p[1], p[2]}) <= 1;
    }
    const double pixels = double(picture.pixels.size());
    exposures.push_back(
        {fmt::format("{}/{}", view.scene, view.view), fmt::format("{:.2f}", *trimmed_mean_log2(picture, 0.45, 0.95)),
         fmt::format("{:.2f}", state.mean_log2),
         fmt::format("{:.2f}", state.exposure - std::log2(24.0) + post.compensation_ev),
         fmt::format("{:.2f}", post.exposure_ev), fmt::format("{:.1f}", 100.0 * state.measured / pixels),
         fmt::format("{:.2f}", 100.0 * white / pixels), fmt::format("{:.1f}", 100.0 * black / pixels)});
  }
  write_csv(std::string(directory) + "/06_exposures.csv", notes(kSize, "what the meter finds, curve aces_hill"),
            {"view", "mean_log2_exact", "mean_log2_metered", "stops_metered", "stops_by_hand", "percent_measured",
             "percent_white", "percent_black"},
            exposures);

  double base = 0.0, gained = 0.0, lost = 0.0;
  for (int stride : {1, 2, 4, 8, 16}) {
    std::vector<double> count_ms, all_ms;
    std::vector<std::string> errors;
    double worst = 0.0;
    for (size_t v = 0; v < rigs.size(); ++v) {
      rigs[v]->settings().set_number("exposure.stride", stride);
      for (int repeat = 0; repeat < 15; ++repeat) {
        rigs[v]->draw(0, 0.0);
        const std::vector<gpu::PassTime> times = rigs[v]->times();
        count_ms.push_back(times[0].milliseconds);
        all_ms.push_back(times[0].milliseconds + times[1].milliseconds + times[2].milliseconds);
      }
      const double error = std::abs(rigs[v]->state().exposure - exact[v]);
      worst = std::max(worst, error);
      errors.push_back(fmt::format("{:.4f}", error));
    }
    if (stride == 1) base = median(count_ms);
    if (stride == 2) gained = base / median(count_ms), lost = worst;
    std::vector<std::string> row{std::to_string(stride),
                                 std::to_string((1920 + stride - 1) / stride * ((1080 + stride - 1) / stride)),
                                 fmt::format("{:.3f}", median(count_ms)), fmt::format("{:.3f}", median(all_ms)),
                                 fmt::format("{:.1f}", base / median(count_ms))};
    row.push_back(fmt::format("{:.4f}", worst));
    row.insert(row.end(), errors.begin(), errors.end());
    rows.push_back(row);
  }
  write_csv(
      std::string(directory) + (device().candidate().software ? "/06_stride.csv" : "/06_stride_gpu.csv"),
      notes(kSize,
            "every stride-th pixel of every stride-th row metered: time, and error of the exposure against stride 1"),
      {"stride", "samples", "histogram_ms", "three_passes_ms", "times_faster", "worst_stops", "noon", "sunset",
       "twilight", "orbit", "alien"},
      rows);
  // Each doubling of the stride quarters the samples: two factors of two of them.
  write_file_atomically(
      std::string(directory) + (device().candidate().software ? "/06_factor_of_two.txt" : "/06_factor_of_two_gpu.txt"),
      fmt::format("{}: metering one pixel of four takes the histogram from {:.3f} to {:.3f} ms, a factor of {:.1f}, "
                  "and puts the exposure of the worst view off by {:.4f} stops, "
                  "{:.2f} % of its light: a factor of two in time costs {:.4f} stops.\n",
                  device().candidate().name, base, base / gained, gained, lost, 100.0 * (std::exp2(lost) - 1.0),
                  lost / std::log2(gained)));
}

TEST_CASE("table of the curves", "[.][06_table]") {
  const char* directory = std::getenv("WELKIN_TABLE");
  REQUIRE(directory != nullptr);
  std::vector<Item> items;
  for (int curve = 0; curve < 7; ++curve)
    for (int i = 0; i <= 140; ++i) items.push_back({{0.0f, float(curve), 0.18f * std::exp2(float(i - 80) / 10.0f)}});
  const std::vector<Answer> got = evaluate_items(items);
  std::vector<std::vector<std::string>> rows;
  for (int i = 0; i <= 140; ++i) {
    rows.push_back({fmt::format("{:.1f}", (i - 80) / 10.0)});
    for (int curve = 0; curve < 7; ++curve) rows.back().push_back(fmt::format("{:.5f}", got[curve * 141 + i].out[1]));
  }
  write_csv(
      std::string(directory) + "/06_curves.csv",
      {"grey light in stops from middle grey, and what the curves make of it: share of the screen's white, linear",
       "source: WELKIN_TABLE=docs/generated gpu_tests \"[06_table]\""},
      {"stops", "clamp", "reinhard", "aces_narkowicz", "aces_hill", "lottes", "uchimura", "uncharted2"}, rows);
}

TEST_CASE("table of bands: a twilight with and without dithering", "[.][06_table]") {
  const char* directory = std::getenv("WELKIN_TABLE");
  REQUIRE(directory != nullptr);
  constexpr VkExtent2D kPicture{1280, 720};
  constexpr uint32_t kBlock = 16;
  std::vector<std::vector<std::string>> rows;
  for (const Shot& view : {Shot{"twilight", "glow"}, Shot{"twilight", "shadow"}}) {
    const auto [picture, post] = picture_of(view, kPicture);
    for (const char* dither : {"off", "on"}) {
      DisplayRig rig(kPicture, {{"display.dither", dither}}, post);
      rig.set_picture(picture);
      rig.draw(0, 0.0);
      const Image8 shown = rig.displayed();
      const float factor = std::exp2(rig.state().exposure + float(post.compensation_ev));
      std::vector<Item> items;
      for (const glm::vec4& p : picture.pixels)
        items.push_back({{1.0f, 3.0f, p.r * factor, p.g * factor, p.b * factor}});
      const std::vector<Answer> wanted = evaluate_items(items);
      // Only the sky: blocks whose every pixel has light.
      double sum = 0.0, blocks = 0.0;
      for (uint32_t top = 0; top < kPicture.height; top += kBlock)
        for (uint32_t left = 0; left < kPicture.width; left += kBlock) {
          double error = 0.0;
          bool sky = true;
          for (uint32_t y = top; y < top + kBlock; ++y)
            for (uint32_t x = left; x < left + kBlock; ++x) {
              const size_t i = size_t{y} * kPicture.width + x;
              const double level = 255.0 * encoded(wanted[i].out[1]);
              sky = sky && level > 2.0;
              error += shown.rgba[4 * i + 1] - level;
            }
          if (!sky) continue;
          sum += std::pow(error / (kBlock * kBlock), 2.0);
          blocks += 1.0;
        }
      int longest = 0;
      for (uint32_t x = 0; x < kPicture.width; ++x) {
        int run = 1;
        for (uint32_t y = 1; y < kPicture.height; ++y) {
          const size_t i = size_t{y} * kPicture.width + x;
          const bool same = shown.rgba[4 * i + 1] == shown.rgba[4 * (i - kPicture.width) + 1] &&
                            255.0 * encoded(wanted[i].out[1]) > 2.0;
          run = same ? run + 1 : 1;
          longest = std::max(longest, run);
        }
      }
      rows.push_back({fmt::format("{}/{}", view.scene, view.view), dither,
                      fmt::format("{:.3f}", std::sqrt(sum / blocks)), std::to_string(longest)});
    }
  }
  write_csv(std::string(directory) + "/06_bands.csv",
            notes(kPicture, "green channel of the sky, curve aces_hill; blocks of 16 x 16 pixels, levels of 255"),
            {"view", "dither", "rms_of_block_means", "longest_band_pixels"}, rows);
}
