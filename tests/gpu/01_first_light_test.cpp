// Chapter 01's picture against integer arithmetic on the processor: every bit of every pixel.
#include <catch2/catch.hpp>
#include <cstring>

#include "chapters/01_first_light/first_light.hpp"
#include "common/app/renderer.hpp"
#include "common/gpu/resources.hpp"
#include "tests/gpu/harness.hpp"

namespace {

using namespace welkin;

int blend(int first, int last, int position, int length) {
  const int span = length > 1 ? length - 1 : 1;
  return (first * (span - position) + last * position + span / 2) / span;
}

struct Drawn {
  Image linear;
  Image8 shown;
};

Drawn draw(VkExtent2D size) {
  const Scene scene;
  const Settings settings;
  const std::string no_fault;
  const app::Context context{test::device(), scene, settings, no_fault};
  const app::Chapter chapter{.display = app::Display::raw};
  FirstLight program(context);
  app::Renderer renderer(context, chapter, program, size);
  renderer.draw({}, 0.0, 1, 0);
  return {renderer.picture(), renderer.displayed()};
}

}  // namespace

TEST_CASE("first light is exact in every pixel, at sizes that fit no workgroup") {
  const int night_top[3] = {16, 24, 72}, night_bottom[3] = {96, 64, 88};
  const int dawn_top[3] = {64, 112, 200}, dawn_bottom[3] = {255, 176, 96};
  for (const VkExtent2D size : {VkExtent2D{1, 1}, {1, 9}, {8, 8}, {33, 17}, {320, 180}}) {
    const Drawn drawn = draw(size);
    REQUIRE(drawn.linear.pixels.size() == size_t{size.width} * size.height);
    int wrong = 0;
    for (uint32_t y = 0; y < size.height; ++y) {
      for (uint32_t x = 0; x < size.width; ++x) {
        const size_t i = size_t{y} * size.width + x;
        for (int c = 0; c < 3; ++c) {
          const int height = static_cast<int>(size.height), row = static_cast<int>(y);
          const int level =
              blend(blend(night_top[c], night_bottom[c], row, height), blend(dawn_top[c], dawn_bottom[c], row, height),
                    static_cast<int>(x), static_cast<int>(size.width));
          const float value = static_cast<float>(level) * (1.0f / 255.0f);
          if (drawn.linear.pixels[i][c] != value || drawn.shown.rgba[4 * i + static_cast<size_t>(c)] != level) ++wrong;
        }
        if (drawn.linear.pixels[i].a != 1.0f || drawn.shown.rgba[4 * i + 3] != 255) ++wrong;
      }
    }
    INFO(size.width << "x" << size.height);
    CHECK(wrong == 0);
  }
}

TEST_CASE("resources are accounted while they live, and only then") {
  const uint64_t before = test::device().allocated_bytes();
  {
    const gpu::Buffer buffer =
        gpu::create_buffer(test::device(), "ledger", 1000, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::device);
    CHECK(test::device().allocated_bytes() >= before + 1000);
    gpu::Buffer moved =
        gpu::create_buffer(test::device(), "other", 10, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload);
    moved = gpu::create_buffer(test::device(), "third", 20, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload);
    CHECK(moved.as<float>().size() == 5);
  }
  CHECK(test::device().allocated_bytes() == before);
}

TEST_CASE("an image no device can hold is refused in one line") {
  for (const VkExtent2D size : {VkExtent2D{0, 4}, {4, 0}, {1u << 30, 1}}) {
    try {
      gpu::create_image(test::device(), "absurd", size, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_STORAGE_BIT);
      FAIL("accepted");
    } catch (const Error& error) {
      CHECK(std::string(error.what()).find("absurd") == 0);
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
}

TEST_CASE("device choice says what was wanted and what was offered") {
  const auto message = [](const std::vector<gpu::Candidate>& candidates, const std::string& wanted,
                          Exit& code) -> std::string {
    try {
      gpu::choose_device(candidates, wanted);
    } catch (const Error& error) {
      code = error.exit_code;
      return error.what();
    }
    return "";
  };
  Exit code = Exit::ok;
  CHECK(message({}, "", code).find("no Vulkan device") == 0);
  CHECK(code == Exit::skipped);
  const gpu::Candidate lame{.name = "Lame 3000", .lacks = {"synchronization2"}};
  const std::string line = message({lame}, "", code);
  CHECK(line.find("Lame 3000 (lacks synchronization2)") != std::string::npos);
  CHECK(code == Exit::usage);
  CHECK(message({lame}, "Lame", code).find("lacks synchronization2") != std::string::npos);
  CHECK(message({lame}, "1", code).find("offered: 0 Lame 3000") != std::string::npos);
}

TEST_CASE("the memory account keeps apart what has one name") {
  const gpu::Device& device = test::device();
  const uint64_t before = device.allocated_bytes();
  const auto buffer = [&](VkDeviceSize bytes) {
    return gpu::create_buffer(device, "twin", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::device);
  };
  const gpu::Buffer small = buffer(64 << 10);
  const uint64_t with_small = device.allocated_bytes();
  {
    gpu::Buffer large = buffer(1 << 20), moved = std::move(large);
    CHECK(device.allocated_bytes() >= with_small + (1 << 20));
    large = buffer(2 << 20);
    moved = std::move(large);  // whose megabyte `large` now holds
    CHECK(device.allocated_bytes() >= with_small + (3 << 20));
  }
  CHECK(device.allocated_bytes() == with_small);
  CHECK(with_small >= before + (64 << 10));
}
