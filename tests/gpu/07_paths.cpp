// See 07_paths.hpp.
#include "tests/gpu/07_paths.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "common/image/csv.hpp"
#include "tests/gpu/harness.hpp"
#include "tree.hpp"

namespace welkin::test {
namespace {

// Items of one call: enough to fill a device, few enough that a batch takes a second on a software driver.
constexpr size_t kBatch = 1 << 15;

RayItem path_item(const reference::Planet& planet, const PathRay& ray, int paths) {
  // Distances to surfaces are the eye's: such a ray begins there, in space as well.
  RayItem item = ray_item(planet, ray.ray, {.g = ray.g, .enter_in_double = ray.surface_km == 0.0});
  for (int c = 0; c < 3; ++c) item.ground[c] = static_cast<float>(ray.albedo[c]);
  item.ground[3] = static_cast<float>(ray.second_g);
  item.sun_irradiance[3] = static_cast<float>(ray.shape);
  item.steps[0] = static_cast<float>(paths);
  item.steps[2] = static_cast<float>(ray.orders);
  item.steps[3] = static_cast<float>(ray.surface_km);
  return item;
}

}  // namespace

std::vector<PathMean> trace(const reference::Planet& planet, const std::vector<PathRay>& rays,
                            const PathVariant& variant, int blocks, int paths_per_block) {
  const gpu::Specialization constants{variant.rayleigh,
                                      variant.mie,
                                      variant.ozone,
                                      static_cast<uint32_t>(variant.phase),
                                      static_cast<uint32_t>(variant.tracking),
                                      variant.hero,
                                      variant.environment,
                                      variant.spread,
                                      variant.surfaces};
  constexpr size_t kFloats = sizeof(RayItem) / sizeof(float);
  struct Sum {
    double sum[3] = {}, squares[3] = {}, unfinished = 0.0, longest = 0.0;
  };
  std::vector<Sum> sums(rays.size());
  const size_t items = rays.size() * blocks;
  uint32_t call = 0;
  for (size_t first = 0; first < items; first += kBatch, ++call) {
    const size_t count = std::min(kBatch, items - first);
    std::vector<float> inputs(count * kFloats);
    for (size_t i = 0; i < count; ++i) {
      const PathRay& ray = rays[(first + i) / blocks];
      RayItem item = path_item(planet, ray, paths_per_block);
      item.steps[1] = static_cast<float>((ray.seed * 4099u + call) & 0xffffffu);
      std::memcpy(&inputs[i * kFloats], &item, sizeof item);
    }
    const std::vector<float> out = evaluate("tests/07_path.comp", inputs, kFloats, 8, constants);
    for (size_t i = 0; i < count; ++i) {
      Sum& sum = sums[(first + i) / blocks];
      for (int c = 0; c < 3; ++c) sum.sum[c] += out[8 * i + c], sum.squares[c] += out[8 * i + 3 + c];
      sum.unfinished += out[8 * i + 6];
      sum.longest = std::max(sum.longest, double(out[8 * i + 7]));
    }
  }
  const double n = double(blocks) * paths_per_block;
  std::vector<PathMean> means(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      means[i].mean[c] = sums[i].sum[c] / n;
      means[i].error[c] =
          std::sqrt(std::max(sums[i].squares[c] / n - means[i].mean[c] * means[i].mean[c], 0.0) / (n - 1.0));
    }
    means[i].unfinished = sums[i].unfinished;
    means[i].longest = sums[i].longest;
  }
  return means;
}

std::vector<OrdersRow> orders_rows(const std::string& file) {
  const CsvTable table = read_csv(std::string(WELKIN_TEST_DATA "/") + file,
                                  {"h_km", "view_zenith_deg", "sun_zenith_deg", "rel_azimuth_deg", "ground_albedo",
                                   "L1_quad", "L2", "L2_se", "L3", "L3_se", "L5", "L5_se", "Linf", "Linf_se"},
                                  {"ray_end", "mie_phase", "channel"});
  std::vector<OrdersRow> rows(table.rows);
  for (size_t i = 0; i < table.rows; ++i) {
    const auto at = [&](const char* name) { return table.column(name)[i]; };
    OrdersRow& row = rows[i];
    row.ray.ray = ray_from_degrees(at("h_km"), at("view_zenith_deg"), at("sun_zenith_deg"), at("rel_azimuth_deg"));
    row.ray.albedo = {at("ground_albedo"), at("ground_albedo"), at("ground_albedo")};
    row.ray.seed = static_cast<uint32_t>(i + 1);
    const std::string& letter = table.text("channel")[i];
    row.channel = letter == "r" ? 0 : letter == "g" ? 1 : 2;
    const char* const names[] = {"L1_quad", "L2", "L3", "L5", "Linf"};
    for (int k = 0; k < 5; ++k) {
      row.radiance[k] = at(names[k]);
      if (k > 0) row.error[k] = at((std::string(names[k]) + "_se").c_str());
    }
  }
  return rows;
}

double ZScores::share_within_3() const {
  return double(std::count_if(values.begin(), values.end(), [](double z) { return std::abs(z) <= 3.0; })) /
         double(values.size());
}

double ZScores::rms() const {
  double sum = 0.0;
  for (double z : values) sum += z * z;
  return std::sqrt(sum / double(values.size()));
}

double ZScores::mean() const {
  double sum = 0.0;
  for (double z : values) sum += z;
  return sum / double(values.size());
}

UnfoundLight unfound_light() {
  UnfoundLight light;
  for (const OrdersRow& row : orders_rows("multiple_scattering_alien_cs.csv"))
    if (row.channel == 2 && row.ray.ray.altitude_km < 0.001 && row.ray.ray.view[2] > 0.08 &&
        row.ray.ray.view[2] < 0.09 && row.ray.ray.sun[2] > 0.03 && row.ray.ray.sun[2] < 0.04)
      light = {row.ray, row.radiance[0]};
  REQUIRE(light.expected > 0.0);
  light.ray.orders = 1;
  return light;
}

reference::Planet planet_of(bool alien) { return alien ? reference::dense_alien() : reference::earth(); }

double score(double got, double error, double expected, double expected_error) {
  const double difference = got - expected,
               combined = std::sqrt(error * error + expected_error * expected_error + 1e-8 * expected * expected);
  return combined > 0.0 ? difference / combined : (difference == 0.0 ? 0.0 : 1e9);
}

// Rows first, first + stride, … with one order each if `order` < 0.
void score_rows(const OrdersTable& table, size_t first, size_t stride, int order, int blocks,
                const PathVariant& variant, ZScores& z) {
  const std::vector<OrdersRow> rows = orders_rows(table.file);
  std::vector<PathRay> rays;
  std::vector<std::pair<const OrdersRow*, int>> wanted;
  for (size_t i = first, n = 0; i < rows.size(); i += stride, ++n) {
    const int k = order >= 0 ? order : static_cast<int>(n % 5);
    if (rows[i].radiance[k] < kDark) continue;
    rays.push_back(rows[i].ray);
    rays.back().orders = kOrders[k];
    wanted.push_back({&rows[i], k});
  }
  const std::vector<PathMean> means = trace(planet_of(table.alien), rays, variant, blocks, 8);
  for (size_t i = 0; i < rays.size(); ++i) {
    const auto [row, k] = wanted[i];
    z.values.push_back(
        score(means[i].mean[row->channel], means[i].error[row->channel], row->radiance[k], row->error[k]));
    REQUIRE(means[i].unfinished == 0.0);
    if (std::abs(z.values.back()) > 3.0)
      UNSCOPED_INFO(table.file << " h " << rays[i].ray.altitude_km << " view " << rays[i].ray.view[0] << ","
                               << rays[i].ray.view[2] << " sun " << rays[i].ray.sun[0] << "," << rays[i].ray.sun[2]
                               << " albedo " << rays[i].albedo[0] << " order " << kOrders[k] << " channel "
                               << row->channel << ": " << means[i].mean[row->channel] << " +- "
                               << means[i].error[row->channel] << ", expected " << row->radiance[k] << " z "
                               << z.values.back());
  }
}

}  // namespace welkin::test
