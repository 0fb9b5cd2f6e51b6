// Maps, shadows and mesh of the terrain. See relief.hpp and docs/chapters/11_aerial_perspective.md.
#include "chapters/11_aerial_perspective/relief.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/trigonometric.hpp>

#include "common/app/camera.hpp"

namespace welkin {
namespace {

constexpr VkImageUsageFlags kMapUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr int kShadowSteps = 96;
constexpr double kShadowGrowth = 0.06;  // of the step, per distance: 96 steps reach across the map
constexpr double kEyes_km = 0.002;      // a camera in a hill is lifted to this height above it
constexpr gpu::Use kDepthWrite{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_GENERAL};

struct ShadowPush {
  glm::vec4 sun, map;
  glm::ivec4 size;
};

struct RingPush {
  glm::vec4 right, up, forward, position, ring;
};

struct Mesh {
  int cells = 0;
  gpu::Buffer indices;
  uint32_t whole_count = 0, ring_count = 0;
};

// Makes a map on the device and fills it, once, before any frame.
template <typename T>
gpu::Image upload(const gpu::Device& device, const char* name, VkFormat format, int size,
                  const std::vector<T>& texels) {
  const VkExtent2D extent{static_cast<uint32_t>(size), static_cast<uint32_t>(size)};
  gpu::Image image = gpu::create_image(device, name, extent, format, kMapUsage);
  const gpu::Buffer staging = gpu::create_buffer(device, "staging", texels.size() * sizeof(T),
                                                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Where::upload);
  std::memcpy(staging.mapped, texels.data(), staging.bytes);
  const gpu::CommandPool pool = gpu::create_command_pool(device);
  gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
    gpu::image_barrier(commands, image.handle, {}, gpu::kTransferWrite);
    const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {extent.width, extent.height, 1}};
    vkCmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    gpu::image_barrier(commands, image.handle, gpu::kTransferWrite,
                       {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
                        VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
  });
  return image;
}

// Shares as halves: a driver may filter 8-bit numbers to 8 bits, and a step of 1/255 of snow among grass is 3 % of its
// light.
std::vector<uint64_t> halves(const std::vector<std::array<uint8_t, 4>>& cover) {
  std::vector<uint64_t> texels;
  texels.reserve(cover.size());
  for (const auto& c : cover) texels.push_back(glm::packHalf4x16(glm::vec4(c[0], c[1], c[2], c[3]) / 255.0f));
  return texels;
}

// The sun in the global frame, where it does not turn as the camera moves.
glm::dvec3 global_sun(const app::Frame& frame, double ground_radius_km) {
  const app::LocalFrame at = app::local_frame({.position_km = frame.position_km}, ground_radius_km);
  const glm::dvec3 local(frame.camera.sun);
  return glm::normalize(at.east * local.x + at.north * local.y + at.up * local.z);
}

// Straight up: directions stay what they are.
void lift_out_of_ground(const TerrainMap& map, double ground_radius_km, CameraRays& camera, glm::dvec3& position_km) {
  const app::CameraPose pose{.position_km = position_km};
  const glm::dvec3 up = app::local_frame(pose, ground_radius_km).up;
  const double below_km = height_at(map, up.x * ground_radius_km, up.y * ground_radius_km),
               stands_km = app::altitude_km(pose, ground_radius_km);
  const double altitude_km = std::max(stands_km, below_km > 0.0 ? below_km + kEyes_km : 0.0);
  position_km += up * (altitude_km - stands_km);
  if (altitude_km > stands_km)
    camera.altitude_km = static_cast<float>(altitude_km), camera.altitude_m = static_cast<float>(altitude_km * 1000.0);
}

app::Wanted terrain_wanted(const Scene& scene) {
  return {scene.terrain.has_value(), scene.terrain ? "[terrain] in scene" : "no [terrain] in scene"};
}

// Everything the maps are made from; of a file also when it was written.
std::string key_of_maps(const Scene& scene) {
  const Terrain& t = *scene.terrain;
  std::error_code missing;
  const auto written = t.height_map.empty() ? std::filesystem::file_time_type{}
                                            : std::filesystem::last_write_time(t.height_map, missing);
  return fmt::format("{} {} {} {} {} {} {}", t.height_map, written.time_since_epoch().count(), t.extent_km, t.height_km,
                     t.size, t.seed, scene.planet.ground_radius_km);
}

}  // namespace

// [knobs]
static Knob cells_knob() {
  return {.name = "terrain.cells",
          .unit = "cells",
          .meaning = "cells across a ring of the mesh; the innermost are as large as the map's samples",
          .minimum = 32,
          .maximum = 512,
          .initial = 128,
          .integer = true,
          .rebuilds = true};
}

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

std::vector<Knob> terrain_knobs() { return {cells_knob(), shadow_knob()}; }
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

// [mesh]
// Triangles of a square of cells, and of four squares with a hole in the middle: the ring inside sits on this one's
// cells, but as both snap to their own grids it may be a cell to the east or to the north.
static Mesh make_mesh(const gpu::Device& device, int cells) {
  Mesh mesh{.cells = cells};
  std::vector<uint32_t> indices;
  const auto add = [&](int hole_x, int hole_y) {
    const int quarter = cells / 4;
    // In columns eight cells wide: their nine vertices are still at hand when the next row wants them again.
    for (int first = 0; first < cells; first += 8)
      for (int j = 0; j < cells; ++j)
        for (int i = first; i < first + 8; ++i) {
          const bool hole = hole_x >= 0 && i >= quarter + hole_x && i < 3 * quarter + hole_x && j >= quarter + hole_y &&
                            j < 3 * quarter + hole_y;
          const uint32_t a = static_cast<uint32_t>(j * (cells + 1) + i), b = a + 1,
                         c = a + static_cast<uint32_t>(cells) + 1, d = c + 1;
          if (!hole) indices.insert(indices.end(), {a, b, d, a, d, c});
        }
  };
  add(-1, -1);
  mesh.whole_count = static_cast<uint32_t>(indices.size());
  for (const int y : {0, 1})
    for (const int x : {0, 1}) add(x, y);
  mesh.ring_count = (static_cast<uint32_t>(indices.size()) - mesh.whole_count) / 4;
  // Into the device's own memory: a frame reads them all, and the host's lies behind a bus.
  const gpu::Buffer staging = gpu::create_buffer(device, "staging", indices.size() * sizeof(uint32_t),
                                                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Where::upload);
  std::memcpy(staging.mapped, indices.data(), staging.bytes);
  mesh.indices =
      gpu::create_buffer(device, "terrain triangles", staging.bytes,
                         VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Where::device);
  const gpu::CommandPool pool = gpu::create_command_pool(device);
  gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
    const VkBufferCopy copy{0, 0, staging.bytes};
    vkCmdCopyBuffer(commands, staging.handle, mesh.indices.handle, 1, &copy);
    gpu::buffer_barrier(commands, mesh.indices.handle, gpu::kTransferWrite,
                        {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT});
  });
  return mesh;
}

static void draw_mesh(const app::Context& context, const TerrainMap& map, const Mesh& mesh, graph::Resource depth_image,
                      const graph::Recorder& r) {
  const app::Frame& frame = r.frame;
  const gpu::Image& target = r.graph.image(depth_image);
  const VkCommandBuffer commands = frame.commands;
  const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                        .imageView = target.view,
                                        .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
                                        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                        .clearValue = {.depthStencil = {0.0f, 0}}};
  const VkRect2D area{{0, 0}, target.size};
  const VkViewport viewport{0.0f, 0.0f, static_cast<float>(target.size.width), static_cast<float>(target.size.height),
                            0.0f, 1.0f};
  const VkRenderingInfo rendering{
      .sType = VK_STRUCTURE_TYPE_RENDERING_INFO, .renderArea = area, .layerCount = 1, .pDepthAttachment = &depth};
  vkCmdBeginRendering(commands, &rendering);
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &area);
  vkCmdBindIndexBuffer(commands, mesh.indices.handle, 0, VK_INDEX_TYPE_UINT32);
  const double radius = context.scene.planet.ground_radius_km;
  const app::LocalFrame at = app::local_frame({.position_km = frame.position_km}, radius);
  const auto global = [&](const glm::vec3& v) {
    return at.east * double(v.x) + at.north * double(v.y) + at.up * double(v.z);
  };
  const glm::dvec2 below(at.up.x * radius, at.up.y * radius);
  RingPush push{{global(frame.camera.right), radius},
                {global(frame.camera.up), map.extent_km},
                {global(frame.camera.forward), kNear_km},
                {frame.position_km, 0.0},
                {0.0, 0.0, below}};
  // Rings from the camera outwards until one reaches beyond the map on all sides.
  double cell_km = map.extent_km / map.size;
  glm::dvec2 inner(0.0);
  const double reach_km = 0.5 * map.extent_km + std::max(std::abs(below.x), std::abs(below.y));
  for (int level = 0; level < 24; ++level, cell_km *= 2.0) {
    const glm::dvec2 middle = glm::floor(below / (2.0 * cell_km)) * 2.0 * cell_km;
    push.position.w = static_cast<float>(cell_km), push.ring.x = static_cast<float>(middle.x),
    push.ring.y = static_cast<float>(middle.y);
    r.push(push);
    if (level == 0) {
      vkCmdDrawIndexed(commands, mesh.whole_count, 1, 0, 0, 0);
    } else {
      const uint32_t east = inner.x > middle.x ? 1 : 0, north = inner.y > middle.y ? 1 : 0;
      vkCmdDrawIndexed(commands, mesh.ring_count, 1, mesh.whole_count + (2 * north + east) * mesh.ring_count, 0, 0);
    }
    inner = middle;
    if ((0.5 * mesh.cells - 4.0) * cell_km > reach_km) break;
  }
  vkCmdEndRendering(commands);
}
// [/mesh]

// [terrain]
app::Effect terrain() {
  app::Effect effect{.name = "terrain", .chapter = 11, .knobs = {cells_knob()}};
  effect.wanted = [](const Scene& scene, const Settings&) { return terrain_wanted(scene); };
  effect.key = [](const Scene& scene, const Settings&) { return key_of_maps(scene); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const gpu::Device& device = context.device;
    TerrainMap made = make_terrain_map(*context.scene.terrain);
    TerrainMaps maps;
    maps.heights = builder.graph.add_filled(
        "terrain heights", upload(device, "terrain heights", VK_FORMAT_R32_SFLOAT, made.size, made.height_km));
    maps.slopes = builder.graph.add_filled(
        "terrain slopes", upload(device, "terrain slopes", VK_FORMAT_R32G32_SFLOAT, made.size, made.slope));
    maps.cover = builder.graph.add_filled(
        "terrain cover", upload(device, "terrain cover", VK_FORMAT_R16G16B16A16_SFLOAT, made.size, halves(made.cover)));
    maps.depth = builder.graph.add_image(
        "terrain depth", {.format = VK_FORMAT_D32_SFLOAT,
                          .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    made.slope = {}, made.cover = {};  // only heights are asked for again, where the camera stands
    maps.map = std::make_shared<const TerrainMap>(std::move(made));
    board.offer(maps);

    const int cells =
        context.settings.integer("terrain.cells") / 8 * 8;  // so that a ring's hole is whole cells, wherever it is
    const auto mesh = std::make_shared<const Mesh>(make_mesh(device, cells));
    const auto seen = std::make_shared<ViewChange>();
    graph::Pass pass{.name = "terrain", .changed = [seen](const app::Frame& frame) { return seen->differs(frame); }};
    pass.steps.push_back({.shader = "11_aerial_perspective/ring.vert",
                          .constants = {{"CELLS", cells}},
                          .raster = gpu::Raster{.depth = VK_FORMAT_D32_SFLOAT},
                          .bindings = {{"height_map", maps.heights}},
                          .accesses = {{maps.depth, kDepthWrite}},
                          .record = [context, mesh, seen, maps](const graph::Recorder& r) {
                            seen->note(r.frame);
                            draw_mesh(context, *maps.map, *mesh, maps.depth, r);
                          }});
    builder.graph.add(std::move(pass));
    const double radius_km = context.scene.planet.ground_radius_km;
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
    const TerrainMaps maps = board.get<TerrainMaps>("terrain");
    const uint32_t side = static_cast<uint32_t>(context.settings.integer("terrain.shadow_size"));
    const graph::Resource image =
        builder.graph.add_image("terrain shadows", {.size = {side, side}, .format = VK_FORMAT_R32G32_SFLOAT});
    board.offer(TerrainShadows{image});
    const auto shadowed_from = std::make_shared<glm::dvec3>(0.0);
    const double radius_km = context.scene.planet.ground_radius_km;
    graph::Pass pass{.name = "terrain shadows"};
    pass.changed = [shadowed_from, radius_km](const app::Frame& frame) {
      return glm::length(global_sun(frame, radius_km) - *shadowed_from) > 1e-6;
    };
    pass.steps.push_back({.shader = "11_aerial_perspective/shadow.comp",
                          .constants = {{"STEPS", kShadowSteps}},
                          .bindings = {{"height_map", maps.heights}, {"shadows", image}},
                          .record = [context, maps, shadowed_from, radius_km, side](const graph::Recorder& r) {
                            *shadowed_from = global_sun(r.frame, radius_km);
                            const TerrainMap& map = *maps.map;
                            const int size = static_cast<int>(side);
                            r.push(ShadowPush{{*shadowed_from, glm::radians(context.scene.sun.angular_radius_deg)},
                                              {map.extent_km, radius_km, map.extent_km / map.size, kShadowGrowth},
                                              {size, size, 0, 0}});
                            r.dispatch_over({side, side});
                          }});
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/shadows]

}  // namespace welkin
