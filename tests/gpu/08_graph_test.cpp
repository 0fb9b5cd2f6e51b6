// The frame graph. Without a device: the order of passes, what is left out or refused, and the derived barriers. On a
// device, with chapter 08's frames: which passes run again after which change, and that a frame allocates nothing.
#include <algorithm>
#include <catch2/catch.hpp>

#include "chapters/06_display/display.hpp"
#include "chapters/08_transmittance_lut/table_sky.hpp"
#include "common/app/renderer.hpp"
#include "common/app/session.hpp"
#include "common/scene/scene_knobs.hpp"
#include "tests/gpu/harness.hpp"

namespace welkin::test {
extern thread_local long heap_allocations;  // counted by 05_speed_test.cpp's operator new
}

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr gpu::Use kVertexRead{VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                               VK_IMAGE_LAYOUT_GENERAL};
constexpr gpu::Use kFragmentSampled{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                                    VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL};

const gpu::Image kNoImage;  // compile() looks at names only
const gpu::Buffer kNoBuffer;

void pass(graph::Graph& graph, const std::string& name, std::vector<graph::Access> accesses) {
  graph::Pass made{.name = name};
  made.steps.push_back({.accesses = std::move(accesses), .record = [](const graph::Recorder&) {}});
  graph.add(std::move(made));
}

std::string message_of(graph::Graph& graph) {
  try {
    graph.compile();
  } catch (const Error& error) {
    return error.what();
  }
  return "compiled";
}

std::string text(const graph::Barrier& barrier) {
  return barrier.pass + "/" + barrier.resource + ": " + graph::describe(barrier.before) + " -> " +
         graph::describe(barrier.after);
}

std::vector<std::string> texts(const graph::Graph& graph, int frame = 0) {
  std::vector<std::string> all;
  for (const graph::Barrier& barrier : graph.barriers(frame)) all.push_back(text(barrier));
  return all;
}

// air -> table -> picture, the passes declared in the order given.
std::vector<std::string> order_declared(const std::string& declared) {
  graph::Graph graph;
  const graph::Resource air = graph.import("air", &kNoBuffer), table = graph.import("table", &kNoImage),
                        picture = graph.import("picture", &kNoImage);
  for (char which : declared) {
    if (which == 'a') pass(graph, "air", {{air, gpu::kUpdate}});
    if (which == 't') pass(graph, "table", {{air, gpu::kUniformRead}, {table, gpu::kComputeWrite}});
    if (which == 'm')
      pass(graph, "march", {{table, gpu::kSampledRead}, {air, gpu::kUniformRead}, {picture, gpu::kComputeWrite}});
  }
  graph.set_output(picture);
  graph.compile();
  return graph.order();
}

}  // namespace

TEST_CASE("graph: the order follows from who needs what, not from who was declared first") {
  for (const char* declared : {"atm", "amt", "tam", "tma", "mat", "mta"}) {
    CAPTURE(declared);
    CHECK(order_declared(declared) == std::vector<std::string>{"air", "table", "march"});
  }
}

TEST_CASE("graph: a pass nobody needs is left out, and so is what only it needs") {
  graph::Graph graph;
  const graph::Resource a = graph.import("a", &kNoImage), b = graph.import("b", &kNoImage),
                        c = graph.import("c", &kNoImage);
  pass(graph, "for c", {{a, gpu::kComputeWrite}});
  pass(graph, "c", {{a, gpu::kComputeRead}, {c, gpu::kComputeWrite}});
  pass(graph, "b", {{b, gpu::kComputeWrite}});
  graph.set_output(b);
  graph.compile();
  CHECK(graph.order() == std::vector<std::string>{"b"});
  CHECK(graph.explain().find("for c                left out: nobody needs what it writes") != std::string::npos);
}

TEST_CASE("graph: what cannot be ordered is refused, by name") {
  graph::Graph cycle;
  const graph::Resource a = cycle.import("a", &kNoImage), b = cycle.import("b", &kNoImage);
  pass(cycle, "first", {{b, gpu::kComputeRead}, {a, gpu::kComputeWrite}});
  pass(cycle, "second", {{a, gpu::kComputeRead}, {b, gpu::kComputeWrite}});
  cycle.set_output(a);
  CHECK(message_of(cycle) == "frame graph: pass 'first' needs its own result");

  graph::Graph twice;
  const graph::Resource image = twice.import("image", &kNoImage);
  pass(twice, "first", {{image, gpu::kComputeWrite}});
  pass(twice, "second", {{image, gpu::kComputeWrite}});
  twice.set_output(image);
  CHECK(message_of(twice) == "frame graph: 'image' is written by 'first' and by 'second'; one pass writes a resource");

  graph::Graph nobody;
  const graph::Resource source = nobody.import("source", &kNoImage), result = nobody.import("result", &kNoImage);
  pass(nobody, "reader", {{source, gpu::kComputeRead}, {result, gpu::kComputeWrite}});
  nobody.set_output(result);
  CHECK(message_of(nobody) == "frame graph: pass 'reader' reads 'source', which no pass writes");

  graph::Graph in_place;
  const graph::Resource itself = in_place.import("itself", &kNoImage);
  pass(in_place, "changer", {{itself, gpu::kComputeRead}, {itself, gpu::kComputeWrite}});
  in_place.set_output(itself);
  CHECK(message_of(in_place) ==
        "frame graph: pass 'changer' names 'itself' twice in a step; what it changes must be another resource than "
        "what it reads");

  graph::Graph wanted;
  wanted.set_output(wanted.import("nothing", &kNoImage));
  CHECK(message_of(wanted) == "frame graph: 'nothing' is an output, and no pass writes it");
}

TEST_CASE("graph: the barriers are these and no others") {
  graph::Graph graph;
  const graph::Resource air = graph.import("air", &kNoBuffer), table = graph.import("table", &kNoImage),
                        picture = graph.import("picture", &kNoImage);
  const graph::Resource shown = graph.import("shown", &kNoImage);
  pass(graph, "air", {{air, gpu::kUpdate}});
  pass(graph, "table", {{air, gpu::kUniformRead}, {table, gpu::kComputeWrite}});
  pass(graph, "march", {{air, gpu::kUniformRead}, {table, gpu::kSampledRead}, {picture, gpu::kComputeWrite}});
  pass(graph, "show", {{table, gpu::kSampledRead}, {picture, kFragmentSampled}, {shown, gpu::kComputeWrite}});
  graph.set_output(shown);
  graph.compile();
  CHECK(texts(graph) ==
        std::vector<std::string>{
            "table/air: transfer, write -> compute shader, uniform read",      // read after write
            "table/table: nothing -> compute shader, storage write, GENERAL",  // a first layout
            "march/table: compute shader, storage write, GENERAL -> compute shader, sampled read, GENERAL",
            "march/picture: nothing -> compute shader, storage write, GENERAL",  // none for air: visible already
            "show/picture: compute shader, storage write, GENERAL -> fragment shader, sampled read, READ_ONLY_OPTIMAL",
            "show/shown: nothing -> compute shader, storage write, GENERAL"});  // nor for table
  // The second frame: what is written now was read before (an execution dependency is enough) or, `shown`, only
  // written.
  CHECK(
      texts(graph, 1) ==
      std::vector<std::string>{
          "air/air: compute shader, transfer -> transfer, write",  // write after read
          "table/air: transfer, write -> compute shader, uniform read",
          "table/table: compute shader, GENERAL -> compute shader, storage write, GENERAL",  // write after two readers
          "march/table: compute shader, storage write, GENERAL -> compute shader, sampled read, GENERAL",
          "march/picture: fragment shader, READ_ONLY_OPTIMAL -> compute shader, storage write, GENERAL",  // and back to
                                                                                                          // its layout
          "show/picture: compute shader, storage write, GENERAL -> fragment shader, sampled read, READ_ONLY_OPTIMAL",
          "show/shown: compute shader, storage write, GENERAL -> compute shader, storage write, GENERAL"});  // write
                                                                                                             // after
                                                                                                             // write
}

TEST_CASE("graph: who looks at a picture between frames is waited for") {
  for (const VkImageLayout layout : {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL}) {
    graph::Graph graph;
    const graph::Resource picture =
        graph.import("picture", &kNoImage, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_NONE, layout});
    pass(graph, "march", {{picture, gpu::kComputeWrite}});
    graph.set_output(picture);
    graph.compile();
    const std::string kept = layout == VK_IMAGE_LAYOUT_UNDEFINED ? "" : ", GENERAL";
    CHECK(texts(graph, 1) == std::vector<std::string>{"march/picture: compute shader, copy" + kept +
                                                      " -> compute shader, storage write, GENERAL"});
  }
}

// A read by another stage, or in another way, of what was written once.
TEST_CASE("graph: visibility is counted per stage and access together") {
  graph::Graph graph;
  const graph::Resource table = graph.import("table", &kNoImage);
  std::vector<graph::Resource> results;
  for (int i = 0; i < 5; ++i) results.push_back(graph.import("result " + std::to_string(i), &kNoBuffer));
  pass(graph, "table", {{table, gpu::kComputeWrite}});
  const gpu::Use reads[] = {gpu::kSampledRead, kVertexRead, gpu::kSampledRead, gpu::kComputeRead, kVertexRead};
  for (int i = 0; i < 5; ++i)
    pass(graph, "reader " + std::to_string(i), {{table, reads[i]}, {results[i], gpu::kUpdate}});
  for (graph::Resource result : results) graph.set_output(result);
  graph.compile();
  std::vector<std::string> waits;
  for (const graph::Barrier& barrier : graph.barriers())
    if (barrier.resource == "table") waits.push_back(barrier.pass);
  // Reader 3 reads storage from compute: sampled reads of compute and storage reads of vertex do not add up to that.
  CHECK(waits == std::vector<std::string>{"table", "reader 0", "reader 1", "reader 3"});
}

namespace {

std::vector<app::Effect> frame_effects() {
  return {air(), transmittance_table(), table_march(), exposure(), display()};
}

struct SceneFixture {
  Scene scene = load_scene("noon", app::scenes_directory());
  Settings settings = [this] {
    std::vector<Knob> knobs = app::knobs_of(frame_effects(), 8);
    for (Knob& knob : scene_knobs(scene)) knobs.push_back(knob);
    Settings all(knobs);
    all.set("transmittance.height", "64");  // these tests check when it is filled, not its values
    return all;
  }();
  std::string no_fault;
  app::Context context{device(), scene, settings, no_fault};
  app::Chapter chapter;
  app::CameraPose pose = app::pose_of(scene.view("horizon"), scene.planet.ground_radius_km);
};

}  // namespace

TEST_CASE("graph: the table is filled once, and again only when the air or its own knobs change") {
  SceneFixture fixture;
  app::Composition sky(fixture.context, frame_effects());
  app::Renderer renderer(fixture.context, fixture.chapter, sky, {64, 36});
  uint32_t index = 0;
  const auto frames = [&](int count) {
    for (int i = 0; i < count; ++i) renderer.draw(fixture.pose, 0.0, 1, index++);
  };
  const auto runs = [&] {
    return std::array<uint64_t, 3>{sky.graph().runs("air"), sky.graph().runs("transmittance"),
                                   sky.graph().runs("march")};
  };
  using Runs = std::array<uint64_t, 3>;
  frames(5);
  CHECK(runs() == Runs{1, 1, 5});
  fixture.scene.media[1].scattering_per_km *= 2.0;  // the air
  frames(3);
  CHECK(runs() == Runs{2, 2, 8});
  fixture.scene.post.exposure_ev += 1.0;  // not the air
  fixture.pose.position_km = {0.0, 0.0, 5.0};
  fixture.settings.set("view.steps", "16");
  frames(2);
  CHECK(runs() == Runs{2, 2, 10});
  fixture.settings.set("display.curve", "uchimura");  // pipelines are rebuilt, the table is not
  frames(2);
  CHECK(runs() == Runs{2, 2, 12});
  const Image before = renderer.picture();
  fixture.settings.set("transmittance.width", "32");  // another table
  frames(2);
  CHECK(runs() == Runs{2, 3, 14});
  CHECK(sky.image("transmittance")->size.width == 32);
  const Image after = renderer.picture();
  CHECK(!std::equal(before.pixels.begin(), before.pixels.end(), after.pixels.begin()));
  app::Renderer other(fixture.context, fixture.chapter, sky, {32, 18});  // another target: the table stays
  other.draw(fixture.pose, 0.0, 1, 0);
  CHECK(runs() == Runs{2, 3, 15});
  CHECK(sky.graph().explain().find("transmittance        ran in 3 of 15 frames") != std::string::npos);
}

TEST_CASE("graph: no allocation by a frame after the first") {
  SceneFixture fixture;
  app::Composition sky(fixture.context, frame_effects());
  app::Renderer renderer(fixture.context, fixture.chapter, sky, {64, 36});
  renderer.draw(fixture.pose, 0.0, 1, 0);
  renderer.draw(fixture.pose, 0.0, 1, 1);
  const uint64_t device_before = device().allocation_count();
  const long heap_before = heap_allocations;
  sky.graph().redo();  // every pass runs
  renderer.draw(fixture.pose, 0.0, 1, 2);
  const long heap_by_frame = heap_allocations - heap_before;
  CHECK(device().allocation_count() == device_before);
  CHECK(heap_by_frame == 0);
  CHECK(sky.graph().runs("transmittance") == 2);
}
