// The pass of chapter 03. See planet_and_rays.hpp and docs/chapters/03_planet_and_rays.md.
#include "chapters/03_planet_and_rays/planet_and_rays.hpp"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace welkin {
namespace {

// Push constants of planet.comp: 112 of the 128 bytes that every device offers.
struct Push {
  CameraRays camera;
  glm::vec4 planet;  // x: ground radius, km; y: altitude of the top of the atmosphere, km; z: angle of a pixel, rad
  glm::vec4 albedo;
};
static_assert(sizeof(Push) == 112);

}  // namespace

// [knobs]
std::vector<Knob> planet_knobs() {
  return {
      {.name = "rays.form",
       .meaning = "how a ray is intersected with a sphere",
       .maximum = 3.0,
       .initial = 2.0,
       .integer = true,
       .choices = {"naive", "camera_relative", "robust", "double_float"},
       .ladder = {0, 1, 2, 3},
       .rebuilds = true},
      {.name = "debug.view",
       .meaning = "what is painted: the planet, or what the rays found",
       .maximum = 4.0,
       .integer = true,
       .choices = {"shaded", "distance", "distance_error", "normal", "altitude_of_hit"},
       .rebuilds = true},
      {.name = "camera.zoom",
       .unit = "x",
       .meaning = "telescope in front of the view",
       .minimum = 1.0,
       .maximum = 600.0,
       .initial = 1.0},
  };
}
// [/knobs]

PlanetAndRays::PlanetAndRays(const app::Context& context) : context_(context) { rebuild(); }

// [rebuild]
void PlanetAndRays::rebuild() {
  // Form and view are specialization constants: the pipeline contains the one form that is asked for and no branch.
  const auto value = [&](const char* knob) { return static_cast<uint32_t>(context_.settings.integer(knob)); };
  pipeline_ = gpu::create_compute_pipeline(context_.device, "03_planet_and_rays/planet.comp",
                                           {{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}}, sizeof(Push),
                                           {value("rays.form"), value("debug.view")});
  if (set_.handle == VK_NULL_HANDLE)
    set_ = gpu::create_descriptor_set(context_.device, pipeline_.set_layout, pipeline_.bindings);
}
// [/rebuild]

void PlanetAndRays::set_target(const gpu::Image& target) { gpu::write_storage_image(context_.device, set_, 0, target); }

// [draw]
void PlanetAndRays::draw(const app::Frame& frame) {
  // The display pass of an earlier frame may still read the picture; its old content is not needed.
  constexpr gpu::Use earlier_read{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT};
  gpu::image_barrier(frame.commands, frame.target.handle, earlier_read, gpu::kComputeWrite);

  const Planet& planet = context_.scene.planet;
  const float zoom = static_cast<float>(context_.settings.number("camera.zoom"));
  Push push{.camera = frame.camera,
            .planet = {planet.ground_radius_km, planet.top_radius_km - planet.ground_radius_km, 0.0, 0.0},
            .albedo = {planet.ground_albedo, 1.0}};
  for (int axis = 0; axis < 3; ++axis) push.camera.right[axis] /= zoom, push.camera.up[axis] /= zoom;
  push.planet.z = 2.0f * glm::length(glm::vec3(push.camera.up)) / static_cast<float>(frame.target.size.height);

  const gpu::TimedPass pass(frame.timer, frame.commands, "planet");
  gpu::dispatch_over(frame.commands, pipeline_, set_, push, frame.target.size);
}
// [/draw]

}  // namespace welkin
