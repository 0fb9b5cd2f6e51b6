// Maps and shadows of the terrain, and where rays meet it. See relief.hpp and docs/chapters/11_aerial_perspective.md.
#include "chapters/11_aerial_perspective/relief.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/trigonometric.hpp>
#include <span>

#include "common/app/camera.hpp"

namespace welkin {
namespace {

constexpr VkImageUsageFlags kMapUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr double kEyes_km = 0.002;  // a camera inside a hill is lifted to this height above the ground

struct ShadowPush {
  glm::vec4 sun;
};

// Shares of cover as 16-bit floats: a driver may round what it filters from 8-bit texels to 8 bits, and a step of 1/255
// in the share of snow changes the light from grass by 3 %.
std::vector<uint64_t> halves(const std::vector<std::array<uint8_t, 4>>& cover) {
  std::vector<uint64_t> texels;
  texels.reserve(cover.size());
  for (const auto& c : cover) texels.push_back(glm::packHalf4x16(glm::vec4(c[0], c[1], c[2], c[3]) / 255.0f));
  return texels;
}

// Direction to the sun in the global frame, where it does not change as the camera moves.
glm::dvec3 global_sun(const app::Frame& frame, double ground_radius_km) {
  const app::LocalFrame at = app::local_frame({.position_km = frame.position_km}, ground_radius_km);
  const glm::dvec3 local(frame.camera.sun);
  return glm::normalize(at.east * local.x + at.north * local.y + at.up * local.z);
}

// Lifts a camera that is inside a hill straight up: its local frame, and with it all directions, stay the same.
void lift_out_of_ground(const TerrainMap& map, double ground_radius_km, CameraRays& camera, glm::dvec3& position_km) {
  const app::CameraPose pose{.position_km = position_km};
  const glm::dvec3 up = app::local_frame(pose, ground_radius_km).up;
  const double below_km = up.z <= 0.0 ? 0.0 : height_at(map, up.x * ground_radius_km, up.y * ground_radius_km),
               stands_km = app::altitude_km(pose, ground_radius_km);
  const double altitude_km = std::max(stands_km, below_km > 0.0 ? below_km + kEyes_km : 0.0);
  position_km += up * (altitude_km - stands_km);
  if (altitude_km > stands_km)
    camera.altitude_km = static_cast<float>(altitude_km), camera.altitude_m = static_cast<float>(altitude_km * 1000.0);
}

app::Wanted terrain_wanted(const Scene& scene) {
  return {scene.terrain.has_value(), scene.terrain ? "[terrain] in scene" : "no [terrain] in scene"};
}

// Everything the maps are made from, as text; for a file also the time it was written.
std::string key_of_maps(const Scene& scene) {
  const Terrain& t = *scene.terrain;
  std::error_code missing;
  const auto written = t.height_map.empty() ? std::filesystem::file_time_type{}
                                            : std::filesystem::last_write_time(t.height_map, missing);
  return fmt::format("{} {} {} {} {} {} {}", t.height_map, written.time_since_epoch().count(), t.extent_km, t.height_km,
                     t.size, t.seed, scene.planet.ground_radius_km);
}

// A step with the maps and their constants, for the two passes that walk over them.
graph::Step walking(const TerrainMaps& maps, double ground_radius_km, const char* shader) {
  return {.shader = shader,
          .constants = {{"GROUND_RADIUS_KM", static_cast<float>(ground_radius_km)},
                        {"EXTENT_KM", static_cast<float>(maps.map->extent_km)},
                        {"HIGHEST_KM", maps.map->highest_km},
                        {"MAP_SIZE", maps.map->size},
                        {"TREE_LEVELS", maps.levels}},
          .bindings = {{"height_map", maps.heights}, {"height_maxima", maps.maxima}}};
}

}  // namespace

// [knobs]
static Knob shadow_knob() {
  return {.name = "terrain.shadow_size",
          .unit = "texels",
          .meaning = "side of the map of shadows",
          .minimum = 64,
          .maximum = 4096,
          .initial = 512,
          .integer = true,
          .rebuilds = true};
}

static std::vector<Knob> surface_knobs() {
  return {
      {.name = "terrain.detail",
       .meaning =
           "relief and cover finer than the map's: noise down to centimetres; waves too fine for a pixel are left out",
       .initial = 1,
       .choices = {"off", "on"},
       .rebuilds = true},
      {.name = "terrain.edges",
       .meaning = "a crest that a ray passes by less than half a pixel covers a part of it, or nothing",
       .initial = 1,
       .choices = {"off", "on"},
       .rebuilds = true}};
}

std::vector<Knob> terrain_knobs() { return joined(surface_knobs(), {shadow_knob()}); }
// [/knobs]

bool ViewChange::differs(const app::Frame& frame) const {
  CameraRays now = frame.camera;
  now.time_s = 0.0f, now.seed = now.frame = 0;
  return fresh_ || std::memcmp(&now, &camera_, sizeof now) != 0 || frame.position_km != position_km_;
}

void ViewChange::note(const app::Frame& frame) {
  camera_ = frame.camera;
  camera_.time_s = 0.0f, camera_.seed = camera_.frame = 0;
  position_km_ = frame.position_km, fresh_ = false;
}

gpu::Image filled_image(const gpu::Device& device, const char* name, VkFormat format, VkExtent2D size, uint32_t depth,
                        std::span<const std::byte> texels) {
  gpu::Image image = gpu::create_image(device, name, size, format, kMapUsage, depth);
  const gpu::Buffer staging =
      gpu::create_buffer(device, "staging", texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Where::upload);
  std::memcpy(staging.mapped, texels.data(), texels.size());
  const gpu::CommandPool pool = gpu::create_command_pool(device);
  gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
    gpu::image_barrier(commands, image.handle, {}, gpu::kTransferWrite);
    const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {size.width, size.height, std::max(depth, 1u)}};
    vkCmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    gpu::image_barrier(commands, image.handle, gpu::kTransferWrite, gpu::kSampledRead);
  });
  return image;
}

// [maps]
// Puts the maps on the device. The CPU keeps only the heights, which keep the camera out of the ground.
static TerrainMaps upload_maps(app::Builder& builder) {
  const app::Context& context = builder.context;
  const auto add = [&](const char* name, VkFormat format, int width, int height, const auto& texels) {
    const VkExtent2D size{static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
    return builder.graph.add_filled(
        name, filled_image(context.device, name, format, size, 0, std::as_bytes(std::span(texels))));
  };
  TerrainMap map = make_terrain_map(*context.scene.terrain);
  check_fits_planet(*context.scene.terrain, context.scene.planet.ground_radius_km);
  const HeightMaxima maxima = height_maxima(map);
  TerrainMaps maps;
  maps.levels = maxima.levels;
  maps.heights = add("terrain heights", VK_FORMAT_R32_SFLOAT, map.size, map.size, map.height_km);
  maps.maxima = add("terrain maxima", VK_FORMAT_R32_SFLOAT, maxima.width, maxima.rows, maxima.highest_km);
  maps.slopes = add("terrain slopes", VK_FORMAT_R32G32_SFLOAT, map.size, map.size, map.slope);
  maps.cover = add("terrain cover", VK_FORMAT_R16G16B16A16_SFLOAT, map.size, map.size, halves(map.cover));
  map.slope = {}, map.cover = {};
  maps.map = std::make_shared<const TerrainMap>(std::move(map));
  return maps;
}
// [/maps]

// [terrain]
app::Effect terrain() {
  app::Effect effect{.name = "terrain", .chapter = 11, .knobs = surface_knobs()};
  effect.wanted = [](const Scene& scene, const Settings&) { return terrain_wanted(scene); };
  effect.key = [](const Scene& scene, const Settings&) { return key_of_maps(scene); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const double radius_km = context.scene.planet.ground_radius_km;
    TerrainMaps maps = upload_maps(builder);
    maps.distance = builder.graph.add_image("terrain distance");
    board.offer(maps);

    const auto seen = std::make_shared<ViewChange>();
    graph::Step step = walking(maps, radius_km, "11_aerial_perspective/terrain.comp");
    step.constants.push_back({"HAS_RELIEF", context.settings.choice("terrain.detail") == "on"});
    step.bindings.push_back({"terrain_distance", maps.distance});
    step.record = [seen, distance = maps.distance](const graph::Recorder& r) {
      seen->note(r.frame);
      r.dispatch_over(r.graph.image(distance).size);
    };
    graph::Pass pass{.name = "terrain", .changed = [seen](const app::Frame& frame) { return seen->differs(frame); }};
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
    builder.adjust_camera = [map = maps.map, radius_km](CameraRays& camera, glm::dvec3& position_km) {
      lift_out_of_ground(*map, radius_km, camera, position_km);
    };
    builder.explain = [map = maps.map] {
      return fmt::format("terrain: {} x {} samples of {:.0f} m, up to {:.2f} km\n", map->size, map->size,
                         1e3 * map->extent_km / map->size, map->highest_km);
    };
  };
  return effect;
}
// [/terrain]

// [shadows]
app::Effect terrain_shadows() {
  app::Effect effect{.name = "terrain shadows", .chapter = 11, .knobs = {shadow_knob()}};
  effect.wanted = [](const Scene& scene, const Settings&) -> app::Wanted {
    if (!scene.terrain) return terrain_wanted(scene);
    return {scene.terrain->shadows, fmt::format("terrain.shadows = {}", scene.terrain->shadows)};
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const TerrainMaps& maps = board.get<TerrainMaps>("terrain");
    const double radius_km = context.scene.planet.ground_radius_km;
    const uint32_t side = static_cast<uint32_t>(context.settings.integer("terrain.shadow_size"));
    const graph::Resource image = builder.graph.add_image("terrain shadows", {.size = {side, side}});
    board.offer(TerrainShadows{image});

    const auto shadows_of = [context, radius_km](const app::Frame& frame) {
      return glm::dvec4(global_sun(frame, radius_km), glm::radians(context.scene.sun.angular_radius_deg));
    };
    const auto shadowed_from = std::make_shared<glm::dvec4>(0.0);  // the sun the map was made for
    graph::Step step = walking(maps, radius_km, "11_aerial_perspective/shadow.comp");
    step.bindings.push_back({"shadow_map", image});
    step.record = [shadows_of, shadowed_from, side](const graph::Recorder& r) {
      *shadowed_from = shadows_of(r.frame);
      r.push(ShadowPush{glm::vec4(*shadowed_from)}).dispatch_over({side, side});
    };
    graph::Pass pass{.name = "terrain shadows"};
    pass.changed = [shadows_of, shadowed_from](const app::Frame& frame) {
      return glm::length(shadows_of(frame) - *shadowed_from) > 1e-6;
    };
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/shadows]

}  // namespace welkin
