// The pass "sky view". See sky_view_lut.hpp and docs/chapters/10_sky_view_lut.md.
#include "chapters/10_sky_view_lut/sky_view_lut.hpp"

#include <cmath>
#include <optional>

namespace welkin {
namespace {

constexpr float kHalfUnit = 1.0f / 4096.0f;  // as in sky_view_half.comp

struct FillPush {
  glm::vec4 viewpoint;
  int32_t view_steps, table_steps, unused[2];
};

VkExtent2D size_of(const std::string& choice) {
  const size_t cross = choice.find('x');
  return {static_cast<uint32_t>(std::stoi(choice)), static_cast<uint32_t>(std::stoi(choice.substr(cross + 1)))};
}

}  // namespace

// [knobs]
std::vector<Knob> sky_view_knobs() {
  return {{.name = "sky_view.method",
           .meaning = "where the sky comes from: the table, the direct march, or whichever is right for the altitude",
           .initial = 0,
           .choices = {"auto", "table", "march"},
           .ladder = {1, 2}},
          {.name = "sky_view.size",
           .unit = "texels",
           .meaning = "azimuths x heights in the table",
           .initial = 1,
           .choices = {"96x54", "192x108", "288x162", "384x216", "768x432"},
           .ladder = {0, 1, 2, 3},
           .rebuilds = true},
          {.name = "sky_view.steps",
           .unit = "steps",
           .meaning = "samples of the first order along a texel's ray, in fours",
           .minimum = 4,
           .maximum = 512,
           .initial = 16,
           .integer = true,
           .ladder = {8, 16, 32}},
          {.name = "sky_view.format",
           .meaning = "bits of a number in the table: 16 or 32",
           .initial = 1,
           .choices = {"half", "float"},
           .ladder = {0, 1},
           .rebuilds = true},
          {.name = "sky_view.highest",
           .unit = "km",
           .meaning = "altitude above which `auto` marches",
           .minimum = 0,
           .maximum = 1000,
           .initial = 20}};
}
// [/knobs]

bool uses_sky_view_table(const Settings& settings, double altitude_km) {
  const std::string& method = settings.choice("sky_view.method");
  return method == "table" || (method == "auto" && altitude_km <= settings.number("sky_view.highest"));
}

// [pass]
// The inputs of the table besides the air. The sun's azimuth is none of them: azimuths in the table are relative to the
// sun's.
struct SkyViewInputs {
  float altitude_km, mu_sun;
  int view_steps, table_steps;
  bool operator==(const SkyViewInputs&) const = default;
};

static SkyViewInputs sky_view_inputs(const Settings& settings, bool has_orders, const CameraRays& camera) {
  return {camera.altitude_km, camera.sun.z, settings.integer("sky_view.steps"),
          has_orders ? settings.integer("multiple_scattering.view_steps") : 0};
}

app::Effect sky_view() {
  app::Effect effect{.name = "sky view", .chapter = 10, .knobs = sky_view_knobs()};
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const AirBlock& air = board.get<AirBlock>("the air");
    const MultipleScatteringTable* orders = board.find<MultipleScatteringTable>();
    const bool half = context.settings.choice("sky_view.format") == "half", has_orders = orders != nullptr;
    const VkExtent2D size = size_of(context.settings.choice("sky_view.size"));
    const graph::Resource image = builder.graph.add_image(
        "sky view", {.size = size, .format = half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT});
    board.offer(SkyViewTable{image, half ? kHalfUnit : 1.0f});

    graph::Step step{.shader = fmt::format("10_sky_view_lut/sky_view{}_{}.comp", has_orders ? "" : "_single",
                                           half ? "half" : "float"),
                     .constants = air.constants,
                     .bindings = {{"Air", air.block}, {"sky_view", image}}};
    if (has_orders) {
      step.constants = joined(step.constants, orders->constants);
      step.bindings.push_back({"scattering_table", orders->image});
    }
    const auto filled_for = std::make_shared<std::optional<SkyViewInputs>>();
    step.record = [context, filled_for, has_orders, size](const graph::Recorder& r) {
      const CameraRays& camera = r.frame.camera;
      *filled_for = sky_view_inputs(context.settings, has_orders, camera);
      const float sun_sine = std::hypot(camera.sun.x, camera.sun.y);
      r.push(FillPush{{camera.altitude_km, camera.sun.z, sun_sine, 0.0f},
                      (*filled_for)->view_steps,
                      (*filled_for)->table_steps,
                      {}});
      r.dispatch((size.width + 31) / 32, size.height);
    };
    graph::Pass pass{.name = "sky view"};
    pass.changed = [context, filled_for, has_orders](const app::Frame& frame) {
      return *filled_for != sky_view_inputs(context.settings, has_orders, frame.camera);
    };
    pass.needed = [context](const app::Frame& frame) {
      return uses_sky_view_table(context.settings, frame.camera.altitude_km);
    };
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/pass]

}  // namespace welkin
