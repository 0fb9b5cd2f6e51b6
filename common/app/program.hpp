// A running chapter: what the framework asks it to draw and to measure.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/gpu/commands.hpp"
#include "common/gpu/pipeline.hpp"
#include "common/graph/frame.hpp"
#include "common/knobs.hpp"
#include "common/scene/scene.hpp"

namespace welkin::app {

// What a program may use for as long as it lives. Scene and settings change under it between frames.
struct Context {
  const gpu::Device& device;
  const Scene& scene;
  const Settings& settings;
  const std::string& inject;  // --inject FAULT
};

// A ray of --probe, in degrees as in the file; relative azimuth 0 looks towards the sun.
struct ProbeRay {
  double altitude_km, view_zenith_deg, sun_zenith_deg, relative_azimuth_deg;
  // The same in the tangent frame of the scene's place (unit vectors), for what differs from place to place.
  glm::dvec3 position_km{0.0}, direction{0.0, 0.0, 1.0}, sun{0.0, 0.0, 1.0};
};
struct ProbeResult {
  glm::dvec3 radiance, transmittance;
  glm::dvec3 standard_error{0.0};  // of the radiance, where the chapter is stochastic
};

// A running chapter.
struct Program {
  virtual ~Program() = default;
  // The image draw() writes: called before the first draw and after every resize, when no frame is in flight.
  virtual void set_target(const gpu::Image& target) = 0;
  // The 8-bit picture, likewise, before set_target(). False: the program leaves it to the framework's display.
  virtual bool set_displayed(const gpu::Image&) { return false; }
  // Records the passes of one frame, each timed, with their barriers.
  virtual void draw(const Frame& frame) = 0;
  // Whether scene or settings are others than what was built, beyond knobs marked `rebuilds`.
  virtual bool stale() { return false; }
  // Follows scene and settings: a knob marked `rebuilds` changed, the scene did, or stale(). No frame is in flight.
  virtual void rebuild() = 0;
  virtual void reload() { rebuild(); }  // from shaders compiled anew
  // Radiance and transmittance along rays, in the order given. Chapters without a sky have none.
  virtual std::vector<ProbeResult> probe(std::span<const ProbeRay> rays);
  // What --explain prints beside passes and bytes: whole lines, or nothing.
  virtual std::string explain() const { return {}; }
  // An intermediate image for --dump: rgba32f or rgba16f, 2-D, left in layout GENERAL. nullptr: there is none of this
  // name.
  virtual const gpu::Image* image(const std::string& name) const;
};

}  // namespace welkin::app
