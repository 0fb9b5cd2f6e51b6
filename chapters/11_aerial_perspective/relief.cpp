// Maps and shadows of the terrain, and where rays meet it. See relief.hpp and docs/chapters/11_aerial_perspective.md.
#include "chapters/11_aerial_perspective/relief.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/trigonometric.hpp>

#include "common/app/camera.hpp"

namespace welkin {
namespace {

constexpr VkImageUsageFlags kMapUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

// Push constants of shadow.comp and terrain.comp.
struct ShadowPush {
  glm::vec4 sun;
};
struct TerrainPush {
  CameraRays camera;
  glm::vec4 position, east, north;
};

// Makes a map on the device and fills it, once, before any frame.
template <typename T>
gpu::Image upload(const gpu::Device& device, const char* name, VkFormat format, int width, int height,
                  const std::vector<T>& texels) {
  const VkExtent2D extent{static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
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
    gpu::image_barrier(
        commands, image.handle, gpu::kTransferWrite,
        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_GENERAL});
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

}  // namespace

// [knobs]
std::vector<Knob> terrain_knobs() {
  return {{.name = "terrain.shadow_size",
           .unit = "texels",
           .meaning = "side of the map of shadows",
           .minimum = 64,
           .maximum = 4096,
           .initial = 512,
           .integer = true,
           .rebuilds = true},
          {.name = "terrain.detail",
           .meaning = "relief finer than the map's where a ray meets the ground within 250 m",
           .initial = 1,
           .choices = {"off", "on"},
           .rebuilds = true},
          {.name = "terrain.edges",
           .meaning = "a crest that a ray passes by less than half a pixel covers a part of it, or nothing",
           .initial = 1,
           .choices = {"off", "on"},
           .rebuilds = true}};
}
// [/knobs]

Standpoint standpoint(const app::Frame& frame, double ground_radius_km) {
  const app::CameraPose pose{.position_km = frame.position_km};
  const app::LocalFrame local = app::local_frame(pose, ground_radius_km);
  return {frame.position_km, local.east, local.north, local.up, app::altitude_km(pose, ground_radius_km)};
}

bool Watch::differs(const app::Frame& frame) const {
  CameraRays now = frame.camera;
  now.time_s = 0.0f, now.seed = now.frame = 0;
  return fresh_ || std::memcmp(&now, &camera_, sizeof now) != 0 || frame.position_km != position_km_;
}

void Watch::note(const app::Frame& frame) {
  camera_ = frame.camera;
  camera_.time_s = 0.0f, camera_.seed = camera_.frame = 0;
  position_km_ = frame.position_km, fresh_ = false;
}

Relief::Relief(const app::Context& context, graph::Graph& graph)
    : context_(context),
      graph_(graph),
      map_(make_terrain_map(*context.scene.terrain)),
      maxima_(height_maxima(map_)),
      sampler_(gpu::create_sampler(context.device)),
      heights_(upload(context.device, "terrain heights", VK_FORMAT_R32_SFLOAT, map_.size, map_.size, map_.height_km)),
      height_maxima_(upload(context.device, "terrain maxima", VK_FORMAT_R32_SFLOAT, maxima_.width, maxima_.rows,
                            maxima_.highest_km)),
      slopes_(upload(context.device, "terrain slopes", VK_FORMAT_R32G32_SFLOAT, map_.size, map_.size, map_.slope)),
      cover_(upload(context.device, "terrain cover", VK_FORMAT_R16G16B16A16_SFLOAT, map_.size, map_.size,
                    halves(map_.cover))) {
  check_fits_planet(*context.scene.terrain, context.scene.planet.ground_radius_km);
  // Only heights are asked for again, where the camera stands.
  map_.slope = {}, map_.cover = {}, maxima_.highest_km = {};
  if (has_shadows()) {
    make_shadow_image();
    shadow_resource_ = graph.add("terrain shadows", shadows_);
    graph.add(
        {.name = "terrain shadows",
         .accesses = {{shadow_resource_, gpu::kComputeWrite}},
         .record = [this](const app::Frame& frame) { draw_shadows(frame); },
         .changed = [this](const app::Frame& frame) { return glm::length(sun_of(frame) - shadowed_from_) > 1e-6; }});
  }
  distance_resource_ = graph.add("terrain distance", distance_);
  graph.add({.name = "terrain",
             .accesses = {{distance_resource_, gpu::kComputeWrite}},
             .record = [this](const app::Frame& frame) { watch_.note(frame), find_distances(frame); },
             .changed = [this](const app::Frame& frame) { return watch_.differs(frame); }});
  rebuild();
}

void Relief::make_shadow_image() {
  const uint32_t side = static_cast<uint32_t>(context_.settings.integer("terrain.shadow_size"));
  shadows_ = gpu::create_image(context_.device, "terrain shadows", {side, side}, VK_FORMAT_R32G32B32A32_SFLOAT,
                               VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
}

void Relief::set_size(VkExtent2D size) {
  distance_ = gpu::create_image(context_.device, "terrain distance", size, VK_FORMAT_R32G32B32A32_SFLOAT,
                                VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  gpu::write_storage_image(context_.device, distance_set_, 2, distance_);
  graph_.replace(distance_resource_, distance_);
}

// [rebuild]
// Both passes walk over the same two maps, bindings 0 and 1, and know the same of them, constants 0 to 5.
void Relief::rebuild() {
  const gpu::Device& device = context_.device;
  const auto bits = [](double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); };
  const gpu::Specialization constants{bits(context_.scene.planet.ground_radius_km),
                                      bits(map_.extent_km),
                                      bits(map_.highest_km),
                                      static_cast<uint32_t>(map_.size),
                                      static_cast<uint32_t>(maxima_.levels),
                                      context_.settings.choice("terrain.detail") == "on"};
  const std::vector<gpu::Binding> bindings{{0, kSampled}, {1, kSampled}, {2, kStorage}};
  const auto make = [&](const char* shader, size_t push, gpu::ComputePipeline& pipeline, gpu::DescriptorSet& set) {
    pipeline = gpu::create_compute_pipeline(device, shader, bindings, static_cast<uint32_t>(push), constants);
    if (set.handle == VK_NULL_HANDLE) set = gpu::create_descriptor_set(device, pipeline.set_layout, pipeline.bindings);
    gpu::write_sampled_image(device, set, 0, heights_, sampler_);
    gpu::write_sampled_image(device, set, 1, height_maxima_, sampler_);
  };
  make("11_aerial_perspective/terrain.comp", sizeof(TerrainPush), distance_pipeline_, distance_set_);
  if (has_shadows()) {
    if (shadows_.size.width != static_cast<uint32_t>(context_.settings.integer("terrain.shadow_size"))) {
      make_shadow_image();
      graph_.replace(shadow_resource_, shadows_);
    }
    make("11_aerial_perspective/shadow.comp", sizeof(ShadowPush), shadow_pipeline_, shadow_set_);
    gpu::write_storage_image(device, shadow_set_, 2, shadows_);
  }
  graph_.redo(distance_resource_);
  if (has_shadows()) graph_.redo(shadow_resource_);
}
// [/rebuild]

// The sun in the global frame, where it does not turn as the camera moves.
glm::dvec3 Relief::sun_of(const app::Frame& frame) const {
  const Standpoint at = standpoint(frame, context_.scene.planet.ground_radius_km);
  const glm::dvec3 local(frame.camera.sun);
  return glm::normalize(at.east * local.x + at.north * local.y + at.up * local.z);
}

void Relief::draw_shadows(const app::Frame& frame) {
  shadowed_from_ = sun_of(frame);
  const ShadowPush push{{shadowed_from_, glm::radians(context_.scene.sun.angular_radius_deg)}};
  gpu::dispatch_over(frame.commands, shadow_pipeline_, shadow_set_, push, shadows_.size);
}

void Relief::find_distances(const app::Frame& frame) const {
  const Standpoint at = standpoint(frame, context_.scene.planet.ground_radius_km);
  const TerrainPush push{frame.camera, {at.position_km, 0.0}, {at.east, 0.0}, {at.north, 0.0}};
  gpu::dispatch_over(frame.commands, distance_pipeline_, distance_set_, push, distance_.size);
}

Lifted lifted(const app::Frame& frame, const TerrainMap& map, double ground_radius_km) {
  constexpr double kEyes_km = 0.002;  // a camera in a hill is lifted to this height above it
  const Standpoint at = standpoint(frame, ground_radius_km);
  const double ground_km = height_at(map, at.up.x * ground_radius_km, at.up.y * ground_radius_km);
  const double altitude_km = std::max(at.altitude_km, ground_km > 0.0 ? ground_km + kEyes_km : 0.0);
  Lifted result{frame.camera, at.position_km + at.up * (altitude_km - at.altitude_km)};
  if (altitude_km > at.altitude_km)
    result.camera.altitude_km = static_cast<float>(altitude_km),
    result.camera.altitude_m = static_cast<float>(altitude_km * 1000.0);
  return result;
}

}  // namespace welkin
