// Chapter 18, cloud light: sunlight in clouds, by a march and by paths of every order.
#include "chapters/02_window/window.hpp"
#include "chapters/06_display/display.hpp"
#include "chapters/08_transmittance_lut/transmittance_lut.hpp"
#include "chapters/10_sky_view_lut/sky.hpp"
#include "chapters/11_aerial_perspective/lit_terrain.hpp"
#include "chapters/16_noise/noise.hpp"
#include "chapters/18_cloud_light/cloud_light.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 18,
      .name = "18_cloud_light",
      .title = "Cloud light",
      .whats_new = "Sunlight in clouds: phase functions, octaves, orders by escape, and paths of every order.",
      .try_next = "./welkin run 18 --scene fair --set cloud.orders=octaves",
      .sky = true,
      .stochastic = true,
      .images = {"sky_view", "transmittance"},
      .reference = {{"cloud.view_steps", "512"}, {"cloud.light_samples", "32"}},
      .default_scene = "fair",
      .standard_views = {{"fair", "horizon"}, {"fair", "above"}, {"overcast", "horizon"}, {"storm", "horizon"}},
      .window = open_window_system,
      .still_passes = {"sky", "compose", "histogram", "exposure", "display"},
      .extra_bytes = 34 << 20,
      .effects = {air(), transmittance_table(), multiple_scattering_table(), sky_view(), sky(), terrain(),
                  terrain_shadows(), aerial_perspective(), lit_terrain(), noise_textures(), weather_texture(), clouds(),
                  cloud_bounds(), cloud_light(), exposure(), display()},
      .probe = probe_cloud_light};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
