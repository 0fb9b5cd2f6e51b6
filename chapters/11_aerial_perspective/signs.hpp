// A row of signs 1, 2, 5, 10, 20, 50 and 100 km from the scene's place, so that distance can be seen.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "common/graph/effect.hpp"

namespace welkin {

// A board and its post, upright on the ground, facing the scene's place. km, global frame.
struct SignBoard {
  double distance_km = 0.0;                    // along the tangent plane; the board's width is a tenth of it
  glm::dvec3 foot_km{0.0};                     // where the post meets the ground
  glm::dvec3 side{0.0}, up{0.0}, normal{0.0};  // unit: along the board, along the post, towards the scene's place
};

// The seven signs around a direction, radians clockwise from north.
std::vector<SignBoard> sign_boards(double ground_radius_km, double azimuth_rad);

// On the board where the scene has signs: four texels a row and a row a sign, as signs.glsl reads them.
struct Signs {
  graph::Resource image;
};

// No pass: the boards are known when the scene is.
app::Effect signs();

// What a step needs that draws signs: the image, and HAS_SIGNS.
void add_signs(graph::Step& step, app::Board& board, graph::Resource stand_in);

}  // namespace welkin
