// See 08_look_up.hpp.
#include "tests/gpu/08_look_up.hpp"

#include <cmath>

#include "chapters/08_transmittance_lut/transmittance_lut.hpp"
#include "common/app/session.hpp"
#include "common/graph/composition.hpp"
#include "common/image/csv.hpp"
#include "common/scene/scene_knobs.hpp"
#include "tests/gpu/harness.hpp"
#include "tree.hpp"

namespace welkin::test {

std::vector<TableLookup> look_up(const std::string& scene_name, const Choices& choices, std::span<const Path> paths,
                                 Sampler sampler) {
  const Scene scene = load_scene(scene_name, app::scenes_directory());
  Settings settings(transmittance_knobs());
  for (const auto& [name, text] : choices) settings.set(name, text);
  const std::string no_fault;
  const app::Context context{device(), scene, settings, no_fault};
  app::Effect look_up_effect{.name = "look up", .chapter = 8};
  const gpu::Buffer* out = nullptr;
  graph::Resource results = 0;
  look_up_effect.declare = [&](app::Builder& builder, app::Board& board) {
    const AirBlock& block = *board.find<AirBlock>();
    const TransmittanceTable& table = *board.find<TransmittanceTable>();
    gpu::Buffer in = gpu::create_buffer(device(), "paths", paths.size() * sizeof(glm::vec4),
                                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload);
    for (size_t i = 0; i < paths.size(); ++i) in.as<glm::vec4>()[i] = {paths[i].altitude_km, paths[i].mu, 0.0f, 0.0f};
    const graph::Resource inputs = builder.graph.add_filled("paths", std::move(in));
    results = builder.graph.add_buffer(
        "results", {paths.size() * 2 * sizeof(glm::vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback});
    graph::Pass pass{.name = "look up"};
    const uint32_t count = static_cast<uint32_t>(paths.size());
    pass.steps.push_back(
        {.shader = sampler == Sampler::coarse ? "tests/08_look_up_coarse.comp" : "tests/08_look_up.comp",
         .constants = joined(block.constants, table.constants),
         .bindings =
             {{"Air", block.block}, {"transmittance_table", table.image}, {"Inputs", inputs}, {"Outputs", results}},
         .record = [count](const graph::Recorder& r) { r.push(count).dispatch((count + 63) / 64); }});
    pass.steps.push_back({.accesses = {{results, gpu::kHostRead}}, .record = [](const graph::Recorder&) {}});
    builder.graph.add(std::move(pass));
    builder.graph.set_output(results);
  };
  app::Composition composition(context, {air(), transmittance_table(), look_up_effect});
  composition.execute_once();
  out = &composition.graph().buffer(results);

  std::vector<TableLookup> found(paths.size());
  for (size_t i = 0; i < paths.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      found[i].transmittance[k] = out->as<glm::vec4>()[2 * i][k];
      found[i].optical_depth[k] = out->as<glm::vec4>()[2 * i + 1][k];
    }
  return found;
}

std::vector<ReferencePath> path_rows(const std::string& file) {
  const CsvTable table =
      read_csv(std::string(WELKIN_TEST_DATA "/") + file,
               {"h_km", "view_zenith_deg", "lowest_altitude_km", "tau_r", "tau_g", "tau_b", "T_r", "T_g", "T_b"});
  std::vector<ReferencePath> rows;
  for (size_t i = 0; i < table.rows; ++i) {
    const auto at = [&](const char* name) { return table.column(name)[i]; };
    const Path path{float(at("h_km")), float(reference::direction_from_degrees(at("view_zenith_deg"), 0.0)[2])};
    rows.push_back(
        {path, at("lowest_altitude_km"), {at("tau_r"), at("tau_g"), at("tau_b")}, {at("T_r"), at("T_g"), at("T_b")}});
  }
  return rows;
}

std::vector<ReferencePath> random_paths(const reference::Planet& planet, uint64_t seed, int count) {
  Random random(seed);
  const double radius = planet.ground_radius_km, top_km = planet.top_radius_km - radius;
  std::vector<ReferencePath> paths;
  for (int i = 0; i < count; ++i) {
    double h = i % 2 == 0 ? random.uniform(0.0, top_km) : random.log_uniform(5e-4, top_km);
    if (i % 5 == 4) h = top_km - random.log_uniform(1e-3, 5.0);
    h = std::fmin(h, top_km);
    const double r = radius + h, horizon = -std::sqrt(h * (2.0 * radius + h)) / r;
    double mu = random.uniform(horizon, 1.0);
    if (i % 3 == 1) mu = random.uniform(horizon, 0.0);
    if (i % 3 == 2) {
      const double lowest = random.log_uniform(1e-3, 30.0);
      if (lowest >= h) continue;
      mu = -std::sqrt((h - lowest) * (2.0 * radius + h + lowest)) / r;
    }
    const Path path{float(h), float(mu)};
    const double m = path.mu, a = path.altitude_km, sine = std::sqrt((1.0 - m) * (1.0 + m)), ra = radius + a;
    const double lowest = m < 0.0 ? a - ra * m * m / (1.0 + sine) : a;
    if (lowest < 0.0 || a > top_km) continue;
    const double rho2 = (top_km - a) * (2.0 * radius + top_km + a), root = std::sqrt(ra * m * ra * m + rho2);
    const auto column = reference::columns(planet, a, m, sine, m >= 0.0 ? rho2 / (ra * m + root) : root - ra * m);
    ReferencePath truth{path, lowest, {}, {}};
    for (int k = 0; k < 3; ++k) {
      truth.optical_depth[k] = planet.rayleigh_scattering_per_km[k] * column[0] +
                               planet.mie_extinction_per_km[k] * column[1] +
                               planet.ozone_absorption_per_km[k] * column[2];
      truth.transmittance[k] = std::exp(-truth.optical_depth[k]);
    }
    paths.push_back(truth);
  }
  return paths;
}

double worst_error(const std::string& scene, const Choices& choices, std::span<const ReferencePath> truth,
                   Sampler sampler) {
  std::vector<Path> paths;
  for (const ReferencePath& one : truth) paths.push_back(one.path);
  const std::vector<TableLookup> found = look_up(scene, choices, paths, sampler);
  double worst = 0.0;
  for (size_t i = 0; i < truth.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (truth[i].transmittance[k] <= 1e-4) continue;
      const double error = std::abs(found[i].transmittance[k] / truth[i].transmittance[k] - 1.0);
      if (!(error <= worst)) worst = error >= 0.0 ? error : 1e30;
    }
  return worst;
}

}  // namespace welkin::test
