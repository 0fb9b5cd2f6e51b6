// The pass "air". See air_block.hpp and docs/chapters/04_air.md.
#include "chapters/04_air/air_block.hpp"

#include <cstring>
#include <optional>

namespace welkin {

interop::Atmosphere air_of_device(const app::Context& context) {
  interop::Atmosphere air = make_atmosphere(context.scene);
  if (context.inject == "wrong-constant") air.rayleigh_scattering.x *= 1.1f;
  return air;
}

gpu::Constants air_constants(const Scene& scene) {
  const AirVariant variant = air_variant(scene);
  return {{"HAS_RAYLEIGH", variant.rayleigh, true},
          {"HAS_MIE", variant.mie, true},
          {"HAS_OZONE", variant.ozone, true},
          {"MIE_PHASE", static_cast<int>(variant.mie_phase), true}};
}

std::string air_key(const Scene& scene) {
  const AirVariant variant = air_variant(scene);
  return fmt::format("{} {} {} {}", variant.rayleigh, variant.mie, variant.ozone, variant.mie_phase);
}

// [air]
app::Effect air() {
  app::Effect effect{.name = "air", .chapter = 4};
  effect.key = [](const Scene& scene, const Settings&) { return air_key(scene); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const graph::Resource block = builder.graph.add_buffer(
        "air", {.bytes = sizeof(interop::Atmosphere),
                .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT});
    board.offer(AirBlock{block, air_constants(builder.context.scene)});
    const auto written = std::make_shared<std::optional<interop::Atmosphere>>();
    graph::Pass pass{.name = "air", .changed = [context = builder.context, written](const app::Frame&) {
                       const interop::Atmosphere now = air_of_device(context);
                       return !*written || std::memcmp(&now, &**written, sizeof now) != 0;
                     }};
    pass.steps.push_back({.accesses = {{block, gpu::kUpdate}},
                          .record = [context = builder.context, written, block](const graph::Recorder& r) {
                            *written = air_of_device(context);
                            vkCmdUpdateBuffer(r.frame.commands, r.graph.buffer(block).handle, 0, sizeof **written,
                                              &**written);
                          }});
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/air]

}  // namespace welkin
