// Chapter 05's march where formulas break: a million random and edge rays, fresh rays against the quadrature, and named
// cases, each with the figure of the naive way beside that of the way that holds.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

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
  const auto scale = [](reference::Rgb& rgb, double factor) { for (double& value : rgb) value *= factor; };
  switch (random.next() % 10) {
    case 0: case 1: {  // no air, thin air, air as dense as a cloud
      const double factor = pick(random, {0.0, 1e-30, 1e-6, 1e3, 1e5});
      for (reference::Rgb* rgb : {&planet.rayleigh_scattering_per_km, &planet.mie_scattering_per_km,
                                  &planet.mie_extinction_per_km, &planet.ozone_absorption_per_km})
        scale(*rgb, factor);
      break;
    }
    case 2: scale(planet.mie_scattering_per_km, 0.0); break;  // soot: absorbs only
    case 3: {  // an asteroid
      planet.ground_radius_km = 100.0, planet.top_radius_km = 101.0;
      planet.rayleigh_scale_height_km = 0.1, planet.mie_scale_height_km = 0.01;
      break;
    }
    case 4: {  // a giant
      planet.ground_radius_km = 70000.0, planet.top_radius_km = 70500.0;
      planet.rayleigh_scale_height_km = 50.0, planet.mie_scale_height_km = 25.0;
      break;
    }
    case 5: planet.ozone_half_width_km = pick(random, {1e-3, 0.1, 60.0}), planet.ozone_peak_km = pick(random, {0.0, 25.0, 100.0}); break;
    default: break;
  }
  return planet;
}

reference::Direction some_direction(Random& random) {
  switch (random.next() % 6) {
    case 0: return pick(random, {reference::Direction{0, 0, 1}, reference::Direction{0, 0, -1}, reference::Direction{1, 0, 0},
                                 reference::Direction{-1, 0, 0}, reference::Direction{0, 1, 0}});
    case 1: return reference::direction_from_degrees(90.0 + (random.next() % 2 ? 1 : -1) * random.log_uniform(1e-6, 5.0), random.uniform(0, 360));
    case 2: return reference::direction_from_degrees(random.next() % 2 ? random.log_uniform(1e-7, 1.0) : 180.0 - random.log_uniform(1e-7, 1.0), random.uniform(0, 360));
    default: return reference::direction_from_degrees(std::acos(random.uniform(-1, 1)) * 180.0 / kPi, random.uniform(0, 360));
  }
}

// From below the ground to the Moon.
double some_altitude(Random& random, double top_km) {
  switch (random.next() % 8) {
    case 0: return pick(random, {0.0, -5.0, 1e-7, 5e-4, top_km, std::nextafter(float(top_km), 1e9f) * 1.0, std::nextafter(float(top_km), 0.0f) * 1.0, 384400.0});
    case 1: return random.uniform(0.0, top_km);
    default: return random.log_uniform(1e-6, 384400.0);
  }
}

// What a table of rays gives against the truth, with the phase function and albedo 0.3 of the march.
double worst_of(const reference::Planet& planet, const std::vector<SkyRay>& rays, const std::vector<Light>& truth, March march) {
  march.albedo = 0.3;
  const std::vector<Light> lights = march_rays(planet, rays, march);
  Errors errors;
  for (size_t i = 0; i < rays.size(); ++i) errors.add(lights[i].radiance, truth[i].radiance, 1e-9);
  return errors.maximum();
}

double worst_transmittance(const reference::Planet& planet, const std::vector<SkyRay>& rays, const std::vector<Light>& truth, const March& march) {
  const std::vector<Light> lights = march_rays(planet, rays, march);
  Errors errors;
  for (size_t i = 0; i < rays.size(); ++i) errors.add(lights[i].transmittance, truth[i].transmittance, 1e-6);
  return errors.maximum();
}

std::vector<Light> truth_of(const reference::Planet& planet, const std::vector<SkyRay>& rays) {
  std::vector<Light> lights;
  for (const SkyRay& ray : rays) {
    const reference::SingleScattering exact = reference::single_scattering(planet, ray.altitude_km, ray.view, ray.sun, 1e-6);
    Light light{{}, exact.transmittance};
    for (int k = 0; k < 3; ++k)
      light.radiance[k] = reference::rayleigh_phase(exact.nu) * exact.rayleigh[k] +
                          reference::henyey_greenstein(exact.nu, 0.8) * exact.mie[k] + 0.3 * exact.ground1[k];
    lights.push_back(light);
  }
  return lights;
}

// The ray from a camera in space whose tangent point is at this altitude.
SkyRay limb_ray(const reference::Planet& planet, double camera_km, double tangent_km, double sun_zenith_deg, double azimuth_deg) {
  const double sine = (planet.ground_radius_km + tangent_km) / (planet.ground_radius_km + camera_km);
  return {camera_km, {sine, 0.0, -std::sqrt((1.0 - sine) * (1.0 + sine))}, reference::direction_from_degrees(sun_zenith_deg, azimuth_deg)};
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
      SkyRay ray{some_altitude(random, planet.top_radius_km - planet.ground_radius_km), some_direction(random), some_direction(random)};
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
    const double altitude_km = i % 3 == 0 ? random.log_uniform(110.0, 384400.0) : i % 3 == 1 ? random.uniform(0.0, 100.0) : random.log_uniform(5e-4, 20.0);
    cameras.insert({altitude_km, i % 2 ? random.uniform(0.0, 90.0) : random.uniform(84.0, 100.0)});
  }
  const std::map<Camera, double> maxima = sky_maxima(planet, cameras);
  std::vector<SkyRay> rays;
  std::vector<double> floors;
  for (const auto& [camera, maximum] : maxima)
    for (int i = 0; i < 7; ++i) {
      const double azimuth_deg = random.uniform(0.0, 360.0);
      if (camera.first > 100.0)
        rays.push_back(limb_ray(planet, camera.first, i % 2 ? random.uniform(0.0, 60.0) : random.uniform(-planet.ground_radius_km, 0.0), camera.second, azimuth_deg));
      else
        rays.push_back(ray_from_degrees(camera.first, i % 2 ? random.uniform(85.0, 95.0) : random.uniform(0.0, 180.0), camera.second, azimuth_deg));
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
      for (double azimuth_deg : {0.0, 60.0, 180.0}) rays.push_back(limb_ray(planet, 400.0, tangent_km, sun_zenith_deg, azimuth_deg));
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
        for (double azimuth_deg : {0.0, 90.0, 180.0}) rays.push_back(limb_ray(planet, camera_km, tangent_km, sun_zenith_deg, azimuth_deg));
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
  const std::vector<Light> entered = march_rays(planet, rays, {}), rounded = march_rays(planet, rays, {.enter_in_double = false});
  Errors moved;
  for (size_t i = 0; i < rays.size(); ++i) moved.add(rounded[i].transmittance, entered[i].transmittance, 1e-6);
  const double naive = moved.maximum();  // a tangent point moved by 0.3 m, through an optical depth of ten
  const double holds = worst_transmittance(planet, rays, truth, {});
  const double radiance = worst_of(planet, rays, truth, {.enter_in_double = false});
  CAPTURE(naive, holds, radiance);
  CHECK(naive > 4e-4);
  CHECK(holds < 2e-3);
  CHECK(radiance < 0.005);  // the shader's own way in is fit for pictures
}

TEST_CASE("hard: a camera exactly on the top, skimming it") {
  // The dip below the top is r mu^2 / 2: at 90.002 degrees 4 m, and at 90.01 it is 0.1 m per ulp of the altitude.
  std::vector<Part> parts;
  std::vector<double> lengths;
  for (double zenith_deg = 90.0005; zenith_deg < 90.02; zenith_deg += 0.0005) {
    const reference::Direction view = reference::direction_from_degrees(zenith_deg, 0.0);
    parts.push_back({{Part::kEnter, 100.0f, float(view[0]), float(view[2])}});
    lengths.push_back(-2.0 * 6460.0 * double(float(view[2])));  // chord through the sphere of the top
  }
  const auto results = evaluate_parts(parts);
  int naive_misses = 0;
  double worst = 0.0;
  for (size_t i = 0; i < parts.size(); ++i) {
    CHECK(results[i][0] == 1.0f);
    if (results[i][2] == 0.0f) ++naive_misses;
    worst = std::max(worst, std::abs(results[i][1] / lengths[i] - 1.0));
  }
  CAPTURE(naive_misses, worst);
  CHECK(naive_misses >= 1);  // top - tangent rounds to 0: the ray is thought to miss
  CHECK(worst < 1e-4);
}

TEST_CASE("hard: a planet whose radii are no floats") {
  // 11271.6 + 84.937 km: as the difference of two float radii the top is 0.5 m too high, so that a camera on it stands
  // inside, and a ray that should skim the top for 0.8 km stays in the air for 160 km.
  reference::Planet planet = reference::earth();
  planet.ground_radius_km = 11271.6, planet.top_radius_km = 11271.6 + 84.937;
  const double top_km = planet.top_radius_km - planet.ground_radius_km;
  std::vector<SkyRay> rays;
  for (double zenith_deg : {90.002, 90.05, 90.2, 91.0, 95.0}) rays.push_back(ray_from_degrees(top_km, zenith_deg, 40.0, 20.0));
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

TEST_CASE("hard: a sun path that dips to the ground") {
  // From 2 km towards a sun whose rays touch the ground, through aerosol of scale height 1.2 km.
  const reference::Planet planet = reference::earth();
  std::vector<Part> parts;
  std::vector<std::array<double, 3>> truth;
  for (double altitude_km : {0.5, 2.0, 5.0, 10.0, 30.0, 60.0})
    for (double tangent_km : {0.001, 0.3, 1.0}) {
      if (tangent_km > altitude_km) continue;
      const double sine = (6360.0 + tangent_km) / (6360.0 + altitude_km);
      const float mu = float(-std::sqrt((1.0 - sine) * (1.0 + sine)));
      const double exact_mu = mu, exact_sine = std::sqrt((1.0 - exact_mu) * (1.0 + exact_mu));
      parts.push_back({{Part::kSunColumns, float(altitude_km), mu, 8.0f}});
      const double r = 6360.0 + double(float(altitude_km));
      truth.push_back(reference::columns(planet, double(float(altitude_km)), exact_mu, exact_sine,
                                         -r * exact_mu + std::sqrt(6460.0 * 6460.0 - r * r * exact_sine * exact_sine)));
    }
  const auto results = evaluate_parts(parts);
  double naive = 0.0, holds = 0.0;
  for (size_t i = 0; i < parts.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      holds = std::max(holds, std::abs(results[i][k] / truth[i][k] - 1.0));
      naive = std::max(naive, std::abs(results[i][3 + k] / truth[i][k] - 1.0));
    }
  CAPTURE(naive, holds);
  CHECK(naive > 0.15);
  CHECK(holds < 0.001);
}

TEST_CASE("hard: a sun path that dips hardly at all") {
  // Twice the column from the tangent point less the column outward: nearly the same number twice.
  const reference::Planet planet = reference::earth();
  std::vector<Part> parts;
  std::vector<double> truth;
  for (double altitude_km : {0.5, 1.0, 3.0, 10.0})
    for (double mu : {-1e-6, -1e-5, -1e-4, -1e-3}) {
      parts.push_back({{Part::kSunColumns, float(altitude_km), float(mu), 8.0f}});
      const double m = float(mu), sine = std::sqrt((1.0 - m) * (1.0 + m)), h = float(altitude_km), r = 6360.0 + h;
      truth.push_back(reference::columns(planet, h, m, sine, -r * m + std::sqrt(6460.0 * 6460.0 - r * r * sine * sine))[1]);
    }
  const auto results = evaluate_parts(parts);
  double naive = 0.0, holds = 0.0;
  for (size_t i = 0; i < parts.size(); ++i) {
    holds = std::max(holds, std::abs(results[i][1] / truth[i] - 1.0));
    naive = std::max(naive, std::abs(results[i][4] / truth[i] - 1.0));
  }
  CAPTURE(naive, holds);
  CHECK(naive > 0.005);
  CHECK(holds < 1e-3);
}

TEST_CASE("hard: half a metre above the ground, looking down") {
  // The ray crosses 0.04 % of a scale height: counted in scale heights its samples would be a few ulp apart.
  const reference::Planet planet = reference::earth();
  std::vector<SkyRay> rays;
  for (double view_zenith_deg : {91.0, 95.0, 120.0, 150.0, 180.0})
    for (double sun_zenith_deg : {0.0, 60.0, 85.0}) rays.push_back(ray_from_degrees(5e-4, view_zenith_deg, sun_zenith_deg, 45.0));
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

TEST_CASE("hard: segments from sample to sample do not tile the ray") {
  std::vector<Part> parts;
  for (int n : {2, 8, 32})
    for (int i = 0; i < n; ++i) parts.push_back({{Part::kSegment, float(kOffset03), float(i), float(n)}});
  const auto results = evaluate_parts(parts);
  size_t next = 0;
  for (int n : {2, 8, 32}) {
    double holds = 0.0, naive = 0.0;
    for (int i = 0; i < n; ++i, ++next) {
      holds += results[next][1];
      naive += results[next][3];
    }
    CAPTURE(n);
    CHECK(holds == Approx(1.0).epsilon(1e-6));
    CHECK(naive == Approx((n - 0.7) / n).epsilon(1e-6));  // 65 % of the ray at two steps
  }
}

TEST_CASE("hard: the mean transmittance of almost no air") {
  std::vector<Part> parts;
  const double taus[] = {0.0, 1e-10, 3e-8, 1e-7, 1e-5, 1e-3, 0.049, 0.051, 1.0, 80.0};
  for (double tau : taus) parts.push_back({{Part::kMeanTransmittance, float(tau)}});
  const auto results = evaluate_parts(parts);
  for (size_t i = 0; i < std::size(taus); ++i) {
    const double tau = float(taus[i]), exact = tau > 0.0 ? -std::expm1(-tau) / tau : 1.0;
    CAPTURE(tau, results[i][0], results[i][1]);
    CHECK(results[i][0] == Approx(exact).epsilon(1e-5));
    if (tau == 0.0) CHECK(std::isnan(results[i][1]));
    // 1 - exp(-tau) is a whole number of 6e-8: nothing, or as much too much as exp() is rounded the wrong way.
    if (tau > 0.0 && tau < 3.1e-8) CHECK(std::abs(results[i][1] - 1.0) > 0.5);
    if (taus[i] == 1e-7) CHECK(std::abs(results[i][1] / exact - 1.0) > 0.1);
  }
}

TEST_CASE("hard: the edge of the planet's shadow from half a metre") {
  // Suns within a thousandth of the horizon's dip, judged by 1 - (R/r)^2 and by the altitude of the tangent point.
  Random random(9);
  std::vector<Part> parts;
  std::vector<bool> up;
  for (int i = 0; i < 20'000; ++i) {
    const float altitude_km = float(random.log_uniform(5e-4, 0.1));
    const double r = 6360.0 + double(altitude_km);
    const double dip = std::sqrt(altitude_km * (2.0 * 6360.0 + altitude_km)) / r;
    const float mu = float(-dip * (1.0 + random.uniform(-0.01, 0.01)));
    if (std::abs(-mu / dip - 1.0) < 1e-4) continue;  // closer than this no float knows its altitude
    parts.push_back({{Part::kSunUp, 6360.0f, altitude_km, mu}});
    up.push_back(-double(mu) <= dip);
  }
  const auto results = evaluate_parts(parts);
  size_t wrong = 0, naive_wrong = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    wrong += (results[i][0] != 0.0f) != up[i];
    naive_wrong += (results[i][1] != 0.0f) != up[i];
  }
  CAPTURE(wrong, naive_wrong, parts.size());
  CHECK(wrong == 0);
  CHECK(double(naive_wrong) > 0.1 * double(parts.size()));
}
