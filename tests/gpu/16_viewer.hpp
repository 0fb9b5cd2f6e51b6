// Small frames of chapter 16's viewer.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>

#include "chapters/16_noise/noise.hpp"
#include "chapters/16_noise/viewer.hpp"
#include "common/app/chapter.hpp"
#include "common/app/renderer.hpp"
#include "tests/gpu/harness.hpp"

namespace welkin::test {

struct ViewerFixture {
  Scene scene;
  Settings settings;
  std::string no_fault;
  app::Context context{device(), scene, settings, no_fault};
  app::Chapter chapter;
  std::unique_ptr<app::Composition> program;
  std::unique_ptr<app::Renderer> renderer;

  explicit ViewerFixture(std::initializer_list<const char*> assignments = {}, VkExtent2D size = {32, 18}) {
    const std::vector<app::Effect> effects{noise_textures(), weather_texture(), alligator_texture(), noise_viewer()};
    settings = Settings(app::knobs_of(effects, 16));
    for (const char* quick : {"noise.base_size=32", "noise.detail_size=16", "noise.curl_size=64", "weather.size=128",
                              "noise.alligator_size=32"})
      set(quick);
    for (const char* assignment : assignments) set(assignment);
    program = std::make_unique<app::Composition>(context, effects);
    renderer = std::make_unique<app::Renderer>(context, chapter, *program, size);
  }
  void set(const char* assignment) {
    const auto [name, value] = split_assignment(assignment);
    settings.set(name, value);
  }
  Image picture() {
    renderer->draw({}, 0.0, 1, 0);
    return renderer->picture();
  }
  bool says(const std::string& words) const { return program->explain().find(words) != std::string::npos; }
};

}  // namespace welkin::test
