// The display pass as a whole: what it draws, what a scene that has no meter does not have, and what dithering does to
// the bands of a twilight.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "tests/gpu/06_rig.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

const char* const kNames[] = {"clamp", "reinhard", "aces_narkowicz", "aces_hill", "lottes", "uchimura", "uncharted2"};

std::vector<std::string> pass_names(DisplayRig& rig) {
  std::vector<std::string> names;
  for (const gpu::PassTime& pass : rig.times()) names.push_back(pass.name);
  return names;
}

// Light of a dusk: a slow gradient from top to bottom, every row one value.
Image dusk(uint32_t width, uint32_t height) {
  Image picture = flat_picture(width, height, glm::vec3(0.0f));
  for (uint32_t y = 0; y < height; ++y)
    for (uint32_t x = 0; x < width; ++x)
      picture.pixels[y * width + x] = glm::vec4(
          glm::vec3(1e-4f * std::exp2(0.6f * (float(y) + 0.5f) / float(height))) * glm::vec3(0.5f, 0.6f, 1.0f), 1.0f);
  return picture;
}

}  // namespace

TEST_CASE("an exposure set by hand leaves no pass and no buffer") {
  const std::vector<std::pair<std::string, std::string>> by_hand{{"exposure.mode", "manual"}}, none;
  DisplayRig metered({32, 32}, none), manual({32, 32}, by_hand), scene_manual({32, 32}, none, {.manual = true});
  for (DisplayRig* rig : {&metered, &manual, &scene_manual}) {
    rig->set_picture(flat_picture(32, 32, glm::vec3(0.01f)));
    rig->draw(0, 0.0);
  }
  CHECK(pass_names(metered) == std::vector<std::string>{"histogram", "exposure", "display"});
  CHECK(metered.bytes() == 1024 + 16);
  for (DisplayRig* rig : {&manual, &scene_manual}) {
    CHECK(pass_names(*rig) == std::vector<std::string>{"display"});
    CHECK(rig->bytes() == 0);
    CHECK_FALSE(rig->metered());
  }
  // A change of mind while it runs: the meter goes, and comes back measuring from its first frame on.
  metered.post().manual = true;
  metered.draw(1, 1.0 / 60.0);
  CHECK(pass_names(metered) == std::vector<std::string>{"display"});
  metered.post().manual = false;
  metered.draw(2, 1.0 / 60.0);
  CHECK(metered.state().exposure == metered.state().target);
}

TEST_CASE("by hand it is 24 times two to the stops; metered, compensation adds stops") {
  for (const char* curve : kNames) {
    const auto level = [&](const std::vector<std::pair<std::string, std::string>>& knobs, const Post& post,
                           float light) {
      std::vector<std::pair<std::string, std::string>> all{{"display.curve", curve}, {"display.dither", "off"}};
      all.insert(all.end(), knobs.begin(), knobs.end());
      DisplayRig rig({8, 8}, all, post);
      rig.set_picture(flat_picture(8, 8, glm::vec3(light)));
      rig.draw(0, 0.0);
      return int(rig.displayed().rgba[0]);
    };
    INFO(curve);
    const int grey = 118;  // 255 srgb(0.18) = 117.6
    CHECK(std::abs(level({{"exposure.mode", "manual"}}, {}, 0.18f / 24.0f) - grey) <= 1);
    CHECK(std::abs(level({{"exposure.mode", "manual"}}, {.exposure_ev = 3.0}, 0.18f / 192.0f) - grey) <= 1);
    CHECK(std::abs(level({{"exposure.adaptation", "1"}}, {}, 3e-5f) - grey) <=
          3);  // 64 pixels: known to a few hundredths of a stop
    CHECK(level({{"exposure.adaptation", "1"}, {"exposure.compensation", "2"}}, {}, 3e-5f) ==
          level({{"exposure.adaptation", "1"}}, {.compensation_ev = 2.0}, 3e-5f));
    CHECK(level({{"exposure.adaptation", "1"}, {"exposure.compensation", "2"}}, {}, 3e-5f) > grey + 40);
  }
}

TEST_CASE("strips: each shows the middle of the picture through its own curve") {
  constexpr uint32_t kWidth = 7 * 24, kHeight = 9;
  Image picture = flat_picture(kWidth, kHeight, glm::vec3(0.0f));
  for (uint32_t i = 0; i < kWidth * kHeight; ++i)
    picture.pixels[i] = glm::vec4(glm::vec3(0.05f, 0.02f, 0.001f) * float(1 + i % kWidth), 1.0f);
  const auto shown = [&](const char* curve, const char* space) {
    DisplayRig rig(
        {kWidth, kHeight},
        {{"display.curve", curve}, {"display.space", space}, {"display.dither", "off"}, {"exposure.mode", "manual"}});
    rig.set_picture(picture);
    rig.draw(0, 0.0);
    return rig.displayed();
  };
  for (const char* space : {"rgb", "xyY"}) {
    const Image8 all = shown("compare", space);
    for (uint32_t strip = 0; strip < 7; ++strip) {
      const Image8 one = shown(kNames[strip], space);
      INFO(kNames[strip] << " in " << space);
      for (uint32_t x = strip > 0; x < 24; ++x)  // the separator is a strip's first column
        for (int c = 0; c < 3; ++c) REQUIRE(int(all.rgba[4 * (strip * 24 + x) + c]) == int(one.rgba[4 * (72 + x) + c]));
      if (strip > 0) CHECK(all.rgba[4 * strip * 24] + all.rgba[4 * strip * 24 + 1] == 0);
    }
  }
}

TEST_CASE("a value that is no number is magenta, and its neighbours are not") {
  Image picture = flat_picture(16, 16, glm::vec3(0.01f));
  picture.pixels[20].g = std::numeric_limits<float>::quiet_NaN();
  picture.pixels[40].b = std::numeric_limits<float>::infinity();
  DisplayRig rig({16, 16}, {});
  rig.set_picture(picture);
  rig.draw(0, 0.0);
  const Image8 shown = rig.displayed();
  for (size_t i = 0; i < 256; ++i) {
    const bool magenta = shown.rgba[4 * i] == 255 && shown.rgba[4 * i + 1] == 0 && shown.rgba[4 * i + 2] == 255;
    REQUIRE(magenta == (i == 20 || i == 40));
  }
}

TEST_CASE("dithering: the bands of a dusk are gone, its light is not") {
  // What an eye does from afar: means over blocks of 16 x 16 pixels. Undithered, a block is off by up to half a level
  // in one direction over the whole band; dithered, its error is that of 256 independent roundings.
  constexpr uint32_t kWidth = 512, kHeight = 1024, kBlock = 16;
  const Image picture = dusk(kWidth, kHeight);
  double rms[2] = {}, longest[2] = {};
  Image8 shown[2];
  for (int on = 0; on < 2; ++on) {
    DisplayRig rig({kWidth, kHeight},
                   {{"display.dither", on ? "on" : "off"}, {"display.curve", "clamp"}, {"exposure.mode", "manual"}},
                   {.exposure_ev = 4.0});
    rig.set_picture(picture);
    rig.draw(0, 0.0);
    shown[on] = rig.displayed();
    double sum = 0.0, count = 0.0;
    for (uint32_t top = 0; top < kHeight; top += kBlock)
      for (uint32_t left = 0; left < kWidth; left += kBlock, ++count) {
        double error = 0.0;
        for (uint32_t y = top; y < top + kBlock; ++y)
          for (uint32_t x = left; x < left + kBlock; ++x) {
            const double linear = std::clamp(24.0 * 16.0 * picture.pixels[y * kWidth + x].g, 0.0, 1.0);
            const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
            error += shown[on].rgba[4 * (y * kWidth + x) + 1] - 255.0 * encoded;
          }
        sum += std::pow(error / (kBlock * kBlock), 2.0);
      }
    rms[on] = std::sqrt(sum / count);
    // The longest run of rows of one and the same level: a band.
    double run = 1.0;
    for (uint32_t y = 1; y < kHeight; ++y) {
      run = shown[on].rgba[4 * y * kWidth + 1] == shown[on].rgba[4 * (y - 1) * kWidth + 1] ? run + 1.0 : 1.0;
      longest[on] = std::max(longest[on], run);
    }
  }
  std::printf(
      "dusk, blocks of 16 x 16: rms error %.3f levels without, %.3f with dithering; longest band %.0f and %.0f rows\n",
      rms[0], rms[1], longest[0], longest[1]);
  CHECK(rms[0] > 0.2);
  CHECK(rms[1] < 0.05);  // sqrt(1/12 + 1/6)/16 = 0.031 for independent roundings; noise of neighbours cancels some
  CHECK(longest[0] > 10.0);
  CHECK(longest[1] < 0.7 * longest[0]);
  // Off is off: every pixel is the nearest level, and every row one level.
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 1; x < kWidth; ++x)
      REQUIRE(int(shown[0].rgba[4 * (y * kWidth + x) + 1]) == int(shown[0].rgba[4 * y * kWidth + 1]));
}

TEST_CASE("dithering leaves black black and white white") {
  for (float light : {0.0f, 1e6f}) {
    DisplayRig rig({64, 64}, {{"exposure.mode", "manual"}, {"display.curve", "clamp"}});
    rig.set_picture(flat_picture(64, 64, glm::vec3(light)));
    rig.draw(0, 0.0);
    const Image8 shown = rig.displayed();
    for (size_t i = 0; i < shown.rgba.size(); ++i)
      REQUIRE(int(shown.rgba[i]) == (light > 0.0f || i % 4 == 3 ? 255 : 0));
  }
}
