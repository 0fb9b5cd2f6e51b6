// What must not upset a light meter: named cases.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/gpu/06_rig.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

uint64_t total(const std::vector<uint32_t>& bins) { return std::accumulate(bins.begin(), bins.end(), uint64_t{0}); }

void check_finite(const ExposureState& state) {
  CHECK(std::isfinite(state.exposure));
  CHECK(std::isfinite(state.target));
  CHECK(std::isfinite(state.mean_log2));
}

}  // namespace

TEST_CASE("hard: counts sum to the pixels, whatever the size") {
  Random random(62);
  for (const auto& [width, height] : {std::pair<uint32_t, uint32_t>{1, 1},
                                      {7, 5},
                                      {1, 33},
                                      {33, 1},
                                      {31, 32},
                                      {64, 64},
                                      {1920, 1080},
                                      {1921, 1079}}) {
    Image picture = flat_picture(width, height, glm::vec3(0.0f));
    const float unusual[] = {0.0f, -1.0f, kInf, -kInf, kNan, 1e-44f, 3e38f, 0.01f};
    for (glm::vec4& pixel : picture.pixels) pixel.r = pixel.g = pixel.b = unusual[random.next() % 8];
    const uint64_t stride = width > 1000 ? 3 : 1;
    for (uint64_t s : {uint64_t{1}, stride}) {
      DisplayRig rig({width, height}, {{"exposure.stride", std::to_string(s)}});
      rig.set_picture(picture);
      rig.draw(0, 0.0);
      INFO(width << "x" << height << " stride " << s);
      const std::vector<uint32_t> bins = rig.histogram();
      CHECK(total(bins) == (width + s - 1) / s * ((height + s - 1) / s));
      CHECK(rig.state().measured == total(bins) - bins[0]);
      check_finite(rig.state());
    }
  }
}

TEST_CASE("hard: black, infinity and NaN have their bins") {
  const auto bins_of = [](glm::vec3 color) {
    DisplayRig rig({7, 5}, {{"exposure.stride", "1"}});
    rig.set_picture(flat_picture(7, 5, color));
    rig.draw(0, 0.0);
    check_finite(rig.state());
    return rig.histogram();
  };
  CHECK(bins_of(glm::vec3(0.0f))[0] == 35);
  CHECK(bins_of(glm::vec3(-1.0f))[0] == 35);
  CHECK(bins_of(glm::vec3(kNan))[0] == 35);
  CHECK(bins_of(glm::vec3(kNan, 1.0f, 1.0f))[0] == 35);
  CHECK(bins_of(glm::vec3(kInf))[255] == 35);
  CHECK(bins_of(glm::vec3(kInf, 0.0f, 0.0f))[255] == 35);
  CHECK(bins_of(glm::vec3(kInf, -kInf, 0.0f))[0] == 35);
  CHECK(bins_of(glm::vec3(3e38f))[255] == 35);
  CHECK(bins_of(glm::vec3(1e-20f))[1] == 35);
}

TEST_CASE("hard: nothing to measure") {
  // The first picture black: the exposure of one set by hand. Black later on: what it was, for as long as it lasts.
  DisplayRig rig({33, 17}, {{"exposure.stride", "1"}});
  rig.set_picture(flat_picture(33, 17, glm::vec3(0.0f)));
  rig.draw(0, 0.0);
  CHECK(rig.state().exposure == Approx(std::log2(24.0)));
  CHECK(rig.state().measured == 0u);
  rig.set_picture(flat_picture(33, 17, glm::vec3(0.001f)));
  rig.draw(0, 0.0);
  const float before = rig.state().exposure;
  rig.set_picture(flat_picture(33, 17, glm::vec3(kNan)));
  for (uint32_t i = 1; i < 5; ++i) rig.draw(i, 100.0);
  CHECK(rig.state().exposure == before);
  // A picture that comes after it is measured as ever: nothing that was not finite stayed.
  rig.set_picture(flat_picture(33, 17, glm::vec3(0.001f)));
  rig.draw(5, 100.0);
  CHECK(rig.state().exposure == Approx(before).margin(1e-4));
}

TEST_CASE("hard: one lit pixel in the dark of space") {
  Image picture = flat_picture(640, 360, glm::vec3(0.0f));
  picture.pixels[12345] = glm::vec4(glm::vec3(0.02f), 1.0f);
  DisplayRig rig({640, 360}, {{"exposure.stride", "1"}, {"exposure.adaptation", "1"}});
  rig.set_picture(picture);
  rig.draw(0, 0.0);
  CHECK(rig.state().measured == 1u);
  CHECK(rig.state().exposure == Approx(std::log2(0.18 / 0.02)).margin(0.2));  // one pixel: known to a bin
}

TEST_CASE("hard: the exposure does not flicker") {
  // A sky with 2 % noise that changes every frame, and in frame 20 the sun's disc: a few pixels 10^6 times as bright.
  constexpr uint32_t kWidth = 320, kHeight = 180;
  Random random(63);
  const auto sky = [&](bool sun) {
    Image picture = flat_picture(kWidth, kHeight, glm::vec3(0.0f));
    for (uint32_t i = 0; i < kWidth * kHeight; ++i)
      picture.pixels[i] = glm::vec4(
          glm::vec3(float(0.02 * (1.0 + 0.02 * random.uniform(-1, 1)) * std::exp2(-2.0 * i / (kWidth * kHeight)))),
          1.0f);
    if (sun)
      for (uint32_t i = 0; i < 4; ++i) picture.pixels[1000 + i] = glm::vec4(glm::vec3(2e4f), 1.0f);
    return picture;
  };
  DisplayRig rig({kWidth, kHeight}, {});
  double worst_target = 0.0, worst = 0.0, first = 0.0, before = 0.0, before_target = 0.0;
  for (uint32_t frame = 0; frame < 40; ++frame) {
    rig.set_picture(sky(frame >= 20));
    rig.draw(frame, 1.0 / 60.0);
    const ExposureState state = rig.state();
    if (frame == 0)
      first = state.exposure;
    else
      worst = std::max(worst, std::abs(state.exposure - before)),
      worst_target = std::max(worst_target, std::abs(state.target - before_target));
    before = state.exposure, before_target = state.target;
  }
  std::printf("noise of 2 %%, then the sun: target moves by at most %.5f stops a frame, exposure by %.6f\n",
              worst_target, worst);
  CHECK(worst_target < 0.01);
  CHECK(worst < 0.001);
  CHECK(std::abs(before - first) < 0.005);
}

TEST_CASE("hard: a mean of light instead of its logarithm follows the sun") {
  // The naive meter: 4 pixels of 57,600 take its exposure down by stops.
  Image picture = flat_picture(320, 180, glm::vec3(0.02f));
  for (uint32_t i = 0; i < 4; ++i) picture.pixels[1000 + i] = glm::vec4(glm::vec3(2e4f), 1.0f);
  double mean = 0.0;
  for (const glm::vec4& pixel : picture.pixels) mean += pixel.g / double(picture.pixels.size());
  const double naive = std::log2(mean / 0.02);
  DisplayRig rig({320, 180}, {{"exposure.stride", "1"}, {"exposure.adaptation", "1"}});
  rig.set_picture(picture);
  rig.draw(0, 0.0);
  const double held = std::abs(rig.state().mean_log2 - std::log2(0.02));
  std::printf("the sun's disc in a picture: mean of light off by %.1f stops, trimmed mean of logarithms by %.3f\n",
              naive, held);
  CHECK(naive > 5.0);
  CHECK(held < 0.1);  // a picture of one colour is known to half a bin
}
