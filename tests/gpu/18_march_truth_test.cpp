// Chapter 18: the real-time forms against the tables of all orders, by optical thickness: octaves as published, and
// orders by escape.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "tests/gpu/18_clouds.hpp"

using namespace welkin::test;

namespace {

struct Errors {
  std::vector<double> values;
  double quantile(double q) {
    std::sort(values.begin(), values.end());
    return values.empty() ? NAN : values[std::min(values.size() - 1, static_cast<size_t>(q * values.size()))];
  }
};

// Relative errors over the rows whose truth is known, by thickness.
std::map<double, Errors> errors_of(const std::string& table, const CloudMarching& marching) {
  std::vector<CloudRow> rows = cloud_rows(table);
  std::erase_if(rows, [](const CloudRow& row) { return !(row.all > 0.0); });
  std::vector<CloudItem> items;
  for (const CloudRow& row : rows) items.push_back(row.item);
  const std::vector<double> lights = march_clouds(items, grid_of(table), marching);
  std::map<double, Errors> errors;
  for (size_t i = 0; i < rows.size(); ++i) {
    const double error = std::abs(lights[i] / rows[i].all - 1.0);
    errors[rows[i].thickness].values.push_back(std::isnan(error) ? 1e9 : error);
  }
  return errors;
}

}  // namespace

TEST_CASE("18 truth: order 1 is the quadrature's, for every kind of body") {
  // Where it is a millionth of the light at least: far behind in thick cloud it is 1e-30 and means nothing.
  for (const char* table : {"blob", "cumulus", "deck", "sphere", "slab", "shell"}) {
    std::vector<CloudRow> rows = cloud_rows(table);
    std::erase_if(rows, [](const CloudRow& row) { return !(row.first > 1e-6 * (row.all > 0.0 ? row.all : 1.0)); });
    std::vector<CloudItem> items;
    for (const CloudRow& row : rows) items.push_back(row.item);
    const std::vector<double> lights = first_orders(items, grid_of(table));
    Errors errors;
    for (size_t i = 0; i < rows.size(); ++i) errors.values.push_back(std::abs(lights[i] / rows[i].first - 1.0));
    WARN(fmt::format("{}: median {:.5f}, 95th percentile {:.5f}, worst {:.3f} of {} rows", table, errors.quantile(0.5),
                     errors.quantile(0.95), errors.quantile(1.0), rows.size()));
    // Two Gauss nodes a step, float32 for optical depths up to 25: a rounding of 1e-6 in each exponent.
    CHECK(errors.quantile(0.5) < 1e-4);
    CHECK(errors.quantile(0.95) < 5e-4);
    CHECK(errors.quantile(1.0) < 5e-3);
  }
}

TEST_CASE("18 truth: orders by escape halve the error of four octaves at every thickness") {
  std::map<double, Errors> octaves, escape;
  for (const char* table : {"blob", "cumulus", "deck"}) {
    for (auto& [thickness, errors] : errors_of(table, {.orders = 1, .octaves = 4, .steps = 64}))
      octaves[thickness].values.insert(octaves[thickness].values.end(), errors.values.begin(), errors.values.end());
    for (auto& [thickness, errors] : errors_of(table, {.orders = 2, .steps = 64})) {
      WARN(fmt::format("{} at {}: escape median {:.3f}, 95th percentile {:.3f}", table, thickness, errors.quantile(0.5),
                       errors.quantile(0.95)));
      escape[thickness].values.insert(escape[thickness].values.end(), errors.values.begin(), errors.values.end());
    }
  }
  for (auto& [thickness, errors] : octaves) {
    const double published = errors.quantile(0.5), ours = escape[thickness].quantile(0.5);
    WARN(fmt::format("optical thickness {}: median of four octaves {:.3f}, of orders by escape {:.3f}", thickness,
                     published, ours));
    CHECK(ours < 0.5 * published);
    CHECK(ours < 0.25);
  }
}

TEST_CASE("18 truth: orders by escape keep the light of a white furnace") {
  // Step by step, whatever the number of steps, the samples or where the march ends: shares of one whole.
  for (const char* table : {"slab", "sphere", "shell", "cumulus"}) {
    std::vector<CloudItem> items;
    for (const CloudRow& row : cloud_rows(table)) items.push_back(row.item);
    const std::vector<double> sums = furnace_by_escape(items, grid_of(table));
    double worst = 0.0;
    for (const double sum : sums) worst = std::max(worst, std::abs(sum - 1.0));
    INFO(table);
    CHECK(worst < 1e-4);  // some hundred roundings
  }
}
