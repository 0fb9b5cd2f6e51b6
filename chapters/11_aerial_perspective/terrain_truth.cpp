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
};

// On the board: what each pixel's ray meets first.
struct SurfaceImages {
  graph::Resource normals, albedos;
};

// [surfaces]
app::Effect first_surfaces() {
  app::Effect effect{.name = "first surfaces", .chapter = 11};
  effect.wanted = [](const Scene& scene, const Settings&) -> app::Wanted {
    return {scene.terrain.has_value(), "[terrain]"};
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const TerrainMaps& maps = board.get<TerrainMaps>("terrain");
    const SurfaceImages images{builder.graph.add_image("normals and distances"), builder.graph.add_image("albedos")};
    board.offer(images);
    graph::Pass pass{.name = "surfaces", .changed = [](const app::Frame&) { return true; }};  // the albedo is a knob
    pass.steps.push_back({.shader = "11_aerial_perspective/surfaces.comp",
                          .constants = {{"EXTENT_KM", static_cast<float>(context.scene.terrain->extent_km)},
                                        {"RADIUS_KM", static_cast<float>(context.scene.planet.ground_radius_km)},
                                        {"HAS_DETAIL", context.settings.choice("terrain.detail") == "on"}},
                          .bindings = {{"terrain_distance", maps.distance},
                                       {"slope_map", maps.slopes},
                                       {"cover_map", maps.cover},
                                       {"normals", images.normals},
                                       {"albedos", images.albedos}},
                          .record = [context, images](const graph::Recorder& r) {
                            r.push(SurfacesPush{{context.scene.planet.ground_albedo, 0.0}})
                                .dispatch_over(r.graph.image(images.normals).size);
                          }});
    add_signs(pass.steps.front(), board, maps.cover);
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/surfaces]

// Chapter 07's tracer, its rays ending on those surfaces.
app::Effect traced_terrain() {
  app::Effect effect{.name = "paths", .chapter = 11};
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const SurfaceImages images = board.get<SurfaceImages>("first surfaces");
    const graph::Resource picture = builder.picture(board, "picture");
    const auto tracer = std::make_shared<GroundTruth>(builder.context, true);
    graph::Pass pass{.name = "paths", .changed = [](const app::Frame&) { return true; }, .times_itself = true};
    pass.steps.push_back(
        {.accesses = {{images.normals, gpu::kComputeRead},
                      {images.albedos, gpu::kComputeRead},
                      {picture, gpu::kComputeWrite}},
         .record = [tracer, images, picture, drawn_into = uint64_t{0}](const graph::Recorder& r) mutable {
           const gpu::Image& target = r.graph.image(picture);
           const uint64_t version = r.graph.version(picture);
           if (std::exchange(drawn_into, version) != version) {
             tracer->set_target(target);
             tracer->set_surfaces({&r.graph.image(images.normals), &r.graph.image(images.albedos)});
           }
           const app::Frame& f = r.frame;
           tracer->draw({f.commands, target, f.camera, f.timer, f.index, f.seed, f.seconds, f.position_km, f.cut});
         }});
    builder.graph.add(std::move(pass));
    builder.explain = [tracer] { return tracer->explain(); };
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
        context, std::vector<app::Effect>{terrain(), signs(), first_surfaces(), traced_terrain()}, probe_paths);
  };
  return truth;
}

}  // namespace welkin
