// The double twin: the shader's own text compiled as C++ with float meaning double, beside the shader as it runs. It
// says what float32 loses, and nothing about whether the formulas are right: for that there are the truth tables.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/glm.hpp>

#include "tests/gpu/05_rays.hpp"
#include "tests/gpu/harness.hpp"

// The compiler does not see that a loop over four components sets them all.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

namespace twin {
using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using namespace glm;
const bool HAS_RAYLEIGH = true, HAS_MIE = true, HAS_OZONE = true;
const int MIE_PHASE = 0;
#define float double
#define WELKIN_SHADER_TWIN
#include "05_single_scattering/single_scattering.glsl"
#undef WELKIN_SHADER_TWIN
#undef float

// The floats the shader is given, so that the inputs' own rounding is not part of the difference.
RayLight march(const welkin::test::RayItem& item, int rule) {
  const auto wide = [](const float(&v)[4]) { return vec4(v[0], v[1], v[2], v[3]); };
  const auto three = [](const float(&v)[4]) { return vec3(v[0], v[1], v[2]); };
  const Atmosphere atmosphere{three(item.rayleigh),
                              item.rayleigh[3],
                              three(item.mie_scattering),
                              item.mie_scattering[3],
                              three(item.mie_extinction),
                              item.mie_extinction[3],
                              three(item.ozone),
                              item.ozone[3],
                              item.shape[0],
                              item.shape[1],
                              item.shape[2],
                              item.shape[3],
                              three(item.ground),
                              item.ground[3],
                              three(item.sun_irradiance),
                              item.sun_irradiance[3]};
  return single_scattering(atmosphere, double(item.view[3]), vec3(wide(item.view)), vec3(wide(item.sun)),
                           int(item.steps[0]), int(item.steps[1]), rule);
}
}  // namespace twin

using namespace welkin;
using namespace welkin::test;

TEST_CASE("twin: what float32 loses") {
  struct Case {
    bool alien;
    bool space;
    Rule rule;
    double worst, p99;  // bounds; what was seen stands beside them
  };
  const Case one = GENERATE(Case{false, false, kAdapted, 2e-3, 2e-4}, Case{false, true, kAdapted, 5e-3, 5e-4},
                            Case{true, false, kAdapted, 2e-3, 5e-4}, Case{true, true, kAdapted, 5e-3, 5e-4},
                            Case{false, false, kMidpoint, 2e-3, 2e-4}, Case{false, false, kGaussLegendre, 2e-3, 2e-4});
  const reference::Planet planet = one.alien ? reference::dense_alien() : reference::earth();
  Random random(17);
  std::vector<RayItem> items;
  std::vector<Camera> cameras;
  March march{.rule = one.rule, .albedo = 0.3};
  for (int camera = 0; camera < 150; ++camera) {
    const double altitude_km = one.space ? random.log_uniform(110.0, 384400.0) : random.log_uniform(5e-4, 100.0);
    const double sun_zenith_deg = camera % 2 ? random.uniform(0.0, 90.0) : random.uniform(84.0, 100.0);
    for (int i = 0; i < 40; ++i) {
      const double closest =
          (planet.ground_radius_km + random.uniform(-100.0, 60.0)) / (planet.ground_radius_km + altitude_km);
      const double zenith_deg = one.space ? 180.0 - std::asin(std::min(closest, 1.0)) * 180.0 / 3.14159265358979324
                                : i % 2   ? random.uniform(85.0, 95.0)
                                          : random.uniform(0.0, 180.0);
      items.push_back(ray_item(
          planet, ray_from_degrees(altitude_km, zenith_deg, sun_zenith_deg, random.uniform(0.0, 360.0)), march));
      cameras.push_back({altitude_km, sun_zenith_deg});
    }
  }
  const std::map<Camera, double> maxima = sky_maxima(planet, {cameras.begin(), cameras.end()});
  const std::vector<Light> lights = march_items(items, march);
  Errors radiance, transmittance;
  for (size_t i = 0; i < items.size(); ++i) {
    const twin::RayLight exact = twin::march(items[i], one.rule);
    radiance.add(lights[i].radiance, {exact.radiance.x, exact.radiance.y, exact.radiance.z},
                 1e-6 * maxima.at(cameras[i]));
    transmittance.add(lights[i].transmittance, {exact.transmittance.x, exact.transmittance.y, exact.transmittance.z},
                      1e-6);
  }
  CAPTURE(one.alien, one.space, one.rule, radiance.values.size(), radiance.maximum(), radiance.quantile(0.99),
          transmittance.maximum());
  CHECK(radiance.values.size() > 9000);
  CHECK(radiance.maximum() < one.worst);
  CHECK(radiance.quantile(0.99) < one.p99);
  CHECK(radiance.maximum() > 1e-7);  // the twin is double: no difference at all would mean it is not
  CHECK(transmittance.maximum() < 1e-3);
}
