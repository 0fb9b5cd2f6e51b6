// See 09_sky.hpp.
#include "tests/gpu/09_sky.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "chapters/07_ground_truth/ground_truth.hpp"
#include "chapters/09_multiple_scattering_lut/all_orders_sky.hpp"
#include "common/app/session.hpp"
#include "common/image/csv.hpp"
#include "tests/gpu/harness.hpp"
#include "tree.hpp"

namespace welkin::test {
namespace {

Settings settings_of(const Choices& choices) {
  Settings settings(app::knobs_of({multiple_scattering_table(), all_orders_march()}, 9));
  for (const auto& [name, text] : choices) settings.set(name, text);
  return settings;
}

}  // namespace

std::vector<std::array<float, 12>> evaluate_orders(const std::vector<OrderPart>& parts) {
  std::vector<float> inputs(parts.size() * 8);
  std::memcpy(inputs.data(), parts.data(), inputs.size() * sizeof(float));
  const std::vector<float> outputs = evaluate("tests/09_parts.comp", inputs, 8, 12);
  std::vector<std::array<float, 12>> results(parts.size());
  std::memcpy(results.data(), outputs.data(), outputs.size() * sizeof(float));
  return results;
}

Scene orders_scene(const std::string& name) { return load_scene(name, app::scenes_directory()); }

std::vector<OrderRow> order_rows(const std::string& file) {
  const CsvTable table = read_csv(std::string(WELKIN_TEST_DATA "/") + file,
                                  {"h_km", "view_zenith_deg", "sun_zenith_deg", "rel_azimuth_deg", "ground_albedo",
                                   "L1_quad", "L2", "Linf", "Linf_se"},
                                  {"ray_end", "mie_phase", "channel"});
  std::vector<OrderRow> rows;
  for (size_t i = 0; i < table.rows; ++i) {
    const auto at = [&](const char* name) { return table.column(name)[i]; };
    const std::string& channel = table.text("channel")[i];
    const double horizon_deg = 180.0 - std::asin(6360.0 / (6360.0 + at("h_km"))) * 180.0 / 3.14159265358979324;
    rows.push_back({{at("h_km"), at("view_zenith_deg"), at("sun_zenith_deg"), at("rel_azimuth_deg")},
                    channel == "r"   ? 0
                    : channel == "g" ? 1
                                     : 2,
                    at("ground_albedo"),
                    at("L1_quad"),
                    at("L2"),
                    at("Linf"),
                    at("Linf_se"),
                    std::abs(at("view_zenith_deg") - horizon_deg) <= 0.5});
  }
  return rows;
}

std::vector<app::ProbeResult> chapter_09_sky(const Scene& scene, const Choices& choices,
                                             const std::vector<app::ProbeRay>& rays) {
  const Settings settings = settings_of(choices);
  const std::string no_fault;
  return probe_all_orders({device(), scene, settings, no_fault}, rays);
}

std::vector<double> sky_of_rows(const std::string& name, Phase phase, const Choices& choices,
                                const std::vector<OrderRow>& rows) {
  std::vector<double> got(rows.size());
  Scene scene = orders_scene(name);
  scene.medium("mie")->phase = phase;
  for (const double albedo : {0.0, 0.1, 0.3}) {
    std::vector<app::ProbeRay> rays;
    std::vector<size_t> places;
    for (size_t i = 0; i < rows.size(); ++i)
      if (rows[i].albedo == albedo) rays.push_back(rows[i].ray), places.push_back(i);
    if (rays.empty()) continue;
    scene.planet.ground_albedo = {albedo, albedo, albedo};
    const std::vector<app::ProbeResult> light = chapter_09_sky(scene, choices, rays);
    for (size_t i = 0; i < places.size(); ++i) got[places[i]] = light[i].radiance[rows[places[i]].channel];
  }
  return got;
}

std::vector<TableTexel> table_of(const Scene& scene, const Choices& choices) {
  Settings settings = settings_of(choices);
  settings.set("multiple_scattering.format", "float");
  const std::string no_fault;
  const app::Context context{device(), scene, settings, no_fault};
  app::Effect keep_table{.name = "kept", .chapter = 9};
  keep_table.declare = [](app::Builder& builder, app::Board& board) {
    builder.graph.set_output(board.find<MultipleScatteringTable>()->image);
  };
  app::Composition composition(context, {air(), multiple_scattering_table(), keep_table});
  composition.execute_once();
  const gpu::Image& image = *composition.image("multiple_scattering");
  const gpu::Buffer back = gpu::create_buffer(device(), "texels", size_t{16} * image.size.width * image.size.height,
                                              VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Where::readback);
  const gpu::CommandPool pool = gpu::create_command_pool(device());
  gpu::run_once(device(), pool, [&](VkCommandBuffer commands) {
    gpu::image_barrier(commands, image.handle, gpu::kComputeWrite, gpu::kTransferRead);
    gpu::copy_image_to_buffer(commands, image, back);
    gpu::buffer_barrier(commands, back.handle, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                        gpu::kHostRead);
  });
  const uint32_t side = image.size.width;
  const bool published = image.size.height == side, logarithm = settings.choice("multiple_scattering.map") == "horizon";
  std::vector<TableTexel> texels;
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const double u = double(x) / (side - 1), v = double(y) / (side - 1), w = 2.0 * u - 1.0;
      TableTexel texel{logarithm ? 0.4 * w / (1.4 - std::abs(w)) : w,
                       (logarithm ? v * v : v) * (scene.planet.top_radius_km - scene.planet.ground_radius_km)};
      for (int k = 0; k < 3; ++k) {
        const double stored = back.as<glm::vec4>()[y * side + x][k];
        texel.mean[k] = logarithm ? std::exp2(stored) : stored;
        texel.irradiance[k] = 3.14159265358979324 * texel.mean[k] *
                              (published ? 1.0 : back.as<glm::vec4>()[(y + 6 * side) * side + x][k]);
      }
      texels.push_back(texel);
    }
  return texels;
}

std::vector<Aureole> aureole(const std::string& name, const std::string& paths) {
  const Scene scene = orders_scene(name);
  const std::vector<double> angles_deg{1.0, 2.0, 5.0, 10.0, 20.0, 40.0};
  std::vector<app::ProbeRay> rays;
  for (const double angle : angles_deg) rays.push_back({0.0005, 45.0 - angle, 45.0, 0.0});
  Settings settings(path_knobs());
  settings.set("probe.samples", paths);
  const std::string no_fault;
  const std::vector<app::ProbeResult> truth = probe_paths({device(), scene, settings, no_fault}, rays),
                                      got = chapter_09_sky(scene, {}, rays);
  std::vector<Aureole> all;
  for (size_t i = 0; i < rays.size(); ++i)
    all.push_back(
        {angles_deg[i], got[i].radiance / truth[i].radiance - 1.0, truth[i].standard_error / truth[i].radiance});
  return all;
}

double OrderErrors::quantile(double share) const {
  if (values.empty()) return 1e30;
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  return sorted[std::min(static_cast<size_t>(share * double(sorted.size())), sorted.size() - 1)];
}

OrderErrors errors_of(const std::vector<OrderRow>& rows, const std::vector<double>& got, Rows which) {
  OrderErrors errors;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!(rows[i].all > 0.0) || rows[i].all_error > 0.01 * rows[i].all) continue;
    if (which == Rows::target && (rows[i].near_horizon || rows[i].ray.sun_zenith_deg > 94.0)) continue;
    const double error = std::abs(got[i] / rows[i].all - 1.0);
    errors.values.push_back(error >= 0.0 ? error : 1e30);
  }
  return errors;
}

}  // namespace welkin::test
