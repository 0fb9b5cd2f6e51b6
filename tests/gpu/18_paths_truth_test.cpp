// Chapter 18: the cloud path tracer against the tables of every order, a white furnace, and conservation.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "tests/gpu/18_clouds.hpp"

using namespace welkin::test;

namespace {

// A short run by default; WELKIN_CLOUD_PATHS multiplies the paths.
int batches() {
  const char* text = std::getenv("WELKIN_CLOUD_PATHS");
  return text ? std::atoi(text) : 1;
}

struct Scores {
  int rows = 0, beyond_3 = 0;
  double squares = 0.0;
  void add(double difference, double error) {
    ++rows;
    const double z = difference / error;
    squares += z * z;
    if (!(std::abs(z) <= 3.0)) ++beyond_3;
  }
};

}  // namespace

TEST_CASE("18 truth: paths of every order are the tables'") {
  for (const char* table : {"slab", "sphere", "shell", "blob", "cumulus", "deck"}) {
    const std::vector<CloudRow> rows = cloud_rows(table);
    std::vector<CloudItem> items;
    std::vector<const CloudRow*> used;
    for (size_t i = 0; i < rows.size(); i += 1) {
      if (!(rows[i].all > 0.0)) continue;
      used.push_back(&rows[i]);
      items.push_back(rows[i].item);
      items.back().samples = 2;
      items.back().side_rays = 0.5f;
      items.back().seed = 7;
    }
    const std::vector<CloudLight> lights = trace_clouds(items, grid_of(table), 512 * batches());
    Scores scores;
    double relative = 0.0, unfinished = 0.0;
    for (size_t i = 0; i < items.size(); ++i) {
      scores.add(lights[i].mean - used[i]->all,
                 std::hypot(lights[i].standard_error, std::isnan(used[i]->all_se) ? 0.0 : used[i]->all_se));
      relative += lights[i].standard_error / used[i]->all / items.size();
      unfinished += lights[i].unfinished;
      if (std::getenv("WELKIN_ROWS"))
        fmt::print("{} {} tau {} g {} omega {} z {:.2f} mean {:.4e} se {:.1e} table {:.4e} vertices {:.1f}\n", table,
                   used[i]->kind, used[i]->thickness, used[i]->item.g, used[i]->item.albedo,
                   (lights[i].mean - used[i]->all) / std::hypot(lights[i].standard_error, used[i]->all_se),
                   lights[i].mean, lights[i].standard_error, used[i]->all, lights[i].vertices);
    }
    WARN(fmt::format(
        "{}: {} rows, {} beyond 3 standard errors, RMS of z {:.2f}, mean relative error {:.3f}, unfinished {}", table,
        scores.rows, scores.beyond_3, std::sqrt(scores.squares / scores.rows), relative, unfinished));
    CHECK(scores.beyond_3 <= 0.01 * scores.rows + 2);
    CHECK(unfinished == 0.0);
  }
}
