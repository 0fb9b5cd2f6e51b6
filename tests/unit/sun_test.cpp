// The sun's angles against almanac values and closed forms that do not come from ERFA.
#include "common/scene/sun.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "common/error.hpp"
#include "tree.hpp"

namespace {

using welkin::sun_angles;
using welkin::SunAngles;

const std::filesystem::path kRoot = WELKIN_SOURCE_DIRECTORY;
constexpr double kPi = 3.14159265358979323846;

std::string refused(const std::string& utc, double latitude_deg = 0, double longitude_deg = 0) {
  try {
    sun_angles(utc, latitude_deg, longitude_deg);
  } catch (const welkin::Error& error) {
    REQUIRE(error.exit_code == welkin::Exit::usage);
    return error.what();
  }
  return "accepted";
}

double azimuth_difference(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

// Angle between two directions, degrees; by the chord, which stays exact when they are close.
double separation_deg(const SunAngles& a, const SunAngles& b) {
  const auto x = [](const SunAngles& s, int i) {
    const double z = s.zenith_deg * kPi / 180, n = s.azimuth_deg * kPi / 180;
    return i == 0 ? std::sin(z) * std::sin(n) : i == 1 ? std::sin(z) * std::cos(n) : std::cos(z);
  };
  double chord2 = 0;
  for (int i = 0; i < 3; ++i) chord2 += std::pow(x(a, i) - x(b, i), 2);
  return 2 * std::asin(std::sqrt(chord2) / 2) * 180 / kPi;
}

}  // namespace

TEST_CASE("the sun agrees with almanac values", "[sun]") {
  std::ifstream file(kRoot / "tests/data/sun_almanac.csv");
  REQUIRE(file);
  int rows = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line.starts_with("source,")) continue;
    std::vector<std::string> field;
    std::istringstream in(line);
    for (std::string part; std::getline(in, part, ',');) field.push_back(part);
    INFO(line);
    REQUIRE(field.size() == 7);
    const SunAngles sun = sun_angles(field[1], std::stod(field[2]), std::stod(field[3]));
    const double tolerance = std::stod(field[6]);
    if (!field[4].empty()) CHECK(std::abs(sun.zenith_deg - std::stod(field[4])) <= tolerance);
    if (!field[5].empty()) CHECK(azimuth_difference(sun.azimuth_deg, std::stod(field[5])) <= tolerance);
    ++rows;
  }
  CHECK(rows == 14);
}

TEST_CASE("at the subsolar point the sun is overhead, opposite it underfoot", "[sun]") {
  // The subsolar point is found from the angles alone: the pole's zenith distance is 90 - declination (+
  // parallax), and on the equator at longitude 0 hour angle follows from the horizontal coordinates (azimuth,
  // zenith).
  for (const char* utc : {"2026-06-21T10:30:00", "2001-01-01T00:00:00", "2099-12-31T23:59:59", "1900-01-01T00:00:00"}) {
    INFO(utc);
    const double parallax = 0.00244;  // 8.794 arc seconds
    const SunAngles pole = sun_angles(utc, 90, 0);
    const double latitude = 90 - pole.zenith_deg + parallax * std::sin(pole.zenith_deg * kPi / 180);
    const SunAngles equator = sun_angles(utc, 0, 0);
    const double z = equator.zenith_deg * kPi / 180, a = equator.azimuth_deg * kPi / 180;
    const double longitude = std::atan2(std::sin(z) * std::sin(a), std::cos(z)) * 180 / kPi;
    // 0.005 deg: the parallax (0.0024) at the equator is not removed from the longitude.
    CHECK(sun_angles(utc, latitude, longitude).zenith_deg < 0.005);
    // The antipode of a geodetic point is underfoot exactly on an ellipsoid, by symmetry.
    CHECK(sun_angles(utc, -latitude, longitude + 180).zenith_deg > 179.995);
  }
}

TEST_CASE("polar day and polar night", "[sun]") {
  for (int hour = 0; hour < 24; ++hour) {
    const std::string time = fmt::format("T{:02}:00:00", hour);
    // Latitude 80: the lowest sun of the June solstice is at zenith distance 180 - 80 - 23.44 = 76.56.
    CHECK(sun_angles("2026-06-21" + time, 80, 20).zenith_deg < 76.6);
    CHECK(sun_angles("2026-12-21" + time, 80, 20).zenith_deg > 103.4);
    CHECK(sun_angles("2026-06-21" + time, -80, 20).zenith_deg > 103.4);
  }
}

TEST_CASE("the sun moves 15 degrees an hour, smoothly over midnight, leap seconds and the poles", "[sun]") {
  const auto step = [](const char* a, const char* b, double latitude_deg) {
    return separation_deg(sun_angles(a, latitude_deg, 16.47), sun_angles(b, latitude_deg, 16.47));
  };
  // One second of time is 15.04 arc seconds of hour angle at most: 0.00418 deg; over 23:59:60 it is two
  // seconds.
  CHECK(step("2026-03-20T23:59:59", "2026-03-21T00:00:00", 43.6) == Approx(0.00418).epsilon(0.01));
  CHECK(step("2016-12-31T23:59:59", "2017-01-01T00:00:00", 43.6) < 0.009);
  CHECK(step("2016-12-31T23:59:59", "2017-01-01T00:00:00", 43.6) > 0.003);
  // The leap second itself: half way, and only where there was one.
  for (const char* half : {"2016-12-31T23:59:60", "2016-12-31T23:59:60Z"}) {
    CHECK(step("2016-12-31T23:59:59", half, 43.6) == Approx(0.00418).epsilon(0.1));
    CHECK(step(half, "2017-01-01T00:00:00", 43.6) == Approx(0.00418).epsilon(0.1));
  }
  CHECK(step("2016-12-31T23:59:60.999", "2017-01-01T00:00:00", 43.6) < 1e-5);
  for (const char* none : {"2015-12-31T23:59:60", "2016-12-31T23:58:60", "2016-12-31T23:59:61"}) {
    INFO(none);
    CHECK_THAT(refused(none), Catch::StartsWith("utc '") && Catch::Contains("accepted is YYYY-MM-DDThh:mm[:ss]"));
  }
  CHECK_THAT(refused("2015-12-31T23:59:60"), Catch::Contains("no leap second stands there"));
  CHECK(step("1959-12-31T23:59:59", "1960-01-01T00:00:00", 43.6) < 0.009);
  // Places side by side see the sun side by side, across the date line and next to the pole.
  CHECK(separation_deg(sun_angles("2026-05-01T12:00", 43.6, -180), sun_angles("2026-05-01T12:00", 43.6, 180)) < 1e-9);
  CHECK(separation_deg(sun_angles("2026-05-01T12:00", 90, 30), sun_angles("2026-05-01T12:00", 89.9999, 30)) < 2e-4);
}

TEST_CASE("text of the date: what is read and what is refused", "[sun]") {
  const SunAngles exact = sun_angles("2026-06-21T10:30:00", 43.6, 16.47);
  for (const char* same : {"2026-06-21T10:30", "2026-06-21T10:30Z", "2026-06-21T10:30:00.000Z"})
    CHECK(sun_angles(same, 43.6, 16.47).zenith_deg == exact.zenith_deg);
  CHECK(sun_angles("2026-06-21T10:30:00", 43.6, 16.47 - 360).zenith_deg == Approx(exact.zenith_deg).margin(1e-9));
  CHECK(sun_angles("2024-02-29T00:00:00", 0, 0).zenith_deg > 90);

  for (const char* utc : {"",
                          "noon",
                          "2026-06-21",
                          "2026-06-21 10:30",
                          "2026-6-21T10:30",
                          "2026-02-29T00:00",
                          "2026-13-01T00:00",
                          "2026-00-10T00:00",
                          "2026-06-31T00:00",
                          "2026-06-21T24:00",
                          "2026-06-21T10:60",
                          "2026-06-21T10:30:60",
                          "2026-06-21T10:30:00+02:00",
                          "2026-06-21T10:30:00Zulu",
                          "1899-12-31T23:59:59",
                          "2101-01-01T00:00",
                          "today ",
                          "today 25:00",
                          "today14:00",
                          "tomorrow",
                          "now ",
                          "2026-06-21T10:30:",
                          "2026-06-21T10:30:00.",
                          "-026-06-21T10:30"}) {
    INFO(utc);
    CHECK_THAT(refused(utc), Catch::StartsWith("utc '") && Catch::Contains("accepted is YYYY-MM-DDThh:mm[:ss]"));
  }
  CHECK(refused("now\n") ==
        "utc 'now\\x0a': accepted is YYYY-MM-DDThh:mm[:ss] in UTC from 1900 to 2100, now, or today hh:mm[:ss]");
  CHECK(refused("now", 90.1) == "latitude_deg = 90.1: accepted is -90 to 90 deg");
  CHECK(refused("now", 0, 361) == "longitude_deg = 361: accepted is -360 to 360 deg");
  CHECK(refused("now", NAN) == "latitude_deg = nan: accepted is -90 to 90 deg");
}

TEST_CASE("now and today are the present date in UTC, in any time zone", "[sun]") {
  const auto here = [](const char* utc) { return sun_angles(utc, 43.6, 16.47); };
  setenv("TZ", "Pacific/Kiritimati", 1);
  const SunAngles far_east = here("now");
  setenv("TZ", "UTC", 1);
  CHECK(separation_deg(far_east, here("now")) < 0.1);  // the calls are well under 24 s apart: 0.1 deg of hour angle
  CHECK(separation_deg(here("today"), here("now")) < 0.1);
  // "today 14:00" differs from the same hour of another date by the season only, never by the hour of day.
  CHECK(here("today 14:00").azimuth_deg > 215);  // between south-west and west all year at 43.6 N, 16.47 E
  CHECK(here("today 14:00").azimuth_deg < 275);
}

TEST_CASE("the afternoon of scene 'today' is day on every day of the year", "[sun]") {
  for (int month = 1; month <= 12; ++month)
    for (int day = 1; day <= 28; ++day)
      CHECK(sun_angles(fmt::format("2026-{:02}-{:02}T14:00", month, day), 43.60, 16.47).zenith_deg < 80.5);
}

TEST_CASE("the sun's angles are the same from many threads", "[sun]") {
  std::vector<double> alone, together(64);
  const auto at = [](int i) { return sun_angles(fmt::format("20{:02}-05-05T05:05:05", i), i, 2.0 * i).azimuth_deg; };
  for (int i = 0; i < 64; ++i) alone.push_back(at(i));
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = t; i < 64; i += 4) together[static_cast<size_t>(i)] = at(i);
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(alone == together);
}
