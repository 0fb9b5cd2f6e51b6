// The light meter against double: every bin of the histogram, the mean between two ranks, the exposure, and its way
// there in time against the closed form.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "tests/gpu/06_rig.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

double luminance_of(const glm::vec4& p) { return 0.2126729 * p.r + 0.7151522 * p.g + 0.0721750 * p.b; }

// Position in the histogram, in bins from the darkest edge; the formula of the page.
double position_of(double luminance) { return (std::log2(luminance) + 30.0) * 255.0 / 50.0; }

Image gradient(uint32_t width, uint32_t height, double darkest_log2, double brightest_log2) {
  Image picture = flat_picture(width, height, glm::vec3(0.0f));
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x) {
      const double at = (x + double(y) / height) / width;
      picture.pixels[y * width + x] =
          glm::vec4(glm::vec3(float(std::exp2(darkest_log2 + (brightest_log2 - darkest_log2) * at))), 1.0f);
    }
  return picture;
}

double total(const std::vector<uint32_t>& bins) { return std::accumulate(bins.begin(), bins.end(), 0.0); }

}  // namespace

TEST_CASE("truth: the bin of a luminance, and the value of a bin") {
  Random random(61);
  std::vector<Item> items;
  for (int i = 0; i < 100000; ++i)
    items.push_back({{6.0f, float(random.log_uniform(1e-12, 1e8)), float(random.uniform(0.0, 1.0))}});
  const std::vector<Answer> got = evaluate_items(items);
  double worst_bin = 0.0, sum = 0.0, sum_wanted = 0.0;
  for (size_t i = 0; i < items.size(); ++i) {
    const double position = position_of(items[i].in[1]) + items[i].in[2] - 0.5;
    const double wanted = 1.0 + std::clamp(std::floor(position), 0.0, 254.0);
    // Exactly the bin, unless the position lies on an edge to within what float32 knows of log2.
    if (std::abs(position - std::round(position)) > 1e-3) REQUIRE(got[i].out[0] == wanted);
    REQUIRE(std::abs(got[i].out[0] - wanted) <= 1.0);
    REQUIRE(got[i].out[1] == Approx(-30.0 + (got[i].out[0] - 0.5) * 50.0 / 255.0).margin(1e-5));
    const double inside = std::clamp(std::log2(double(items[i].in[1])), -30.0, 20.0);
    worst_bin = std::max(worst_bin, std::abs(got[i].out[1] - inside));
    if (inside == -30.0 || inside == 20.0 || position < 0.0 || position > 254.0) continue;
    sum += got[i].out[1];
    sum_wanted += inside;
  }
  CHECK(worst_bin < 1.01 * 50.0 / 255.0);  // noise moves a value by at most one bin
  // The noise is fair: the mean has no bias. 100,000 values, each off by up to a bin: a standard error of 3e-4.
  CHECK(std::abs(sum - sum_wanted) / items.size() < 1e-3);
}

TEST_CASE("truth: the hash is the published one, and uniform") {
  std::vector<Item> items;
  for (uint32_t y = 0; y < 300; ++y)
    for (uint32_t x = 0; x < 300; ++x) items.push_back({{7.0f, float(x), float(y), float(x % 3)}});
  const std::vector<Answer> got = evaluate_items(items);
  double mean = 0.0, square = 0.0, dither = 0.0, dither_square = 0.0;
  for (size_t i = 0; i < items.size(); ++i) {
    const uint32_t x = uint32_t(items[i].in[1]), y = uint32_t(items[i].in[2]), seed = uint32_t(items[i].in[3]);
    const double noise = pixel_noise_reference(x, y, seed);
    REQUIRE(got[i].out[0] == noise);
    REQUIRE(got[i].out[1] == Approx(pixel_noise_reference(x + 1, y, seed) - noise).margin(1e-7));
    mean += noise, square += noise * noise, dither += got[i].out[1], dither_square += got[i].out[1] * got[i].out[1];
  }
  const double n = double(items.size());
  // 90,000 numbers: standard errors of 1/sqrt(12 n) = 1e-3 and of 1e-3 for the squares; four of them.
  CHECK(mean / n == Approx(0.5).margin(4e-3));
  CHECK(square / n == Approx(1.0 / 3.0).margin(4e-3));
  CHECK(dither / n == Approx(0.0).margin(4e-3));
  CHECK(dither_square / n == Approx(1.0 / 6.0).margin(4e-3));  // the variance of a triangle from -1 to 1
}

TEST_CASE("truth: every bin of a picture") {
  for (const auto& [width, height] : {std::pair<uint32_t, uint32_t>{640, 361}, {33, 65}}) {
    const Image picture = gradient(width, height, -32.0, 22.0);
    for (uint32_t stride : {1u, 2u, 3u}) {
      DisplayRig rig({width, height}, {{"exposure.stride", std::to_string(stride)}});
      rig.set_picture(picture);
      rig.draw(0, 0.0);
      std::vector<double> wanted(256, 0.0);
      double doubtful = 0.0;  // pixels on an edge of a bin to within what float32 knows of log2
      for (uint32_t y = 0; y * stride < height; ++y)
        for (uint32_t x = 0; x * stride < width; ++x) {
          const uint32_t row = std::min(y * stride + stride / 2, height - 1),
                         column = std::min(x * stride + stride / 2, width - 1);
          const double position =
              position_of(luminance_of(picture.pixels[row * width + column])) + pixel_noise_reference(x, y, 0) - 0.5;
          wanted[1 + size_t(std::clamp(std::floor(position), 0.0, 254.0))] += 1.0;
          doubtful += std::abs(position - std::round(position)) < 1e-3;
        }
      const std::vector<uint32_t> got = rig.histogram();
      double moved = 0.0;
      for (size_t bin = 0; bin < 256; ++bin) moved += std::abs(got[bin] - wanted[bin]);
      CHECK(moved <= 2.0 * doubtful);
      CHECK(total(got) == double((width + stride - 1) / stride * ((height + stride - 1) / stride)));
    }
  }
}

TEST_CASE("truth: the mean between two ranks and the exposure it asks for") {
  for (const auto& [low, high] : {std::pair{"0", "1"}, {"0.1", "0.95"}, {"0.4", "0.6"}})
    for (const char* adaptation : {"0", "0.85", "1"}) {
      DisplayRig rig({320, 181}, {{"exposure.low", low},
                                  {"exposure.high", high},
                                  {"exposure.adaptation", adaptation},
                                  {"exposure.stride", "1"}});
      const Image picture = gradient(320, 181, -20.0, -3.0);
      rig.set_picture(picture);
      rig.draw(0, 0.0);
      const double mean = *trimmed_mean_log2(picture, std::stod(low), std::stod(high));
      const ExposureState state = rig.state();
      // A bin is 0.196 stops; noise and 58,000 pixels take that down to a thousandth. Ranks inside a bin are not known.
      CHECK(state.mean_log2 == Approx(mean).margin(0.01));
      CHECK(state.measured == 320u * 181u);
      CHECK(state.target == Approx(std::log2(0.18) + 13.0 - std::stod(adaptation) * (mean + 13.0)).margin(0.01));
      CHECK(state.exposure == state.target);  // the first frame goes the whole way
    }
}

TEST_CASE("truth: the exposure of a uniform picture has no steps") {
  // A picture that slowly gets brighter crosses bins of 0.196 stops. Without noise its exposure would stand still, then
  // jump by that much.
  double worst = 0.0, largest_step = 0.0, before = 0.0;
  const double step = 0.01;
  for (int i = 0; i < 40; ++i) {
    const double log2 = -9.0 + step * i;
    DisplayRig rig({256, 256}, {{"exposure.adaptation", "1"}, {"exposure.stride", "1"}});
    rig.set_picture(flat_picture(256, 256, glm::vec3(float(std::exp2(log2)))));
    rig.draw(0, 0.0);
    const double exposure = rig.state().exposure;
    worst = std::max(worst, std::abs(exposure + log2 - std::log2(0.18)));
    if (i > 0) largest_step = std::max(largest_step, std::abs(exposure - before));
    before = exposure;
  }
  std::printf(
      "a uniform picture, brighter by %.2f stops a frame: exposure off by at most %.3f, largest step %.3f stops\n",
      step, worst, largest_step);
  // The noise leaves two bins, and of the lower one 45 % of the pixels are cut off: at most 0.45 bins, 0.088 stops.
  // While that happens the mean moves by up to twice what the light does; the rest is chance.
  CHECK(worst < 0.1);
  CHECK(largest_step < 0.03);
}

TEST_CASE("truth: adaptation follows the exponential, whatever the frames") {
  // From one picture to another, 7 stops apart, in 2 s of irregular frames.
  const auto run = [](double from_log2, double to_log2, int frames, uint64_t seed, double seconds) {
    DisplayRig rig({32, 32},
                   {{"exposure.to_bright_s", "0.4"}, {"exposure.to_dark_s", "1.5"}, {"exposure.stride", "1"}});
    rig.set_picture(flat_picture(32, 32, glm::vec3(float(std::exp2(from_log2)))));
    rig.draw(0, 0.0);
    const double start = rig.state().exposure;
    rig.set_picture(flat_picture(32, 32, glm::vec3(float(std::exp2(to_log2)))));
    Random random(seed);
    std::vector<double> steps(frames);
    for (double& step : steps) step = random.uniform(0.1, 1.0);
    const double sum = std::accumulate(steps.begin(), steps.end(), 0.0);
    for (int i = 0; i < frames; ++i) rig.draw(uint32_t(i + 1), steps[i] / sum * seconds);
    const ExposureState end = rig.state();
    const double tau = to_log2 > from_log2 ? 0.4 : 1.5;
    const double wanted = end.target + (start - end.target) * std::exp(-seconds / tau);
    CHECK(end.exposure == Approx(wanted).margin(1e-3));
    return double(end.exposure);
  };
  for (const auto& [from, to] : {std::pair{-10.0, -3.0}, {-3.0, -10.0}}) {
    const double few = run(from, to, 3, 1, 1.2), some = run(from, to, 40, 2, 1.2), many = run(from, to, 300, 3, 1.2);
    CHECK(few == Approx(many).margin(1e-3));
    CHECK(some == Approx(many).margin(1e-3));
    CHECK(run(from, to, 30, 4, 30.0) == Approx(run(from, to, 30, 5, 60.0)).margin(1e-4));  // it arrives
  }
  CHECK(adapted_share(0.0, 1.0) == 0.0);
  CHECK(adapted_share(1.0, 0.0) == 1.0);
  CHECK(adapted_share(1e-12, 1.0) == Approx(1e-12).epsilon(1e-9));  // 1 - exp() would give 1.00009e-12
  CHECK(adapted_share(0.0, 0.0) == 1.0);
}
