// Every kind of refusal by the scene reader, with its exact message: what, file:line:column, what is
// accepted.
#include <algorithm>
#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "common/scene/scene.hpp"

namespace {

const std::string kView = "[[view]]\nname = \"v\"\n";  // two lines

template <typename Call>
std::string refused(const Call& call) {
  try {
    call();
  } catch (const welkin::Error& error) {
    REQUIRE(error.exit_code == welkin::Exit::usage);
    const std::string line = error.what();
    REQUIRE_FALSE(line.empty());
    REQUIRE(std::none_of(line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }));
    return line;
  }
  return "accepted";
}

// The message for "version = 1" and `rest`, which begins on line 2.
std::string message(const std::string& rest) {
  return refused([&] { welkin::parse_scene("version = 1\n" + rest, "f"); });
}

}  // namespace

TEST_CASE("each refusal names file, line, column and what is accepted", "[scene]") {
  const std::string mie = "[[medium]]\nkind = \"mie\"\nscattering_per_km = 0.004\n";  // lines 2 to 4
  struct Case {
    std::string rest, expected;
  };
  const Case cases[] = {
      // the file as a whole; `rest` starts on line 2
      {"", "no views at f:1:1: a scene has at least one [[view]]"},
      {"wind = 1\n" + kView,
       "unknown section or key 'wind' at f:2:1: known are name, time_s, version, planet, medium, sun, "
       "view, path, terrain, cloud, weather, post, settings"},
      {kView + "[[fog]]\n",
       "unknown section or key 'fog' at f:4:3: known are name, time_s, version, planet, medium, sun, view, path, "
       "terrain, cloud, weather, post, settings"},
      {"time_s = 60\n" + kView,
       "time_s in a scene without a latitude at f:2:10: accepted beside latitude_deg in [sun], about whose pole the "
       "sun "
       "turns"},
      {"time_s = 1e10\n" + kView, "time_s = 10000000000 at f:2:10: accepted is a number from -1e+09 to 1e+09 s"},
      {"name = \"a b\"\n", "name = 'a b' at f:2:8: accepted is quoted text of 1 to 64 letters, digits, _, - or ."},
      {"name = \"a\\nb\"\n",
       "name = 'a\\x0ab' at f:2:8: accepted is quoted text of 1 to 64 letters, digits, _, - or ."},
      {"x = [[[[[[[[[1]]]]]]]]]\n", "not valid TOML at f:2:13: "},
      {"a = 1 2\n", "not valid TOML at f:2:7: "},
      {"[[[view]]\n", "not valid TOML at f:2:3: this character does not belong here"},
      {"[=]\n", "not valid TOML at f:2:2: this character does not belong here"},
      {"a = \"open", "not valid TOML at f:2:10: "},
      {"# " + std::string(2000, '.') + "\n", "line too long at f:2:1025: accepted are lines of up to 1024 bytes"},
      {"planet = 5\n", "planet = 5 at f:2:10: accepted is a section, [planet]"},
      {"[view]\nname = \"v\"\n", "view = a table at f:2:1: accepted is [[view]], a section for each"},
      {"view = [3]\n", "view = 3 at f:2:9: accepted is [[view]], a section for each"},
      // planet
      {"[planet]\nradius = 1\n",
       "unknown key 'radius' in planet at f:3:1: known are ground_radius_km, top_radius_km, ground_albedo"},
      {"[planet]\nground_radius_km = 6360\n",
       "planet with one radius at f:2:1: accepted is ground_radius_km and top_radius_km together, or "
       "neither"},
      {"[planet]\nground_radius_km = 6360\ntop_radius_km = 6360\n",
       "planet.top_radius_km = 6360 at f:4:17: accepted is a number from 6361 to 8360 km (1 to 2000 km above "
       "the ground)"},
      {"[planet]\nground_radius_km = 6360\ntop_radius_km = 9000.5\n",
       "planet.top_radius_km = 9000.5 at f:4:17: accepted is a number from 6361 to 8360 km (1 to 2000 km "
       "above the ground)"},
      {"[planet]\nground_radius_km = 99\ntop_radius_km = 300\n",
       "planet.ground_radius_km = 99 at f:3:20: accepted is a number from 100 to 100000 km"},
      {"[planet]\nground_albedo = 1.01\n",
       "planet.ground_albedo = 1.01 at f:3:17: accepted is a number from 0 to 1 or three of them, [r, g, b]"},
      {"[planet]\nground_albedo = [0.1, 0.2]\n",
       "planet.ground_albedo has 2 numbers at f:3:17: accepted is a number from 0 to 1 or three of them, [r, "
       "g, b]"},
      {"[planet]\nground_albedo = [0.1, \"x\", 0.2]\n",
       "planet.ground_albedo[1] = 'x' at f:3:23: accepted is a number from 0 to 1 or three of them, [r, g, "
       "b]"},
      {"[planet]\nground_albedo = [0.1, 0.1, nan]\n",
       "planet.ground_albedo[2] = nan at f:3:28: accepted is a number from 0 to 1 or three of them, [r, g, "
       "b]"},
      // medium
      {"[[medium]]\n", "no kind in medium at f:2:1: accepted is one of \"rayleigh\", \"mie\", \"ozone\""},
      {"[[medium]]\nkind = \"dust\"\n",
       "medium.kind = 'dust' at f:3:8: accepted is one of \"rayleigh\", \"mie\", \"ozone\""},
      {"[[medium]]\nkind = \"mie\"\n",
       "no scattering_per_km in medium 'mie' at f:2:1: accepted is a number from 0 to 100 km^-1 or three of them, [r, "
       "g, b]"},
      {"[[medium]]\nkind = \"ozone\"\n",
       "no absorption_per_km in medium 'ozone' at f:2:1: accepted is a number from 0 to 100 km^-1 or three of them, "
       "[r, g, b]"},
      {"[[medium]]\nkind = \"rayleigh\"\ng = 0\n",
       "unknown key 'g' in medium 'rayleigh' at f:4:1: known are kind, scattering_per_km, profile, "
       "scale_height_km, phase"},
      {"[[medium]]\nkind = \"ozone\"\nscattering_per_km = 1\n",
       "unknown key 'scattering_per_km' in medium 'ozone' at f:4:1: known are kind, absorption_per_km, "
       "extinction_per_km, profile, peak_altitude_km, half_width_km"},
      {"[[medium]]\nkind = \"mie\"\nscattering_per_km = -1e-9\n",
       "medium.scattering_per_km = -1e-09 at f:4:21: accepted is a number from 0 to 100 km^-1 or three of "
       "them, [r, g, b]"},
      {"[[medium]]\nkind = \"mie\"\nscattering_per_km = inf\n",
       "medium.scattering_per_km = inf at f:4:21: accepted is a number from 0 to 100 km^-1 or three of them, "
       "[r, g, b]"},
      {mie + "g = 1\n", "medium.g = 1 at f:5:5: accepted is a number from -0.999 to 0.999"},
      {mie + "g = -nan\n", "medium.g = nan at f:5:5: accepted is a number from -0.999 to 0.999"},
      {mie + "g = true\n", "medium.g = true at f:5:5: accepted is a number from -0.999 to 0.999"},
      {mie + "second_weight = 2\n", "medium.second_weight = 2 at f:5:17: accepted is a number from 0 to 1"},
      {mie + "draine_alpha = -1\n", "medium.draine_alpha = -1 at f:5:16: accepted is a number from 0 to 100"},
      {mie + "phase = \"mie\"\n",
       "medium.phase = 'mie' at f:5:9: accepted is one of \"henyey_greenstein\", \"cornette_shanks\", "
       "\"draine\", \"double_hg\""},
      {mie + "profile = \"tent\"\n", "medium.profile = 'tent' at f:5:11: accepted is one of \"exponential\""},
      {mie + "scale_height_km = 0\n",
       "medium.scale_height_km = 0 at f:5:19: accepted is a number from 0.01 to 1000 km"},
      {mie + "absorption_per_km = 1\nextinction_per_km = 1\n",
       "medium.extinction_per_km given beside absorption_per_km at f:6:21: accepted is one of the two"},
      {mie + "extinction_per_km = [0.004, 0.003, 0.004]\n",
       "medium.extinction_per_km[1] = 0.003 is less than scattering_per_km[1] = 0.004 at f:5:21: accepted is "
       "extinction = scattering + absorption, so at least the scattering"},
      {mie + mie, "second medium 'mie' at f:6:8: each kind at most once"},
      // sun
      {"[sun]\nzenith_deg = 180.5\n", "sun.zenith_deg = 180.5 at f:3:14: accepted is a number from 0 to 180 deg"},
      {"[sun]\nzenith_deg = \"45\"\n", "sun.zenith_deg = '45' at f:3:14: accepted is a number from 0 to 180 deg"},
      {"[sun]\nzenith_deg = 2026-01-01\n",
       "sun.zenith_deg = a date or time at f:3:14: accepted is a number from 0 to 180 deg"},
      {"[sun]\ndisc = 1\n", "sun.disc = 1 at f:3:8: accepted is true or false"},
      {"[sun]\nangular_radius_deg = 0\n",
       "sun.angular_radius_deg = 0 at f:3:22: accepted is a number from 0.001 to 45 deg"},
      {"[sun]\nirradiance = [1, 1, -1]\n",
       "sun.irradiance[2] = -1 at f:3:21: accepted is a number from 0 to 1e+06 or three of them, [r, g, b]"},
      {"[sun]\nelevation_deg = 4\n",
       "unknown key 'elevation_deg' in sun at f:3:1: known are zenith_deg, azimuth_deg, utc, latitude_deg, "
       "longitude_deg, angular_radius_deg, irradiance, disc"},
      {"[sun]\nutc = \"now\"\n",
       "sun.utc without latitude_deg at f:3:7: accepted is zenith_deg and azimuth_deg, or utc, latitude_deg "
       "and longitude_deg together"},
      {"[sun]\nutc = \"now\"\nlatitude_deg = 4\n",
       "sun.utc without longitude_deg at f:3:7: accepted is zenith_deg and azimuth_deg, or utc, latitude_deg "
       "and longitude_deg together"},
      {"[sun]\nutc = \"now\"\nlatitude_deg = 4\nlongitude_deg = 4\nzenith_deg = 4\n",
       "sun.zenith_deg given beside utc at f:6:14: accepted is one of the two"},
      {"[sun]\nutc = \"now\"\nlatitude_deg = 91\nlongitude_deg = 4\n",
       "sun.latitude_deg = 91 at f:4:16: accepted is a number from -90 to 90 deg"},
      {"[sun]\nutc = \"noon\"\nlatitude_deg = 4\nlongitude_deg = 4\n",
       "sun.utc at f:3:7: utc 'noon': accepted is YYYY-MM-DDThh:mm[:ss] in UTC from 1900 to 2100, now, or "
       "today hh:mm[:ss]"},
      {"[sun]\nutc = 2026-06-21T10:30:00\nlatitude_deg = 4\nlongitude_deg = 4\n",
       "sun.utc = a date or time at f:3:7: accepted is quoted text, for example \"2026-06-21T10:30:00\""},
      // views, post, settings
      {"[[view]]\n", "no name in view at f:2:1: accepted is quoted text of 1 to 64 letters, digits, _, - or ."},
      {kView + "latitude_deg = 4\nlongitude_deg = 4\n",
       "a place by half at f:4:16: accepted are latitude_deg and longitude_deg together, of the scene's place in [sun] "
       "and of the view"},
      {"[sun]\nlatitude_deg = 4\nlongitude_deg = 4\n" + kView + "longitude_deg = 4\n",
       "a place by half at f:7:17: accepted are latitude_deg and longitude_deg together, of the scene's place in [sun] "
       "and of the view"},
      {kView + "east_km = 1\nlongitude_deg = 4\n",
       "view.longitude_deg given beside east_km at f:5:17: accepted is one of the two"},
      // paths
      {kView + "[[path]]\nname = \"p\"\n",
       "no views in path at f:4:1: accepted are up to 64, [a, b, ...], names of 1 to 64 letters, digits, _, - or ."},
      {kView + "[[path]]\nname = \"p\"\nviews = [\"v\", \"w\"]\ntime_s = [0, 1]\n",
       "path.views at f:6:9: accepted are names of views"},
      {kView + "[[path]]\nname = \"p\"\nviews = [\"v\"]\ntime_s = [0]\n",
       "path of one view at f:6:9: accepted are two or more"},
      {kView + "[[path]]\nname = \"p\"\nviews = [\"v\", \"v\"]\ntime_s = [0]\n",
       "path.time_s has 1 numbers at f:7:10: accepted is one for each of the 2 views"},
      {kView + "[[path]]\nname = \"p\"\nviews = [\"v\", \"v\"]\ntime_s = [1, 1]\n",
       "path.time_s does not rise at f:7:10: accepted are times each later than the one before"},
      {kView + "[[path]]\nname = \"p\"\nviews = [\"v\", \"v\"]\ntime_s = [1, nan]\n",
       "path.time_s = nan at f:7:14: accepted is a number from -1e+06 to 1e+06 s"},
      {kView + "[[path]]\nname = \"p\"\nviews = [\"v\", \"v\"]\ntime_s = [0, 1]\nmoment_s = [0, 1]\n",
       "path.moment_s in a scene without a latitude at f:8:12: accepted beside latitude_deg in [sun], about whose pole "
       "the sun turns"},
      {kView + kView, "second view 'v' at f:5:8: each name once"},
      {kView + "fov_deg = 171\n", "view.fov_deg = 171 at f:4:11: accepted is a number from 1 to 170 deg"},
      {kView + "altitude_km = -0.001\n",
       "view.altitude_km = -0.001 at f:4:15: accepted is a number from 0 to 1e+06 km"},
      {kView + "elevation_deg = 91\n", "view.elevation_deg = 91 at f:4:17: accepted is a number from -90 to 90 deg"},
      {kView + "azimuth_deg = 1e9\n",
       "view.azimuth_deg = 1000000000 at f:4:15: accepted is a number from -360 to 360 deg"},
      {kView + "azimuth_deg = 1\nazimuth_from_sun_deg = 1\n",
       "view.azimuth_from_sun_deg given beside azimuth_deg at f:5:24: accepted is one of the two"},
      {kView + "[post]\nexposure_ev = 31\n",
       "post.exposure_ev = 31 at f:5:15: accepted is a number from -20 to 30 stops"},
      {kView + "[post]\ngamma = 2\n",
       "unknown key 'gamma' in post at f:5:1: known are exposure, exposure_ev, compensation_ev"},
      // terrain
      {kView + "[terrain]\nscale = 2\n",
       "unknown key 'scale' in terrain at f:5:1: known are height_map, extent_km, height_km, size, seed, shadows, "
       "signs_azimuth_deg"},
      {"[planet]\nground_radius_km = 120\ntop_radius_km = 130\n" + kView + "[terrain]\nextent_km = 121\n",
       "terrain.extent_km = 121 at f:8:13: accepted is a number from 1 to 120 km"},
      {"[planet]\nground_radius_km = 120\ntop_radius_km = 130\n" + kView + "[terrain]\n",
       "terrain.extent_km = 128 at f:7:1: accepted is a number from 1 to 120 km: no map is wider than the planet's "
       "radius"},
      {"[planet]\nground_radius_km = 6360\ntop_radius_km = 6362\n" + kView + "[terrain]\nheight_km = 2.5\n",
       "terrain.height_km = 2.5 at f:8:13: accepted is a number from 0 to 2 km"},
      {"[planet]\nground_radius_km = 6360\ntop_radius_km = 6362\n" + kView + "[terrain]\n",
       "terrain.height_km = 3 at f:7:1: accepted is a number from 0 to 2 km: no hill stands above the air"},
      {kView + "[[terrain]]\n", "terrain = an array at f:4:1: accepted is a section, [terrain]"},
      {kView + "[terrain]\nheight_map = 3\n",
       "terrain.height_map = 3 at f:5:14: accepted is the name of a 16-bit grayscale PNG file, quoted"},
      {kView + "[terrain]\nheight_map = \"\"\n",
       "terrain.height_map = '' at f:5:14: accepted is the name of a 16-bit grayscale PNG file, quoted"},
      {kView + "[terrain]\nheight_map = \"a.png\"\nsize = 64\n",
       "terrain.size given beside height_map at f:6:8: accepted is one of the two"},
      {kView + "[terrain]\nextent_km = 0\n", "terrain.extent_km = 0 at f:5:13: accepted is a number from 1 to 1000 km"},
      {kView + "[terrain]\nheight_km = nan\n",
       "terrain.height_km = nan at f:5:13: accepted is a number from 0 to 20 km"},
      {kView + "[terrain]\nsize = 64.5\n",
       "terrain.size = 64.5 at f:5:8: accepted is a whole number from 64 to 4096 samples"},
      {kView + "[terrain]\nsize = 8192\n",
       "terrain.size = 8192 at f:5:8: accepted is a whole number from 64 to 4096 samples"},
      {kView + "[terrain]\nseed = -1\n", "terrain.seed = -1 at f:5:8: accepted is a whole number from 0 to 1e+06"},
      {kView + "[terrain]\nshadows = 1\n", "terrain.shadows = 1 at f:5:11: accepted is true or false"},
      {kView + "[terrain]\nsigns_azimuth_deg = 400\n",
       "terrain.signs_azimuth_deg = 400 at f:5:21: accepted is a number from -360 to 360 deg"},
      {kView + "[settings]\nmie.g = 0.8\n",
       "settings.mie is a table at f:5:1: a knob's name is quoted, for example \"view.steps\" = 64"},
      {kView + "[settings]\n\"mie.g\" = [1]\n",
       "settings.mie.g = an array at f:5:11: accepted is a finite number, true, false or quoted text of 1 to "
       "200 characters"},
      {kView + "[settings]\n\"mie.g\" = inf\n",
       "settings.mie.g = inf at f:5:11: accepted is a finite number, true, false or quoted text of 1 to 200 "
       "characters"},
      {kView + "[settings]\n\"Mie g\" = 1\n",
       "knob name 'Mie g' at f:5:1: accepted is 1 to 64 lower-case letters, digits, _ and ."},
  };
  for (const Case& c : cases) {
    INFO(c.rest);
    if (c.expected.ends_with(": "))
      CHECK_THAT(message(c.rest), Catch::StartsWith(c.expected));  // the rest is toml++'s description
    else
      CHECK(message(c.rest) == c.expected);
  }
}

TEST_CASE("the version comes first", "[scene]") {
  const auto whole = [](const std::string& text) { return refused([&] { welkin::parse_scene(text, "f"); }); };
  CHECK(whole("version = 2\n[hail]\n") == "version 2 at f:1:11: this build knows version 1");
  CHECK(whole("version = \"1\"\n") == "version '1' at f:1:11: this build knows version 1");
  CHECK(whole("version = 1.0\n") == "version 1 at f:1:11: this build knows version 1");
  CHECK(whole("") == "no version at f:1:1: a scene says version = 1");
  CHECK(whole(kView) == "no version at f:1:1: a scene says version = 1");
}

TEST_CASE("a message stays on one line whatever the file and its name contain", "[scene]") {
  const std::string nasty = "a\nb\r\x1b[2J\x7f\u0085\u2028";
  for (const char* text :
       {"", "version = 2", "version = 1\n\"k\\ney\" = 1", "version = 1\nname = \"\\u001b[2J\"", "\x01", "a = \"\n"}) {
    const std::string line = refused([&] { welkin::parse_scene(text, nasty); });
    CHECK_THAT(line, Catch::Contains("a\\x0ab\\x0d\\x1b[2J\\x7f"));
    CHECK(line.find("\u2028") == std::string::npos);
    CHECK(line.find("\u0085") == std::string::npos);
  }
  const std::string line = message("\"" + std::string(900, 'k') + "\" = 1\n");
  CHECK(line.size() < 400);
}
