// Terrain: maps from noise and from files, the mesh, depth, and where a map lies on the planet.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "chapters/11_aerial_perspective/relief.hpp"
#include "chapters/11_aerial_perspective/signs.hpp"
#include "chapters/11_aerial_perspective/terrain_map.hpp"
#include "common/image/atomic_file.hpp"
#include "tests/gpu/11_parts.hpp"
#include "tests/unit/temporary.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

std::string refusal(const Terrain& terrain) {
  try {
    make_terrain_map(terrain);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

uint64_t bits_of(const std::vector<float>& values) {
  uint64_t hash = 14695981039346656037ull;
  for (const float value : values) {
    uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211ull;
  }
  return hash;
}

}  // namespace

TEST_CASE("terrain from noise is the same bits every time, level at the rim and as high as asked") {
  const TerrainMap map = make_terrain_map({.size = 256}), again = make_terrain_map({.size = 256}),
                   other = make_terrain_map({.size = 256, .seed = 2});
  CHECK(map.height_km == again.height_km);
  CHECK(map.height_km != other.height_km);
  CHECK(bits_of(map.height_km) == 0x41f7140c1dc916c1ull);
  CHECK(map.highest_km == Approx(3.0).epsilon(1e-6));
  for (int i = 0; i < 256; ++i) CHECK(map.height_km[static_cast<size_t>(i)] == 0.0f);
  CHECK(*std::min_element(map.height_km.begin(), map.height_km.end()) >= 0.0f);
  // The views stand on a knoll: a kilometre away on all sides the ground is lower.
  for (const auto& [x, y] : {std::pair{1.5, 0.0}, {-1.5, 0.0}, {0.0, 1.5}, {0.0, -1.5}})
    CHECK(height_at(map, x, y) < height_at(map, 0.0, 0.0) - 0.04);
  for (const auto& shares : map.cover) CHECK(std::abs(shares[0] + shares[1] + shares[2] + shares[3] - 255) <= 2);
}

TEST_CASE("terrain from a file: what is in it, where it is") {
  const TemporaryDirectory directory;
  const auto file = directory.path / "ramp.png";
  write_height_map(file, 4, 4, [](uint32_t i, uint32_t j) { return 10000 * i + 1000 * j; });
  const TerrainMap map = make_terrain_map({.height_map = file.string(), .extent_km = 8.0, .height_km = 6.5535});
  CHECK(map.size == 4);
  CHECK(height_at(map, -3.0, 3.0) == Approx(0.0));   // north-west: the first sample
  CHECK(height_at(map, 3.0, 3.0) == Approx(3.0));    // north-east
  CHECK(height_at(map, -3.0, -3.0) == Approx(0.3));  // south-west
  CHECK(height_at(map, 0.0, 0.0) == Approx(1.65));
  CHECK(height_at(map, 4.1, 0.0) == 0.0);
  CHECK(map.slope[5][0] == Approx(0.5));    // 1 km a sample of 2 km, to the east
  CHECK(map.slope[5][1] == Approx(-0.05));  // 0.1 km a sample down to the south
}

TEST_CASE("height maps that are none are refused in one line") {
  const TemporaryDirectory directory;
  const auto named = [&](const char* name) { return (directory.path / name).string(); };
  const std::string accepted = "accepted is a square 16-bit grayscale PNG of 2 to 4096 samples a side";
  const auto flat = [](uint32_t, uint32_t) { return 0; };
  write_height_map(named("eight.png"), 4, 4, flat, 8);
  write_height_map(named("oblong.png"), 4, 8, flat);
  write_height_map(named("one.png"), 1, 1, flat);
  write_height_map(named("large.png"), 4097, 4097, flat);
  write_file_atomically(named("text.png"), "this is not a picture, though its name says that it is one");
  CHECK(refusal({.height_map = named("eight.png")}) ==
        "height map: " + named("eight.png") + ": 8 bits a sample, grayscale, where 16-bit grayscale is read; " +
            accepted);
  CHECK(refusal({.height_map = named("oblong.png")}) ==
        "height map: " + named("oblong.png") + ": 4 x 8 samples, not square; " + accepted);
  CHECK(refusal({.height_map = named("one.png")}) ==
        "height map: " + named("one.png") + ": 1 samples a side; " + accepted);
  CHECK(refusal({.height_map = named("large.png")}) ==
        "height map: " + named("large.png") + ": 4097 samples a side; " + accepted);
  CHECK(refusal({.height_map = named("text.png")}) ==
        "height map: " + named("text.png") + ": not a PNG file; " + accepted);
  CHECK(refusal({.height_map = named("missing.png")}).find("missing.png") != std::string::npos);
  // Cut off behind a sound header.
  std::string cut = read_file(named("oblong.png"), 1 << 20);
  write_height_map(named("cut.png"), 8, 8, flat);
  cut = read_file(named("cut.png"), 1 << 20);
  write_file_atomically(named("cut.png"), std::string_view(cut).substr(0, cut.size() - 30));
  CHECK(refusal({.height_map = named("cut.png")}) != "accepted");
}

TEST_CASE("a map wider than its planet is refused") {
  CHECK_NOTHROW(check_fits_planet({.extent_km = 1737.0}, 1737.0));
  CHECK_THROWS_WITH(
      check_fits_planet({.extent_km = 2000.0}, 1737.0),
      "terrain.extent_km: a map of 2000 km on a planet of 1737 km radius; accepted is at most the radius");
}

TEST_CASE("a place of the map and the point above it are inverse, to millimetres") {
  std::vector<AirItem> items;
  Random random(3);
  for (int i = 0; i < 2000; ++i)
    items.push_back(
        {AirPart::planet, {random.uniform(-500, 500), random.uniform(-500, 500), random.uniform(0, 9), 0.0}});
  const std::vector<AirAnswer> answers = evaluate_air(reference::earth(), items);
  double point_km = 0.0, place_km = 0.0, altitude_km = 0.0;
  for (size_t i = 0; i < items.size(); ++i) {
    const double x = double(float(items[i].a[0])), y = double(float(items[i].a[1])), h = double(float(items[i].a[2])),
                 upright = std::sqrt(6360.0 * 6360.0 - x * x - y * y);
    const double truth[3] = {x * (1 + h / 6360.0), y * (1 + h / 6360.0), upright * (1 + h / 6360.0) - 6360.0};
    for (int k = 0; k < 3; ++k) point_km = std::max(point_km, std::abs(answers[i].radiance[k] - truth[k]));
    place_km =
        std::max({place_km, std::abs(answers[i].transmittance[0] - x), std::abs(answers[i].transmittance[1] - y)});
    altitude_km = std::max(altitude_km, std::abs(answers[i].transmittance[2] - h));
  }
  CAPTURE(point_km, place_km, altitude_km);
  CHECK(point_km < 1e-4);  // of 500 km, of which float32 knows 3e-5
  CHECK(place_km < 1.5e-4);
  CHECK(altitude_km < 2e-5);
}

TEST_CASE("scalars: the sun's disc over an edge, shadow height, slices and back") {
  std::vector<AirItem> items;
  const double above[] = {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0}, s[] = {0.25, 1.0, 7.5, 16.0, 31.9, 32.0, 12.0};
  for (int i = 0; i < 7; ++i)
    items.push_back({AirPart::scalars,
                     {above[i], 0.0, 0.0, 0.0},
                     {2.0, 30.0, 0.02, 0.0},
                     {s[i], 32.0, i % 2 == 0 ? 2.0 : 1.0, 0.0}});
  const std::vector<AirAnswer> answers = evaluate_air(reference::earth(), items);
  for (int i = 0; i < 7; ++i) {
    // A circle's segment, counted.
    int inside = 0, over = 0;
    for (int u = -500; u < 500; ++u)
      for (int v = -500; v < 500; ++v) {
        const double x = (u + 0.5) / 500, y = (v + 0.5) / 500;
        if (x * x + y * y < 1.0) ++inside, over += y > -above[i];
      }
    CHECK(answers[i].radiance[0] == Approx(double(over) / inside).margin(2e-3));  // the counting's own error
    CHECK(answers[i].radiance[2] == Approx(2.0 - 0.6 - 900.0 / 12720.0).epsilon(1e-5));
    CHECK(answers[i].transmittance[0] == Approx(s[i]).epsilon(2e-4));
  }
}

TEST_CASE("a surface gives back what falls on it") {
  const std::vector<AirItem> items{
      {AirPart::surface, {0, 0, 1, 0.5}, {0, 0.8, 0.6, 0.2}},    // level: beam 0.5 at cosine 0.6, sky 0.2
      {AirPart::surface, {0, 0, 1, 0.0}, {0, 0.8, 0.6, 0.2}},    // no sun: not black
      {AirPart::surface, {0, 1, 0, 0.5}, {0, 0.8, 0.6, 0.2}},    // a wall facing the sun
      {AirPart::surface, {0, -1, 0, 0.5}, {0, 0.8, 0.6, 0.2}}};  // and its back
  const std::vector<AirAnswer> answers = evaluate_air(reference::earth(), items);
  const double pi = 3.14159265358979323846, level = 0.5 * 0.6 + 0.2, wall = 0.2 * 0.5 + 0.5 * level * 0.5;
  CHECK(answers[0].radiance[0] * pi == Approx(level).epsilon(1e-5));
  CHECK(answers[1].radiance[0] * pi == Approx(0.2).epsilon(1e-5));
  CHECK(answers[2].radiance[0] * pi == Approx(0.5 * 0.8 + wall).epsilon(1e-5));
  CHECK(answers[3].radiance[0] * pi == Approx(wall).epsilon(1e-5));
}

TEST_CASE("each sign stands on the ground at its distance and in its direction") {
  const double radius_km = 6360.0, azimuth = 0.3;
  const SignPlaces places = sign_places(radius_km, azimuth);
  const double distances[] = {1, 2, 5, 10, 20, 50, 100};
  for (int k = 0; k < 7; ++k) {
    const glm::dvec4 place(places[k]);
    CHECK(place.w == Approx(distances[k]).epsilon(1e-7));
    CHECK(std::hypot(place.x, place.y) == Approx(distances[k]).epsilon(1e-7));
    CHECK(std::atan2(place.x, place.y) == Approx(azimuth + (k - 3) * 0.13).margin(1e-6));
    CHECK(std::hypot(place.x, place.y, place.z + radius_km) == Approx(radius_km).epsilon(1e-10));
  }
}

TEST_CASE("a ray meets a sign where its board is, and passes above it and beside its post") {
  const double radius_km = 6360.0;
  std::vector<AirItem> items;
  std::vector<double> expected;
  for (const double d : {1.0, 20.0, 100.0})
    for (const double azimuth : {0.0, 2.0})
      for (const double height : {0.18, 0.3, 0.1}) {  // of the board's middle, above it, beside the post; in distances
        const double above_centre = std::sqrt(radius_km * radius_km - d * d);
        const glm::dvec3 foot(d * std::sin(azimuth), d * std::cos(azimuth), -d * d / (radius_km + above_centre)),
            up = (foot + glm::dvec3(0, 0, radius_km)) / radius_km, side(std::cos(azimuth), -std::sin(azimuth), 0.0);
        // Along the post: the height above the tangent plane's level, and what the ground has fallen by.
        const glm::dvec3 at =
            foot + up * (height * d + 0.5 * d * d / radius_km) + side * (height == 0.1 ? 0.01 * d : 0.0);
        const glm::dvec3 ray = glm::normalize(at);
        items.push_back({AirPart::sign, {0, 0, 0, 0}, {ray.x, ray.y, ray.z, d}, {foot.x, foot.y, foot.z, 0}});
        expected.push_back(height == 0.18 ? glm::length(at) : -1.0);
      }
  const std::vector<AirAnswer> answers = evaluate_air(reference::earth(), items);
  for (size_t i = 0; i < items.size(); ++i) CHECK(answers[i].radiance[0] == Approx(expected[i]).epsilon(2e-6));
}

TEST_CASE("the ground is of unit normals and of albedos between 0 and 1") {
  for (const AirAnswer& answer : evaluate_air(
           reference::earth(), {{AirPart::ground, {0.3, -0.2, 0, 0}, {0.2, 0.3, 0.1, 0.4}, {12.3, -40.0, 1e-6, 0}},
                                {AirPart::ground, {0, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 1.0, 0}}})) {
    CHECK(std::hypot(answer.transmittance[0], answer.transmittance[1], answer.transmittance[2]) ==
          Approx(1.0).epsilon(1e-5));
    for (int k = 0; k < 3; ++k) CHECK((answer.radiance[k] > 0.0 && answer.radiance[k] < 1.0));
  }
}
