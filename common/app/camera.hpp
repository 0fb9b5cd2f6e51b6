// A fly camera around a planet, without roll: position in double, look direction in the local frame.
//
// Global frame: origin on the ground at the scene's place, x east, y north, z up there; the planet's centre is at
// (0, 0, -R). The camera's local frame is east, north, up where the camera stands.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "common/scene/scene.hpp"
#include "common/scene/sun.hpp"
#include "shaders/interop/camera.h"

namespace welkin::app {

struct CameraPose {
  glm::dvec3 position_km{0.0};
  double azimuth_deg = 0.0;    // clockwise from north
  double elevation_deg = 0.0;  // -90 … 90: no roll, no flip; at ±90 the azimuth says where the picture's edges point
  double fov_deg = 60.0;       // vertical
};

struct LocalFrame {
  glm::dvec3 east, north, up;
};

CameraPose pose_of(const View& view, double ground_radius_km);
double altitude_km(const CameraPose& pose, double ground_radius_km);
LocalFrame local_frame(const CameraPose& pose, double ground_radius_km);

// Unit vector in the local frame from zenith and azimuth (clockwise from north), degrees.
glm::dvec3 direction_from(double zenith_deg, double azimuth_deg);

// Turns by the given angles; elevation stays within ±90 degrees.
void turn(CameraPose& pose, double azimuth_deg, double elevation_deg);

// Moves along local axes (x right, y forward in the look direction, z up) for `seconds`; speed grows with altitude so
// that grass and orbit are both comfortable. Never below 0.5 m nor above kHighest_km. The look keeps its direction:
// near the frame's pole, where north turns about, the azimuth turns with it.
void fly(CameraPose& pose, const glm::dvec3& axes, double seconds, bool fast, double ground_radius_km);

// The sun `seconds` after it stood at (zenith, azimuth): it turns 15 degrees an hour about the pole at this latitude.
SunAngles advance_sun(double zenith_deg, double azimuth_deg, double latitude_deg, double seconds);

// The camera and the sun in the camera's local frame, for the shader.
CameraRays camera_rays(const CameraPose& pose, const Scene& scene, double time_s, glm::uvec2 size, uint32_t seed,
                       uint32_t frame);

// The pose as a view of a scene, so that a screenshot can restore it.
View view_of(const CameraPose& pose, double ground_radius_km);

}  // namespace welkin::app
