// The pass "transmittance". See transmittance_lut.hpp and docs/chapters/08_transmittance_lut.md.
#include "chapters/08_transmittance_lut/transmittance_lut.hpp"

namespace welkin {
namespace {

struct TablePush {
  int32_t width, height, unused[2];
};

}  // namespace

// [knobs]
// Only one knob has a ladder, because a sweep runs all combinations. The page's table of errors covers the others.
std::vector<Knob> transmittance_knobs() {
  return {{.name = "transmittance.width",
           .unit = "texels",
           .meaning = "paths per altitude in the table",
           .minimum = 8,
           .maximum = 1024,
           .initial = 256,
           .integer = true,
           .rebuilds = true},
          {.name = "transmittance.height",
           .unit = "texels",
           .meaning = "altitudes in the table",
           .minimum = 8,
           .maximum = 1024,
           .initial = 512,
           .integer = true,
           .ladder = {64, 512},
           .rebuilds = true},
          {.name = "transmittance.steps",
           .unit = "steps",
           .meaning = "Gauss-Legendre points per texel, in fours; 0: the closed form of chapter 05",
           .minimum = 0,
           .maximum = 512,
           .initial = 0,
           .integer = true,
           .rebuilds = true},
          {.name = "transmittance.mapping",
           .meaning = "which paths the table holds: all that miss the ground, or the upward ones",
           .initial = 1,
           .choices = {"published", "folded"},
           .rebuilds = true},
          {.name = "transmittance.stored",
           .meaning = "what a texel holds",
           .initial = 2,
           .choices = {"transmittance", "optical_depth", "mean_extinction"},
           .rebuilds = true},
          {.name = "transmittance.format",
           .meaning = "bits of a number in the table: 16 or 32",
           .initial = 1,
           .choices = {"half", "float"},
           .rebuilds = true}};
}
// [/knobs]

// [table]
app::Effect transmittance_table() {
  app::Effect effect{.name = "transmittance table", .chapter = 8, .knobs = transmittance_knobs()};
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const Settings& settings = builder.context.settings;
    const AirBlock& air = board.get<AirBlock>("the air");
    const VkExtent2D size{static_cast<uint32_t>(settings.integer("transmittance.width")),
                          static_cast<uint32_t>(settings.integer("transmittance.height"))};
    const bool half = settings.choice("transmittance.format") == "half";
    const graph::Resource image = builder.graph.add_image(
        "transmittance",
        {.size = size, .format = half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT});
    const gpu::Constants stored{{"TABLE_MAPPING", settings.integer("transmittance.mapping"), true},
                                {"TABLE_STORED", settings.integer("transmittance.stored"), true}};
    gpu::Constants constants = joined(air.constants, stored);
    constants.push_back({"STEPS", (settings.integer("transmittance.steps") + 3) / 4 * 4});
    graph::Pass pass{.name = "transmittance"};
    pass.steps.push_back({.shader = half ? "08_transmittance_lut/transmittance_half.comp"
                                         : "08_transmittance_lut/transmittance_float.comp",
                          .constants = std::move(constants),
                          .bindings = {{"Air", air.block}, {"table", image}},
                          .record = [size](const graph::Recorder& r) {
                            r.push(TablePush{static_cast<int32_t>(size.width), static_cast<int32_t>(size.height), {}})
                                .dispatch_over(size);
                          }});
    builder.graph.add(std::move(pass));
    board.offer(TransmittanceTable{image, stored});
  };
  return effect;
}
// [/table]

}  // namespace welkin
