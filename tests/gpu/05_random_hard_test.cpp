// Chapter 05's march where formulas break: a million random and edge rays, fresh rays against the quadrature, and named
// cases, each with the figure of the naive way beside that of the way that holds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/05_rays.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kPi = 3.14159265358979323846;

template <typename T, size_t N>
const T& pick(Random& random, const T (&choices)[N]) {
  return choices[random.next() % N];
}

reference::Planet some_planet(Random& random) {
  reference::Planet planet = random.next() % 4 ? reference::earth() : reference::dense_alien();
  const auto scale = [](reference::Rgb& rgb, double factor) {
    for (double& value : rgb) value *= factor;
  };
  switch (random.next() % 10) {
    case 0:
    case 1: {  // no air, thin air, air as dense as a cloud
      const double factor = pick(random, {0.0, 1e-30, 1e-6, 1e3, 1e5});
      for (reference::Rgb* rgb : {&planet.rayleigh_scattering_per_km, &planet.mie_scattering_per_km,
                                  &planet.mie_extinction_per_km, &planet.ozone_absorption_per_km})
        scale(*rgb, factor);
      break;
    }
    case 2: scale(planet.mie_scattering_per_km, 0.0); break;  // soot: absorbs only
    case 3: {                                                 // an asteroid
      planet.ground_radius_km = 100.0, planet.top_radius_km = 101.0;
      planet.rayleigh_scale_height_km = 0.1, planet.mie_scale_height_km = 0.01;
      break;
    }
    case 4: {  // a giant
      planet.ground_radius_km = 70000.0, planet.top_radius_km = 70500.0;
      planet.rayleigh_scale_height_km = 50.0, planet.mie_scale_height_km = 25.0;
      break;
    }
    case 5:
      planet.ozone_half_width_km = pick(random, {1e-3, 0.1, 60.0}),
      planet.ozone_peak_km = pick(random, {0.0, 25.0, 100.0});
      break;
    default: break;
  }
  return planet;
}

reference::Direction some_direction(Random& random) {
  switch (random.next() % 6) {
    case 0:
      return pick(random, {reference::Direction{0, 0, 1}, reference::Direction{0, 0, -1}, reference::Direction{1, 0, 0},
                           reference::Direction{-1, 0, 0}, reference::Direction{0, 1, 0}});
    case 1:
      return reference::direction_from_degrees(90.0 + (random.next() % 2 ? 1 : -1) * random.log_uniform(1e-6, 5.0),
                                               random.uniform(0, 360));
    case 2:
      return reference::direction_from_degrees(
          random.next() % 2 ? random.log_uniform(1e-7, 1.0) : 180.0 - random.log_uniform(1e-7, 1.0),
          random.uniform(0, 360));
    default:
      return reference::direction_from_degrees(std::acos(random.uniform(-1, 1)) * 180.0 / kPi, random.uniform(0, 360));
  }
}

// From below the ground to the Moon.
double some_altitude(Random& random, double top_km) {
  switch (random.next() % 8) {
    case 0:
      return pick(random, {0.0, -5.0, 1e-7, 5e-4, top_km, std::nextafter(float(top_km), 1e9f) * 1.0,
                           std::nextafter(float(top_km), 0.0f) * 1.0, 384400.0});
    case 1: return random.uniform(0.0, top_km);
    default: return random.log_uniform(1e-6, 384400.0);
  }
}

// What a table of rays gives against the truth, with the phase function and albedo 0.3 of the march.
double worst_of(const reference::Planet& planet, const std::vector<SkyRay>& rays, const std::vector<Light>& truth,
                March march) {
  march.albedo = 0.3;
  const std::vector<Light> lights = march_rays(planet, rays, march);
  Errors errors;
  for (size_t i = 0; i < rays.size(); ++i) errors.add(lights[i].radiance, truth[i].radiance, 1e-9);
  return errors.maximum();
}

double worst_transmittance(const reference::Planet& planet, const std::vector<SkyRay>& rays,
                           const std::vector<Light>& truth, const March& march) {
  const std::vector<Light> lights = march_rays(planet, rays, march);
  Errors errors;
  for (size_t i = 0; i < rays.size(); ++i) errors.add(lights[i].transmittance, truth[i].transmittance, 1e-6);
  return errors.maximum();
}

std::vector<Light> truth_of(const reference::Planet& planet, const std::vector<SkyRay>& rays) {
  std::vector<Light> lights;
  for (const SkyRay& ray : rays) {
    const reference::SingleScattering exact =
        reference::single_scattering(planet, ray.altitude_km, ray.view, ray.sun, 1e-6);
    Light light{{}, exact.transmittance};
    for (int k = 0; k < 3; ++k)
      light.radiance[k] = reference::rayleigh_phase(exact.nu) * exact.rayleigh[k] +
                          reference::henyey_greenstein(exact.nu, 0.8) * exact.mie[k] + 0.3 * exact.ground1[k];
    lights.push_back(light);
  }
  return lights;
}

// The ray from a camera in space whose tangent point is at this altitude.
SkyRay limb_ray(const reference::Planet& planet, double camera_km, double tangent_km, double sun_zenith_deg,
                double azimuth_deg) {
  const double sine = (planet.ground_radius_km + tangent_km) / (planet.ground_radius_km + camera_km);
  return {camera_km,
          {sine, 0.0, -std::sqrt((1.0 - sine) * (1.0 + sine))},
          reference::direction_from_degrees(sun_zenith_deg, azimuth_deg)};
}

}  // namespace

TEST_CASE("hard: a million random and edge rays stay finite and within bounds") {
  Random random(5);
  long rays = 0, unfinite = 0, negative = 0, outside = 0, too_bright = 0, unseen = 0;
  for (Rule rule : {kAdapted, kLeft, kMidpoint, kOffset03, kNonuniform, kGaussLegendre}) {
    March march{.rule = rule};
    std::vector<RayItem> items;
    std::vector<double> most;  // no more light than the sun's through the brightest phase function, and the ground's
    const size_t count = rule == kAdapted ? 600'000 : 100'000;
    reference::Planet planet;
    for (size_t i = 0; i < count; ++i) {
      if (i % 64 == 0) planet = some_planet(random);
      SkyRay ray{some_altitude(random, planet.top_radius_km - planet.ground_radius_km), some_direction(random),
                 some_direction(random)};
      if (random.next() % 8 == 0) ray.sun = ray.view;
      if (random.next() % 16 == 0) ray.sun = {-ray.view[0], -ray.view[1], -ray.view[2]};
      march.g = random.next() % 4 ? 0.8 : pick(random, {0.0, -0.8, 0.99, 0.99999, -0.99999});
      march.albedo = pick(random, {0.0, 0.3, 1.0});
      march.enter_in_double = random.next() % 2;
      const int steps = random.next() % 3;
      march.view_steps = steps == 0 ? 1 : steps == 1 ? 8 : 16;
      march.light_steps = steps == 0 ? 1 : steps == 1 ? 4 : 8;
      items.push_back(ray_item(planet, ray, march));
    }
    const std::vector<Light> lights = march_items(items, march);
    for (size_t i = 0; i < lights.size(); ++i) {
      const float top_km = items[i].shape[1];
      const bool misses = items[i].view[3] >= top_km && items[i].view[2] >= 0.0f;
      for (int k = 0; k < 3; ++k) {
        const double radiance = lights[i].radiance[k], transmittance = lights[i].transmittance[k];
        if (!std::isfinite(radiance) || !std::isfinite(transmittance)) ++unfinite;
        if (radiance < 0.0) ++negative;
        if (transmittance < 0.0 || transmittance > 1.0) ++outside;
        if (misses && (radiance != 0.0 || transmittance != 1.0)) ++unseen;
        // Segments of constant source cannot scatter more than all light: at most the phase function's peak.
        const double g = std::abs(items[i].mie_extinction[3]);
        const double peak = (1.0 + g) / (4.0 * kPi * (1.0 - g) * (1.0 - g));
        if (rule < kNonuniform && radiance > std::max(peak, 3.0 / (8.0 * kPi)) * 1.01 + 1.0 / kPi) ++too_bright;
      }
      ++rays;
    }
  }
  CHECK(rays >= 1'000'000);
  CHECK(unfinite == 0);
  CHECK(negative == 0);
  CHECK(outside == 0);
  CHECK(unseen == 0);
  CHECK(too_bright == 0);
}

TEST_CASE("hard: fresh random rays against the quadrature") {
  const bool alien = GENERATE(false, true);
  const reference::Planet planet = alien ? reference::dense_alien() : reference::earth();
  Random random(alien ? 77 : 42);
  std::set<Camera> cameras;
  for (int i = 0; i < 90; ++i) {
    const double altitude_km = i % 3 == 0   ? random.log_uniform(110.0, 384400.0)
                               : i % 3 == 1 ? random.uniform(0.0, 100.0)
                                            : random.log_uniform(5e-4, 20.0);
    cameras.insert({altitude_km, i % 2 ? random.uniform(0.0, 90.0) : random.uniform(84.0, 100.0)});
  }
  const std::map<Camera, double> maxima = sky_maxima(planet, cameras);
  std::vector<SkyRay> rays;
  std::vector<double> floors;
  for (const auto& [camera, maximum] : maxima)
    for (int i = 0; i < 7; ++i) {
      const double azimuth_deg = random.uniform(0.0, 360.0);
      if (camera.first > 100.0)
        rays.push_back(limb_ray(planet, camera.first,
                                i % 2 ? random.uniform(0.0, 60.0) : random.uniform(-planet.ground_radius_km, 0.0),
                                camera.second, azimuth_deg));
      else
        rays.push_back(ray_from_degrees(camera.first, i % 2 ? random.uniform(85.0, 95.0) : random.uniform(0.0, 180.0),
                                        camera.second, azimuth_deg));
      floors.push_back(1e-6 * maximum);
    }
  const std::vector<Light> truth = truth_of(planet, rays);
  const std::vector<Light> lights = march_rays(planet, rays, {.albedo = 0.3});
  Errors errors;
  for (size_t i = 0; i < rays.size(); ++i) errors.add(lights[i].radiance, truth[i].radiance, floors[i]);
  CAPTURE(alien, errors.values.size(), errors.maximum(), errors.quantile(0.99), errors.quantile(0.5));
  CHECK(rays.size() == 630);
  CHECK(errors.values.size() > 1200);
  CHECK(errors.maximum() < 0.01);
  CHECK(errors.quantile(0.99) < 0.003);
}

TEST_CASE("hard: the planet's shadow cuts the ray in two") {
  // Looking from space through the dark side: lit air, shadow, lit air.
  const reference::Planet planet = reference::earth();
  std::vector<SkyRay> rays;
  for (double tangent_km : {2.0, 10.0, 25.0, 40.0})
    for (double sun_zenith_deg : {100.0, 105.0, 110.0, 114.0})
      for (double azimuth_deg : {0.0, 60.0, 180.0})
        rays.push_back(limb_ray(planet, 400.0, tangent_km, sun_zenith_deg, azimuth_deg));
  const std::vector<Light> truth = truth_of(planet, rays);
  const double naive = worst_of(planet, rays, truth, {.rule = kMidpoint});
  const double dearer = worst_of(planet, rays, truth, {.view_steps = 128, .light_steps = 8, .rule = kMidpoint});
  const double holds = worst_of(planet, rays, truth, {});
  CAPTURE(naive, dearer, holds);
  CHECK(naive > 0.3);
  CHECK(dearer > 0.01);  // four times the steps do not mend it
  CHECK(holds < 0.005);
}

TEST_CASE("hard: the limb seen from space, through thousands of kilometres of air") {
  const bool alien = GENERATE(false, true);
  const reference::Planet planet = alien ? reference::dense_alien() : reference::earth();
  std::vector<SkyRay> rays;
  for (double camera_km : {400.0, 36000.0})
    for (double tangent_km : {0.05, 1.0, 4.0, 9.0, 17.0, 30.0, 50.0})
      for (double sun_zenith_deg : {0.0, 60.0, 85.0, 92.0, 100.0})
        for (double azimuth_deg : {0.0, 90.0, 180.0})
          rays.push_back(limb_ray(planet, camera_km, tangent_km, sun_zenith_deg, azimuth_deg));
  const std::vector<Light> truth = truth_of(planet, rays);
  const double naive = worst_of(planet, rays, truth, {.rule = kMidpoint});
  const double holds = worst_of(planet, rays, truth, {});
  CAPTURE(alien, naive, holds);
  CHECK(naive > 0.3);
  CHECK(holds < 0.005);
}

TEST_CASE("hard: seen from the Moon, rounding the direction moves the tangent point") {
  const reference::Planet planet = reference::earth();
  std::vector<SkyRay> rays;
  for (double camera_km : {36000.0, 384400.0})
    for (int i = 0; i < 40; ++i) rays.push_back(limb_ray(planet, camera_km, 0.02 + 0.5 * i, 60.0, 30.0));
  const std::vector<Light> truth = truth_of(planet, rays);
  const std::vector<Light> entered = march_rays(planet, rays, {}),
                           rounded = march_rays(planet, rays, {.enter_in_double = false});
  Errors moved;
  for (size_t i = 0; i < rays.size(); ++i) moved.add(rounded[i].transmittance, entered[i].transmittance, 1e-6);
  const double naive = moved.maximum();  // a tangent point moved by 0.3 m, through an optical depth of ten
  const double holds = worst_transmittance(planet, rays, truth, {});
  const double radiance = worst_of(planet, rays, truth, {.enter_in_double = false});
  CAPTURE(naive, holds, radiance);
  CHECK(naive > 4e-4);
  CHECK(holds < 5e-4);
  CHECK(radiance < 0.005);  // the shader's own way in is fit for pictures
}

TEST_CASE("hard: a planet whose radii are no floats") {
  // 11271.6 + 84.937 km: as the difference of two float radii the top is 0.5 m too high, so that a camera on it stands
  // inside, and a ray that should skim the top for 0.8 km stays in the air for 160 km.
  reference::Planet planet = reference::earth();
  planet.ground_radius_km = 11271.6, planet.top_radius_km = 11271.6 + 84.937;
  const double top_km = planet.top_radius_km - planet.ground_radius_km;
  std::vector<SkyRay> rays;
  for (double zenith_deg : {90.002, 90.05, 90.2, 91.0, 95.0})
    rays.push_back(ray_from_degrees(top_km, zenith_deg, 40.0, 20.0));
  const std::vector<Light> truth = truth_of(planet, rays);
  const March march{.albedo = 0.3, .enter_in_double = false};
  std::vector<RayItem> items, naive_items;
  for (const SkyRay& ray : rays) {
    items.push_back(ray_item(planet, ray, march));
    naive_items.push_back(items.back());
    naive_items.back().shape[1] = float(planet.top_radius_km) - float(planet.ground_radius_km);
  }
  Errors naive, holds;
  const std::vector<Light> lights = march_items(items, march), naive_lights = march_items(naive_items, march);
  for (size_t i = 0; i < rays.size(); ++i) {
    naive.add(naive_lights[i].radiance, truth[i].radiance, 0.0);
    holds.add(lights[i].radiance, truth[i].radiance, 0.0);
  }
  CAPTURE(naive.maximum(), holds.maximum());
  CHECK(naive.maximum() > 0.5);
  CHECK(holds.maximum() < 0.001);
}

TEST_CASE("hard: half a metre above the ground, looking down") {
  // The ray crosses 0.04 % of a scale height: counted in scale heights its samples would be a few ulp apart.
  const reference::Planet planet = reference::earth();
  std::vector<SkyRay> rays;
  for (double view_zenith_deg : {91.0, 95.0, 120.0, 150.0, 180.0})
    for (double sun_zenith_deg : {0.0, 60.0, 85.0})
      rays.push_back(ray_from_degrees(5e-4, view_zenith_deg, sun_zenith_deg, 45.0));
  std::vector<Light> truth = truth_of(planet, rays);
  // Air alone: under the lit ground, a thousand times brighter, an error of the air would not show.
  for (size_t i = 0; i < rays.size(); ++i) {
    const auto exact = reference::single_scattering(planet, rays[i].altitude_km, rays[i].view, rays[i].sun, 1e-6);
    for (int k = 0; k < 3; ++k) truth[i].radiance[k] -= 0.3 * exact.ground1[k];
  }
  const std::vector<Light> lights = march_rays(planet, rays, {});
  Errors errors;
  for (size_t i = 0; i < rays.size(); ++i) errors.add(lights[i].radiance, truth[i].radiance, 0.0);
  CAPTURE(errors.maximum());
  CHECK(errors.maximum() < 5e-4);
}
