// The pass "cloud picture". See cloud_picture.hpp and docs/chapters/17_cloud_shapes.md.
#include "chapters/17_cloud_shapes/cloud_picture.hpp"

#include <algorithm>

#include "chapters/11_aerial_perspective/relief.hpp"

namespace welkin {
namespace {

struct PicturePush {
  CloudMarchPush march;
  glm::vec4 white;
  int32_t show_depth;
};

struct SectionPush {
  CloudMarchPush march;
  float section_km, slice_km;
  int32_t level;
};

// Radiance of what scatters all of the light that falls on it, by the sun's height alone.
glm::vec4 white_of(const app::Context& context, const app::Frame& frame) {
  const double sun = std::max(static_cast<double>(frame.camera.sun.z), 0.0);
  const glm::dvec3 white = context.scene.sun.irradiance * ((0.9 * sun + 0.01) / 3.14159265358979323846);
  return {white, context.settings.choice("cloud.jitter") == "on" ? 1.0f : 0.0f};
}

// [steps]
graph::Step picture_step(const app::Context& context, app::Board& board, graph::Resource before,
                         graph::Resource after) {
  const TerrainMaps* terrain = board.find<TerrainMaps>();
  graph::Step step{.shader = "17_cloud_shapes/picture.comp",
                   .constants = {{"HAS_TERRAIN", terrain != nullptr}},
                   .bindings = {{"behind", before},
                                {"terrain_distance", terrain != nullptr ? terrain->distance : before},
                                {"target", after}}};
  step.record = [context, after](const graph::Recorder& r) {
    r.push(PicturePush{cloud_march(context.settings), white_of(context, r.frame),
                       context.settings.choice("cloud.show") == "depth"});
    r.dispatch_over(r.graph.image(after).size);
  };
  return step;
}

graph::Step section_step(const app::Context& context, graph::Resource after) {
  graph::Step step{.shader = "17_cloud_shapes/section.comp", .bindings = {{"target", after}}};
  step.record = [context, after](const graph::Recorder& r) {
    const Settings& settings = context.settings;
    r.push(SectionPush{cloud_march(settings), static_cast<float>(settings.number("cloud.section_km")),
                       static_cast<float>(settings.number("cloud.slice_km")),
                       settings.choice("cloud.show") == "slice"});
    r.dispatch_over(r.graph.image(after).size);
  };
  return step;
}
// [/steps]

}  // namespace

// [picture]
app::Effect cloud_picture() {
  app::Effect effect{.name = "cloud picture", .chapter = 17};
  effect.knobs = {{.name = "cloud.show",
                   .meaning = "the clouds, their optical depth in colours, a cut along the look, or a level one",
                   .initial = 0,
                   .choices = {"transmittance", "depth", "side", "slice"},
                   .rebuilds = true},
                  {.name = "cloud.jitter",
                   .meaning = "every pixel moves its samples by a share of a step: grain in place of bands",
                   .initial = 1,
                   .choices = {"off", "on"}},
                  {.name = "cloud.section_km",
                   .unit = "km",
                   .meaning = "width of a cut",
                   .minimum = 0.1,
                   .maximum = 1000,
                   .initial = 16},
                  {.name = "cloud.slice_km",
                   .unit = "km",
                   .meaning = "altitude of a level cut",
                   .minimum = 0,
                   .maximum = 100,
                   .initial = 1.8}};
  effect.wanted = [](const Scene& scene, const Settings&) -> app::Wanted {
    const bool any = !bodies_of(scene).empty();
    return {any, any ? "clouds before what is behind them" : "no clouds"};
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const CloudBodies& clouds = board.get<CloudBodies>("clouds");
    const std::string& show = context.settings.choice("cloud.show");
    const graph::Resource before = board.get<app::Picture>("a sky").image;
    const graph::Resource after = builder.picture(board, "cloud picture");
    graph::Pass pass{.name = "cloud picture", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back(show == "side" || show == "slice" ? section_step(context, after)
                                                           : picture_step(context, board, before, after));
    bind_clouds(pass.steps.back(), clouds);
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/picture]

}  // namespace welkin
