// See 05_rays.hpp.
#include "tests/gpu/05_rays.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/image/csv.hpp"
#include "tests/gpu/harness.hpp"
#include "tree.hpp"

namespace welkin::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

void set(float (&to)[4], const reference::Rgb& rgb, double w) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(rgb[i]);
  to[3] = static_cast<float>(w);
}

// Zenith angles that see the whole sky of a camera: dense at the horizon; from space, by the altitude of the tangent
// point.
std::vector<double> views_of(const reference::Planet& planet, double altitude_km) {
  std::vector<double> zenith_deg;
  for (int i = 0; i < 60; ++i) {
    if (altitude_km <= planet.top_radius_km - planet.ground_radius_km) {
      zenith_deg.push_back(i < 30 ? 3.05 * i : 88.6 + 0.4 * (i - 30));
    } else {
      const double closest_km =
          std::max(planet.ground_radius_km + (i < 40 ? 2.5 * i - 2.0 : -5.0 - 300.0 * (i - 40)), 0.0);
      zenith_deg.push_back(180.0 - std::asin(std::min(closest_km / (planet.ground_radius_km + altitude_km), 1.0)) *
                                       180.0 / kPi);
    }
  }
  return zenith_deg;
}

}  // namespace

SkyRay enter_in_double(const reference::Planet& planet, const SkyRay& ray) {
  const double top_km = planet.top_radius_km - planet.ground_radius_km;
  if (ray.altitude_km <= top_km) return ray;
  const double sine = std::hypot(ray.view[0], ray.view[1]);
  const double closest_km = (planet.ground_radius_km + ray.altitude_km) * sine;
  if (ray.view[2] >= 0.0 || closest_km >= planet.top_radius_km) return {top_km, {0.0, 0.0, 1.0}, ray.sun};
  const double entry_sine = closest_km / planet.top_radius_km;
  const double entry_mu = -std::sqrt((1.0 - entry_sine) * (1.0 + entry_sine));
  // Rotation in the vertical plane of the view by zenith angle at entry minus zenith angle at the camera.
  const double c = ray.view[2] * entry_mu + sine * entry_sine;
  const double s = ray.view[2] * entry_sine - sine * entry_mu;
  const double x = sine > 0.0 ? ray.view[0] / sine : 1.0;
  const double y = sine > 0.0 ? ray.view[1] / sine : 0.0;
  const double along = ray.sun[0] * x + ray.sun[1] * y;
  const double turned = c * along + s * ray.sun[2];
  return {top_km,
          {entry_sine * x, entry_sine * y, entry_mu},
          {ray.sun[0] + (turned - along) * x, ray.sun[1] + (turned - along) * y, c * ray.sun[2] - s * along}};
}

RayItem ray_item(const reference::Planet& planet, const SkyRay& camera_ray, const March& march) {
  const SkyRay ray = march.enter_in_double ? enter_in_double(planet, camera_ray) : camera_ray;
  RayItem item{};
  set(item.rayleigh, planet.rayleigh_scattering_per_km, planet.rayleigh_scale_height_km);
  set(item.mie_scattering, planet.mie_scattering_per_km, planet.mie_scale_height_km);
  set(item.mie_extinction, planet.mie_extinction_per_km, march.g);
  set(item.ozone, planet.ozone_absorption_per_km, planet.ozone_peak_km);
  set(item.shape, {planet.ground_radius_km, planet.top_radius_km - planet.ground_radius_km, planet.ozone_half_width_km},
      0.00465);
  set(item.ground, {march.albedo, march.albedo, march.albedo}, 0.0);
  set(item.sun_irradiance, {1.0, 1.0, 1.0}, 0.0);
  set(item.view, ray.view, ray.altitude_km);
  set(item.sun, ray.sun, 0.0);
  set(item.steps, {double(march.view_steps), double(march.light_steps), 0.0}, 0.0);
  return item;
}

std::vector<Light> march_items(std::span<const RayItem> items, const March& march) {
  constexpr size_t kBatch = 1 << 18;  // 42 MB: a third of the smallest limit on a storage buffer
  constexpr size_t kFloats = sizeof(RayItem) / sizeof(float);
  std::vector<Light> lights;
  lights.reserve(items.size());
  for (size_t first = 0; first < items.size(); first += kBatch) {
    const size_t count = std::min(kBatch, items.size() - first);
    std::vector<float> inputs(count * kFloats);
    std::memcpy(inputs.data(), items.data() + first, count * sizeof(RayItem));
    const std::vector<float> outputs =
        evaluate("tests/05_ray.comp", inputs, kFloats, 6,
                 {march.rayleigh, march.mie, march.ozone, static_cast<uint32_t>(march.phase),
                  static_cast<uint32_t>(march.rule)});
    for (size_t i = 0; i < count; ++i) {
      const float* out = outputs.data() + 6 * i;
      lights.push_back({{out[0], out[1], out[2]}, {out[3], out[4], out[5]}});
    }
  }
  return lights;
}

std::vector<Light> march_rays(const reference::Planet& planet, std::span<const SkyRay> rays, const March& march) {
  std::vector<RayItem> items;
  items.reserve(rays.size());
  for (const SkyRay& ray : rays) items.push_back(ray_item(planet, ray, march));
  return march_items(items, march);
}

SkyRay ray_from_degrees(double altitude_km, double view_zenith_deg, double sun_zenith_deg, double azimuth_deg) {
  return {altitude_km, reference::direction_from_degrees(view_zenith_deg, 0.0),
          reference::direction_from_degrees(sun_zenith_deg, azimuth_deg)};
}

std::vector<TruthRow> truth_rows(const std::string& file, const reference::Planet& planet) {
  const CsvTable table =
      read_csv(std::string(WELKIN_TEST_DATA "/") + file,
               {"h_km", "view_zenith_deg", "sun_zenith_deg", "rel_azimuth_deg", "ground1_r", "ground1_g", "ground1_b",
                "Tview_r", "Tview_g", "Tview_b", "L_HG_r", "L_HG_g", "L_HG_b", "L_CS_r", "L_CS_g", "L_CS_b"},
               {"ray_end"});
  std::vector<TruthRow> rows(table.rows);
  for (size_t i = 0; i < table.rows; ++i) {
    const auto at = [&](const std::string& name) { return table.column(name)[i]; };
    const auto rgb = [&](const std::string& name) {
      return reference::Rgb{at(name + "_r"), at(name + "_g"), at(name + "_b")};
    };
    const double view = at("view_zenith_deg"), sun = at("sun_zenith_deg"), azimuth = at("rel_azimuth_deg");
    rows[i] = {view,           sun,          azimuth,     ray_from_degrees(at("h_km"), view, sun, azimuth),
               rgb("ground1"), rgb("Tview"), rgb("L_HG"), rgb("L_CS")};
  }

  std::set<Camera> cameras;
  for (const TruthRow& row : rows) cameras.insert({row.ray.altitude_km, row.sun_zenith_deg});
  std::map<Camera, double> maxima = sky_maxima(planet, cameras);
  for (const TruthRow& row : rows)
    for (double value : row.henyey_greenstein) {
      double& most = maxima.at({row.ray.altitude_km, row.sun_zenith_deg});
      most = std::max(most, value);
    }
  for (TruthRow& row : rows) row.sky_maximum = maxima.at({row.ray.altitude_km, row.sun_zenith_deg});
  return rows;
}

std::map<Camera, double> sky_maxima(const reference::Planet& planet, const std::set<Camera>& cameras) {
  std::vector<SkyRay> grid;
  for (const Camera& camera : cameras)
    for (double view_zenith_deg : views_of(planet, camera.first))
      for (int azimuth = 0; azimuth < 7; ++azimuth)
        grid.push_back(ray_from_degrees(camera.first, view_zenith_deg, camera.second, 30.0 * azimuth));
  const std::vector<Light> lights = march_rays(planet, grid, {});
  std::map<Camera, double> maxima;
  size_t next = 0;
  for (const Camera& camera : cameras) {
    double& most = maxima[camera];
    for (int i = 0; i < 60 * 7; ++i, ++next)
      for (double value : lights[next].radiance) most = std::max(most, value);
  }
  return maxima;
}

std::vector<std::array<float, 8>> evaluate_parts(std::span<const Part> parts) {
  std::vector<float> inputs(parts.size() * 8);
  std::memcpy(inputs.data(), parts.data(), inputs.size() * sizeof(float));
  const std::vector<float> outputs = evaluate("tests/05_parts.comp", inputs, 8, 8);
  std::vector<std::array<float, 8>> results(parts.size());
  std::memcpy(results.data(), outputs.data(), outputs.size() * sizeof(float));
  return results;
}

void Errors::add(const reference::Rgb& got, const reference::Rgb& expected, double floor) {
  for (int i = 0; i < 3; ++i) {
    if (!(expected[i] > floor)) continue;
    const double error = std::abs(got[i] / expected[i] - 1.0);
    values.push_back(error >= 0.0 ? error : 1e30);  // NaN counts as an error, not as absent
  }
}

double Errors::maximum() const { return values.empty() ? 1e30 : *std::max_element(values.begin(), values.end()); }

double Errors::quantile(double share) const {
  if (values.empty()) return 1e30;
  std::vector<double> sorted = values;
  const size_t place = std::min(static_cast<size_t>(share * double(sorted.size())), sorted.size() - 1);
  std::nth_element(sorted.begin(), sorted.begin() + place, sorted.end());
  return sorted[place];
}

}  // namespace welkin::test
