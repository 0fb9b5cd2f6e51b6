// EXR: exact round trips, and files that are missing, cut short, damaged or of a kind that is not read.
#include "common/image/exr.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "temporary.hpp"

using namespace welkin;
using Catch::Matchers::Contains;

namespace {

Image noise(uint32_t width, uint32_t height) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> exponent(-30.0f, 15.0f);
  Image picture{width, height, {}};
  for (size_t i = 0; i < size_t{width} * height; ++i)
    picture.pixels.emplace_back(std::exp2(exponent(random)), -std::exp2(exponent(random)), std::exp2(exponent(random)),
                                0.25f);
  return picture;
}

void put(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

bool survives(const std::filesystem::path& file) {
  try {
    image::read_exr(file);
    return true;
  } catch (const Error& error) {
    REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
    return false;
  }
}

}  // namespace

TEST_CASE("EXR round trips every bit, odd sizes too", "[exr]") {
  const TemporaryDirectory dir;
  for (const auto& [w, h] : {std::pair{1u, 1u}, {3u, 5u}, {5u, 3u}, {33u, 17u}, {128u, 72u}}) {
    Image wrote = noise(w, h);
    wrote.pixels[0] = {std::numeric_limits<float>::infinity(), 0.0f, std::numeric_limits<float>::denorm_min(), 0.5f};
    image::write_exr(dir / "a.exr", wrote);
    const Image read = image::read_exr(dir / "a.exr");
    CHECK(read.width == w);
    CHECK(read.height == h);
    for (auto& pixel : wrote.pixels) pixel.a = 1.0f;  // what a file without alpha means
    CHECK(read.pixels == wrote.pixels);
  }
}

TEST_CASE("EXR keeps NaN for the metrics to see", "[exr]") {
  const TemporaryDirectory dir;
  image::write_exr(dir / "a.exr", {1, 1, {glm::vec4(NAN, 1.0f, 2.0f, 1.0f)}});
  const auto pixel = image::read_exr(dir / "a.exr").pixels[0];
  CHECK(std::isnan(pixel.r));
  CHECK(pixel.g == 1.0f);
}

TEST_CASE("EXR: bad files are named, with what is wrong", "[exr]") {
  const TemporaryDirectory dir;
  CHECK_THROWS_WITH(image::read_exr(dir / "none.exr"), Contains("none.exr") && Contains("No such file"));
  CHECK_THROWS_WITH(image::read_exr(dir.path), Contains("directory"));
  put(dir / "empty.exr", "");
  CHECK_THROWS_WITH(image::read_exr(dir / "empty.exr"), Contains("not an EXR"));
  CHECK_THROWS_WITH(image::write_exr(dir / "out.exr", {0, 0, {}}), Contains("0x0"));
  CHECK_THROWS_WITH(image::write_exr(dir / "out.exr", {2, 2, {glm::vec4(0.0f)}}), Contains("1 pixels"));
  CHECK_FALSE(std::filesystem::exists(dir / "out.exr"));

  image::write_exr(dir / "a.exr", noise(4, 40));
  const std::string good = read_file(dir / "a.exr", 100000);
  const auto refused = [&](const char* attribute, size_t skip, auto value, const char* message) {
    std::string bytes = good;
    const size_t at = attribute ? bytes.find(attribute) + skip : skip;
    std::memcpy(&bytes.at(at), &value, sizeof value);
    put(dir / "bad.exr", bytes);
    CHECK_THROWS_WITH(image::read_exr(dir / "bad.exr"), Contains(message));
  };
  const size_t window = std::strlen("dataWindow") + 1 + std::strlen("box2i") + 1 + 4;
  refused("dataWindow", window + 8, int32_t{16384}, "16385x40");
  refused("dataWindow", window + 8, int32_t{-1}, "0x40");
  refused("dataWindow", window + 12, std::numeric_limits<int32_t>::max(), "accepted is 1 to 16384");
  refused("dataWindow", window + 8, int32_t{16383}, "damaged");  // more pixels than the blocks can hold
  const size_t method = 2 * std::strlen("compression") + 2 + 4;
  refused("compression", method, char{4}, "accepted is none, ZIPS or ZIP");
  refused("compression", method, char{0}, "damaged");
  refused("lineOrder", 2 * std::strlen("lineOrder") + 2 + 4, char{1}, "top to bottom");
  refused("channels", std::strlen("channels") + 1 + std::strlen("chlist") + 1 + 4, 'X', "lacks one of the channels");
  refused(nullptr, 5, char{2}, "accepted is one part of scan lines");  // tiled
  refused(nullptr, 4, char{3}, "accepted is one part of scan lines");  // version 3
}

TEST_CASE("EXR: every truncation is an Error", "[exr]") {
  const TemporaryDirectory dir;
  for (const uint32_t height : {2u, 20u}) {
    image::write_exr(dir / "a.exr", noise(3, height));
    const std::string good = read_file(dir / "a.exr", 100000);
    for (size_t length = 0; length < good.size(); ++length) {
      put(dir / "cut.exr", good.substr(0, length));
      REQUIRE_FALSE(survives(dir / "cut.exr"));
    }
  }
}

TEST_CASE("EXR: damaged files end in Error or success, nothing else", "[exr]") {
  const TemporaryDirectory dir;
  std::mt19937 random(5);
  Image grey{20, 40, std::vector<glm::vec4>(800, glm::vec4(0.5f))};  // compresses well: blocks are truly packed
  int refused = 0;
  for (const Image& picture : {noise(5, 4), grey}) {
    image::write_exr(dir / "a.exr", picture);
    const std::string good = read_file(dir / "a.exr", 100000);
    for (int round = 0; round < 2000; ++round) {
      std::string bytes = good;
      const size_t reach =
          round % 2 == 0 ? bytes.size() : std::min<size_t>(bytes.size(), 400);  // half of them in the header
      for (size_t i = 0; i < 1 + random() % 4; ++i) bytes[random() % reach] ^= static_cast<char>(1 + random() % 255);
      put(dir / "bad.exr", bytes);
      refused += !survives(dir / "bad.exr");
    }
  }
  CHECK(refused > 1000);
}
