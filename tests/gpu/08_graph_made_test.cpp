// The frame graph's resources and pipelines on a device: names checked against shaders, mips, iteration, histories,
// more passes than one pool of timestamps holds, and two hundred frames in which everything changes, under
// synchronization validation.
#include <catch2/catch.hpp>
#include <random>

#include "chapters/06_display/display.hpp"
#include "common/gpu/instance.hpp"
#include "common/gpu/shader_file.hpp"
#include "tests/gpu/10_sky.hpp"
#include "tests/gpu/11_parts.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

// A graph without effects, executed outside of any frame.
struct GraphFixture {
  graph::Graph graph{device()};
  gpu::CommandPool pool = gpu::create_command_pool(device());
  gpu::Timer timer{device()};
  uint32_t index = 0;

  void execute() {
    const gpu::Image no_target;
    const CameraRays no_camera{};
    gpu::run_once(device(), pool, [&](VkCommandBuffer commands) {
      timer.begin_frame(commands);
      graph.execute({commands, no_target, no_camera, timer, index++, 0, 0.0});
    });
  }
  std::string refused(graph::Step step) {
    graph::Pass pass{.name = "tried"};
    pass.steps.push_back(std::move(step));
    graph.add(std::move(pass));
    try {
      graph.compile();
      execute();
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
};

std::vector<app::Effect> whole_frame() {
  std::vector<app::Effect> effects = terrain_effects();
  effects.push_back(exposure());
  effects.push_back(display());
  return effects;
}

}  // namespace

TEST_CASE(
    "graph: a pipeline is one for the constants its shader has, and goes when nobody holds it and there are many") {
  gpu::Pipelines pipelines(device(), 4);
  const auto get = [&](int form, gpu::Constants more = {}) {
    return pipelines.get("tests/03_rays.comp", joined({{"FORM", form}}, more));
  };
  const auto held = get(0);
  CHECK(get(0) == held);
  CHECK(get(0, {{"OF_ANOTHER_SHADER", 7, true}}) == held);
  CHECK(pipelines.count() == 1);
  for (int form = 1; form <= 3; ++form) get(form);
  CHECK(pipelines.count() == 4);
  pipelines.drop_unused();
  CHECK(pipelines.count() == 1);
  CHECK(get(0) == held);
}

TEST_CASE("graph: a shader says what it has, and a wrong name, type or size is one clear line") {
  const gpu::ShaderInterface exposure = gpu::reflect(gpu::load_spirv("06_display/exposure.comp"), "exposure");
  REQUIRE(exposure.bindings.size() == 2);
  CHECK((exposure.bindings[0].name == "Histogram" && exposure.bindings[0].reads && !exposure.bindings[0].writes &&
         exposure.bindings[0].bytes == 1024));
  CHECK((exposure.bindings[1].name == "State" && exposure.bindings[1].reads && exposure.bindings[1].writes &&
         exposure.bindings[1].bytes == 16));
  CHECK(exposure.push_constant_bytes == 28);
  const std::vector<uint32_t> whole = gpu::load_spirv("06_display/exposure.comp");
  for (size_t end = 5; end < whole.size(); ++end)  // wherever it is cut
    CHECK_THROWS_WITH(gpu::reflect(std::span(whole).first(end), "exposure"), Catch::Contains("SPIR-V is"));
  for (size_t at = 5; at < whole.size(); ++at) {  // and with a word that is another: an error or none, nothing else
    std::vector<uint32_t> odd = whole;
    odd[at] ^= 0x00010007u;
    try {
      gpu::reflect(odd, "exposure");
    } catch (const Error&) {
    }
  }

  const auto record = [](const graph::Recorder& r) { r.push(1.0f).dispatch(1); };
  const auto try_step = [&](const std::string& shader, gpu::Constants constants,
                            const std::vector<std::pair<std::string, bool>>& names) {
    GraphFixture fixture;
    graph::Step step{.shader = shader, .constants = std::move(constants), .record = record};
    for (const auto& [name, is_map] : names) {
      const graph::Resource resource =
          is_map ? fixture.graph.add_image(name, {.size = {8, 8}, .format = VK_FORMAT_R32_SFLOAT})
                 : fixture.graph.add_buffer(name, {4});
      step.bindings.push_back({name, resource});
      fixture.graph.set_output(resource);
    }
    return fixture.refused(std::move(step));
  };
  const std::string mip = "tests/08_first_mip.comp";
  CHECK(try_step(mip, {}, {{"map", true}}).find("its push constants are 0 bytes, and 4 were given") !=
        std::string::npos);
  CHECK(try_step(mip, {}, {}).find("nothing is bound to 'map'") != std::string::npos);
  CHECK(try_step(mip, {}, {{"map", true}, {"mop", true}}).find("has no binding 'mop'; it has map") !=
        std::string::npos);
  CHECK(try_step(mip, {}, {{"map", false}}).find("an image is wanted, and this is a buffer") != std::string::npos);
  CHECK(try_step(mip, {{"SCALES", 1.0f}}, {{"map", true}}).find("no constant 'SCALES'; it has SCALE") !=
        std::string::npos);
  CHECK(try_step(mip, {{"SCALE", 1}}, {{"map", true}}).find("constant 'SCALE' is of type float, and a int was given") !=
        std::string::npos);
}

TEST_CASE("graph: mips one after the other in one pass, each waiting for the one before") {
  GraphFixture fixture;
  const graph::Resource map =
      fixture.graph.add_image("map", {.size = {16, 16}, .format = VK_FORMAT_R32_SFLOAT, .mips = 5});
  graph::Pass pass{.name = "mips"};
  pass.steps.push_back({.shader = "tests/08_first_mip.comp",
                        .constants = {{"SCALE", 2.0f}},
                        .bindings = {{"map", map, {}, 0}},
                        .record = [](const graph::Recorder& r) { r.dispatch(2, 2); }});
  for (int mip = 1; mip < 5; ++mip)
    pass.steps.push_back({.shader = "tests/08_next_mip.comp",
                          .bindings = {{"finer", map, {}, mip - 1}, {"coarser", map, {}, mip}},
                          .record = [](const graph::Recorder& r) { r.dispatch(1); }});
  fixture.graph.add(std::move(pass));
  fixture.graph.set_output(map);
  fixture.graph.compile();
  CHECK(fixture.graph.barriers().size() == 9);  // a first layout for each of five, and four reads
  fixture.execute();
  const gpu::Image& image = fixture.graph.image(map);
  const gpu::Buffer back =
      gpu::create_buffer(device(), "back", 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Where::readback);
  gpu::run_once(device(), fixture.pool, [&](VkCommandBuffer commands) {
    const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 4, 0, 1}, .imageExtent = {1, 1, 1}};
    const VkMemoryBarrier2 all{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                               .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                               .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                               .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                               .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT};
    const VkDependencyInfo info{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &all};
    vkCmdPipelineBarrier2(commands, &info);
    vkCmdCopyImageToBuffer(commands, image.handle, VK_IMAGE_LAYOUT_GENERAL, back.handle, 1, &region);
    gpu::buffer_barrier(commands, back.handle, gpu::kTransferWrite, gpu::kHostRead);
  });
  CHECK(back.as<float>()[0] == 2.0f * 255.0f);  // the largest of all
}

TEST_CASE("graph: a history holds last frame's, until a cut, a resize or a frame without it") {
  Scene scene;
  const Settings settings(std::vector<Knob>{});
  const std::string no_fault;
  const app::Context context{device(), scene, settings, no_fault};
  app::Effect counter{.name = "counter", .chapter = 8};
  counter.declare = [](app::Builder& builder, app::Board& board) {
    const graph::Resource frames = builder.graph.add_history("frames"), picture = builder.picture(board, "picture");
    graph::Pass pass{.name = "count", .changed = [](const app::Frame&) { return true; }};
    const auto record = [frames](const graph::Recorder& r) {
      r.push(r.graph.valid(frames) ? 1 : 0).dispatch_over(r.graph.image(frames).size);
    };
    pass.steps.push_back({.shader = "tests/08_history.comp",
                          .bindings = {{.name = "before", .resource = frames, .last_frame = true}, {"now", frames}},
                          .record = record});
    pass.steps.push_back({.shader = "tests/08_history.comp",
                          .bindings = {{.name = "before", .resource = frames, .last_frame = true}, {"now", picture}},
                          .record = record});
    builder.graph.add(std::move(pass));
  };
  app::Composition program(context, {counter});
  const app::Chapter chapter;
  const auto count = [&](app::Renderer& renderer, uint32_t index, double altitude_km = 1.0) {
    renderer.draw(app::pose_of({.altitude_km = altitude_km}, 6360.0), 0.0, 1, index);
    return renderer.picture().pixels.front();
  };
  app::Renderer first(context, chapter, program, {16, 8});
  CHECK(count(first, 0) == glm::vec4(1.0f, 1.0f, 1.0f, 1.0f));  // count, cut, last altitude, altitude
  CHECK(count(first, 1, 2.0) == glm::vec4(2.0f, 0.0f, 1.0f, 2.0f));
  CHECK(count(first, 2, 3.0) == glm::vec4(3.0f, 0.0f, 2.0f, 3.0f));
  app::Renderer second(context, chapter, program, {24, 8});  // another size
  CHECK(count(second, 3, 4.0) == glm::vec4(1.0f, 1.0f, 4.0f, 4.0f));
  CHECK(count(second, 4, 5.0).r == 2.0f);
  program.graph().cut();
  CHECK(count(second, 5).r == 1.0f);
}

TEST_CASE("graph: twenty passes are timed, and each waits for the one before") {
  GraphFixture fixture;
  std::vector<graph::Resource> maps;
  for (int i = 0; i < 20; ++i) {
    maps.push_back(fixture.graph.add_image("map", {.size = {8, 8}, .format = VK_FORMAT_R32_SFLOAT}));
    graph::Pass pass{.name = "pass " + std::to_string(i)};
    if (i == 0)
      pass.steps.push_back({.shader = "tests/08_first_mip.comp",
                            .bindings = {{"map", maps[0]}},
                            .record = [](const graph::Recorder& r) { r.dispatch(1); }});
    else
      pass.steps.push_back({.shader = "tests/08_next_mip.comp",
                            .bindings = {{"finer", maps[i - 1]}, {"coarser", maps[i]}},
                            .record = [](const graph::Recorder& r) { r.dispatch(1); }});
    fixture.graph.add(std::move(pass));
  }
  fixture.graph.set_output(maps.back());
  fixture.graph.compile();
  fixture.execute();
  CHECK(fixture.timer.read().size() == 20);
  CHECK(fixture.timer.read().back().name == "pass 19");
}

// Adds, removes and changes everything that can be, in random order: an hour of a window's events in half a minute.
TEST_CASE("08 hard: two hundred frames of resizes, dropped scenes and effects on and off, synchronization validated") {
  gpu::Instance instance(gpu::Validation::sync, {});
  const gpu::Device validated(instance, gpu::choose_device(gpu::list_devices(instance), ""), false);
  std::vector<app::Effect> effects = whole_frame();
  Scene scene = scene_named("noon");
  Settings settings(app::knobs_of(effects, 11));
  for (const char* quick :
       {"multiple_scattering.iterations=3", "multiple_scattering.directions=16", "transmittance.height=16",
        "terrain.shadow_size=64", "froxels.size=8", "froxels.slices=8", "aerial.march_slices=8"}) {
    const auto [name, value] = split_assignment(quick);
    settings.set(name, value);
  }
  const std::string no_fault;
  const app::Context context{validated, scene, settings, no_fault};
  app::Composition program(context, std::move(effects));
  const app::Chapter chapter;
  std::unique_ptr<app::Renderer> renderer =
      std::make_unique<app::Renderer>(context, chapter, program, VkExtent2D{24, 16});
  const std::vector<std::pair<const char*, std::vector<const char*>>> switches{
      {"orders", {"0", "1"}},
      {"aerial.march_slices", {"8", "12"}},
      {"froxels.samples", {"1", "2"}},

      {"aerial.method", {"froxels", "march"}},
      {"tables", {"changed", "all"}},
      {"sky_view.method", {"auto", "table", "march"}},
      {"froxels.transmittance", {"colour", "mean"}},
      {"display.curve", {"aces_hill", "compare"}},
      {"sky_view.size", {"96x54", "192x108"}},
      {"multiple_scattering.method", {"moments", "published"}}};
  Random random(8);
  double altitude_km = 0.5;
  for (uint32_t frame = 0; frame < 200; ++frame) {
    switch (random.next() % 7) {
      case 0:
        renderer = std::make_unique<app::Renderer>(
            context, chapter, program,
            VkExtent2D{static_cast<uint32_t>(1 + random.next() % 40), static_cast<uint32_t>(1 + random.next() % 24)});
        break;
      case 1:
        scene = scene_named(random.next() % 2 ? "sunset" : "noon");
        if (scene.terrain) scene.terrain->size = 64;
        break;
      case 2:
        if (scene.terrain)
          scene.terrain.reset();
        else
          scene.terrain = Terrain{.size = 48, .seed = static_cast<int>(random.next() % 3)};
        break;
      case 3:
        if (scene.terrain)
          scene.terrain->shadows = !scene.terrain->shadows;
        else
          scene.sun.disc = !scene.sun.disc;
        break;
      case 4:
        scene.post.manual = !scene.post.manual;
        altitude_km = random.next() % 3 == 0 ? 400.0 : 0.5;
        break;
      default: {
        const auto& [knob, values] = switches[random.next() % switches.size()];
        settings.set(knob, values[random.next() % values.size()]);
      }
    }
    const app::CameraPose pose =
        app::pose_of({.altitude_km = altitude_km, .azimuth_deg = double(frame), .elevation_deg = -5.0}, 6360.0);
    renderer->draw(pose, 0.0, 1, frame);
    if (frame % 10 == 9) {  // the incrementally rebuilt program must draw the same as a fresh one
      const Image got = renderer->picture();
      app::Composition fresh(context, whole_frame());
      app::Renderer fresh_renderer(context, chapter, fresh, {got.width, got.height});
      fresh_renderer.draw(pose, 0.0, 1, frame);
      CAPTURE(frame);
      REQUIRE(got.pixels == fresh_renderer.picture().pixels);
      for (const glm::vec4& pixel : got.pixels) REQUIRE(std::isfinite(pixel.r + pixel.g + pixel.b));
    }
    REQUIRE(instance.validation_messages().empty());
  }
}
