// Effects on a composition: the sample of CONTRIBUTING.md, what is rebuilt after which change, and that each effect,
// when left out, leaves nothing behind.
#include <algorithm>
#include <catch2/catch.hpp>

#include "chapters/06_display/display.hpp"
#include "chapters/07_ground_truth/ground_truth.hpp"
#include "common/app/session.hpp"
#include "tests/gpu/10_sky.hpp"
#include "tests/gpu/11_parts.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

// [sample_effect]
// Darkens the picture towards its corners. Wanted when its knob is above 0.
app::Effect vignette() {
  app::Effect effect{.name = "vignette", .chapter = 99};
  effect.knobs = {{.name = "vignette.strength", .meaning = "light lost in the corners", .initial = 0.0}};
  effect.wanted = [](const Scene&, const Settings& settings) -> app::Wanted {
    const double strength = settings.number("vignette.strength");
    return {strength > 0.0, fmt::format("vignette.strength is {}", strength)};
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const graph::Resource before = board.get<app::Picture>("a picture").image;
    const graph::Resource after = builder.picture(board, "vignette");
    graph::Pass pass{.name = "vignette", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back({.shader = "tests/08_vignette.comp",
                          .bindings = {{"before", before}, {"target", after}},
                          .record = [context = builder.context, after](const graph::Recorder& r) {
                            r.push(static_cast<float>(context.settings.number("vignette.strength")));
                            r.dispatch_over(r.graph.image(after).size);
                          }});
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/sample_effect]

std::vector<app::Effect> whole_frame() {
  std::vector<app::Effect> effects = terrain_effects();
  effects.push_back(exposure());
  effects.push_back(display());
  return effects;
}

// A composition of the given effects, with its settings and scene.
struct FrameFixture {
  Scene scene = scene_named("noon");
  Settings settings;
  std::string no_fault;
  app::Context context{device(), scene, settings, no_fault};
  app::Chapter chapter;
  app::CameraPose pose;
  std::unique_ptr<app::Composition> program;
  std::unique_ptr<app::Renderer> renderer;
  uint32_t index = 0;

  explicit FrameFixture(std::vector<app::Effect> effects)
      : settings(app::knobs_of(effects, 11)), pose(app::pose_of(scene.views[0], 6360.0)) {
    scene.terrain->size = 64;
    for (const char* quick :
         {"multiple_scattering.iterations=3", "multiple_scattering.directions=16", "transmittance.height=16",
          "terrain.shadow_size=64", "froxels.size=8", "froxels.slices=8"}) {
      const auto [name, value] = split_assignment(quick);
      if (settings.has(name)) settings.set(name, value);
    }
    program = std::make_unique<app::Composition>(context, std::move(effects));
    renderer = std::make_unique<app::Renderer>(context, chapter, *program, VkExtent2D{24, 16});
  }
  void draw() { renderer->draw(pose, 0.0, 1, index++); }
  uint64_t runs(const char* pass) const { return program->graph().runs(pass); }
};

}  // namespace

TEST_CASE(
    "an effect is one function: the sample of CONTRIBUTING.md darkens the corners, and is not there unless wanted") {
  std::vector<app::Effect> effects = sky_effects();
  effects.push_back(vignette());
  FrameFixture frame(std::move(effects));
  frame.draw();
  const Image plain = frame.renderer->picture();
  CHECK(frame.program->graph().order().back() == "sky");
  CHECK(frame.program->explain().find("vignette               off  vignette.strength is 0") != std::string::npos);
  frame.settings.set("vignette.strength", "0.5");
  frame.draw();
  const Image dark = frame.renderer->picture();
  CHECK(frame.program->graph().order().back() == "vignette");
  CHECK(dark.pixels[0].r / plain.pixels[0].r ==
        Approx(1.0 - 0.25 * (std::pow(23.0 / 24.0, 2) + std::pow(15.0 / 16.0, 2))).epsilon(1e-4));
  CHECK(frame.runs("sky view") == 1);  // the vignette recomputes no table
  frame.settings.set("vignette.strength", "0");
  frame.draw();
  CHECK(frame.renderer->picture().pixels == plain.pixels);
}

TEST_CASE("keys decide what is made anew: a display knob no table, the air what reads it, terrain the terrain") {
  FrameFixture frame(whole_frame());
  frame.draw();
  const auto declared = [&] {
    std::vector<uint64_t> counts;
    for (const char* effect : {"air", "transmittance table", "multiple scattering", "sky view", "terrain",
                               "terrain shadows", "aerial perspective", "display"})
      counts.push_back(frame.program->declared(effect));
    return counts;
  };
  const auto ran = [&] {
    return std::vector<uint64_t>{frame.runs("transmittance"), frame.runs("multiple scattering"), frame.runs("sky view"),
                                 frame.runs("terrain shadows"), frame.runs("aerial perspective")};
  };
  using Counts = std::vector<uint64_t>;
  CHECK(declared() == Counts{1, 1, 1, 1, 1, 1, 1, 1});
  frame.settings.set("display.curve", "uchimura");
  frame.draw();
  CHECK(declared() == Counts{1, 1, 1, 1, 1, 1, 1, 2});
  CHECK(ran() == Counts{1, 1, 1, 1, 1});
  frame.scene.media[1].scattering_per_km *= 1.2;  // thicker air: the same passes, other numbers
  frame.draw();
  CHECK(declared() == Counts{1, 1, 1, 1, 1, 1, 1, 2});
  CHECK(ran() == Counts{2, 2, 2, 1, 2});
  frame.scene.terrain->seed = 5;
  frame.draw();
  CHECK(declared() == Counts{1, 1, 1, 1, 2, 2, 2, 2});
  CHECK(ran() == Counts{2, 2, 3, 2, 3});                   // also the sky view: the ground under the camera changed
  frame.scene.media.erase(frame.scene.media.begin() + 2);  // no ozone: other variants of all that reads the air
  frame.draw();
  CHECK(declared() == Counts{2, 2, 2, 2, 2, 2, 3, 2});
  CHECK(ran() == Counts{3, 3, 4, 2, 4});
}

TEST_CASE("a program drawn by an effect follows its target and the scene") {
  std::vector<app::Effect> effects{paths()};
  Scene scene = scene_named("noon");
  Settings settings(app::knobs_of(effects, 7));
  const std::string no_fault;
  const app::Context context{device(), scene, settings, no_fault};
  const app::Chapter chapter;
  const app::CameraPose pose = app::pose_of(scene.views[0], 6360.0);
  app::Composition program(context, effects);
  const auto drawn = [&](app::Composition& by, VkExtent2D size) {
    app::Renderer renderer(context, chapter, by, size);
    renderer.draw(pose, 0.0, 1, 0);
    return renderer.picture();
  };
  const auto fresh = [&](VkExtent2D size) {
    app::Composition other(context, effects);
    return drawn(other, size);
  };
  // The first picture, one workgroup large, is destroyed; the next one may get its handle.
  for (const VkExtent2D size : {VkExtent2D{8, 8}, VkExtent2D{64, 36}, VkExtent2D{8, 8}, VkExtent2D{48, 27}})
    CHECK(drawn(program, size).pixels == fresh(size).pixels);
  scene.medium("mie")->phase = welkin::Phase::draine;
  CHECK(drawn(program, {16, 9}).pixels == fresh({16, 9}).pixels);
}

TEST_CASE("each effect left out leaves no pass, no byte, no variant, no knob") {
  FrameFixture whole(whole_frame());
  whole.draw();
  const std::vector<app::Effect> effects = whole_frame();
  int left_out = 0;
  for (size_t i = 0; i < effects.size(); ++i) {
    CAPTURE(effects[i].name);
    std::vector<app::Effect> others = effects;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    std::unique_ptr<FrameFixture> without;
    try {
      without = std::make_unique<FrameFixture>(std::move(others));
      without->draw();
    } catch (const Error& error) {  // another effect needs what it offers, or one of its knobs, and says so
      const std::string message = error.what();
      const auto names_it = [&](const Knob& knob) {
        return message.find("unknown knob '" + knob.name + "'") != message.npos;
      };
      CHECK((message.find("needs") != message.npos ||
             std::any_of(effects[i].knobs.begin(), effects[i].knobs.end(), names_it)));
      continue;
    }
    ++left_out;
    for (const Knob& knob : effects[i].knobs) CHECK_FALSE(without->settings.has(knob.name));
    const std::vector<std::string> order = without->program->graph().order();
    for (const std::string& pass : whole.program->passes_of(effects[i].name))
      CHECK(std::count(order.begin(), order.end(), pass) == 0);
    for (const std::string& resource : whole.program->resources_of(effects[i].name)) {
      if (resource == "picture") continue;  // the last effect draws into the target
      CHECK(without->program->graph().find_image(resource) == nullptr);
    }
    CHECK(without->program->bytes() < whole.program->bytes());
    CHECK(without->program->graph().pipelines() < whole.program->graph().pipelines());
  }
  // At least multiple scattering, shadows, froxels, exposure and display can be left out; others are needed.
  CHECK(left_out >= 5);
}
