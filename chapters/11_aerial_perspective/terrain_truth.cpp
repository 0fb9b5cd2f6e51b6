// Images of first surfaces for the path tracer. See terrain_truth.hpp.
#include "chapters/11_aerial_perspective/terrain_truth.hpp"

#include <glm/trigonometric.hpp>

#include "chapters/07_ground_truth/ground_truth.hpp"
#include "chapters/11_aerial_perspective/relief.hpp"
#include "chapters/11_aerial_perspective/signs.hpp"

namespace welkin {
namespace {

struct SurfacesPush {
  glm::vec4 bare_albedo;
  SignPlaces signs;
};

// [surfaces]
// Offers SurfaceImages: what each pixel's ray meets first.
app::Effect first_surfaces() {
  app::Effect effect{.name = "first surfaces", .chapter = 11};
  effect.wanted = [](const Scene& scene, const Settings&) -> app::Wanted {
    return {scene.terrain.has_value(), "[terrain]"};
  };
  effect.key = [](const Scene& scene, const Settings&) { return has_signs(scene) ? "signs" : ""; };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const TerrainMaps& maps = board.get<TerrainMaps>("terrain");
    const SurfaceImages images{builder.graph.add_image("normals and distances"), builder.graph.add_image("albedos")};
    board.offer(images);
    graph::Pass pass{.name = "surfaces", .changed = [](const app::Frame&) { return true; }};  // the albedo is a knob
    pass.steps.push_back({.shader = "11_aerial_perspective/surfaces.comp",
                          .constants = {{"HAS_SIGNS", has_signs(context.scene)},
                                        {"EXTENT_KM", static_cast<float>(context.scene.terrain->extent_km)},
                                        {"RADIUS_KM", static_cast<float>(context.scene.planet.ground_radius_km)},
                                        {"HAS_DETAIL", context.settings.choice("terrain.detail") == "on"}},
                          .bindings = {{"terrain_distance", maps.distance},
                                       {"slope_map", maps.slopes},
                                       {"cover_map", maps.cover},
                                       {"normals", images.normals},
                                       {"albedos", images.albedos}},
                          .record = [context, images](const graph::Recorder& r) {
                            r.push(SurfacesPush{{context.scene.planet.ground_albedo, 0.0}, sign_places(context.scene)})
                                .dispatch_over(r.graph.image(images.normals).size);
                          }});
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/surfaces]

// Chapter 07's path tracer, whose rays from the eye end on those surfaces.
app::Effect traced_terrain() {
  app::Effect effect{.name = "paths", .chapter = 11};
  effect.declare = [](app::Builder& builder, app::Board& board) {
    add_paths(builder, board, "paths", board.get<SurfaceImages>("first surfaces"));
  };
  return effect;
}

}  // namespace

app::Truth terrain_truth() {
  app::Truth truth = path_truth();
  truth.knobs = joined(truth.knobs, terrain_knobs());
  truth.make = [](const app::Context& context) -> std::unique_ptr<app::Program> {
    if (!context.scene.terrain) return std::make_unique<GroundTruth>(context);
    return std::make_unique<app::Composition>(
        context, std::vector<app::Effect>{terrain(), first_surfaces(), traced_terrain()}, probe_paths);
  };
  return truth;
}

}  // namespace welkin
