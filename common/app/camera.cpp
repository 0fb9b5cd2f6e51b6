// Camera mathematics. See camera.hpp.
#include "common/app/camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace welkin::app {
namespace {

constexpr double kLowest_km = 0.0005;  // half a metre

glm::dvec3 planet_centre(double ground_radius_km) { return {0.0, 0.0, -ground_radius_km}; }

}  // namespace

CameraPose pose_of(const View& view, double ground_radius_km) {
  // Up at the end of an arc of `angle` from the scene's place; r cos(angle) - R, written so that altitude keeps its
  // digits.
  const double arc_km = std::hypot(view.east_km, view.north_km), angle = arc_km / ground_radius_km;
  const double across = arc_km > 0.0 ? (ground_radius_km + view.altitude_km) * std::sin(angle) / arc_km : 0.0;
  const double half = std::sin(0.5 * angle);
  return {.position_km = {across * view.east_km, across * view.north_km,
                          view.altitude_km * std::cos(angle) - 2.0 * ground_radius_km * half * half},
          .azimuth_deg = view.azimuth_deg,
          .elevation_deg = view.elevation_deg,
          .fov_deg = view.fov_deg};
}

double altitude_km(const CameraPose& pose, double ground_radius_km) {
  // |p - c| - R without subtracting two large numbers: (|p - c|^2 - R^2) / (|p - c| + R), and p - c = p + (0, 0, R).
  const glm::dvec3& p = pose.position_km;
  const double r = glm::length(p - planet_centre(ground_radius_km));
  return (glm::dot(p, p) + 2.0 * ground_radius_km * p.z) / (r + ground_radius_km);
}

LocalFrame local_frame(const CameraPose& pose, double ground_radius_km) {
  const glm::dvec3 up = glm::normalize(pose.position_km - planet_centre(ground_radius_km));
  // The scene's place lies on the equator of a pole along +y, so that east and north there are x and y.
  glm::dvec3 east = glm::cross(glm::dvec3(0.0, 1.0, 0.0), up);
  east = glm::length(east) > 1e-9 ? glm::normalize(east) : glm::dvec3(1.0, 0.0, 0.0);
  return {east, glm::cross(up, east), up};
}

glm::dvec3 direction_from(double zenith_deg, double azimuth_deg) {
  const double zenith = glm::radians(zenith_deg), azimuth = glm::radians(azimuth_deg);
  return {std::sin(zenith) * std::sin(azimuth), std::sin(zenith) * std::cos(azimuth), std::cos(zenith)};
}

void turn(CameraPose& pose, double azimuth_deg, double elevation_deg) {
  pose.azimuth_deg = std::fmod(pose.azimuth_deg + azimuth_deg + 720.0, 360.0);
  pose.elevation_deg = std::clamp(pose.elevation_deg + elevation_deg, -90.0, 90.0);
}

void fly(CameraPose& pose, const glm::dvec3& axes, double seconds, bool fast, double ground_radius_km) {
  const double altitude = altitude_km(pose, ground_radius_km);
  const double speed_km_s = std::max(0.005, 0.5 * altitude) * (fast ? 8.0 : 1.0);
  const LocalFrame frame = local_frame(pose, ground_radius_km);
  const glm::dvec3 look = direction_from(90.0 - pose.elevation_deg, pose.azimuth_deg);
  const glm::dvec3 right = direction_from(90.0, pose.azimuth_deg + 90.0);
  const glm::dvec3 local = right * axes.x + look * axes.y + glm::dvec3(0.0, 0.0, axes.z);
  pose.position_km += (frame.east * local.x + frame.north * local.y + frame.up * local.z) * speed_km_s * seconds;
  const double now = altitude_km(pose, ground_radius_km), clamped_km = std::clamp(now, kLowest_km, kHighest_km);
  const LocalFrame there = local_frame(pose, ground_radius_km);
  pose.position_km += there.up * (clamped_km - now);
  // The heading, level, as it was: but seen from the new frame.
  const glm::dvec3 ahead = glm::cross(there.up, frame.east * right.x + frame.north * right.y);
  const double azimuth_deg = glm::degrees(std::atan2(glm::dot(ahead, there.east), glm::dot(ahead, there.north)));
  pose.azimuth_deg = std::fmod(azimuth_deg + 360.0, 360.0);
}

SunAngles advance_sun(double zenith_deg, double azimuth_deg, double latitude_deg, double seconds) {
  if (seconds == 0.0) return {zenith_deg, azimuth_deg};
  // Rotate the local direction about the celestial pole (0, cos latitude, sin latitude), westwards.
  const glm::dvec3 sun = direction_from(zenith_deg, azimuth_deg);
  const double latitude = glm::radians(latitude_deg);
  const glm::dvec3 pole(0.0, std::cos(latitude), std::sin(latitude));
  const double angle = -seconds / 86400.0 * 2.0 * 3.14159265358979323846;
  const glm::dvec3 turned = sun * std::cos(angle) + glm::cross(pole, sun) * std::sin(angle) +
                            pole * glm::dot(pole, sun) * (1.0 - std::cos(angle));
  return {glm::degrees(std::atan2(std::hypot(turned.x, turned.y), turned.z)),
          std::fmod(glm::degrees(std::atan2(turned.x, turned.y)) + 360.0, 360.0)};
}

CameraRays camera_rays(const CameraPose& pose, const Scene& scene, double time_s, glm::uvec2 size, uint32_t seed,
                       uint32_t frame) {
  const double radius = scene.planet.ground_radius_km;
  const LocalFrame local = local_frame(pose, radius);
  const SunAngles place =
      advance_sun(scene.sun.zenith_deg, scene.sun.azimuth_deg, scene.sun.latitude_deg.value_or(0.0), time_s);
  const glm::dvec3 sun = direction_from(place.zenith_deg, place.azimuth_deg);  // in the frame of the scene's place
  const glm::dvec3 forward = direction_from(90.0 - pose.elevation_deg, pose.azimuth_deg);
  const glm::dvec3 right = direction_from(90.0, pose.azimuth_deg + 90.0);
  const glm::dvec3 up = glm::cross(right, forward);
  const double scale = std::tan(glm::radians(pose.fov_deg) / 2.0);
  const double aspect = static_cast<double>(size.x) / static_cast<double>(size.y);
  const double altitude = std::max(altitude_km(pose, radius), 0.0);
  return {.right = right * (scale * aspect),
          .altitude_km = static_cast<float>(altitude),
          .up = up * scale,
          .altitude_m = static_cast<float>(altitude * 1000.0),
          .forward = forward,
          .time_s = static_cast<float>(time_s),
          .sun = {glm::dot(sun, local.east), glm::dot(sun, local.north), glm::dot(sun, local.up)},
          .size = size,
          .seed = static_cast<int>(seed),
          .frame = static_cast<int>(frame)};
}

View view_of(const CameraPose& pose, double ground_radius_km) {
  const glm::dvec3& p = pose.position_km;
  const double across = std::hypot(p.x, p.y), arc_km = ground_radius_km * std::atan2(across, p.z + ground_radius_km);
  const bool away = across > 0.0;  // straight below the place the way there is any way: north
  return {.name = kRestoredView,
          .east_km = away ? arc_km * p.x / across : 0.0,
          .north_km = away ? arc_km * p.y / across : arc_km,
          .altitude_km = std::clamp(altitude_km(pose, ground_radius_km), 0.0, kHighest_km),
          .azimuth_deg = pose.azimuth_deg,
          .elevation_deg = pose.elevation_deg,
          .fov_deg = pose.fov_deg};
}

}  // namespace welkin::app
