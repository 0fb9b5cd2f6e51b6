// See 11_parts.hpp.
#include "tests/gpu/11_parts.hpp"

#include <cmath>
#include <cstring>

#include "chapters/06_display/display.hpp"
#include "chapters/10_sky_view_lut/sky.hpp"
#include "common/gpu/shader_file.hpp"
#include "common/image/atomic_file.hpp"
#include "tests/gpu/10_sky.hpp"

namespace welkin::test {

std::vector<AirAnswer> evaluate_air(const reference::Planet& planet, const std::vector<AirItem>& items, bool orders,
                                    uint32_t method) {
  std::vector<RayItem> inputs;
  for (const AirItem& item : items) {
    RayItem input = ray_item(planet, {}, {.phase = kHenyeyGreenstein});
    for (size_t i = 0; i < 4; ++i) {
      input.view[i] = static_cast<float>(item.a[i]);
      input.sun[i] = static_cast<float>(item.b[i]);
      input.steps[i] = i == 3 ? static_cast<float>(item.part) : static_cast<float>(item.c[i]);
    }
    inputs.push_back(input);
  }
  std::vector<float> floats(inputs.size() * 40);
  std::memcpy(floats.data(), inputs.data(), floats.size() * sizeof(float));
  const std::vector<float> outputs =
      evaluate("tests/11_parts.comp", floats, 40, 6, {1, 1, 1, 0, method, 1, 32, orders});
  std::vector<AirAnswer> answers;
  for (size_t i = 0; i < items.size(); ++i) {
    const float* o = &outputs[6 * i];
    answers.push_back({{o[0], o[1], o[2]}, {o[3], o[4], o[5]}});
  }
  return answers;
}

Light truth_to(const reference::Planet& planet, const SkyRay& ray, double d) {
  const auto radiance = [&](const SkyRay& from) {
    const reference::SingleScattering light =
        reference::single_scattering(planet, from.altitude_km, from.view, from.sun);
    reference::Rgb sum{};
    for (int k = 0; k < 3; ++k)
      sum[k] = reference::rayleigh_phase(light.nu) * light.rayleigh[k] +
               reference::henyey_greenstein(light.nu, 0.8) * light.mie[k];
    return sum;
  };
  // The rest of the ray, in the frame where its own start is straight up: the vertical turns towards the view.
  const double r = planet.ground_radius_km + ray.altitude_km, mu = ray.view[2],
               sine = std::hypot(ray.view[0], ray.view[1]);
  const double r_d = std::sqrt(r * r + 2.0 * r * mu * d + d * d);
  const double c = (r + d * mu) / r_d, s = d * sine / r_d;  // of the turn
  const double x = sine > 0.0 ? ray.view[0] / sine : 1.0, y = sine > 0.0 ? ray.view[1] / sine : 0.0;
  const auto turned = [&](const reference::Direction& v) {
    const double along = v[0] * x + v[1] * y, level = c * along - s * v[2], up = s * along + c * v[2];
    return reference::Direction{v[0] + (level - along) * x, v[1] + (level - along) * y, up};
  };
  const double altitude_d = ray.altitude_km + d * (2.0 * r * mu + d) / (r_d + r);
  const SkyRay rest{altitude_d, turned(ray.view), turned(ray.sun)};
  const std::array<double, 3> column = reference::columns(planet, ray.altitude_km, mu, sine, d);
  const reference::Rgb whole = radiance(ray), beyond = radiance(rest);
  Light light;
  for (int k = 0; k < 3; ++k) {
    light.transmittance[k] =
        std::exp(-(planet.rayleigh_scattering_per_km[k] * column[0] + planet.mie_extinction_per_km[k] * column[1] +
                   planet.ozone_absorption_per_km[k] * column[2]));
    light.radiance[k] = whole[k] - light.transmittance[k] * beyond[k];
  }
  return light;
}

std::vector<app::Effect> terrain_effects() {
  std::vector<app::Effect> effects = sky_effects();
  for (app::Effect& effect :
       std::vector<app::Effect>{terrain(), terrain_shadows(), aerial_perspective(), lit_terrain()})
    effects.push_back(std::move(effect));
  return effects;
}

Scene scene_named(const std::string& name) { return load_scene(name, gpu::source_directory() / "chapters" / "scenes"); }

Drawn::Drawn(const Scene& scene, VkExtent2D size, const std::vector<std::pair<std::string, std::string>>& knobs,
             bool chapter_10)
    : scene_(scene), settings_(app::knobs_of(terrain_effects(), 11)), context_{device(), scene_, settings_, inject_} {
  for (const auto& [name, text] : knobs) settings_.set(name, text);
  const uint64_t before = device().allocated_bytes();
  program_ = std::make_unique<app::Composition>(context_, chapter_10 ? sky_effects() : terrain_effects());
  renderer_ = std::make_unique<app::Renderer>(context_, chapter_, *program_, size);
  bytes_ = device().allocated_bytes() - before;
}

Image Drawn::picture(const View& view, uint32_t index) {
  renderer_->draw(app::pose_of(view, 6360.0), 0.0, 0, index);
  passes_.clear();
  for (const gpu::PassTime& pass : renderer_->pass_times()) passes_.push_back(pass.name);
  return renderer_->picture();
}

void write_gray(const std::filesystem::path& file, uint32_t width, uint32_t height,
                const std::vector<uint16_t>& samples, int bits) {
  std::string rows;
  for (uint32_t j = 0; j < height; ++j) {
    rows += '\0';  // no filter
    for (uint32_t i = 0; i < width; ++i) {
      rows += static_cast<char>(samples[size_t{j} * width + i] >> 8);
      if (bits == 16) rows += static_cast<char>(samples[size_t{j} * width + i] & 255);
    }
  }
  const auto big = [](uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                       static_cast<char>(v)};
  };
  std::string packed = "\x78\x01";  // deflate's blocks of up to 65535 bytes, stored as they are
  uint32_t a = 1, b = 0;
  for (size_t at = 0; at < rows.size(); at += 65535) {
    const uint32_t n = static_cast<uint32_t>(std::min<size_t>(65535, rows.size() - at));
    packed += static_cast<char>(at + n == rows.size());
    for (const uint32_t v : {n, ~n}) packed += static_cast<char>(v & 255), packed += static_cast<char>(v >> 8 & 255);
    packed += rows.substr(at, n);
  }
  for (const char c : rows) a = (a + static_cast<uint8_t>(c)) % 65521, b = (b + a) % 65521;
  packed += big(b << 16 | a);
  const auto chunk = [&](const std::string& kind, const std::string& data) {
    uint32_t crc = ~0u;
    for (const char c : kind + data) {
      crc ^= static_cast<uint8_t>(c);
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
    }
    return big(static_cast<uint32_t>(data.size())) + kind + data + big(~crc);
  };
  write_file_atomically(file,
                        "\x89PNG\r\n\x1a\n" +
                            chunk("IHDR", big(width) + big(height) + static_cast<char>(bits) + std::string(4, '\0')) +
                            chunk("IDAT", packed) + chunk("IEND", ""));
}

}  // namespace welkin::test
