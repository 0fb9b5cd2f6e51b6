// The sun's zenith and azimuth from date, time and place: see sun.hpp.
//
// Geometry (ERFA, the free edition of the IAU's SOFA):
//   UTC -> TAI -> TT                         eraDtf2d, eraUtctai, eraTaitt
//   sun seen from the geocentre = -Earth     eraEpv00 (heliocentric Earth, barycentric velocity; 1900-2100)
//   annual aberration                        eraAb
//   celestial -> true equator of date        eraPnm06a (precession IAU 2006, nutation IAU 2000A)
//   Greenwich apparent sidereal time         eraGst06a
//   observer on the WGS84 ellipsoid          eraGd2gc; subtracted, which is the parallax (8.8 arc seconds)
//
// What is left out, largest first: UT1-UTC is taken as 0 (at most 0.9 s of time since 1972, 0.004 deg of
// azimuth at the equator; for dates beyond the announced leap seconds it is unknown). Before 1960 UTC is read
// as UT1 and TT-UT1 is wrong by at most 30 s (1.3 arc seconds of the sun's motion). Polar motion, diurnal
// aberration and the sun's own motion during the light time are below 0.4 arc seconds each. Refraction is
// left out on purpose.
#include "common/scene/sun.hpp"

#include <erfa.h>
#include <erfam.h>
#include <fmt/chrono.h>

#include <chrono>
#include <cmath>
#include <regex>

#include "common/error.hpp"
#include "common/scene/one_line.hpp"

namespace welkin {
namespace {

struct DateTime {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0;
  double second = 0.0;
};

constexpr const char* kAccepted =
    "accepted is YYYY-MM-DDThh:mm[:ss] in UTC from 1900 to 2100, now, or today hh:mm[:ss]";

// Whether the calendar has that day and the day that minute is for ERFA to say.
DateTime read_utc(const std::string& utc) {
  static const std::regex form(R"((\d{4})-(\d\d)-(\d\d)T(\d\d):(\d\d)(?::(\d\d)(?:\.(\d{1,10}))?)?Z?)");
  const auto now = std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const std::tm clock = fmt::gmtime(std::chrono::system_clock::to_time_t(now));
  std::string text = utc;
  if (utc == "now" || utc == "today")
    text = fmt::format("{:%FT%T}.{:03}", clock, now.time_since_epoch().count() % 1000);
  else if (utc.starts_with("today "))
    text = fmt::format("{:%F}T{}", clock, utc.substr(6));
  std::smatch part;
  const bool good = std::regex_match(text, part, form);
  const auto number = [&](size_t i) { return good && part[i].matched ? std::stoi(part[i]) : 0; };
  DateTime time{number(1), number(2), number(3), number(4), number(5), static_cast<double>(number(6))};
  double place = 0.1;
  for (const char digit : part[7].str()) time.second += place * (digit - '0'), place *= 0.1;
  if (time.year < 1900 || time.year > 2100 || time.second >= 61.0)  // 60: a leap second
    fail("utc '{}': {}", one_line(utc, 60), kAccepted);
  return time;
}

void check_angle(const char* name, double value, double limit) {
  if (!(std::abs(value) <= limit)) fail("{} = {:g}: accepted is -{:g} to {:g} deg", name, value, limit, limit);
}

}  // namespace

SunAngles sun_angles(const std::string& utc, double latitude_deg, double longitude_deg) {
  check_angle("latitude_deg", latitude_deg, 90.0);
  check_angle("longitude_deg", longitude_deg, 360.0);
  const DateTime time = read_utc(utc);

  // Negative codes are errors; positive ones warn of a year without announced leap seconds, which is
  // accepted.
  double utc1 = 0, utc2 = 0, tai1 = 0, tai2 = 0, tt1 = 0, tt2 = 0;
  const int day = eraDtf2d("UTC", time.year, time.month, time.day, time.hour, time.minute, time.second, &utc1, &utc2);
  if (day >= 2) fail("utc '{}': no leap second stands there; {}", one_line(utc, 60), kAccepted);
  if (day < 0 || eraUtctai(utc1, utc2, &tai1, &tai2) < 0 || eraTaitt(tai1, tai2, &tt1, &tt2) < 0)
    fail("utc '{}': {}", one_line(utc, 60), kAccepted);

  // From the geocentre to the sun, in au, with annual aberration. Positive eraEpv00 code: outside 1900-2100
  // by hours.
  double heliocentric[2][3], barycentric[2][3];
  eraEpv00(tt1, tt2, heliocentric, barycentric);
  double distance_au = 0, direction[3], velocity[3], apparent[3];
  eraPn(heliocentric[0], &distance_au, direction);
  for (double& x : direction) x = -x;
  const double au_per_day_in_c = ERFA_AULT / ERFA_DAYSEC;
  eraSxp(au_per_day_in_c, barycentric[1], velocity);
  eraAb(direction, velocity, distance_au, std::sqrt(1.0 - eraPdp(velocity, velocity)), apparent);

  // To the rotating Earth: x towards Greenwich, z towards the north pole.
  double celestial_to_true[3][3], terrestrial[3];
  eraPnm06a(tt1, tt2, celestial_to_true);
  eraRz(eraGst06a(utc1, utc2, tt1, tt2), celestial_to_true);
  eraRxp(celestial_to_true, apparent, terrestrial);

  // To the observer: subtract where they stand, then resolve along east, north and up (the ellipsoid's
  // normal).
  const double latitude = latitude_deg * ERFA_DD2R, longitude = longitude_deg * ERFA_DD2R;
  double observer_m[3], to_sun[3];
  eraGd2gc(ERFA_WGS84, longitude, latitude, 0.0, observer_m);
  for (int i = 0; i < 3; ++i) to_sun[i] = terrestrial[i] * distance_au - observer_m[i] / ERFA_DAU;
  const double towards = std::cos(longitude) * to_sun[0] + std::sin(longitude) * to_sun[1];
  const double east = -std::sin(longitude) * to_sun[0] + std::cos(longitude) * to_sun[1];
  const double north = -std::sin(latitude) * towards + std::cos(latitude) * to_sun[2];
  const double up = std::cos(latitude) * towards + std::sin(latitude) * to_sun[2];
  const double horizontal = std::hypot(east, north);

  // Overhead (or underfoot) there is no azimuth; 0 by convention.
  return {.zenith_deg = std::atan2(horizontal, up) * ERFA_DR2D,
          .azimuth_deg = horizontal > 1e-15 ? eraAnp(std::atan2(east, north)) * ERFA_DR2D : 0.0};
}

}  // namespace welkin
