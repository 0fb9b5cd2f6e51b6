// Where the signs stand. See signs.hpp and shaders/11_aerial_perspective/signs.glsl.
#include "chapters/11_aerial_perspective/signs.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include "chapters/11_aerial_perspective/relief.hpp"

namespace welkin {
namespace {

constexpr double kBetween_rad = 0.13;  // two signs, seen from the scene's place

}  // namespace

// [boards]
std::vector<SignBoard> sign_boards(double ground_radius_km, double azimuth_rad) {
  std::vector<SignBoard> boards;
  double azimuth = azimuth_rad - 3.0 * kBetween_rad;
  for (const double d : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
    const double east = d * std::sin(azimuth), north = d * std::cos(azimuth);
    // On the sphere below (east, north); upright is the height of that point above the centre.
    const double upright = std::sqrt(std::max(ground_radius_km * ground_radius_km - d * d, 0.0));
    const glm::dvec3 up = glm::dvec3(east, north, upright) / ground_radius_km;
    const glm::dvec3 side(std::cos(azimuth), -std::sin(azimuth), 0.0);
    boards.push_back({.distance_km = d,
                      .foot_km = {east, north, -d * d / (ground_radius_km + upright)},
                      .side = side,
                      .up = up,
                      .normal = -glm::cross(up, side)});
    azimuth += kBetween_rad;
  }
  return boards;
}
// [/boards]

app::Effect signs() {
  app::Effect effect{.name = "signs", .chapter = 11};
  effect.wanted = [](const Scene& scene, const Settings&) -> app::Wanted {
    if (!scene.terrain) return {false, "no [terrain] in scene"};
    if (!scene.terrain->signs_azimuth_deg) return {false, "no signs_azimuth_deg in [terrain]"};
    return {true, fmt::format("a row in direction {}", *scene.terrain->signs_azimuth_deg)};
  };
  effect.key = [](const Scene& scene, const Settings&) {
    return fmt::format("{} {}", *scene.terrain->signs_azimuth_deg, scene.planet.ground_radius_km);
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const Scene& scene = builder.context.scene;
    const double radius_km = scene.planet.ground_radius_km;
    std::vector<glm::vec4> texels;
    for (const SignBoard& sign : sign_boards(radius_km, glm::radians(*scene.terrain->signs_azimuth_deg))) {
      texels.emplace_back(glm::vec3(sign.foot_km), sign.distance_km);
      texels.emplace_back(glm::vec3(sign.side), 0.0f);
      texels.emplace_back(glm::vec3(sign.up), 0.0f);
      texels.emplace_back(glm::vec3(sign.normal), 0.0f);
    }
    board.offer(Signs{
        builder.graph.add_filled("signs", uploaded_map(builder.context.device, "signs", VK_FORMAT_R32G32B32A32_SFLOAT,
                                                       {4, 7}, std::as_bytes(std::span(texels))))});
  };
  return effect;
}

void add_signs(graph::Step& step, app::Board& board, graph::Resource stand_in) {
  const Signs* signs = board.find<Signs>();
  step.constants.push_back({"HAS_SIGNS", signs != nullptr});
  step.bindings.push_back({"sign_boards", signs != nullptr ? signs->image : stand_in});
}

}  // namespace welkin
