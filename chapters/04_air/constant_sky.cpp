// Recording the constant-density sky. See constant_sky.hpp.
#include "chapters/04_air/constant_sky.hpp"

#include <cstring>

#include "common/gpu/shader_file.hpp"

namespace welkin {
namespace {

constexpr VkShaderStageFlags kSphereStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
const std::vector<gpu::Binding> kRayBindings{{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                                             {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                                             {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
const std::vector<gpu::Binding> kSphereBindings{{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_SHADER_STAGE_FRAGMENT_BIT},
                                                {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_VERTEX_BIT},
                                                {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_VERTEX_BIT}};

template <typename T>
gpu::Buffer upload(const gpu::Device& device, const char* name, const std::vector<T>& items, VkBufferUsageFlags usage) {
  gpu::Buffer buffer = gpu::create_buffer(device, name, items.size() * sizeof(T), usage, gpu::Where::upload);
  std::memcpy(buffer.mapped, items.data(), items.size() * sizeof(T));
  return buffer;
}

// Runs sky_rays.comp over `count` items, 64 per workgroup.
template <typename Push>
void dispatch_rays(VkCommandBuffer commands, const gpu::ComputePipeline& pipeline, const gpu::DescriptorSet& set,
                   const Push& push, uint32_t count) {
  gpu::dispatch_over(commands, pipeline, set, push, {8 * ((count + 63) / 64), 1});
}

interop::Atmosphere air_of(const app::Context& context) {
  Scene scene = context.scene;
  // A slip that codes have copied from each other, 4.40e-3 per km instead of 0.44e-3: planted to show that the tests
  // catch it.
  if (Medium* mie = scene.medium("mie"); mie != nullptr && context.inject == "wrong-constant")
    mie->absorption_per_km *= 10.0;
  return make_atmosphere(scene);
}

}  // namespace

ConstantSkyProgram::ConstantSkyProgram(const app::Context& context)
    : context_(context),
      atmosphere_(gpu::create_buffer(context.device, "atmosphere", sizeof(interop::Atmosphere),
                                     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                     gpu::Where::device)) {
  rebuild();
}

// [rebuild]
void ConstantSkyProgram::rebuild() {
  const gpu::Device& device = context_.device;
  per_vertex_ = context_.settings.choice("sky.method") == "per_vertex";
  SkySphere sphere = load_sky_sphere(gpu::source_directory() / "chapters" / "04_air" / "sky_sphere.obj");
  for (int level = 0; level < context_.settings.integer("sphere.detail"); ++level) sphere = subdivide(sphere);
  directions_ = upload(device, "sphere vertices", sphere.directions, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  indices_ = upload(device, "sphere triangles", sphere.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  index_count_ = static_cast<uint32_t>(sphere.indices.size());
  colours_ = per_vertex_ ? gpu::create_buffer(device, "vertex colours", directions_.bytes,
                                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::device)
                         : gpu::Buffer{};

  // Constants 0 to 3: what the scene's air is made of. 4: which phase functions. 5: each shader's own.
  gpu::Specialization constants = specialization(air_variant(context_.scene));
  constants.push_back(static_cast<uint32_t>(context_.settings.integer("phase.detail")));
  constants.push_back(per_vertex_);
  make_sphere_pipeline(constants);
  constants.back() = context_.scene.sun.disc;
  finish_pipeline_ = gpu::create_compute_pipeline(
      device, "04_air/finish.comp", {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, {1}, {2}}, sizeof(CameraRays), constants);
  constants.back() = false;
  if (per_vertex_) {
    colour_pipeline_ =
        gpu::create_compute_pipeline(device, "04_air/sky_rays.comp", kRayBindings, sizeof(CameraRays), constants);
    colour_set_ = gpu::create_descriptor_set(device, colour_pipeline_.set_layout, kRayBindings);
    gpu::write_buffer(device, colour_set_, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, atmosphere_);
    gpu::write_buffer(device, colour_set_, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, directions_);
    gpu::write_buffer(device, colour_set_, 2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, colours_);
  }
  sphere_set_ = gpu::create_descriptor_set(device, sphere_set_layout_, kSphereBindings);
  gpu::write_buffer(device, sphere_set_, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, atmosphere_);
  gpu::write_buffer(device, sphere_set_, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, directions_);
  gpu::write_buffer(device, sphere_set_, 2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                    per_vertex_ ? colours_ : directions_);  // not read per pixel
  finish_set_ = gpu::create_descriptor_set(device, finish_pipeline_.set_layout, finish_pipeline_.bindings);
  gpu::write_buffer(device, finish_set_, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, atmosphere_);
  if (target_ != nullptr) set_target(*target_);
}
// [/rebuild]

void ConstantSkyProgram::set_target(const gpu::Image& target) {
  target_ = &target;
  if (sky_.size.width != target.size.width || sky_.size.height != target.size.height)
    sky_ = gpu::create_image(context_.device, "sky", target.size, VK_FORMAT_R32G32B32A32_SFLOAT,
                             VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
  gpu::write_storage_image(context_.device, finish_set_, 1, sky_);
  gpu::write_storage_image(context_.device, finish_set_, 2, target);
}

// [draw]
void ConstantSkyProgram::draw(const app::Frame& frame) {
  const VkCommandBuffer commands = frame.commands;
  // Scene and sun may have changed, so every frame writes the air. An earlier frame may still read the buffer: the
  // barrier waits for the stages that do.
  constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                  fragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
  constexpr gpu::Use updated{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
  const interop::Atmosphere air = air_of(context_);
  gpu::buffer_barrier(commands, atmosphere_.handle, {compute | fragment}, updated);
  vkCmdUpdateBuffer(commands, atmosphere_.handle, 0, sizeof air, &air);
  gpu::buffer_barrier(commands, atmosphere_.handle, updated, {compute | fragment, VK_ACCESS_2_UNIFORM_READ_BIT});

  // The sky image: an earlier frame's finish pass may still read it; then it is drawn into, and this frame's finish
  // pass reads it.
  constexpr gpu::Use drawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                           VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  gpu::image_barrier(commands, sky_.handle, {compute}, drawn);
  {
    // The time includes the vertices' colours, so that the two methods can be compared.
    const gpu::TimedPass pass(frame.timer, commands, "sky sphere");
    if (per_vertex_) {
      constexpr VkPipelineStageFlags2 vertex = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
      gpu::buffer_barrier(commands, colours_.handle, {vertex}, gpu::kComputeWrite);
      dispatch_rays(commands, colour_pipeline_, colour_set_, frame.camera,
                    static_cast<uint32_t>(directions_.bytes / sizeof(glm::vec4)));
      gpu::buffer_barrier(commands, colours_.handle, gpu::kComputeWrite, {vertex, VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
    }
    draw_sphere(frame);
  }
  gpu::image_barrier(commands, sky_.handle, drawn, gpu::kComputeRead);

  gpu::image_barrier(commands, frame.target.handle, {compute}, gpu::kComputeWrite);
  const gpu::TimedPass pass(frame.timer, commands, "copy and sun");
  gpu::dispatch_over(commands, finish_pipeline_, finish_set_, frame.camera, frame.target.size);
}

void ConstantSkyProgram::draw_sphere(const app::Frame& frame) {
  const VkCommandBuffer commands = frame.commands;
  const VkRenderingAttachmentInfo colour{
      .sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
      .imageView = sky_.view,
      .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
      .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,  // a sphere with a hole shows black, not old memory
      .storeOp = VK_ATTACHMENT_STORE_OP_STORE};
  const VkRect2D area{{0, 0}, sky_.size};
  const VkViewport viewport{0.0f, 0.0f, static_cast<float>(sky_.size.width), static_cast<float>(sky_.size.height),
                            0.0f, 1.0f};
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = area,
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &colour};
  vkCmdBeginRendering(commands, &rendering);
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &area);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, sphere_pipeline_);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, sphere_layout_, 0, 1, &sphere_set_.handle, 0,
                          nullptr);
  vkCmdPushConstants(commands, sphere_layout_, kSphereStages, 0, sizeof frame.camera, &frame.camera);
  vkCmdBindIndexBuffer(commands, indices_.handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(commands, index_count_, 1, 0, 0, 0);
  vkCmdEndRendering(commands);
}
// [/draw]

std::vector<app::ProbeResult> ConstantSkyProgram::probe(std::span<const app::ProbeRay> rays) {
  const gpu::Device& device = context_.device;
  std::vector<glm::vec4> items;
  for (const app::ProbeRay& ray : rays) {  // azimuth 0 points to the sun
    items.emplace_back(app::direction_from(ray.view_zenith_deg, ray.relative_azimuth_deg), ray.altitude_km);
    items.emplace_back(app::direction_from(ray.sun_zenith_deg, 0.0), 0.0);
  }
  gpu::Specialization constants = specialization(air_variant(context_.scene));
  constants.insert(constants.end(), {static_cast<uint32_t>(context_.settings.integer("phase.detail")), 1u});
  const gpu::ComputePipeline pipeline =
      gpu::create_compute_pipeline(device, "04_air/sky_rays.comp", kRayBindings, sizeof(CameraRays), constants);
  const gpu::DescriptorSet set = gpu::create_descriptor_set(device, pipeline.set_layout, kRayBindings);
  const gpu::Buffer air =
      upload(device, "probe air", std::vector{air_of(context_)}, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  const gpu::Buffer in = upload(device, "probe rays", items, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  const gpu::Buffer out =
      gpu::create_buffer(device, "probe results", in.bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback);
  gpu::write_buffer(device, set, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, air);
  gpu::write_buffer(device, set, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, in);
  gpu::write_buffer(device, set, 2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, out);
  const gpu::CommandPool pool = gpu::create_command_pool(device);
  gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
    dispatch_rays(commands, pipeline, set, CameraRays{}, static_cast<uint32_t>(rays.size()));
    gpu::buffer_barrier(commands, out.handle, gpu::kComputeWrite, gpu::kHostRead);
  });
  const std::span<glm::vec4> results = out.as<glm::vec4>();
  std::vector<app::ProbeResult> answers;
  for (size_t i = 0; i < rays.size(); ++i)
    answers.push_back({glm::dvec3(results[2 * i]), glm::dvec3(results[2 * i + 1])});
  return answers;
}

// [pipeline]
void ConstantSkyProgram::make_sphere_pipeline(const gpu::Specialization& constants) {
  const gpu::Device& device = context_.device;
  sphere_set_layout_ = gpu::create_set_layout(device, kSphereBindings);
  sphere_layout_ = gpu::create_pipeline_layout(device, sphere_set_layout_, kSphereStages, sizeof(CameraRays));
  sphere_pipeline_ = gpu::create_graphics_pipeline(device, "04_air/sky_sphere.vert", "04_air/sky_sphere.frag",
                                                   sphere_layout_, VK_FORMAT_R32G32B32A32_SFLOAT, constants);
}
// [/pipeline]

}  // namespace welkin
