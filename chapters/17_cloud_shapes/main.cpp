// Chapter 17, cloud shapes: where there is cloud and how much of it a ray crosses. Light comes in chapter 18.
#include "chapters/02_window/window.hpp"
#include "chapters/06_display/display.hpp"
#include "chapters/08_transmittance_lut/transmittance_lut.hpp"
#include "chapters/10_sky_view_lut/sky.hpp"
#include "chapters/11_aerial_perspective/lit_terrain.hpp"
#include "chapters/16_noise/noise.hpp"
#include "chapters/17_cloud_shapes/cloud_picture.hpp"

using namespace welkin;

int main(int argc, char** argv) {
  // [chapter]
  const app::Chapter chapter{
      .number = 17,
      .name = "17_cloud_shapes",
      .title = "Cloud shapes",
      .whats_new =
          "Bodies of cloud from layers, balls, grids and noise: one density function, and a march through shells.",
      .try_next = "./welkin run 17 --scene fair --set cloud.show=side   (or: --set weather.preset=storm)",
      .sky = true,
      .images = {"sky_view", "transmittance"},
      .reference = {{"cloud.steps", "256"}, {"cloud.detail", "full"}, {"cloud.grid", "exact"}, {"cloud.jitter", "off"}},
      .default_scene = "fair",
      .standard_views = {{"fair", "horizon"}, {"fair", "above"}, {"overcast", "horizon"}, {"storm", "horizon"}},
      .window = open_window_system,
      .still_passes = {"sky", "compose", "histogram", "exposure", "display"},
      .extra_bytes = 34 << 20,
      .effects = {air(), transmittance_table(), multiple_scattering_table(), sky_view(), sky(), terrain(),
                  terrain_shadows(), aerial_perspective(), lit_terrain(), noise_textures(), weather_texture(), clouds(),
                  cloud_picture(), exposure(), display()},
      .probe = probe_clouds};
  return app::run(argc, argv, chapter);
  // [/chapter]
}
