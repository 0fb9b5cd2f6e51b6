// Maps, shadows and mesh of the terrain. See relief.hpp and docs/chapters/11_aerial_perspective.md.
#include "chapters/11_aerial_perspective/relief.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>
#include <glm/trigonometric.hpp>

#include "common/app/camera.hpp"

namespace welkin {
namespace {

constexpr VkImageUsageFlags kMapUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr int kShadowSteps = 96;
constexpr double kShadowGrowth = 0.06;  // of the step, per distance: 96 steps reach across the map
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

// Depth is fetched texel by texel, and its format need not have a filter.
gpu::Sampler nearest_sampler(const gpu::Device& device) {
  const VkSamplerCreateInfo info{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                 .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  VkSampler sampler = VK_NULL_HANDLE;
  gpu::check(vkCreateSampler(device, &info, nullptr, &sampler), "vkCreateSampler");
  return gpu::Sampler(device, sampler);
}

}  // namespace

// [knobs]
std::vector<Knob> terrain_knobs() {
  return {{.name = "terrain.cells",
           .unit = "cells",
           .meaning = "cells across a ring of the mesh; the innermost are as large as the map's samples",
           .minimum = 32,
           .maximum = 512,
           .initial = 128,
           .integer = true,
           .rebuilds = true},
          {.name = "terrain.shadow_size",
           .unit = "texels",
           .meaning = "side of the map of shadows",
           .minimum = 64,
           .maximum = 4096,
           .initial = 512,
           .integer = true,
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
      sampler_(gpu::create_sampler(context.device)),
      depth_sampler_(nearest_sampler(context.device)),
      heights_(upload(context.device, "terrain heights", VK_FORMAT_R32_SFLOAT, map_.size, map_.height_km)),
      slopes_(upload(context.device, "terrain slopes", VK_FORMAT_R32G32_SFLOAT, map_.size, map_.slope)),
      cover_(upload(context.device, "terrain cover", VK_FORMAT_R16G16B16A16_SFLOAT, map_.size, halves(map_.cover))) {
  // Only heights are asked for again, where the camera stands.
  map_.slope = {}, map_.cover = {};
  if (has_shadows()) {
    make_shadow_image();
    shadow_resource_ = graph.add("terrain shadows", shadows_);
    graph.add(
        {.name = "terrain shadows",
         .accesses = {{shadow_resource_, gpu::kComputeWrite}},
         .record = [this](const app::Frame& frame) { draw_shadows(frame); },
         .changed = [this](const app::Frame& frame) { return glm::length(sun_of(frame) - shadowed_from_) > 1e-6; }});
  }
  depth_resource_ = graph.add("terrain depth", depth_);
  graph.add({.name = "terrain",
             .accesses = {{depth_resource_, kDepthWrite}},
             .record = [this](const app::Frame& frame) { watch_.note(frame), draw_mesh(frame); },
             .changed = [this](const app::Frame& frame) { return watch_.differs(frame); }});
  rebuild();
}

void Relief::make_shadow_image() {
  const uint32_t side = static_cast<uint32_t>(context_.settings.integer("terrain.shadow_size"));
  shadows_ = gpu::create_image(context_.device, "terrain shadows", {side, side}, VK_FORMAT_R32G32_SFLOAT,
                               VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
}

void Relief::set_size(VkExtent2D size) {
  depth_ = gpu::create_image(
      context_.device, "terrain depth", size, VK_FORMAT_D32_SFLOAT,
      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  graph_.replace(depth_resource_, depth_);
}

// [rebuild]
void Relief::rebuild() {
  const gpu::Device& device = context_.device;
  const int cells =
      context_.settings.integer("terrain.cells") / 8 * 8;  // so that a ring's hole is whole cells, wherever it is
  if (cells != cells_) make_mesh(cells);
  make_mesh_pipeline(cells);
  if (has_shadows()) {
    if (shadows_.size.width != static_cast<uint32_t>(context_.settings.integer("terrain.shadow_size"))) {
      make_shadow_image();
      graph_.replace(shadow_resource_, shadows_);
    }
    shadow_pipeline_ = gpu::create_compute_pipeline(
        device, "11_aerial_perspective/shadow.comp",
        {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}, sizeof(ShadowPush),
        {kShadowSteps});
    if (shadow_set_.handle == VK_NULL_HANDLE)
      shadow_set_ = gpu::create_descriptor_set(device, shadow_pipeline_.set_layout, shadow_pipeline_.bindings);
    gpu::write_sampled_image(device, shadow_set_, 0, heights_, sampler_);
    gpu::write_storage_image(device, shadow_set_, 1, shadows_);
  }
  graph_.redo(depth_resource_);
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
  const Scene& scene = context_.scene;
  const int side = static_cast<int>(shadows_.size.width);
  const ShadowPush push{{shadowed_from_, glm::radians(scene.sun.angular_radius_deg)},
                        {map_.extent_km, scene.planet.ground_radius_km, map_.extent_km / map_.size, kShadowGrowth},
                        {side, side, 0, 0}};
  gpu::dispatch_over(frame.commands, shadow_pipeline_, shadow_set_, push, shadows_.size);
}

// [mesh]
// Triangles of a square of cells, and of four squares with a hole in the middle: the ring inside sits on this one's
// cells, but as both snap to their own grids it may be a cell to the east or to the north.
void Relief::make_mesh(int cells) {
  cells_ = cells;
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
  whole_count_ = static_cast<uint32_t>(indices.size());
  for (const int y : {0, 1})
    for (const int x : {0, 1}) add(x, y);
  ring_count_ = (static_cast<uint32_t>(indices.size()) - whole_count_) / 4;
  // Into the device's own memory: a frame reads them all, and the host's lies behind a bus.
  const gpu::Buffer staging = gpu::create_buffer(context_.device, "staging", indices.size() * sizeof(uint32_t),
                                                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Where::upload);
  std::memcpy(staging.mapped, indices.data(), staging.bytes);
  indices_ =
      gpu::create_buffer(context_.device, "terrain triangles", staging.bytes,
                         VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Where::device);
  const gpu::CommandPool pool = gpu::create_command_pool(context_.device);
  gpu::run_once(context_.device, pool, [&](VkCommandBuffer commands) {
    const VkBufferCopy copy{0, 0, staging.bytes};
    vkCmdCopyBuffer(commands, staging.handle, indices_.handle, 1, &copy);
    gpu::buffer_barrier(commands, indices_.handle, gpu::kTransferWrite,
                        {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT});
  });
}

void Relief::draw_mesh(const app::Frame& frame) const {
  const VkCommandBuffer commands = frame.commands;
  const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                        .imageView = depth_.view,
                                        .imageLayout = VK_IMAGE_LAYOUT_GENERAL,
                                        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                        .clearValue = {.depthStencil = {0.0f, 0}}};
  const VkRect2D area{{0, 0}, depth_.size};
  const VkViewport viewport{0.0f, 0.0f, static_cast<float>(depth_.size.width), static_cast<float>(depth_.size.height),
                            0.0f, 1.0f};
  const VkRenderingInfo rendering{
      .sType = VK_STRUCTURE_TYPE_RENDERING_INFO, .renderArea = area, .layerCount = 1, .pDepthAttachment = &depth};
  vkCmdBeginRendering(commands, &rendering);
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &area);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, mesh_pipeline_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, mesh_layout_, 0, 1, &mesh_set_.handle, 0, nullptr);
  vkCmdBindIndexBuffer(commands, indices_.handle, 0, VK_INDEX_TYPE_UINT32);
  const double radius = context_.scene.planet.ground_radius_km;
  const Standpoint at = standpoint(frame, radius);
  const auto global = [&](const glm::vec3& v) {
    return at.east * double(v.x) + at.north * double(v.y) + at.up * double(v.z);
  };
  const glm::dvec2 below(at.up.x * radius, at.up.y * radius);
  RingPush push{{global(frame.camera.right), radius},
                {global(frame.camera.up), map_.extent_km},
                {global(frame.camera.forward), kNear_km},
                {at.position_km, 0.0},
                {0.0, 0.0, below}};
  // Rings from the camera outwards until one reaches beyond the map on all sides.
  double cell_km = map_.extent_km / map_.size;
  glm::dvec2 inner(0.0);
  const double reach_km = 0.5 * map_.extent_km + std::max(std::abs(below.x), std::abs(below.y));
  for (int level = 0; level < 24; ++level, cell_km *= 2.0) {
    const glm::dvec2 middle = glm::floor(below / (2.0 * cell_km)) * 2.0 * cell_km;
    push.position.w = static_cast<float>(cell_km), push.ring.x = static_cast<float>(middle.x),
    push.ring.y = static_cast<float>(middle.y);
    vkCmdPushConstants(commands, mesh_layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);
    if (level == 0) {
      vkCmdDrawIndexed(commands, whole_count_, 1, 0, 0, 0);
    } else {
      const uint32_t east = inner.x > middle.x ? 1 : 0, north = inner.y > middle.y ? 1 : 0;
      vkCmdDrawIndexed(commands, ring_count_, 1, whole_count_ + (2 * north + east) * ring_count_, 0, 0);
    }
    inner = middle;
    if ((0.5 * cells_ - 4.0) * cell_km > reach_km) break;
  }
  vkCmdEndRendering(commands);
}
// [/mesh]

// [mesh_pipeline]
void Relief::make_mesh_pipeline(int cells) {
  const gpu::Device& device = context_.device;
  const std::vector<gpu::Binding> bindings{{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_VERTEX_BIT}};
  mesh_set_layout_ = gpu::create_set_layout(device, bindings);
  mesh_layout_ = gpu::create_pipeline_layout(device, mesh_set_layout_, VK_SHADER_STAGE_VERTEX_BIT, sizeof(RingPush));
  const VkSpecializationMapEntry entry{.constantID = 0, .offset = 0, .size = sizeof cells};
  const VkSpecializationInfo special{1, &entry, sizeof cells, &cells};
  const gpu::ShaderModule vertex = gpu::create_shader_module(device, "11_aerial_perspective/ring.vert");
  // One stage: there is no colour, so there is no fragment shader. Back faces count: a camera may look up a slope from
  // below.
  const VkPipelineShaderStageCreateInfo stage{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                              .stage = VK_SHADER_STAGE_VERTEX_BIT,
                                              .module = vertex,
                                              .pName = "main",
                                              .pSpecializationInfo = &special};
  const VkPipelineVertexInputStateCreateInfo input{.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .polygonMode = VK_POLYGON_MODE_FILL,
      .cullMode = VK_CULL_MODE_NONE,
      .lineWidth = 1.0f};
  const VkPipelineMultisampleStateCreateInfo samples{.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                     .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  // Reversed: what is nearer has the larger depth.
  const VkPipelineDepthStencilStateCreateInfo depth{.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                                                    .depthTestEnable = VK_TRUE,
                                                    .depthWriteEnable = VK_TRUE,
                                                    .depthCompareOp = VK_COMPARE_OP_GREATER};
  const VkDynamicState states[]{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, .dynamicStateCount = 2, .pDynamicStates = states};
  const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                .depthAttachmentFormat = VK_FORMAT_D32_SFLOAT};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = 1,
                                          .pStages = &stage,
                                          .pVertexInputState = &input,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &raster,
                                          .pMultisampleState = &samples,
                                          .pDepthStencilState = &depth,
                                          .pDynamicState = &dynamic,
                                          .layout = mesh_layout_};
  VkPipeline handle = VK_NULL_HANDLE;
  gpu::check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &handle),
             "vkCreateGraphicsPipelines");
  mesh_pipeline_ = gpu::PipelineHandle(device, handle);
  mesh_set_ = gpu::create_descriptor_set(device, mesh_set_layout_, bindings);
  gpu::write_sampled_image(device, mesh_set_, 0, heights_, sampler_);
}
// [/mesh_pipeline]

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
