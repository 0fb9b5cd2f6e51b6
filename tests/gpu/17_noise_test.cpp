// The density of noise: what must hold whatever the noise is. Coverage 0 and 1, bounds, boundaries, types, precision
// far from the origin, the user's map; and what a scene without noise does not have.
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "common/app/camera.hpp"
#include "common/image/png.hpp"
#include "tests/gpu/17_clouds.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

Cloud noise(double coverage, std::optional<double> type = {}, int seed = 1) {
  return {.kind = "noise", .base_km = 1.5, .top_km = 4.0, .coverage = coverage, .type = type, .seed = seed};
}

std::vector<CloudPlace> places(size_t count, double low_km = 1.5, double high_km = 4.0) {
  Random random(9);
  std::vector<CloudPlace> list;
  for (size_t i = 0; i < count; ++i)
    list.push_back(
        place_above(random.uniform(-150.0, 150.0), random.uniform(-150.0, 150.0), random.uniform(low_km, high_km)));
  return list;
}

// The share of places that are in cloud, and the mean density of all.
struct Cover {
  double share = 0.0, mean = 0.0, largest = 0.0;
};
Cover cover_of(const std::vector<std::array<double, 4>>& answers, size_t form = 2) {
  Cover cover;
  for (const auto& answer : answers) {
    cover.share += (answer[form] > 0.0) / double(answers.size());
    cover.mean += answer[form] / double(answers.size());
    cover.largest = std::max(cover.largest, answer[form]);
  }
  return cover;
}

std::string refused(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    CHECK(error.exit_code == Exit::usage);
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("hard: coverage 0 is a clear sky everywhere, 1 a full one, and more is never less") {
  const std::vector<CloudPlace> list = places(4000);
  for (const std::optional<double> type : {std::optional<double>(), std::optional(0.0), std::optional(2.0 / 7.0),
                                           std::optional(4.0 / 7.0), std::optional(1.0)}) {
    const auto none = CloudRun(scene_of({noise(0.0, type)})).densities(list);
    for (const auto& answer : none)
      for (const double value : answer) REQUIRE(value == 0.0);
    std::vector<std::array<double, 4>> before = none;
    for (const double coverage : {0.3, 0.5, 0.7, 1.0}) {
      const auto more = CloudRun(scene_of({noise(coverage, type)})).densities(list);
      for (size_t i = 0; i < list.size(); ++i) REQUIRE(more[i][0] >= before[i][0] - 1e-6);
      before = more;
    }
    CHECK(cover_of(before).mean > 0.02);
  }
  // A full sky of a sheet has no hole: every vertical ray meets cloud.
  for (const double type : {0.0, 6.0 / 7.0, 1.0}) {
    const CloudRun run(scene_of({noise(1.0, type)}));
    std::vector<app::ProbeRay> up;
    for (const CloudPlace& place : places(400))
      up.push_back(ray_from({place.offset_km.x, place.offset_km.y, 0.1}, {0, 0, 1}));
    std::vector<app::ProbeRay> near_by;
    for (const app::ProbeRay& ray : up)
      if (std::hypot(ray.position_km.x, ray.position_km.y) < 30.0) near_by.push_back(ray);
    const std::vector<double> depths = run.optical_depths(near_by);
    CAPTURE(type, *std::min_element(depths.begin(), depths.end()));
    CHECK(*std::min_element(depths.begin(), depths.end()) > 0.5);
  }
}

TEST_CASE("density is within its bounds, the shape alone bounds the others, and detail takes some") {
  const std::vector<CloudPlace> list = places(20000);
  const auto answers = CloudRun(scene_of({noise(0.6)})).densities(list);
  for (const auto& answer : answers) {
    for (int form = 0; form < 3; ++form) REQUIRE((answer[form] >= 0.0 && answer[form] <= 1.0));
    REQUIRE(answer[1] <= answer[0] + 1e-6);
    REQUIRE(answer[2] <= answer[0] + 1e-6);
    REQUIRE(answer[3] == Approx(40.0 * answer[2]));
  }
  const Cover shape = cover_of(answers, 0), cheap = cover_of(answers, 1), full = cover_of(answers, 2);
  CAPTURE(shape.share, shape.mean, cheap.mean, full.mean, full.largest);
  CHECK(shape.share > 0.05);
  CHECK(full.mean < 0.95 * shape.mean);
  CHECK(full.mean > 0.2 * shape.mean);
  CHECK(full.largest > 0.3);
}

TEST_CASE("hard: nothing outside of base and top, and no step at either") {
  const CloudRun run(scene_of({noise(0.8, 1.0)}));
  const auto densities = [&](double altitude_km) {
    std::vector<CloudPlace> list = places(2000);
    for (CloudPlace& place : list) {
      const double scale = (6360.0 + altitude_km) / (6360.0 + place.altitude_km);
      place.offset_km = (place.offset_km + glm::dvec3(0, 0, 6360.0)) * scale - glm::dvec3(0, 0, 6360.0);
      place.altitude_km = altitude_km;
    }
    return cover_of(run.densities(list));
  };
  for (const double outside_km : {0.0, 1.4999, 1.5, 4.0, 4.0001, 400.0}) CHECK(densities(outside_km).share == 0.0);
  CHECK(densities(1.502).largest < 0.05);
  CHECK(densities(3.0).share > 0.3);
  CHECK(densities(3.999).largest < 0.01);
}

TEST_CASE("eight types stand in the parts of the layer that are theirs") {
  const auto heights = [&](double type) {
    const auto list = places(6000);
    const auto answers = CloudRun(scene_of({noise(0.8, type / 7.0)})).densities(list);
    double sum = 0.0, mean = 0.0, highest = 0.0;
    for (size_t i = 0; i < list.size(); ++i) {
      const double height = (list[i].altitude_km - 1.5) / 2.5;
      sum += answers[i][2], mean += answers[i][2] * height;
      if (answers[i][2] > 0.0) highest = std::max(highest, height);
    }
    REQUIRE(sum > 0.0);
    return std::array{mean / sum, highest};
  };
  const auto stratus = heights(0), stratocumulus = heights(1), cumulus = heights(2), congestus = heights(3),
             cumulonimbus = heights(4), altocumulus = heights(5), altostratus = heights(6), nimbostratus = heights(7);
  CAPTURE(stratus, stratocumulus, cumulus, congestus, cumulonimbus, altocumulus, altostratus, nimbostratus);
  CHECK(stratus[1] < 0.25);
  CHECK(stratus[0] < stratocumulus[0]);
  CHECK(cumulus[1] < congestus[1]);
  CHECK(congestus[0] < cumulonimbus[0]);
  CHECK(cumulonimbus[1] > 0.9);  // the anvil
  CHECK(altocumulus[0] > 0.5);
  CHECK((altostratus[0] > 0.45 && altostratus[0] < 0.7));
  CHECK((nimbostratus[0] > 0.1 && nimbostratus[0] < 0.45));
}

TEST_CASE("hard: far from the origin the field does not depend on how a place is split") {
  // Under a weather that is the same everywhere (a place on its map is known to a metre there), and not of 8 bits.
  const auto file = std::filesystem::temp_directory_path() / fmt::format("welkin_even_{}.png", getpid());
  image::write_png8(file, {.width = 2, .height = 2, .rgba = std::vector<uint8_t>(16, 200)});
  Cloud even = noise(0.5, 2.0 / 7.0);
  even.weather = file.string();
  const CloudRun run(scene_of({even}), {{"noise.format", "half"}});
  // Points that a far origin and an offset give; the same points by another origin; and by one sum, as float32 rounds
  // it.
  std::vector<CloudPlace> split, other, summed;
  const CloudPlace far = place_above(9990.0, 100.0, 2.2);
  const glm::dvec3 origin = glm::dvec3(glm::vec3(far.offset_km));
  const glm::dvec3 up = glm::normalize(origin + glm::dvec3(0, 0, 6360.0)),
                   along = glm::normalize(glm::cross(up, glm::dvec3(0, 1, 0)));
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 offset = glm::dvec3(glm::vec3(along * (0.0123 * i))), place = origin + offset,
                     rounded = glm::dvec3(glm::vec3(place));
    split.push_back({origin, offset, 2.2}), other.push_back({rounded, place - rounded, 2.2});
    summed.push_back({rounded, glm::dvec3(0.0), 2.2});
  }
  const auto one = run.densities(split), two = run.densities(other), rough = run.densities(summed);
  const auto largest = [](const auto& a, const auto& b) {
    double difference = 0.0;
    for (size_t i = 0; i < a.size(); ++i) difference = std::max(difference, std::abs(a[i][0] - b[i][0]));
    return difference;
  };
  CAPTURE(largest(one, two), largest(one, rough), cover_of(one).share);
  CHECK(cover_of(one).share > 0.1);
  // What is left are the steps of the sampler's weights, 1/256 of a texel, on both sides; places themselves are known
  // to 0.1 m (hard: a position is wrapped around exactly).
  CHECK(largest(one, two) < 2e-3);
  CHECK(largest(one, rough) < 3e-3);
  std::filesystem::remove(file);
}

TEST_CASE("seeds show other clouds, and the field does not repeat after a period of its textures") {
  const auto list = places(3000);
  const auto one = CloudRun(scene_of({noise(0.6, {}, 1)})).densities(list),
             two = CloudRun(scene_of({noise(0.6, {}, 2)})).densities(list);
  double same = 0.0;
  for (size_t i = 0; i < list.size(); ++i) same += one[i][2] == two[i][2] && one[i][2] > 0.0;
  CHECK(same < 10);
  // Correlation of the field with itself, moved by a period of the base texture (16 km) and of the weather (96 km).
  const CloudRun run(scene_of({noise(0.6, 2.0 / 7.0)}));
  const auto correlation = [&](double east_km, double north_km) {
    std::vector<CloudPlace> a, b;
    Random random(4);
    for (int i = 0; i < 6000; ++i) {
      const double x = random.uniform(-80.0, 80.0), y = random.uniform(-80.0, 80.0);
      a.push_back(place_above(x, y, 1.9)), b.push_back(place_above(x + east_km, y + north_km, 1.9));
    }
    const auto u = run.densities(a), v = run.densities(b);
    double mu = 0, mv = 0, uu = 0, vv = 0, uv = 0;
    for (size_t i = 0; i < a.size(); ++i) mu += u[i][0] / double(a.size()), mv += v[i][0] / double(a.size());
    for (size_t i = 0; i < a.size(); ++i)
      uu += (u[i][0] - mu) * (u[i][0] - mu), vv += (v[i][0] - mv) * (v[i][0] - mv),
          uv += (u[i][0] - mu) * (v[i][0] - mv);
    return uv / std::sqrt(uu * vv);
  };
  CHECK(correlation(0.0, 0.0) == Approx(1.0));
  for (const auto& [east, north] : {std::pair(16.0, 0.0), std::pair(0.0, 16.0), std::pair(16.0, 16.0),
                                    std::pair(96.0, 0.0), std::pair(0.0, 96.0)}) {
    CAPTURE(east, north, correlation(east, north));
    CHECK(correlation(east, north) < 0.6);
  }
}

TEST_CASE("a user's weather map is read as it is painted; any other picture is one line") {
  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() / fmt::format("welkin_map_{}", getpid());
  std::filesystem::create_directory(directory);
  const auto file = directory / "weather.png";
  // The west covered, the east clear.
  Image8 picture{.width = 64, .height = 64};
  for (int i = 0; i < 64 * 64; ++i) {
    const uint8_t coverage = i % 64 < 32 ? 255 : 0;
    for (const uint8_t value : {coverage, uint8_t{255}, uint8_t{0}, uint8_t{128}}) picture.rgba.push_back(value);
  }
  image::write_png8(file, picture);
  Cloud cloud = noise(0.5, 1.0);
  cloud.weather = file.string(), cloud.extent_km = 40.0;
  const CloudRun run(scene_of({cloud}));
  std::vector<CloudPlace> west, east;
  for (int i = 0; i < 500; ++i)
    west.push_back(place_above(-15.0 + 0.02 * i, 0.03 * i - 7.0, 2.2)),
        east.push_back(place_above(5.0 + 0.02 * i, 0.03 * i - 7.0, 2.2));
  CHECK(cover_of(run.densities(west)).share > 0.9);
  CHECK(cover_of(run.densities(east)).share == 0.0);

  const auto refuse = [&](const std::filesystem::path& wrong) { return refused([&] { read_weather_map(wrong); }); };
  write_height_map(
      directory / "gray.png", 64, 64, [](uint32_t, uint32_t) { return 1000; }, 16);
  CHECK_THAT(refuse(directory / "gray.png"),
             Catch::Contains("64 x 64 pixels, not 8-bit RGBA; accepted is a square PNG of 2 to 4096"));
  picture.height = 32, picture.rgba.resize(64 * 32 * 4);
  image::write_png8(directory / "oblong.png", picture);
  CHECK_THAT(refuse(directory / "oblong.png"), Catch::Contains("64 x 32 pixels; accepted is a square PNG"));
  CHECK_THAT(refuse(directory / "missing.png"), Catch::Contains("missing.png"));
  CHECK_THAT(refused([&] {
               Cloud absent = noise(0.5);
               absent.weather = (directory / "missing.png").string();
               CloudRun(scene_of({absent})).densities(west);
             }),
             Catch::Contains("missing.png"));
  std::filesystem::remove_all(directory);
}
