// From the scene's words to the shaders' numbers. See cloud_bodies.hpp.
#include "chapters/17_cloud_shapes/cloud_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "common/error.hpp"

namespace welkin {
namespace {

using interop::CloudBody;

float single(double value) { return static_cast<float>(value); }

int kind_of(const Cloud& cloud) {
  static const std::map<std::string, int> kinds{{"layer", interop::kCloudLayer},
                                                {"disc", interop::kCloudDisc},
                                                {"sphere", interop::kCloudSphere},
                                                {"grid", interop::kCloudGrid},
                                                {"noise", interop::kCloudNoise}};
  return kinds.at(cloud.kind);
}

double altitude_of(const Planet& planet, const glm::dvec3& point) {
  return glm::length(point + glm::dvec3(0.0, 0.0, planet.ground_radius_km)) - planet.ground_radius_km;
}

// A cone about the vertical at the end of an arc, as wide as the arc to the rim says.
void place_disc(const Cloud& cloud, const Planet& planet, CloudBody& body) {
  const double radius_km = planet.ground_radius_km + cloud.base_km, arc_km = std::hypot(cloud.east_km, cloud.north_km);
  const double angle = arc_km / radius_km, across = arc_km > 0.0 ? std::sin(angle) / arc_km : 0.0;
  const glm::dvec3 axis(cloud.east_km * across, cloud.north_km * across, std::cos(angle));
  const double half = std::sin(0.5 * angle);
  body.axis = axis;
  // (R + base) axis - (0, 0, R), without the difference of large numbers.
  body.place_km = glm::dvec3(radius_km * axis.x, radius_km * axis.y, cloud.base_km - 2.0 * radius_km * half * half);
  body.cone_slope = single(std::tan(cloud.radius_km / radius_km));
  body.radius_km = single(radius_km * std::tan(cloud.radius_km / radius_km));
}

// A period of the base texture is about seven times as long as the layer is thick: 2^n or 3 2^n km, so that 49 of them
// are few bits and positions can be wrapped around exactly.
void place_noise(const Cloud& cloud, CloudBody& body) {
  const double wanted_km = std::clamp(7.0 * (cloud.top_km - cloud.base_km), 1.0, 48.0);
  const double power = std::exp2(std::floor(std::log2(wanted_km)));
  body.cell_km = single(wanted_km < 1.25 * power ? power : wanted_km < 1.75 * power ? 1.5 * power : 2.0 * power);
  body.coverage = single(cloud.coverage);
  body.type = single(cloud.type.value_or(-1.0));
  body.extent_km = single(cloud.extent_km);
  body.painted = cloud.weather != "procedural";
  // Seed 0 is the map as it is; others see another part of it, turned.
  const double turn = body.painted > 0.5f ? 0.0 : 2.399963229728653 * cloud.seed;
  body.turn_x = single(std::cos(turn)), body.turn_y = single(std::sin(turn));
  const auto share = [](double x) { return x - std::floor(x); };
  body.shift_x = single(body.painted > 0.5f ? 0.0 : share(0.7548776662466927 * cloud.seed));
  body.shift_y = single(body.painted > 0.5f ? 0.0 : share(0.5698402909980532 * cloud.seed));
}

// Lowest and highest altitude of a ball or a box.
std::pair<double, double> reach_of(const Cloud& cloud, const Planet& planet) {
  const glm::dvec3 corner(cloud.east_km, cloud.north_km, cloud.up_km);
  if (cloud.kind == "sphere") {
    const double altitude_km = altitude_of(planet, corner);
    return {altitude_km - cloud.radius_km, altitude_km + cloud.radius_km};
  }
  double highest_km = -1e9;
  for (int k = 0; k < 8; ++k)
    highest_km =
        std::max(highest_km, altitude_of(planet, corner + cloud.size_km * glm::dvec3(k & 1, k >> 1 & 1, k >> 2)));
  glm::dvec3 nearest = corner;
  for (int axis = 0; axis < 2; ++axis)
    nearest[axis] = std::clamp(0.0, corner[axis], corner[axis] + cloud.size_km[axis]);
  return {altitude_of(planet, nearest), highest_km};
}

}  // namespace

// [presets]
std::vector<Cloud> preset_bodies(const Weather& weather) {
  const auto body = [&](const char* name, double base_km, double top_km, double coverage, double type,
                        double extinction_per_km) {
    return Cloud{.kind = "noise",
                 .name = name,
                 .base_km = base_km,
                 .top_km = top_km,
                 .coverage = coverage,
                 .type = type / 7.0,
                 .seed = weather.seed,
                 .extinction_per_km = extinction_per_km,
                 .phase = CloudPhase::droplets};
  };
  if (weather.preset == "fair") return {body("cumulus", 1.3, 3.4, 0.43, 2.0, 60.0)};
  if (weather.preset == "broken") return {body("stratocumulus", 1.1, 3.1, 0.62, 1.5, 50.0)};
  if (weather.preset == "overcast") return {body("stratus", 0.7, 3.4, 0.97, 0.4, 30.0)};
  if (weather.preset == "storm") return {body("cumulonimbus", 0.9, 10.5, 0.4, 4.0, 50.0)};
  if (weather.preset == "mackerel") return {body("altocumulus", 4.0, 5.4, 0.6, 5.0, 12.0)};
  return {};  // clear
}

std::vector<Cloud> bodies_of(const Scene& scene) {
  std::vector<Cloud> bodies = scene.clouds;
  if (!scene.weather) return bodies;
  for (const Cloud& body : preset_bodies(*scene.weather)) bodies.push_back(body);
  if (bodies.size() > kMostClouds)
    fail("{} clouds with those of [weather]; accepted are up to {}", bodies.size(), kMostClouds);
  return bodies;
}
// [/presets]

// [droplets]
PhaseMixture droplet_phase(double d) {
  PhaseMixture mixture{.second_alpha = 0.0};
  double share = 0.0, draine_g = 0.0, alpha = 0.0, hg_g = 0.0;
  if (d >= 5.0) {
    hg_g = std::exp(-0.0990567 / (d - 1.67154));
    draine_g = std::exp(-2.20679 / (d + 3.91029) - 0.428934);
    alpha = std::exp(3.62489 - 8.29288 / (d + 5.52825));
    share = std::exp(-0.599085 / (d - 0.641583) - 0.665888);
  } else {
    const double l = std::log(d), ll = std::log(l);
    hg_g = 0.0604931 * ll + 0.940256;
    draine_g = 0.500411 - 0.081287 / (-2.0 * l + std::tan(l) + 1.27551);
    alpha = 7.30354 * l + 6.31675;
    share = 0.026914 * (l - std::cos(5.68947 * (ll - 0.0292149))) + 0.376475;
  }
  mixture.weight = share, mixture.g = draine_g, mixture.alpha = alpha, mixture.second_g = hg_g;
  return mixture;
}

PhaseMixture phase_of(const Cloud& cloud) {
  if (cloud.phase == CloudPhase::droplets) return droplet_phase(cloud.droplet_diameter_um);
  if (cloud.phase == CloudPhase::henyey_greenstein) return {.g = cloud.g};
  return {cloud.weight, cloud.g, cloud.alpha, cloud.second_g, cloud.second_alpha};
}
// [/droplets]

int kinds_of(const std::vector<Cloud>& bodies) {
  int kinds = 0;
  for (const Cloud& cloud : bodies) kinds |= kind_of(cloud);
  return kinds;
}

// [make_block]
interop::CloudBlock make_cloud_block(const std::vector<Cloud>& bodies, const Planet& planet) {
  interop::CloudBlock block{.count = static_cast<int>(bodies.size()),
                            .ground_radius_km = single(planet.ground_radius_km)};
  double ceiling_km = 0.0, floor_km = bodies.empty() ? 0.0 : 1e9;
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Cloud& cloud = bodies[i];
    CloudBody& body = block.bodies[i];
    body.kind = kind_of(cloud);
    body.extinction_per_km = single(cloud.extinction_per_km);
    body.single_scattering_albedo = single(cloud.single_scattering_albedo);
    body.largest_density = 1.0f;
    const bool hangs = cloud.kind == "sphere" || cloud.kind == "grid";
    const auto [lowest_km, highest_km] = hangs ? reach_of(cloud, planet) : std::pair(cloud.base_km, cloud.top_km);
    body.base_km = single(lowest_km), body.top_km = single(highest_km);
    if (hangs) body.place_km = glm::dvec3(cloud.east_km, cloud.north_km, cloud.up_km);
    if (cloud.kind == "sphere") body.radius_km = single(cloud.radius_km);
    if (cloud.kind == "grid") body.axis = cloud.size_km;
    if (cloud.kind == "disc") place_disc(cloud, planet, body);
    if (cloud.kind == "noise") place_noise(cloud, body);
    const PhaseMixture phase = phase_of(cloud);
    body.lobe_weight = single(phase.weight), body.lobe_g = single(phase.g), body.lobe_alpha = single(phase.alpha);
    body.second_g = single(phase.second_g), body.second_alpha = single(phase.second_alpha);
    ceiling_km = std::max(ceiling_km, highest_km), floor_km = std::min(floor_km, lowest_km);
  }
  block.ceiling_km = single(ceiling_km), block.floor_km = single(std::max(floor_km, 0.0));
  return block;
}
// [/make_block]

}  // namespace welkin
