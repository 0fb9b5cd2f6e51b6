// Scene values as knobs. See scene_knobs.hpp.
#include "common/scene/scene_knobs.hpp"

namespace welkin {

std::vector<Knob> scene_knobs(const Scene& scene) {
  std::vector<Knob> knobs{{.name = "sun.zenith_deg",
                           .unit = "deg",
                           .meaning = "angle of the sun from the zenith",
                           .minimum = 0.0,
                           .maximum = 180.0,
                           .initial = scene.sun.zenith_deg},
                          {.name = "sun.azimuth_deg",
                           .unit = "deg",
                           .meaning = "azimuth of the sun, clockwise from north",
                           .minimum = 0.0,
                           .maximum = 360.0,
                           .initial = scene.sun.azimuth_deg},
                          {.name = "sun.disc",
                           .meaning = "draw the sun's disc",
                           .initial = scene.sun.disc ? 1.0 : 0.0,
                           .choices = {"off", "on"},
                           .rebuilds = true},
                          {.name = "ground.albedo",
                           .meaning = "share of light the ground reflects, all channels",
                           .minimum = 0.0,
                           .maximum = 1.0,
                           .initial = scene.planet.ground_albedo.x},
                          {.name = "exposure.ev",
                           .unit = "stops",
                           .meaning = "exposure of the 8-bit picture",
                           .minimum = -20.0,
                           .maximum = 30.0,
                           .initial = scene.post.exposure_ev}};
  if (const Medium* mie = scene.medium("mie"); mie != nullptr) {
    const int phase = mie->phase == Phase::rayleigh ? 0 : static_cast<int>(mie->phase);
    knobs.push_back({.name = "mie.phase",
                     .meaning = "phase function of the aerosol",
                     .initial = static_cast<double>(phase),
                     .choices = {"henyey_greenstein", "cornette_shanks", "draine", "double_hg"},
                     .rebuilds = true});
    knobs.push_back({.name = "mie.g",
                     .meaning = "asymmetry of the aerosol's phase function",
                     .minimum = -0.999,
                     .maximum = 0.999,
                     .initial = mie->g});
  }
  return knobs;
}

void apply_scene_knobs(const Settings& settings, Scene& scene) {
  const auto set = [&](const char* name) { return settings.has(name) && settings.was_set(name); };
  if (set("sun.zenith_deg")) scene.sun.zenith_deg = settings.number("sun.zenith_deg");
  if (set("sun.azimuth_deg")) scene.sun.azimuth_deg = settings.number("sun.azimuth_deg");
  if (set("sun.disc")) scene.sun.disc = settings.on("sun.disc");
  if (set("ground.albedo")) scene.planet.ground_albedo = glm::dvec3(settings.number("ground.albedo"));
  if (set("exposure.ev")) scene.post.exposure_ev = settings.number("exposure.ev"), scene.post.manual = true;
  if (Medium* mie = scene.medium("mie"); mie != nullptr) {
    if (set("mie.phase")) mie->phase = static_cast<Phase>(settings.integer("mie.phase"));
    if (set("mie.g")) mie->g = settings.number("mie.g");
  }
}

}  // namespace welkin
