// The pass "multiple scattering". See multiple_scattering_lut.hpp and docs/chapters/09_multiple_scattering_lut.md.
#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

#include <algorithm>
#include <cmath>

namespace welkin {
namespace {

constexpr uint32_t kLayers = 7;    // as in shaders/09_multiple_scattering_lut/table.glsl
constexpr size_t kNodeBytes = 48;  // RayNode of shaders/09_multiple_scattering_lut/ray_nodes.glsl

// The table's size and cost by the knobs, rounded to the multiples that the shaders need.
struct Plan {
  bool published, half;
  uint32_t side;
  int directions, steps, orders;
  uint32_t rays;  // whose nodes are stored: altitudes times zenith angles, for all suns
};

Plan plan_of(const Scene& scene, const Settings& settings) {
  Plan plan{.published = settings.choice("multiple_scattering.method") == "published",
            .half = settings.choice("multiple_scattering.format") == "half",
            .side = static_cast<uint32_t>(settings.integer("multiple_scattering.size")),
            .directions = (settings.integer("multiple_scattering.directions") + 15) / 16 * 16,
            .steps = (settings.integer("multiple_scattering.steps") + 3) / 4 * 4};
  const int iterations = settings.integer("multiple_scattering.iterations");
  plan.orders = plan.published ? 1 : iterations == 0 ? orders_needed(make_atmosphere(scene)) : std::max(iterations, 3);
  // Every direction of the Fibonacci set has its own zenith angle; those of the horizon set share 8 or 16.
  const int rings = plan.directions >= 128 ? 16 : 8;
  plan.rays = plan.side * static_cast<uint32_t>(
                              settings.choice("multiple_scattering.set") == "fibonacci" ? plan.directions : rings);
  return plan;
}

}  // namespace

// [knobs]
static std::vector<Knob> order_knobs() {
  return {{.name = "orders",
           .meaning = "orders of scattering: 0 all, 1 single scattering only (then there is no table)",
           .minimum = 0,
           .maximum = 1,
           .initial = 0,
           .integer = true,
           .ladder = {1, 0},
           .rebuilds = true},
          {.name = "tables",
           .meaning = "what a frame computes: only what something changed for, or everything (to see what it costs)",
           .choices = {"changed", "all"}},
          {.name = "multiple_scattering.method",
           .meaning = "what the table holds and how its series of orders is summed",
           .initial = 2,
           .choices = {"published", "isotropic", "moments"},
           .ladder = {0, 1, 2},
           .rebuilds = true},
          {.name = "multiple_scattering.iterations",
           .unit = "orders",
           .meaning = "orders gathered one by one before the series is closed, at least 3; 0: as many as the air asks "
                      "for (not by the published method)",
           .minimum = 0,
           .maximum = 64,
           .initial = 0,
           .integer = true,
           .ladder = {3, 5, 10, 20},
           .rebuilds = true},
          {.name = "multiple_scattering.directions",
           .unit = "directions",
           .meaning = "directions light is gathered from, a multiple of 16",
           .minimum = 16,
           .maximum = 512,
           .initial = 32,
           .integer = true,
           .ladder = {16, 32, 64, 128, 256},
           .rebuilds = true},
          {.name = "multiple_scattering.set",
           .meaning = "where those directions are",
           .initial = 0,
           .choices = {"fibonacci", "horizon"},
           .ladder = {0, 1},
           .rebuilds = true},
          {.name = "multiple_scattering.steps",
           .unit = "steps",
           .meaning = "samples along each of them, in fours",
           .minimum = 4,
           .maximum = 64,
           .initial = 8,
           .integer = true,
           .ladder = {4, 8, 16, 32},
           .rebuilds = true},
          {.name = "multiple_scattering.view_steps",
           .unit = "steps",
           .meaning = "samples of the table along a view ray, in fours",
           .minimum = 4,
           .maximum = 256,
           .initial = 16,
           .integer = true,
           .ladder = {4, 8, 16, 32}}};
}

static std::vector<Knob> texel_knobs() {
  return {{.name = "multiple_scattering.size",
           .unit = "texels",
           .meaning = "altitudes, and sun heights, in the table",
           .minimum = 8,
           .maximum = 128,
           .initial = 32,
           .integer = true,
           .ladder = {16, 24, 32, 64},
           .rebuilds = true},
          {.name = "multiple_scattering.map",
           .meaning = "where its texels are and what they hold: evenly and as it is, or denser where light changes and "
                      "by logarithm",
           .initial = 1,
           .choices = {"published", "horizon"},
           .ladder = {0, 1},
           .rebuilds = true},
          {.name = "multiple_scattering.format",
           .meaning = "bits of a number in the table: 16 or 32",
           .initial = 1,
           .choices = {"half", "float"},
           .ladder = {0, 1},
           .rebuilds = true}};
}

std::vector<Knob> multiple_scattering_knobs() { return joined(order_knobs(), texel_knobs()); }
// [/knobs]

// [orders_needed]
// The ratio of two successive orders becomes constant only after light has crossed the air: going straight on in about
// tau scatterings, or by diffusion in about tau^2 / 3, after which the higher eigenmodes of a slab have decayed.
int orders_needed(const interop::Atmosphere& air) {
  const double top_km = air.top_km;
  double max_tau = 0.0;
  for (int c = 0; c < 3; ++c) {
    double tau = 0.0;
    for (const auto& [scattering, scale_height_km] : {std::pair(air.rayleigh_scattering, air.rayleigh_scale_height_km),
                                                      std::pair(air.mie_scattering, air.mie_scale_height_km)})
      if (scale_height_km > 0.0f) tau += scattering[c] * scale_height_km * (1.0 - std::exp(-top_km / scale_height_km));
    max_tau = std::max(max_tau, tau);
  }
  return static_cast<int>(std::min(3.0 + std::ceil(max_tau * (2.0 + 0.3 * max_tau)), 64.0));
}
// [/orders_needed]

// [resources]
// The table and its intermediate results: the first order, three images that higher orders use in turn, and the nodes
// of the rays that light is gathered along.
struct TableResources {
  graph::Resource table, nodes;
  std::vector<graph::Resource> orders;
  // The image that holds the sum of the first n orders.
  graph::Resource sum_of_orders(int n) const { return n == 1 ? orders[0] : orders[1 + static_cast<size_t>(n - 2) % 3]; }
};

static TableResources add_resources(graph::Graph& graph, const Plan& plan) {
  const VkExtent2D size{plan.side, plan.published ? plan.side : plan.side * kLayers};
  TableResources resources;
  resources.table = graph.add_image(
      "multiple scattering",
      {.size = size, .format = plan.half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT});
  for (int i = 0; i < (plan.published ? 1 : 4); ++i)
    resources.orders.push_back(graph.add_image("orders " + std::to_string(i), {.size = size}));
  resources.nodes = graph.add_buffer("ray nodes", {kNodeBytes * plan.rays * static_cast<size_t>(plan.steps + 1)});
  return resources;
}
// [/resources]

// [steps]
// One pass: the nodes, the first order, the higher orders one by one, and the rest of the series.
static graph::Pass gather_pass(const AirBlock& air, const Plan& plan, const TableResources& resources,
                               const gpu::Constants& table, const gpu::Constants& gather) {
  graph::Pass pass{.name = "multiple scattering"};
  const auto add = [&](const std::string& name, const gpu::Constants& constants, std::vector<graph::Binding> bindings,
                       auto record) {
    bindings.push_back({"Air", air.block});
    pass.steps.push_back({.shader = "09_multiple_scattering_lut/" + name + ".comp",
                          .constants = joined(air.constants, constants),
                          .bindings = std::move(bindings),
                          .record = record});
  };
  const auto texels = [side = plan.side](const graph::Recorder& r) { r.dispatch(side, side); };
  const uint32_t panels = plan.rays * static_cast<uint32_t>(plan.steps / 4);
  add("nodes", gather, {{"Nodes", resources.nodes}},
      [panels](const graph::Recorder& r) { r.dispatch((panels + 31) / 32); });
  add(plan.published ? "published" : "first", gather, {{"Nodes", resources.nodes}, {"orders", resources.orders[0]}},
      texels);
  for (int n = 2; n <= plan.orders; ++n)
    add("next", gather,
        {{"Nodes", resources.nodes},
         {"before", resources.sum_of_orders(n - 1)},
         {"first", resources.orders[0]},
         {"orders", resources.sum_of_orders(n)}},
        texels);
  gpu::Constants close = table;
  close.push_back({"EXTRAPOLATE", !plan.published});
  const auto without_last = [&](int count) { return resources.sum_of_orders(std::max(plan.orders - count, 1)); };
  add(plan.half ? "close_half" : "close_float", close,
      {{"orders", without_last(0)},
       {"orders_minus_1", without_last(1)},
       {"orders_minus_2", without_last(2)},
       {"final_table", resources.table}},
      [side = plan.side](const graph::Recorder& r) {
        r.dispatch_over({side, side});
      });
  return pass;
}
// [/steps]

// [effect]
app::Effect multiple_scattering_table() {
  app::Effect effect{.name = "multiple scattering", .chapter = 9, .knobs = multiple_scattering_knobs()};
  effect.wanted = [](const Scene& scene, const Settings& settings) -> app::Wanted {
    if (settings.integer("orders") == 1) return {false, "orders is 1: single scattering is all there is"};
    const Plan plan = plan_of(scene, settings);
    if (plan.published) return {true, "two orders, and a geometric series for the rest: the published method"};
    return {true, fmt::format("{} orders gathered: {}", plan.orders,
                              settings.integer("multiple_scattering.iterations") == 0
                                  ? "the air's optical depth asks for them"
                                  : "multiple_scattering.iterations")};
  };
  effect.runs_everything = [](const Settings& settings) { return settings.choice("tables") == "all"; };
  effect.key = [](const Scene& scene, const Settings& settings) {
    return fmt::format("{} orders", plan_of(scene, settings).orders);
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const Settings& settings = builder.context.settings;
    const AirBlock& air = board.get<AirBlock>("the air");
    const Plan plan = plan_of(builder.context.scene, settings);
    const gpu::Constants table{{"MS_METHOD", settings.integer("multiple_scattering.method"), true},
                               {"MS_MAP", settings.integer("multiple_scattering.map"), true},
                               {"MS_SIZE", static_cast<int>(plan.side), true}};
    const gpu::Constants gather = joined(table, {{"DIRECTIONS", plan.directions},
                                                 {"DIRECTION_SET", settings.integer("multiple_scattering.set")},
                                                 {"STEPS", plan.steps}});
    const TableResources resources = add_resources(builder.graph, plan);
    builder.graph.add(gather_pass(air, plan, resources, table, gather));
    board.offer(MultipleScatteringTable{resources.table, table});
  };
  return effect;
}
// [/effect]

}  // namespace welkin
