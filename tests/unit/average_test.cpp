// Averaging of n x n pixels: the identity for one, means of light for more, in both kinds of pictures.
#include "common/image/average.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace welkin;

TEST_CASE("the mean of one pixel is the pixel, in every level", "[average]") {
  Image8 levels{16, 16, std::vector<uint8_t>(1024)};
  for (size_t i = 0; i < 1024; ++i) levels.rgba[i] = static_cast<uint8_t>(i / 4 * (i % 4 + 1) + i % 4);
  CHECK(image::averaged(levels, 1).rgba == levels.rgba);
  const Image picture{2, 1, {{1e-30f, 3e38f, -2.5f, 0.3f}, {0.1f, std::numeric_limits<float>::infinity(), 0.0f, 1.0f}}};
  CHECK(image::averaged(picture, 1).pixels == picture.pixels);
}

TEST_CASE("means are of light, not of codes", "[average]") {
  Image picture{4, 2, std::vector<glm::vec4>(8, glm::vec4(1.0f))};
  picture.pixels[0] = {5.0f, 1.0f, 1.0f, 1.0f};
  picture.pixels[7] = {NAN, 1.0f, 9.0f, 1.0f};
  const Image mean = image::averaged(picture, 2);
  REQUIRE(mean.pixels.size() == 2);
  CHECK(mean.width == 2);
  CHECK(mean.height == 1);
  CHECK(mean.pixels[0] == glm::vec4(2.0f, 1.0f, 1.0f, 1.0f));
  CHECK(std::isnan(mean.pixels[1].r));  // is not averaged away
  CHECK(mean.pixels[1].b == 3.0f);

  Image8 board{2, 2, std::vector<uint8_t>(16, 255)};  // two black, two white: half of the light is sRGB 188, not 128
  for (const size_t black : {0, 1, 2, 12, 13, 14}) board.rgba[black] = 0;
  CHECK(image::averaged(board, 2).rgba == std::vector<uint8_t>{188, 188, 188, 255});
}
