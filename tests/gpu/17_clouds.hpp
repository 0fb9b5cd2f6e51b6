// What chapter 17's tests share: functions of its shaders over arrays, scenes with clouds, rays through them, and the
// published grids as files.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "chapters/17_cloud_shapes/cloud_picture.hpp"
#include "tests/gpu/11_parts.hpp"

namespace welkin::test {

enum class ShapePart { shell, sphere, cone, box, remapped, ground_way, profile, noise_place, ceiling, ground };

// As tests/gpu/shaders/17_parts.comp reads them: the part goes before them. Eight numbers come back.
struct ShapeItem {
  ShapePart part;
  std::array<double, 15> values{};
};
std::vector<std::array<double, 8>> evaluate_shapes(const std::vector<ShapeItem>& items);

// A point in split precision: origin + offset; altitude NaN: found from both, in double.
struct CloudPlace {
  glm::dvec3 origin_km{0.0}, offset_km{0.0};
  double altitude_km = NAN;
};
// The point above the end of an arc along the ground.
CloudPlace place_above(double east_km, double north_km, double altitude_km);

// Settings of chapter 17 with some set, for a scene that lives as long.
class CloudRun {
 public:
  CloudRun(Scene scene, const std::vector<std::pair<std::string, std::string>>& knobs = {});
  // Of all clouds along rays.
  std::vector<double> optical_depths(const std::vector<app::ProbeRay>& rays) const;
  // Of the first body: shape alone, with detail, with curled detail; then the extinction of all.
  std::vector<std::array<double, 4>> densities(const std::vector<CloudPlace>& places, int grid_method = 0) const;
  // Texels of what the noise is read from.
  enum class Read { base = 1, detail, curl, weather };
  std::vector<std::array<double, 4>> texels(Read texture, size_t count) const;
  const app::Context& context() const { return context_; }
  const Scene& scene() const { return scene_; }

 private:
  std::vector<std::array<double, 4>> run(const std::vector<CloudPlace>& places, size_t count, int read, int grid) const;

  Scene scene_;
  Settings settings_;
  std::string no_fault_;
  app::Context context_;
};

// All effects of chapter 17, as its main.cpp lists them; without meter and display.
std::vector<app::Effect> cloud_effects();

// A planet without air, with these clouds.
Scene scene_of(std::vector<Cloud> clouds);

// From an altitude above the scene's place, zenith and azimuth in degrees; or a place and a direction of its frame.
app::ProbeRay ray_up(double altitude_km, double zenith_deg, double azimuth_deg = 0.0);
app::ProbeRay ray_from(const glm::dvec3& position_km, const glm::dvec3& direction);

// tests/data/cloud_NAME.pgm as a grid file in the temporary directory; removed with this.
class GridFile {
 public:
  explicit GridFile(const std::string& name);
  ~GridFile() { std::filesystem::remove(path_); }
  GridFile(const GridFile&) = delete;
  const std::filesystem::path& path() const { return path_; }
  glm::dvec3 size_km{0.0};
  std::array<int, 3> corners{};
  std::vector<float> density;

 private:
  std::filesystem::path path_;
};

// All rays of tests/data/cloud_NAME.csv against its columns: errors of T, relative errors of tau and of T. The box
// stands 30 km up, away from the origin.
struct GridScore {
  double worst_t = 0.0, median_depth = 0.0, worst_depth = 0.0, median_t = 0.0;
  size_t rows = 0;
};
GridScore grid_score(const std::string& name, const std::vector<std::pair<std::string, std::string>>& knobs);

}  // namespace welkin::test
