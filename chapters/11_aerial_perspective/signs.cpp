// Where the signs stand. See signs.hpp.
#include "chapters/11_aerial_perspective/signs.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace welkin {

// [places]
SignPlaces sign_places(double ground_radius_km, double azimuth_rad) {
  constexpr double kBetween_rad = 0.13;  // two signs, seen from the scene's place
  constexpr std::array kDistances_km{1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};
  SignPlaces places;
  for (size_t k = 0; k < places.size(); ++k) {
    const double d = kDistances_km[k], azimuth = azimuth_rad + (static_cast<double>(k) - 3.0) * kBetween_rad;
    // The ground there lies lower than the tangent plane by sqrt(R^2 - d^2) - R, in the form that does not cancel.
    const double above_centre = std::sqrt(std::max(ground_radius_km * ground_radius_km - d * d, 0.0));
    places[k] = glm::dvec4(d * std::sin(azimuth), d * std::cos(azimuth), -d * d / (ground_radius_km + above_centre), d);
  }
  return places;
}
// [/places]

bool has_signs(const Scene& scene) { return scene.terrain && scene.terrain->signs_azimuth_deg; }

SignPlaces sign_places(const Scene& scene) {
  if (!has_signs(scene)) return {};
  return sign_places(scene.planet.ground_radius_km, glm::radians(*scene.terrain->signs_azimuth_deg));
}

}  // namespace welkin
