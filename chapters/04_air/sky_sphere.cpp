// Reading the sky sphere. See sky_sphere.hpp.
#include "chapters/04_air/sky_sphere.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <sstream>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

namespace welkin {
namespace {

constexpr size_t kLargestFile = 16 << 20;
constexpr size_t kMostVertices = 200'000;
constexpr const char* kAccepted =
    "accepted is an OBJ file with the triangles or polygons of a sphere around the origin";

std::string first_line(std::string text) {
  text.resize(std::min(text.find_first_of("\r\n"), text.size()));
  return text;
}

}  // namespace

// [load]
SkySphere load_sky_sphere(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::istringstream text(read_file(file, kLargestFile));
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  // The library does not triangulate here: its ear clipping takes time quadratic in the number of a face's corners.
  const bool read = tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &text, nullptr, false);
  if (!read) fail("sky sphere {}: {}; {}", name, first_line(error), kAccepted);

  SkySphere sphere;
  const size_t count = attributes.vertices.size() / 3;
  if (count > kMostVertices) fail("sky sphere {}: {} vertices; accepted are up to {}", name, count, kMostVertices);
  for (size_t i = 0; i < count; ++i) {
    const float* v = &attributes.vertices[3 * i];
    const glm::dvec3 position(v[0], v[1], v[2]);
    const double length = glm::length(position);
    if (!std::isfinite(length) || length < 1e-6)
      fail("sky sphere {}: vertex {} is ({}, {}, {}), which is no direction; {}", name, i + 1, v[0], v[1], v[2],
           kAccepted);
    sphere.directions.emplace_back(position / length, 0.0);
  }

  std::vector<bool> used(count, false);
  for (const tinyobj::shape_t& shape : shapes) {
    const std::vector<tinyobj::index_t>& corners = shape.mesh.indices;
    size_t first = 0;
    for (const size_t corner_count : shape.mesh.num_face_vertices) {
      if (corner_count < 3 || first + corner_count > corners.size())
        fail("sky sphere {}: a face of shape '{}' has fewer than 3 or more than 255 corners", name,
             first_line(shape.name));
      for (size_t k = 0; k < corner_count; ++k) {
        const int index = corners[first + k].vertex_index;
        if (index < 0 || static_cast<size_t>(index) >= count)
          fail("sky sphere {}: a face names vertex {}, but the file has {}", name, index + 1, count);
        used[index] = true;
      }
      for (size_t k = 2; k < corner_count; ++k)
        for (const size_t corner : {size_t{0}, k - 1, k})
          sphere.indices.push_back(static_cast<uint32_t>(corners[first + corner].vertex_index));
      first += corner_count;
    }
    if (first != corners.size())
      fail("sky sphere {}: a face of shape '{}' has more than 255 corners", name, first_line(shape.name));
  }
  if (sphere.indices.empty()) fail("sky sphere {}: no face in it; {}", name, kAccepted);
  for (size_t i = 0; i < count; ++i)
    if (!used[i])
      fail("sky sphere {}: vertex {} belongs to no face: the file is cut off, or holds more than a sphere", name,
           i + 1);
  return sphere;
}
// [/load]

// [subdivide]
SkySphere subdivide(const SkySphere& sphere) {
  SkySphere finer{sphere.directions, {}};
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;  // an edge's middle is shared by its two triangles
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(finer.directions.size()));
    if (is_new) {
      const glm::dvec3 sum = glm::dvec3(sphere.directions[a]) + glm::dvec3(sphere.directions[b]);
      const double length = glm::length(sum);
      // Opposite corners have no middle direction. Either corner will do: no triangle of a sphere spans a half circle.
      finer.directions.push_back(length > 1e-6 ? glm::vec4(sum / length, 0.0) : sphere.directions[a]);
    }
    return place->second;
  };
  for (size_t i = 0; i + 2 < sphere.indices.size(); i += 3) {
    const uint32_t a = sphere.indices[i], b = sphere.indices[i + 1], c = sphere.indices[i + 2];
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const uint32_t corner : {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca}) finer.indices.push_back(corner);
  }
  return finer;
}
// [/subdivide]

}  // namespace welkin
