// See 17_clouds.hpp.
#include "tests/gpu/17_clouds.hpp"

#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <map>

#include "chapters/16_noise/noise.hpp"
#include "common/app/camera.hpp"
#include "common/graph/composition.hpp"
#include "common/image/atomic_file.hpp"
#include "common/image/csv.hpp"

namespace welkin::test {

std::vector<std::array<double, 8>> evaluate_shapes(const std::vector<ShapeItem>& items) {
  std::vector<float> inputs;
  for (const ShapeItem& item : items) {
    inputs.push_back(static_cast<float>(item.part));
    for (const double value : item.values) inputs.push_back(static_cast<float>(value));
  }
  const std::vector<float> out = evaluate("tests/17_parts.comp", inputs, 16, 8);
  std::vector<std::array<double, 8>> answers(items.size());
  for (size_t i = 0; i < items.size(); ++i)
    for (size_t k = 0; k < 8; ++k) answers[i][k] = static_cast<double>(out[8 * i + k]);
  return answers;
}

std::vector<app::Effect> cloud_effects() {
  std::vector<app::Effect> effects = terrain_effects();
  for (app::Effect& effect : std::vector<app::Effect>{noise_textures(), weather_texture(), clouds(), cloud_picture()})
    effects.push_back(std::move(effect));
  return effects;
}

CloudRun::CloudRun(Scene scene, const std::vector<std::pair<std::string, std::string>>& knobs)
    : scene_(std::move(scene)),
      settings_(app::knobs_of(cloud_effects(), 17)),
      context_{device(), scene_, settings_, no_fault_} {
  for (const auto& [name, text] : knobs) settings_.set(name, text);
}

std::vector<double> CloudRun::optical_depths(const std::vector<app::ProbeRay>& rays) const {
  return cloud_optical_depths(context_, rays);
}

CloudPlace place_above(double east_km, double north_km, double altitude_km) {
  const View view{.east_km = east_km, .north_km = north_km, .altitude_km = altitude_km};
  return {.offset_km = app::pose_of(view, 6360.0).position_km, .altitude_km = altitude_km};
}

std::vector<std::array<double, 4>> CloudRun::run(const std::vector<CloudPlace>& places, size_t count, int read,
                                                 int grid) const {
  struct Buffers {
    graph::Resource points, results;
  };
  app::Effect effect{.name = "densities", .chapter = 17};
  effect.declare = [&](app::Builder& builder, app::Board& board) {
    Buffers buffers;
    buffers.points = builder.graph.add_filled(
        "points", gpu::create_buffer(device(), "points", std::max<size_t>(places.size(), 1) * 2 * sizeof(glm::vec4),
                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::upload));
    buffers.results = builder.graph.add_buffer(
        "results", {count * sizeof(glm::vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, gpu::Where::readback});
    graph::Step step{.shader = "tests/17_density.comp",
                     .bindings = {{"Points", buffers.points}, {"Results", buffers.results}}};
    bind_clouds(step, board.get<CloudBodies>("clouds"));
    step.record = [count, read, grid](const graph::Recorder& r) {
      r.push(std::array<int32_t, 3>{static_cast<int32_t>(count), read, grid});
      r.dispatch(static_cast<uint32_t>(count + 63) / 64);
    };
    graph::Pass pass{.name = "densities", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back(std::move(step));
    pass.steps.push_back({.accesses = {{buffers.results, gpu::kHostRead}}, .record = [](const graph::Recorder&) {}});
    builder.graph.add(std::move(pass));
    builder.graph.set_output(buffers.results);
    board.offer(buffers);
  };
  app::Composition composition(context_, {noise_textures(), weather_texture(), clouds(), std::move(effect)});
  const Buffers& buffers = *composition.find<Buffers>();
  const std::span<glm::vec4> in = composition.graph().buffer(buffers.points).as<glm::vec4>();
  for (size_t i = 0; i < places.size(); ++i) {
    const CloudPlace& place = places[i];
    const double altitude = std::isnan(place.altitude_km)
                                ? app::altitude_km({.position_km = place.origin_km + place.offset_km}, 6360.0)
                                : place.altitude_km;
    in[2 * i] = glm::vec4(place.origin_km, altitude), in[2 * i + 1] = glm::vec4(place.offset_km, 0.0);
  }
  composition.execute_once();
  const std::span<glm::vec4> out = composition.graph().buffer(buffers.results).as<glm::vec4>();
  std::vector<std::array<double, 4>> answers(count);
  for (size_t i = 0; i < count; ++i)
    for (int k = 0; k < 4; ++k) answers[i][static_cast<size_t>(k)] = static_cast<double>(out[i][k]);
  return answers;
}

std::vector<std::array<double, 4>> CloudRun::densities(const std::vector<CloudPlace>& places, int grid_method) const {
  return run(places, places.size(), 0, grid_method);
}

std::vector<std::array<double, 4>> CloudRun::texels(Read texture, size_t count) const {
  return run({}, count, static_cast<int>(texture), 0);
}

Scene scene_of(std::vector<Cloud> clouds) {
  Scene scene;
  scene.views = {View{}};
  scene.clouds = std::move(clouds);
  return scene;
}

app::ProbeRay ray_up(double altitude_km, double zenith_deg, double azimuth_deg) {
  return {altitude_km, zenith_deg, 0.0, 0.0, {0.0, 0.0, altitude_km}, app::direction_from(zenith_deg, azimuth_deg)};
}

app::ProbeRay ray_from(const glm::dvec3& position_km, const glm::dvec3& direction) {
  return {.altitude_km = 0.0,
          .view_zenith_deg = 0.0,
          .sun_zenith_deg = 0.0,
          .relative_azimuth_deg = 0.0,
          .position_km = position_km,
          .direction = glm::normalize(direction)};
}

GridFile::GridFile(const std::string& name) {
  const double side = name == "blob" ? 2.0 : name == "cumulus" ? 2.56 : 6.4, high = name == "deck" ? 0.8 : side;
  size_km = {side, side, high};
  corners = name == "blob"      ? std::array{33, 33, 33}
            : name == "cumulus" ? std::array{65, 65, 65}
                                : std::array{65, 65, 17};
  const std::string picture = read_file(std::filesystem::path(WELKIN_TEST_DATA) / ("cloud_" + name + ".pgm"), 1 << 20);
  const size_t samples = size_t{1} * corners[0] * corners[1] * corners[2];
  REQUIRE(picture.starts_with("P5"));
  REQUIRE(picture.size() > samples);
  for (size_t i = picture.size() - samples; i < picture.size(); ++i)
    density.push_back(static_cast<float>(static_cast<unsigned char>(picture[i])) / 255.0f);
  std::string text = fmt::format("welkin-grid 1\nname {}\ncorners {} {} {}\nbox_km {} {} {}\n", name, corners[0],
                                 corners[1], corners[2], side, side, high);
  text.resize(256, ' ');
  text.append(reinterpret_cast<const char*>(density.data()), samples * sizeof(float));
  path_ = std::filesystem::temp_directory_path() / fmt::format("welkin_{}_{}.grid", name, getpid());
  write_file_atomically(path_, text);
}

GridScore grid_score(const std::string& name, const std::vector<std::pair<std::string, std::string>>& knobs) {
  const GridFile file(name);
  const CsvTable table = read_csv(std::string(WELKIN_TEST_DATA) + "/cloud_" + name + ".csv",
                                  {"sigma_per_km", "ox", "oy", "oz", "dx", "dy", "dz", "tau", "T"},
                                  {"kind", "L1_rel_err", "L2", "L2_se", "L5", "L5_se", "Linf", "Linf_se"});
  const glm::dvec3 corner(2.0, -1.0, 30.0);
  std::map<double, std::vector<size_t>> by_extinction;
  for (size_t i = 0; i < table.rows; ++i) by_extinction[table.column("sigma_per_km")[i]].push_back(i);
  GridScore score;
  std::vector<double> depth_errors, t_errors;
  const auto three = [&](size_t i, const char* x, const char* y, const char* z) {
    return glm::dvec3(table.column(x)[i], table.column(y)[i], table.column(z)[i]);
  };
  for (const auto& [extinction, rows] : by_extinction) {
    std::vector<app::ProbeRay> rays;
    for (const size_t i : rows)
      rays.push_back(ray_from(corner + three(i, "ox", "oy", "oz"), three(i, "dx", "dy", "dz")));
    const CloudRun run(scene_of({{.kind = "grid",
                                  .east_km = corner.x,
                                  .north_km = corner.y,
                                  .up_km = corner.z,
                                  .file = file.path().string(),
                                  .size_km = file.size_km,
                                  .extinction_per_km = extinction}}),
                       knobs);
    const std::vector<double> depths = run.optical_depths(rays);
    for (size_t k = 0; k < rows.size(); ++k) {
      const double tau = table.column("tau")[rows[k]], t = table.column("T")[rows[k]];
      INFO(name << " row " << rows[k] << " " << table.text("kind")[rows[k]] << " tau " << tau << " got " << depths[k]);
      CHECK(std::isfinite(depths[k]));
      if (tau == 0.0) CHECK(depths[k] < 1e-5);
      ++score.rows;
      score.worst_t = std::max(score.worst_t, std::abs(std::exp(-depths[k]) - t));
      if (tau <= 1e-6) continue;
      depth_errors.push_back(std::abs(depths[k] / tau - 1.0)),
          t_errors.push_back(std::abs(std::expm1(tau - depths[k])));
    }
  }
  const auto middle = [](std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return values.at(values.size() / 2);
  };
  score.median_depth = middle(depth_errors), score.median_t = middle(t_errors);
  score.worst_depth = depth_errors.back();
  return score;
}

}  // namespace welkin::test
