// Rows of the tables of light in clouds, and their rays on the device: tests/gpu/shaders/18_clouds.comp.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace welkin::test {

// A body and a ray, as the shader reads them. Global frame: z up, the planet's centre at (0, 0, -R).
struct CloudItem {
  float kind = 0.0f;  // of interop/cloud.h
  float extinction_per_km = 1.0f, albedo = 1.0f;
  float g = 0.85f, alpha = 0.0f, second_g = 0.0f, second_alpha = 0.0f, weight = 1.0f;
  std::array<float, 3> origin_km{}, direction{}, sun{};  // origin: from place_km
  float base_km = 0.0f, top_or_radius_km = 0.0f;
  std::array<float, 3> place_km{};
  float altitude_km = 0.0f, ground_radius_km = 6360.0f, ceiling_km = 100.0f;
  float mu = -9.0f, sine = 0.0f;  // of the ray to the vertical, where float32 would not give it; -9: it does
  float side_rays = 0.0f, orders = 0.0f, samples = 1.0f, path = 0.0f, seed = 1.0f;
};
static_assert(sizeof(CloudItem) == 32 * sizeof(float));

// What a table says of it: radiance by orders with one standard error; NaN where it says nothing.
struct CloudRow {
  CloudItem item;
  std::string kind;
  double thickness = 0.0;  // optical: largest vertical, or of the slab, or the sphere's diameter
  double first = 0.0, up_to_2 = 0.0, up_to_2_se = 0.0, up_to_5 = 0.0, up_to_5_se = 0.0, all = 0.0, all_se = 0.0;
};

// "blob", "cumulus", "deck"; "slab", "sphere", "shell".
std::vector<CloudRow> cloud_rows(const std::string& table);

// Samples of a grid with its header and bounds, as the shader reads them; of no grid a header alone.
std::vector<float> grid_of(const std::string& table);

struct CloudLight {
  double mean = 0.0, standard_error = 0.0, vertices = 0.0, unfinished = 0.0;
};
// Each item `batches` times with other random numbers, `samples` paths each.
std::vector<CloudLight> trace_clouds(const std::vector<CloudItem>& items, const std::vector<float>& grid, int batches,
                                     bool environment = false);

// The march of chapter 18 along rays, its shader's settings. Orders: 0 none but the first, 1 octaves, 2 escape.
struct CloudMarching {
  int orders = 0, octaves = 1, steps = 64, light_samples = 6, escape_samples = 3, escape_directions = 4,
      refresh = 20;  // refresh in hundredths
};
std::vector<double> march_clouds(const std::vector<CloudItem>& items, const std::vector<float>& grid,
                                 const CloudMarching& marching);

// By escape, of clouds that absorb nothing in surroundings of radiance 1, without the sun: what comes from the
// surroundings by scattering, what has kept its direction, and what was not scattered. They should add up to 1.
std::vector<double> furnace_by_escape(std::vector<CloudItem> items, const std::vector<float>& grid);
// Order 1, converged.
std::vector<double> first_orders(const std::vector<CloudItem>& items, const std::vector<float>& grid);

}  // namespace welkin::test
