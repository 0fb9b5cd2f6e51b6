// The sky sphere: triangles around the eye, loaded from an OBJ file. Only directions matter, so vertices become unit
// vectors.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec4.hpp>
#include <vector>

namespace welkin {

struct SkySphere {
  std::vector<glm::vec4> directions;  // xyz: unit vector from the eye, z up; w: 0 (as a storage buffer aligns them)
  std::vector<uint32_t> indices;      // three per triangle
};

// Accepted: an OBJ of at most 16 MiB and 200,000 vertices, all used, none at the origin, with faces of 3 to 255 corners
// (fanned into triangles). It need not be closed. Anything else is one line: what is wrong, in which file.
SkySphere load_sky_sphere(const std::filesystem::path& file);

// Every triangle split in four, the new vertices pushed out to the sphere: the edges' angles halve.
SkySphere subdivide(const SkySphere& sphere);

}  // namespace welkin
