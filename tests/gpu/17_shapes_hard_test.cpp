// Hard cases of chapter 17: the naive form fails beside the one that holds. Figures stand in docs/hard_cases.md.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "chapters/17_cloud_shapes/grid_file.hpp"
#include "common/app/camera.hpp"
#include "common/image/atomic_file.hpp"
#include "tests/gpu/17_clouds.hpp"

using namespace welkin;
using namespace welkin::test;

namespace {

constexpr double kR = 6360.0;

// Length of a line inside a shell from the floats that the shader gets; closest approach in long double.
long double shell_length(float h, float mu, float sine, double base_km, double top_km) {
  const long double r = kR + static_cast<long double>(h),
                    norm = std::sqrt(static_cast<long double>(mu) * mu + static_cast<long double>(sine) * sine);
  const long double along = r * mu / norm, closest = r * sine / norm;
  const auto part = [&](double altitude_km) -> std::pair<long double, long double> {
    const long double R = kR + altitude_km;
    if (closest >= R) return {0.0L, 0.0L};
    const long double root = std::sqrt((R - closest) * (R + closest));
    return {std::max(-along - root, 0.0L), std::max(-along + root, 0.0L)};
  };
  const auto top = part(top_km), base = part(base_km);
  return (top.second - top.first) - (base.second - base.first);
}

struct Worst {
  double robust = 0.0, naive = 0.0;
};

double spans_length(const std::array<double, 8>& answer, size_t first) {
  return std::max(answer[first + 1] - answer[first], 0.0) + std::max(answer[first + 3] - answer[first + 2], 0.0);
}

// Rays from an altitude whose tangent points lie between two altitudes; errors of the length inside 1.5 to 4 km.
Worst shell_errors(double altitude_km, double lowest_km, double highest_km, bool down) {
  Random random(8);
  std::vector<ShapeItem> items;
  std::vector<std::array<float, 3>> exact;
  for (int i = 0; i < 4000; ++i) {
    const double sine = std::min((kR + random.uniform(lowest_km, highest_km)) / (kR + altitude_km), 1.0);
    const double mu = (down ? -1.0 : 1.0) * std::sqrt((1.0 - sine) * (1.0 + sine));
    exact.push_back({static_cast<float>(altitude_km), static_cast<float>(mu), static_cast<float>(sine)});
    items.push_back({ShapePart::shell, {kR, altitude_km, mu, sine, 1.5, 4.0}});
  }
  Worst worst;
  const auto answers = evaluate_shapes(items);
  for (size_t i = 0; i < items.size(); ++i) {
    const double length = static_cast<double>(shell_length(exact[i][0], exact[i][1], exact[i][2], 1.5, 4.0));
    worst.robust = std::max(worst.robust, std::abs(spans_length(answers[i], 0) - length));
    worst.naive = std::max(worst.naive, std::abs(spans_length(answers[i], 4) - length));
  }
  return worst;
}

std::string refused(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    CHECK(error.exit_code == Exit::usage);
    const std::string line = error.what();
    CHECK(std::none_of(line.begin(), line.end(), [](unsigned char c) { return c < 0x20; }));
    return line;
  }
  return "accepted";
}

}  // namespace

TEST_CASE("hard: the length inside a shell, from the ground, from inside and from an airliner") {
  // Steep enough not to touch base or top: there the length itself has no digits.
  const Worst ground = shell_errors(0.0005, -5000.0, 0.0, false), inside = shell_errors(2.5, 0.1, 1.3, true),
              airliner = shell_errors(11.0, -3000.0, 1.2, true);
  CAPTURE(ground.robust, ground.naive, inside.robust, inside.naive, airliner.robust, airliner.naive);
  CHECK(ground.robust < 2e-4);
  CHECK(ground.naive > 5.0 * ground.robust);
  CHECK(inside.robust < 5e-3);
  CHECK(airliner.robust < 5e-3);
  CHECK(airliner.naive > airliner.robust);
}

TEST_CASE("hard: from space a cloud is counted from its top and not from the camera") {
  // Straight down and obliquely, 2.5 km of cloud: from the camera, floats lie 4 m apart.
  std::vector<ShapeItem> below, far;
  std::vector<double> lengths;
  for (const double h : {400.0, 36000.0, 378000.0})
    for (int i = 0; i < 200; ++i) {
      const double sine = (kR - 30.0) * i / 200.0 / (kR + h), mu = -std::sqrt((1.0 - sine) * (1.0 + sine));
      below.push_back({ShapePart::ceiling, {kR, 4.0, h, mu, sine}});
      far.push_back({ShapePart::shell, {kR, h, mu, sine, 1.5, 4.0}});
      // The first of the two passages, which the ground ends.
      const double along = (kR + h) * mu, closest2 = std::pow((kR + h) * sine, 2);
      lengths.push_back((-along - std::sqrt(std::pow(kR + 1.5, 2) - closest2)) -
                        (-along - std::sqrt(std::pow(kR + 4.0, 2) - closest2)));
    }
  const auto moved = evaluate_shapes(below), naive = evaluate_shapes(far);
  std::vector<ShapeItem> near_by;
  for (const auto& ray : moved) near_by.push_back({ShapePart::shell, {kR, ray[0], ray[1], ray[2], 1.5, 4.0}});
  const auto robust = evaluate_shapes(near_by);
  Worst worst;
  for (size_t i = 0; i < lengths.size(); ++i) {
    CHECK(moved[i][0] == 4.0);
    worst.robust = std::max(worst.robust, std::abs(robust[i][1] - robust[i][0] - lengths[i]) / lengths[i]);
    worst.naive = std::max(worst.naive, std::abs(naive[i][1] - naive[i][0] - lengths[i]) / lengths[i]);
  }
  CAPTURE(worst.robust, worst.naive);
  CHECK(worst.robust < 2e-4);
  CHECK(worst.naive > 5e-3);  // up to 32 m of 2.5 km
}

TEST_CASE("hard: exactly on the base, exactly on the top, level, up and down") {
  const auto spans = [](double h, double mu) {
    return evaluate_shapes({{ShapePart::shell, {kR, h, mu, std::sqrt(1.0 - mu * mu), 1.5, 4.0}}}).front();
  };
  CHECK(spans_length(spans(1.5, 1.0), 0) == Approx(2.5));
  CHECK(spans_length(spans(1.5, 0.0), 0) == Approx(std::sqrt(2.5 * (2 * kR + 5.5))).epsilon(1e-5));
  CHECK(spans_length(spans(4.0, 1.0), 0) == 0.0);
  CHECK(spans_length(spans(4.0, 0.0), 0) == 0.0);
  CHECK(spans_length(spans(4.0, -1.0), 0) == Approx(5.0));                // without a ground, both passages
  CHECK(spans_length(spans(1.5, -1.0), 0) == Approx(2.5).epsilon(1e-3));  // beyond the planet
  const auto ground = [](double h, double mu) {
    return evaluate_shapes({{ShapePart::ground, {kR, h, mu, std::sqrt(1.0 - mu * mu)}}}).front()[0];
  };
  CHECK(ground(0.0005, -1.0) == Approx(0.0005).epsilon(1e-6));
  CHECK(ground(36000.0, -1.0) == Approx(36000.0));
  CHECK(ground(0.0, -0.5) == 0.0);
  for (const double mu : {0.0, 0.5, 1.0}) CHECK(ground(0.0, mu) > 1e8);
  CHECK(ground(-1.0, 1.0) > 1e8);
  CHECK(ground(2.0, -0.01) > 1e8);  // 0.6 degrees down from 2 km: over the horizon
  // With the ground: a camera on it, in it, and one that looks down from the cloud.
  const CloudRun run(scene_of({{.kind = "layer", .base_km = 1.5, .top_km = 4.0, .extinction_per_km = 1.0}}));
  const std::vector<double> depths =
      run.optical_depths({ray_up(0.0, 0.0), ray_up(0.0, 90.0), ray_up(0.0, 91.0), ray_up(1.5, 180.0),
                          ray_up(4.0, 180.0), ray_up(4.0, 0.0), ray_from({0, 0, -1.0}, {0, 0, 1}), ray_up(3.0, 180.0)});
  const std::vector<double> wanted{2.5, 87.514, 0.0, 0.0, 2.5, 0.0, 2.5, 1.5};
  for (size_t i = 0; i < wanted.size(); ++i) {
    CAPTURE(i, depths[i]);
    CHECK(depths[i] == Approx(wanted[i]).epsilon(1e-3).margin(1e-6));
  }
}

TEST_CASE("hard: a thin ball a thousand km away") {
  Random random(2);
  std::vector<ShapeItem> items;
  std::vector<double> lengths;
  for (int i = 0; i < 2000; ++i) {
    const float b = static_cast<float>(random.uniform(0.0, 0.45));
    // Along z with an offset across: the closest distance is known without arithmetic.
    items.push_back({ShapePart::sphere, {b, 0.0, -1000.0, 0.0, 0.0, 1.0, 0.5}});
    lengths.push_back(2.0 * std::sqrt((0.5 - double(b)) * (0.5 + double(b))));
  }
  Worst worst;
  const auto answers = evaluate_shapes(items);
  for (size_t i = 0; i < items.size(); ++i) {
    worst.robust = std::max(worst.robust, std::abs(answers[i][1] - answers[i][0] - lengths[i]));
    worst.naive = std::max(worst.naive, std::abs(answers[i][5] - answers[i][4] - lengths[i]));
  }
  CAPTURE(worst.robust, worst.naive);
  CHECK(worst.robust < 2e-4);
  CHECK(worst.naive > 0.05);  // b^2 - c has lost the ball
}

TEST_CASE("hard: the cone of a small disc, from the planet's centre and from the disc") {
  Random random(6);
  std::vector<ShapeItem> items;
  std::vector<double> lengths;
  const double radius = 0.5, base = kR + 1.5, angle = std::atan(radius / base);
  for (int i = 0; i < 2000; ++i) {
    const double x = random.uniform(-0.4, 0.4), azimuth = random.uniform(0.0, 6.28);
    // A level ray across the foot: the cone is a circle there.
    const glm::dvec3 d(std::cos(azimuth), std::sin(azimuth), 0.0), from = glm::dvec3(-d.y, d.x, 0.0) * x - d * 3.0;
    items.push_back(
        {ShapePart::cone, {from.x, from.y, from.z, d.x, d.y, d.z, 0.0, 0.0, 1.0, radius, radius / base, base, angle}});
    lengths.push_back(2.0 * std::sqrt(radius * radius - x * x));
  }
  Worst worst;
  const auto answers = evaluate_shapes(items);
  for (size_t i = 0; i < items.size(); ++i) {
    worst.robust = std::max(worst.robust, std::abs(answers[i][1] - answers[i][0] - lengths[i]));
    worst.naive = std::max(worst.naive, std::abs(answers[i][5] - answers[i][4] - lengths[i]));
  }
  CAPTURE(worst.robust, worst.naive);
  CHECK(worst.robust < 1e-5);
  CHECK(worst.naive > 0.1);
}

TEST_CASE("hard: boxes along their axes, in their faces and past their edges") {
  const auto span = [](glm::dvec3 from, glm::dvec3 d) {
    const auto a = evaluate_shapes({{ShapePart::box, {from.x, from.y, from.z, d.x, d.y, d.z, 2.0, 3.0, 1.0}}}).front();
    CHECK((std::isfinite(a[0]) && std::isfinite(a[1])));
    return std::max(a[1] - a[0], 0.0);
  };
  CHECK(span({-1, 1, 0.5}, {1, 0, 0}) == Approx(2.0));
  CHECK(span({1, 1, 5}, {0, 0, -1}) == Approx(1.0));
  CHECK(span({-1, 3.0, 0.5}, {1, 0, 0}) == Approx(2.0));          // in a face
  CHECK(span({-1, 3.0001, 0.5}, {1, 0, 0}) == 0.0);               // beside it
  CHECK(span({0, 0, -1}, {0, 0, 1}) == Approx(1.0));              // along an edge
  CHECK(span({-1, 1, 0.5}, {1, 1e-20, -1e-30}) == Approx(2.0));   // 0/0 in a slab test
  CHECK(span({1, 1, 0.5}, {0.6, 0.8, 0.0}) == Approx(2.916667));  // from inside, both ends
}

TEST_CASE("hard: remapping with its bounds, and as it is misprinted") {
  std::vector<ShapeItem> items;
  for (const double x : {0.0, 0.2, 0.5, 0.9, 1.0})
    for (const double threshold : {-0.5, 0.0, 0.4, 0.9, 1.0, 1.5})
      items.push_back({ShapePart::remapped, {x, threshold, 0.5, 0.0, 0.5, 0.5, 0.3}});
  double printed = 0.0;
  size_t naive_not_finite = 0, naive_outside = 0;
  const auto answers = evaluate_shapes(items);
  for (size_t i = 0; i < items.size(); ++i) {
    const double x = items[i].values[0], threshold = items[i].values[1];
    CAPTURE(x, threshold, answers[i][0]);
    const double wanted = threshold < 1.0 ? std::clamp((x - threshold) / (1.0 - threshold), 0.0, 1.0) : 0.0;
    CHECK(answers[i][0] == Approx(wanted).margin(1e-6));
    if (threshold < 1.0) printed = std::max(printed, std::abs(answers[i][3]));
    naive_not_finite += !std::isfinite(answers[i][4]);
    naive_outside += answers[i][4] < 0.0 || answers[i][4] > 1.0;
  }
  CHECK(printed == 0.0);  // to (0, 0): no cloud, whatever the noise
  CHECK(naive_not_finite >= 1);
  CHECK(naive_outside >= 5);
}

TEST_CASE("hard: the way along the ground to a place beyond a quarter of the planet") {
  Worst worst;
  std::vector<ShapeItem> items;
  std::vector<double> ways;
  for (const double way_km : {0.5, 30.0, 600.0, 2500.0, 5000.0, 9900.0, 13000.0}) {
    const CloudPlace place = place_above(way_km * 0.6, way_km * 0.8, 2.0);
    items.push_back({ShapePart::ground_way, {kR, place.offset_km.x, place.offset_km.y, place.offset_km.z}});
    ways.push_back(way_km);
  }
  const auto answers = evaluate_shapes(items);
  for (size_t i = 0; i < ways.size(); ++i) {
    const double got = std::hypot(answers[i][0], answers[i][1]);
    CAPTURE(ways[i], got - ways[i], std::hypot(answers[i][4], answers[i][5]) - ways[i]);
    CHECK(got == Approx(ways[i]).epsilon(3e-6));
    CHECK(answers[i][1] / answers[i][0] == Approx(4.0 / 3.0).epsilon(1e-5));
    worst.naive = std::max(worst.naive, std::abs(std::hypot(answers[i][4], answers[i][5]) - ways[i]));
    worst.robust = std::max(worst.robust, std::abs(got - ways[i]));
  }
  CAPTURE(worst.robust, worst.naive);
  CHECK(worst.robust < 0.05);
  CHECK(worst.naive > 5000.0);  // 13,000 km taken for 6,980
}

TEST_CASE("hard: a position is wrapped around exactly, 10,000 km from the origin") {
  std::vector<ShapeItem> items;
  std::vector<std::array<double, 3>> exact;
  Random random(12);
  for (int i = 0; i < 3000; ++i) {
    const double period = i % 3 == 0 ? 16.0 : i % 3 == 1 ? 12.0 : 6.0, wrap = 49.0 * period;
    std::array<float, 6> p{};
    for (int k = 0; k < 3; ++k)
      p[k] = static_cast<float>(random.uniform(-9000.0, 9000.0)),
      p[k + 3] = static_cast<float>(random.uniform(-20.0, 20.0));
    items.push_back({ShapePart::noise_place, {p[0], p[1], p[2], p[3], p[4], p[5], period}});
    std::array<double, 3> q{};
    for (int k = 0; k < 3; ++k) q[k] = double(p[k]) - wrap * std::floor(double(p[k]) / wrap) + double(p[k + 3]);
    exact.push_back({(24 * q[1] + 40 * q[2] - 15 * q[0]) / wrap, (40 * q[0] + 24 * q[2] - 15 * q[1]) / wrap,
                     (24 * q[0] + 40 * q[1] - 15 * q[2]) / wrap});
  }
  const auto answers = evaluate_shapes(items);
  double worst_km = 0.0, naive_km = 0.0;
  for (size_t i = 0; i < items.size(); ++i) {
    const double period = items[i].values[6];
    for (size_t k = 0; k < 3; ++k) {
      worst_km = std::max(worst_km, std::abs(answers[i][k] - exact[i][k]) * period);
      naive_km =
          std::max(naive_km, std::abs(answers[i][4 + k] * period - (items[i].values[k] + items[i].values[k + 3])));
    }
  }
  CAPTURE(worst_km, naive_km);
  CHECK(worst_km < 3e-4);
  CHECK(naive_km > 3.0 * worst_km);
}

TEST_CASE("hard: corners are not texels: half a texel is a third of a cloud's edge; and what eight bits of filter do") {
  const GridFile file("cumulus");
  const auto run = [&](const char* format) {
    return CloudRun(scene_of({{.kind = "grid",
                               .up_km = 10.0,
                               .file = file.path().string(),
                               .size_km = file.size_km,
                               .extinction_per_km = 1.0}}),
                    {{"cloud.grid_format", format}});
  };
  Random random(21);
  std::vector<CloudPlace> list;
  std::vector<double> truth, shifted;
  const auto sample = [&](double x, double y, double z) {  // trilinear between corners, in double
    const auto& n = file.corners;
    const double p[3] = {std::clamp(x, 0.0, n[0] - 1.0), std::clamp(y, 0.0, n[1] - 1.0),
                         std::clamp(z, 0.0, n[2] - 1.0)};
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      int at[3];
      for (int k = 0; k < 3; ++k) {
        const int low = std::min(static_cast<int>(p[k]), n[k] - 2), up = corner >> k & 1;
        weight *= up ? p[k] - low : 1.0 - (p[k] - low), at[k] = low + up;
      }
      sum += weight * double(file.density[(size_t(at[2]) * n[1] + at[1]) * n[0] + at[0]]);
    }
    return sum;
  };
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 way(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
    const glm::dvec3 place = glm::dvec3(glm::vec3(way * file.size_km + glm::dvec3(0, 0, 10.0)));
    const glm::dvec3 p = (place - glm::dvec3(0, 0, 10.0)) / file.size_km;
    list.push_back({.offset_km = place, .altitude_km = place.z});
    truth.push_back(sample(p.x * 64, p.y * 64, p.z * 64));
    shifted.push_back(sample(p.x * 65 - 0.5, p.y * 65 - 0.5, p.z * 65 - 0.5));  // u = x / l, as for a picture
  }
  const auto worst = [&](const std::vector<std::array<double, 4>>& got) {
    double error = 0.0;
    for (size_t i = 0; i < got.size(); ++i) error = std::max(error, std::abs(got[i][2] - truth[i]));
    return error;
  };
  const double exact = worst(run("float").densities(list, 0)), filtered = worst(run("float").densities(list, 1)),
               bytes_exact = worst(run("bytes").densities(list, 0)), bytes = worst(run("bytes").densities(list, 1));
  double shift = 0.0;
  for (size_t i = 0; i < truth.size(); ++i) shift = std::max(shift, std::abs(shifted[i] - truth[i]));
  CAPTURE(exact, filtered, bytes_exact, bytes, shift);
  CHECK(exact < 2e-5);
  CHECK(bytes_exact < 2e-5);  // every sample is a multiple of 1/255
  CHECK(filtered < 0.02);     // 2e-5 where weights are float32 (this driver), 1/256 of a step where they have 8 bits
  CHECK(bytes < 0.02);
  CHECK(bytes > exact);  // this driver filters bytes to 8 bits: 4e-3
  CHECK(shift > 0.09);
}

TEST_CASE("hard: the number of steps is no knob of brightness") {
  // A homogeneous stretch: any number of steps gives the same; a cloud of noise converges.
  const std::vector<app::ProbeRay> rays{ray_up(0.5, 10.0), ray_up(0.5, 45.0, 30.0), ray_up(0.5, 60.0, 200.0),
                                        ray_up(9.0, 150.0, 90.0)};
  std::vector<double> sums;
  for (const char* steps : {"16", "32", "64", "128", "256"}) {
    const CloudRun run(scene_of({{.kind = "noise", .base_km = 1.5, .top_km = 4.0, .coverage = 1.0, .type = 1.0}}),
                       {{"cloud.steps", steps}});
    double sum = 0.0;
    for (const double depth : run.optical_depths(rays)) sum += depth;
    sums.push_back(sum);
  }
  CAPTURE(sums);
  for (const double sum : sums) CHECK(sum == Approx(sums.back()).epsilon(0.1));
  CHECK(std::abs(sums[3] - sums[4]) < std::abs(sums[0] - sums[4]) + 1e-3 * sums[4]);
}

TEST_CASE("hard: grid files that are no grids give one line") {
  const GridFile file("deck");
  const std::string good = read_file(file.path(), 1 << 24);
  const auto wrong = file.path().string() + ".wrong";
  const auto refuse = [&](const std::string& bytes) {
    std::ofstream(wrong, std::ios::binary) << bytes;
    return refused([&] { read_grid(wrong); });
  };
  CHECK(refuse(good) == "accepted");
  CHECK_THAT(refuse(good.substr(0, good.size() - 1)), Catch::EndsWith("287555 bytes; 65 x 65 x 17 corners are 287556"));
  CHECK_THAT(refuse(good + "x"), Catch::Contains("287557 bytes"));
  CHECK_THAT(refuse(good.substr(0, 100)), Catch::Contains("accepted is a file that begins with 256 bytes of text"));
  CHECK_THAT(refuse(""), Catch::Contains("welkin-grid 1"));
  const auto with_corners = [&](const std::string& corners) {
    std::string text = "welkin-grid 1\nname x\nbox_km 1 1 1\n" + corners + "\n";
    text.resize(256, ' ');
    return refuse(text + good.substr(256));
  };
  for (const char* corners : {"corners 1 65 17", "corners 65 65", "corners 65 65 17 2", "corners 600 600 600",
                              "corners -65 65 17", "corners 99999999999999999999 2 2", "corners nan 2 2"})
    CHECK_THAT(with_corners(corners), Catch::Contains(fmt::format("{}; accepted is a line \"corners nx", corners)));
  CHECK_THAT(with_corners("corners 3 3 3\ncorners 65 65 17"), Catch::Contains("2 lines \"corners …\""));
  CHECK_THAT(with_corners("corners 65 65 17\nbox_km 1 1 1"), Catch::Contains("2 lines \"box_km …\""));
  for (const char* magic : {"welkin-grid 2\n", "welkin-grid 12\n", "welkin-grid 1"})
    CHECK_THAT(refuse(magic + good.substr(14)), Catch::Contains("the first line \"welkin-grid 1\""));
  for (const char* box : {"box_km nan x -1", "box_km 0 1 1", "box_km 1 1"}) {
    std::string text = std::string("welkin-grid 1\ncorners 65 65 17\n") + box + "\n";
    text.resize(256, ' ');
    CHECK_THAT(refuse(text + good.substr(256)), Catch::Contains(std::string(box) + "; accepted is a line \"box_km"));
  }
  for (const auto& [value, shown] :
       {std::pair(-0.01f, "-0.01"), std::pair(NAN, "nan"), std::pair(INFINITY, "inf"), std::pair(2000.0f, "2000")}) {
    std::string changed = good;
    std::memcpy(changed.data() + 256 + 4 * 77, &value, 4);
    CHECK_THAT(refuse(changed),
               Catch::Contains(fmt::format("sample 77 is {}; accepted is a density from 0 to 1000", shown)));
  }
  CHECK_THAT(refused([&] { read_grid("/nowhere/a.grid"); }), Catch::Contains("/nowhere/a.grid"));
  std::filesystem::remove(wrong);
}
