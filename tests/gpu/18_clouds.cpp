// See 18_clouds.hpp.
#include "tests/gpu/18_clouds.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include "common/image/csv.hpp"
#include "shaders/interop/cloud.h"
#include "tests/gpu/harness.hpp"
#include "tree.hpp"

namespace welkin::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kBoxUp_km = 40.0;  // boxes and balls stand so high that no ray of theirs meets the ground

std::array<float, 3> floats(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}
std::array<float, 3> unit(double x, double y, double z) {
  const double length = std::hypot(x, y, z);
  return floats(x / length, y / length, z / length);
}
double altitude_of(double x, double y, double z, double radius_km) {
  return z + (x * x + y * y) / (std::hypot(x, y, z + radius_km) + z + radius_km);
}

// A column that may hold "nan", which csv.hpp refuses as a number.
double number(const CsvTable& table, const std::string& name, size_t row) {
  const std::string& text = table.fields[table.index(name)][row];
  return text == "nan" ? NAN : std::stod(text);
}

void read_orders(CloudRow& row, const CsvTable& table, size_t i, const char* first) {
  row.first = number(table, first, i);
  row.up_to_2 = number(table, "L2", i), row.up_to_2_se = number(table, "L2_se", i);
  row.up_to_5 = number(table, "L5", i), row.up_to_5_se = number(table, "L5_se", i);
  row.all = number(table, "Linf", i), row.all_se = number(table, "Linf_se", i);
}

CloudRow grid_row(const CsvTable& table, size_t i) {
  const auto at = [&](const char* name) { return number(table, name, i); };
  CloudRow row;
  CloudItem& item = row.item;
  item.kind = interop::kCloudGrid;
  item.extinction_per_km = static_cast<float>(at("sigma_per_km")), item.albedo = static_cast<float>(at("omega"));
  item.g = static_cast<float>(at("g1")), item.alpha = static_cast<float>(at("alpha1"));
  item.second_g = static_cast<float>(at("g2")), item.second_alpha = static_cast<float>(at("alpha2"));
  item.weight = static_cast<float>(at("w1"));
  const double x = at("ox"), y = at("oy"), z = at("oz");
  item.origin_km = floats(x, y, z), item.direction = unit(at("dx"), at("dy"), at("dz"));
  item.altitude_km = static_cast<float>(altitude_of(x, y, z + kBoxUp_km, 6360.0));
  const double zenith = at("sun_zenith_deg") * kDegree, azimuth = at("sun_azimuth_deg") * kDegree;
  item.sun = unit(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith));
  item.place_km = floats(0.0, 0.0, kBoxUp_km);
  item.ceiling_km = 1000.0f;
  read_orders(row, table, i, "L1_quad");
  return row;
}

// A plane layer from 1 to 2 km of a planet so large that it is plane.
CloudRow slab_row(const CsvTable& table, size_t i) {
  const auto at = [&](const char* name) { return number(table, name, i); };
  CloudRow row;
  CloudItem& item = row.item;
  item.kind = interop::kCloudLayer;
  item.extinction_per_km = static_cast<float>(row.thickness = at("tau"));
  item.g = static_cast<float>(at("g")), item.albedo = static_cast<float>(at("omega"));
  const double mu_sun = at("mu0"), mu = at("mu_view"), azimuth = at("dphi_deg") * kDegree,
               sine = std::sqrt(1.0 - mu * mu);
  item.sun = unit(std::sqrt(1.0 - mu_sun * mu_sun), 0.0, mu_sun);
  item.direction = unit(sine * std::cos(azimuth), sine * std::sin(azimuth), -mu);
  item.base_km = 1.0f, item.top_or_radius_km = 2.0f, item.ground_radius_km = 3e7f;
  item.altitude_km = mu > 0.0 ? 2.0f : 1.0f;
  item.origin_km = floats(0.0, 0.0, item.altitude_km);
  item.mu = static_cast<float>(-mu), item.sine = static_cast<float>(sine);
  read_orders(row, table, i, "L1");
  row.all_se = 0.0;  // adding-doubling: exact here
  return row;
}

CloudRow sphere_row(const CsvTable& table, size_t i) {
  const auto at = [&](const char* name) { return number(table, name, i); };
  CloudRow row;
  CloudItem& item = row.item;
  item.kind = interop::kCloudSphere;
  row.thickness = at("tau_diameter");
  item.extinction_per_km = static_cast<float>(0.5 * row.thickness);
  item.g = static_cast<float>(at("g")), item.albedo = static_cast<float>(at("omega"));
  const double angle = at("view_sun_angle_deg") * kDegree, u = at("u"), v = at("v");
  item.sun = unit(std::cos(angle), 0.0, std::sin(angle));
  item.direction = floats(1.0, 0.0, 0.0);
  item.origin_km = floats(-1.5, v, u);
  item.altitude_km = static_cast<float>(altitude_of(-1.5, v, u + kBoxUp_km, 6360.0));
  item.place_km = floats(0.0, 0.0, kBoxUp_km), item.top_or_radius_km = 1.0f, item.ceiling_km = 1000.0f;
  read_orders(row, table, i, "L1");
  return row;
}

CloudRow shell_row(const CsvTable& table, size_t i) {
  const auto at = [&](const char* name) { return number(table, name, i); };
  CloudRow row;
  CloudItem& item = row.item;
  item.kind = interop::kCloudLayer;
  item.extinction_per_km = static_cast<float>(at("sigma_per_km"));
  row.thickness = 2.5 * at("sigma_per_km");
  const double zenith = at("view_zenith_deg") * kDegree, azimuth = at("rel_azimuth_deg") * kDegree,
               sun = at("sun_zenith_deg") * kDegree;
  item.sun = unit(std::sin(sun), 0.0, std::cos(sun));
  item.direction = unit(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith));
  item.base_km = 1.5f, item.top_or_radius_km = 4.0f, item.ceiling_km = 4.0f;
  item.altitude_km = static_cast<float>(at("h_km")), item.origin_km = floats(0.0, 0.0, at("h_km"));
  item.mu = static_cast<float>(std::cos(zenith)), item.sine = static_cast<float>(std::sin(zenith));
  read_orders(row, table, i, "L1_quad");
  return row;
}

// PGM of bytes: width, height (slices stacked), 255, then the samples.
struct Pgm {
  std::array<int, 3> corners;
  std::array<double, 3> size_km;
  std::vector<uint8_t> samples;
};
Pgm read_grid_pgm(const std::string& name) {
  const bool deck = name == "deck", blob = name == "blob";
  Pgm pgm;
  pgm.corners = blob ? std::array{33, 33, 33} : std::array{65, 65, deck ? 17 : 65};
  pgm.size_km = blob ? std::array{2.0, 2.0, 2.0} : deck ? std::array{6.4, 6.4, 0.8} : std::array{2.56, 2.56, 2.56};
  std::ifstream file(std::string(WELKIN_TEST_DATA "/cloud_") + name + ".pgm", std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const size_t count = static_cast<size_t>(pgm.corners[0]) * pgm.corners[1] * pgm.corners[2];
  pgm.samples.assign(text.end() - static_cast<std::ptrdiff_t>(count), text.end());
  return pgm;
}

}  // namespace

std::vector<CloudRow> cloud_rows(const std::string& name) {
  const bool plain = name == "slab" || name == "sphere" || name == "shell";
  const std::string file = std::string(WELKIN_TEST_DATA "/cloud_") + name + (plain ? "_radiance.csv" : ".csv");
  // All columns as text: some hold "nan".
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line) && line[0] == '#') {
  }
  std::vector<std::string> columns;
  std::istringstream names(line);
  for (std::string column; std::getline(names, column, ',');) columns.push_back(column);
  const CsvTable table = read_csv(file, columns, columns);
  std::vector<CloudRow> rows;
  for (size_t i = 0; i < table.rows; ++i) {
    CloudRow row = name == "slab"     ? slab_row(table, i)
                   : name == "sphere" ? sphere_row(table, i)
                   : name == "shell"  ? shell_row(table, i)
                                      : grid_row(table, i);
    row.kind = plain ? name : table.fields[table.index("kind")][i];
    rows.push_back(row);
  }
  if (plain) return rows;
  std::set<float> extinctions;
  for (const CloudRow& row : rows) extinctions.insert(row.item.extinction_per_km);
  const double thicknesses[] = {0.5, 10.0, 60.0};
  for (CloudRow& row : rows)
    row.thickness = thicknesses[std::distance(extinctions.begin(), extinctions.find(row.item.extinction_per_km))];
  return rows;
}

std::vector<float> grid_of(const std::string& name) {
  if (name == "slab" || name == "sphere" || name == "shell")
    return {2, 2, 2, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const Pgm pgm = read_grid_pgm(name);
  std::array<int, 3> bounds{};
  for (int a = 0; a < 3; ++a) bounds[a] = (pgm.corners[a] - 1 + 3) / 4;
  std::vector<float> grid;
  for (const int n : pgm.corners) grid.push_back(static_cast<float>(n));
  for (const double l : pgm.size_km) grid.push_back(static_cast<float>(l));
  for (const int n : bounds) grid.push_back(static_cast<float>(n));
  for (const uint8_t sample : pgm.samples) grid.push_back(static_cast<float>(sample) / 255.0f);
  const auto at = [&](int i, int j, int k) {
    return pgm.samples[(static_cast<size_t>(k) * pgm.corners[1] + j) * pgm.corners[0] + i];
  };
  for (int z = 0; z < bounds[2]; ++z)
    for (int y = 0; y < bounds[1]; ++y)
      for (int x = 0; x < bounds[0]; ++x) {
        int most = 0;
        for (int k = 4 * z; k <= std::min(4 * z + 4, pgm.corners[2] - 1); ++k)
          for (int j = 4 * y; j <= std::min(4 * y + 4, pgm.corners[1] - 1); ++j)
            for (int i = 4 * x; i <= std::min(4 * x + 4, pgm.corners[0] - 1); ++i)
              most = std::max<int>(most, at(i, j, k));
        grid.push_back(static_cast<float>(most) / 255.0f);
      }
  return grid;
}

std::vector<CloudLight> trace_clouds(const std::vector<CloudItem>& items, const std::vector<float>& grid, int batches,
                                     bool environment) {
  std::vector<CloudItem> all;
  for (size_t i = 0; i < items.size(); ++i)
    for (int b = 0; b < batches; ++b) {
      CloudItem item = items[i];
      item.path = static_cast<float>(i * batches + b);
      all.push_back(item);
    }
  std::vector<float> inputs(all.size() * 32);
  std::memcpy(inputs.data(), all.data(), inputs.size() * sizeof(float));
  const std::vector<float> out = evaluate("tests/18_clouds.comp", inputs, 32, 4, {0u, environment ? 1u : 0u}, grid);
  std::vector<CloudLight> lights(items.size());
  for (size_t i = 0; i < items.size(); ++i) {
    double mean = 0.0, square = 0.0;
    for (int b = 0; b < batches; ++b) {
      const float* o = &out[4 * (i * batches + b)];
      mean += o[0] / batches, square += o[1] / batches;
      lights[i].vertices += o[2] / batches, lights[i].unfinished += o[3];
    }
    const double n = static_cast<double>(batches) * items[i].samples;
    lights[i].mean = mean;
    lights[i].standard_error = std::sqrt(std::max(square - mean * mean, 0.0) / std::max(n - 1.0, 1.0));
  }
  return lights;
}

namespace {

std::vector<float> four_each(const std::vector<CloudItem>& items, const std::vector<float>& grid, uint32_t method) {
  std::vector<float> inputs(items.size() * 32);
  std::memcpy(inputs.data(), items.data(), inputs.size() * sizeof(float));
  const uint32_t kinds = grid.size() > 100 ? 13u : 5u;
  return evaluate("tests/18_clouds.comp", inputs, 32, 4, {method, 0u, kinds}, grid);
}

std::vector<double> evaluate_clouds(const std::vector<CloudItem>& items, const std::vector<float>& grid,
                                    uint32_t method) {
  const std::vector<float> out = four_each(items, grid, method);
  std::vector<double> lights;
  for (size_t i = 0; i < items.size(); ++i) lights.push_back(out[4 * i]);
  return lights;
}

void set_march(CloudItem& item, const CloudMarching& marching) {
  item.side_rays = static_cast<float>(marching.orders), item.orders = static_cast<float>(marching.octaves);
  item.samples = static_cast<float>(marching.steps), item.path = static_cast<float>(marching.light_samples);
  item.seed = static_cast<float>(100 * marching.refresh + 10 * marching.escape_directions + marching.escape_samples);
}

}  // namespace

std::vector<double> march_clouds(const std::vector<CloudItem>& items, const std::vector<float>& grid,
                                 const CloudMarching& marching) {
  std::vector<CloudItem> all = items;
  for (CloudItem& item : all) set_march(item, marching);
  return evaluate_clouds(all, grid, 1);
}

std::vector<double> furnace_by_escape(std::vector<CloudItem> items, const std::vector<float>& grid) {
  for (CloudItem& item : items) {
    item.albedo = 1.0f;
    set_march(item, {.orders = 2, .steps = 32});
  }
  const std::vector<float> out = four_each(items, grid, 1);
  std::vector<double> sums;
  for (size_t i = 0; i < items.size(); ++i) sums.push_back(out[4 * i + 2] + out[4 * i + 3] + std::exp(-out[4 * i + 1]));
  return sums;
}

std::vector<double> first_orders(const std::vector<CloudItem>& items, const std::vector<float>& grid) {
  constexpr int kParts = 32;
  std::vector<CloudItem> parts;
  for (CloudItem item : items)
    for (int part = 0; part < kParts; ++part) {
      item.path = static_cast<float>(part), item.seed = kParts;
      parts.push_back(item);
    }
  const std::vector<double> lights = evaluate_clouds(parts, grid, 2);
  std::vector<double> sums(items.size(), 0.0);
  for (size_t i = 0; i < lights.size(); ++i) sums[i / kParts] += lights[i];
  return sums;
}

}  // namespace welkin::test
