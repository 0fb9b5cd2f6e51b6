// A row of signs 1, 2, 5, 10, 20, 50 and 100 km from the scene's place, so that distance can be seen.
#pragma once

#include <array>
#include <glm/vec4.hpp>

#include "common/scene/scene.hpp"

namespace welkin {

// Where each sign stands, km, global frame: xyz the foot of its post, on the ground; w its distance along the tangent
// plane. A sign is upright and faces the scene's place: the rest follows (shaders/11_aerial_perspective/signs.glsl).
using SignPlaces = std::array<glm::vec4, 7>;

// Around a direction, radians clockwise from north.
SignPlaces sign_places(double ground_radius_km, double azimuth_rad);

bool has_signs(const Scene& scene);

// Those of the scene; without signs all zero.
SignPlaces sign_places(const Scene& scene);

}  // namespace welkin
