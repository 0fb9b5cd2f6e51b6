// What a scene may say: the table of its sections and fields (key, member, range and unit, meaning), as functions that
// show it row by row to a visitor. Reading (scene_parse.cpp), writing (scene.cpp), the knobs of the scene
// (scene_knobs.cpp), the tables of docs/scenes.md and the fuzzer (tests/hard/scene_fields.hpp) are visitors.
// A new section is a struct in scene.hpp, its fields() and a line in sections().
//
// A visitor f has
//   f(key, member, range, meaning, more)     for every field; an optional one without a value is not said
//   f.given(key)                             whether the file says it (false where none is read)
//   f.must(good, key, what, accepted)        refuses a file whose values do not go together
//   f.reading, f.title                       whether a file is read; what messages call the section
//   f.listing                                whether every field of a kind is asked for, whatever the others say
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/trigonometric.hpp>

#include "common/error.hpp"
#include "common/scene/scene.hpp"
#include "common/scene/sun.hpp"

namespace welkin {

struct Range {
  double minimum = 0.0, maximum = 0.0;  // inclusive; of a text: its length in bytes
  const char* unit = "";
  std::vector<const char*> choices = {};  // of a text, a flag or an enum
  const char* text = "";                  // what a text must be; empty: a name
  int first = 0;                          // of an enum: the number of the first choice
  bool turns = false;                     // an azimuth: brought to 0 <= azimuth < 360
};
struct More {
  const char* besides = "";  // a key that it cannot stand beside
  const char* knob = "";     // its name for --set
  bool required = false;
};
struct Visitor {
  static constexpr bool reading = false, listing = false;
  std::string title;
  bool given(const char*) const { return false; }
  void must(bool, const char*, const std::string&, const std::string&) const {}
};

inline std::string text_of(const Range& range) {
  return fmt::format("{:g} to {:g}{}{}", range.minimum, range.maximum, *range.unit ? " " : "", range.unit);
}
// The same direction, 0 <= azimuth < 360.
inline double turned(double azimuth_deg) {
  const double rest_deg = std::fmod(azimuth_deg, 360.0), positive_deg = rest_deg < 0.0 ? rest_deg + 360.0 : rest_deg;
  return positive_deg < 360.0 ? positive_deg + 0.0 : 0.0;  // -1e-20 + 360 rounds to 360
}

// Knobs go by the number of a choice.
template <typename T>
int choice_of(const Range& range, const T& value) {
  int chosen = 0;
  if constexpr (std::is_same_v<T, std::string>)
    chosen = int(std::find(range.choices.begin(), range.choices.end(), value) - range.choices.begin());
  else if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>)
    chosen = int(value) - range.first;
  return chosen >= 0 && size_t(chosen) < range.choices.size() ? chosen : 0;
}
template <typename T>
void choose(const Range& range, int chosen, T& value) {
  if constexpr (std::is_same_v<T, std::string>)
    value = range.choices[size_t(chosen)];
  else if constexpr (std::is_enum_v<T> || std::is_same_v<T, bool>)
    value = static_cast<T>(chosen + range.first);
}

// A member of the scene is a section, one that may be absent, or many.
template <typename T>
constexpr bool is_many = requires(T member) {
  member.emplace_back();
};

// Calls each(section) for all there are.
template <typename T, typename Each>
void each_of(T& member, const Each& each) {
  if constexpr (is_many<T>) {
    std::for_each(member.begin(), member.end(), each);
  } else if constexpr (requires { member.emplace(); }) {
    if (member) each(*member);
  } else {
    each(member);
  }
}

namespace ranges {
inline const Range name{1, 64}, coefficient{0, 100, "km^-1"}, share{0, 1}, asymmetry{-0.999, 0.999},
    around{-360, 360, "deg"}, azimuth{.minimum = -360, .maximum = 360, .unit = "deg", .turns = true},
    latitude{-90, 90, "deg"}, elevation{-90, 90, "deg"}, place{-4e5, 4e5, "km"}, time{-1e9, 1e9, "s"};
}

template <typename List, typename F>
void must_be_unique(const F& f, const List& list, const char* what) {
  if constexpr (!F::reading) return;
  const auto same = [&](const auto& one) { return one.name == list.back().name; };
  f.must(std::none_of(list.begin(), list.end() - 1, same), "name",
         fmt::format("second {} '{}'", what, list.back().name), "each name once");
}

// [table]
template <typename F>
void fields(F& f, Planet& planet, Scene&) {
  f("ground_radius_km", planet.ground_radius_km, {100, 1e5, "km"}, "both radii are given, or neither");
  const double ground_km = planet.ground_radius_km;
  f("top_radius_km", planet.top_radius_km, {ground_km + 1, ground_km + 2000, "km (1 to 2000 km above the ground)"},
    "above it there is no air");
  f("ground_albedo", planet.ground_albedo, ranges::share, "share of light the ground reflects, all channels",
    {.knob = "ground.albedo"});
  f.must(f.given("ground_radius_km") == f.given("top_radius_km"), "", "planet with one radius",
         "accepted is ground_radius_km and top_radius_km together, or neither");
}

// What a medium may say follows from its kind, so that nothing can be said that would not be simulated.
template <typename F>
void fields(F& f, Medium& medium, Scene& scene) {
  static const Range kPhases{.choices = {"henyey_greenstein", "cornette_shanks", "draine", "double_hg"}};
  f("kind", medium.kind, {.choices = {"rayleigh", "mie", "ozone"}}, "each once at most", {.required = true});
  const bool gas = medium.kind == "rayleigh", haze = medium.kind == "mie", ozone = medium.kind == "ozone";
  f.title += fmt::format(" '{}'", medium.kind);
  if (f.reading && haze) medium.scale_height_km = 1.2, medium.phase = Phase::cornette_shanks, medium.g = 0.8;
  if (f.reading && ozone) medium.profile = Profile::tent;
  if (!ozone)
    f("scattering_per_km", medium.scattering_per_km, ranges::coefficient, "at the ground", {.required = true});
  std::optional<glm::dvec3> extinction;
  if (!gas) {
    f("absorption_per_km", medium.absorption_per_km, ranges::coefficient, "at the ground, or the peak",
      {.required = ozone && !f.given("extinction_per_km")});
    f("extinction_per_km", extinction, ranges::coefficient, "scattering and absorption together",
      {.besides = "absorption_per_km"});
  }
  f("profile", medium.profile, ozone ? Range{.choices = {"tent"}, .first = 1} : Range{.choices = {"exponential"}},
    "density: e^(-h/H), or max(0, 1 - abs(h - peak)/half width)");
  if (!ozone) f("scale_height_km", medium.scale_height_km, {0.01, 1000, "km"}, "H");
  if (ozone) {
    f("peak_altitude_km", medium.peak_altitude_km, {0, 2000, "km"}, "of the densest air");
    f("half_width_km", medium.half_width_km, {0.01, 2000, "km"}, "from there to where there is none");
  }
  if (gas) f("phase", medium.phase, {.choices = {"rayleigh"}, .first = 4}, "phase function");
  if (haze) {
    f("phase", medium.phase, kPhases, "phase function of the aerosol", {.knob = "mie.phase"});
    f("g", medium.g, ranges::asymmetry, "asymmetry of the aerosol's phase function", {.knob = "mie.g"});
    f("draine_alpha", medium.draine_alpha, {0, 100}, "of draine; 0: Henyey-Greenstein, 1: Cornette-Shanks");
    f("second_g", medium.second_g, ranges::asymmetry, "of the second lobe of double_hg");
    f("second_weight", medium.second_weight, ranges::share, "weight of the second lobe");
  }
  if (extinction) medium.absorption_per_km = *extinction - medium.scattering_per_km;
  for (int i = 0; extinction && i < 3; ++i)
    f.must(medium.absorption_per_km[i] >= 0, "extinction_per_km",
           fmt::format("medium.extinction_per_km[{}] = {} is less than scattering_per_km[{}] = {}", i, (*extinction)[i],
                       i, medium.scattering_per_km[i]),
           "accepted is extinction = scattering + absorption, so at least the scattering");
  f.must(!f.reading || scene.medium(medium.kind) == &medium, "kind", fmt::format("second medium '{}'", medium.kind),
         "each kind at most once");
}

template <typename F>
void fields(F& f, Sun& sun, Scene&) {
  std::optional<std::string> utc;
  f("zenith_deg", sun.zenith_deg, {0, 180, "deg"}, "angle of the sun from the zenith",
    {.besides = "utc", .knob = "sun.zenith_deg"});
  f("azimuth_deg", sun.azimuth_deg, ranges::azimuth, "azimuth of the sun, clockwise from north",
    {.besides = "utc", .knob = "sun.azimuth_deg"});
  f("utc", utc, {.text = "quoted text, for example \"2026-06-21T10:30:00\""},
    "date and time in place of the angles: YYYY-MM-DDThh:mm[:ss] from 1900 to 2100, now, today hh:mm[:ss]");
  f("latitude_deg", sun.latitude_deg, ranges::latitude,
    "of the scene's place, north positive; needed where time passes");
  f("longitude_deg", sun.longitude_deg, ranges::around, "of the scene's place, east positive");
  f("angular_radius_deg", sun.angular_radius_deg, {0.001, 45, "deg"}, "of its disc");
  f("irradiance", sun.irradiance, {0, 1e6}, "at the top of the atmosphere");
  f("disc", sun.disc, {}, "draw the sun's disc", {.knob = "sun.disc"});
  if (!utc) return;
  for (const char* key : {"latitude_deg", "longitude_deg"})
    f.must(f.given(key), "utc", fmt::format("sun.utc without {}", key),
           "accepted is zenith_deg and azimuth_deg, or utc, latitude_deg and longitude_deg together");
  try {
    const SunAngles angles = sun_angles(*utc, *sun.latitude_deg, *sun.longitude_deg);
    sun.zenith_deg = angles.zenith_deg, sun.azimuth_deg = turned(angles.azimuth_deg);
  } catch (const Error& error) {
    f.must(false, "utc", "sun.utc", error.what());
  }
}

// From the scene's place to another of the same planet, along the great circle.
inline void place_at(View& view, const Sun& from, double latitude_deg, double longitude_deg, double radius_km) {
  const double here = glm::radians(*from.latitude_deg), there = glm::radians(latitude_deg),
               turn = glm::radians(longitude_deg - *from.longitude_deg);
  const double east = std::cos(there) * std::sin(turn),
               north = std::cos(here) * std::sin(there) - std::sin(here) * std::cos(there) * std::cos(turn),
               up = std::sin(here) * std::sin(there) + std::cos(here) * std::cos(there) * std::cos(turn);
  const double sine = std::hypot(east, north), arc_km = radius_km * std::atan2(sine, up);
  view.east_km = sine > 0.0 ? arc_km * east / sine : 0.0;
  view.north_km = sine > 0.0 ? arc_km * north / sine : arc_km;
}

template <typename F>
void fields(F& f, View& view, Scene& scene) {
  std::optional<double> latitude_deg, longitude_deg, from_sun_deg;
  f("name", view.name, ranges::name, "each once", {.required = true});
  f("east_km", view.east_km, ranges::place, "from the scene's place to where the camera is overhead, along the ground");
  f("north_km", view.north_km, ranges::place, "the same, northwards");
  f("latitude_deg", latitude_deg, ranges::latitude, "of the camera, beside the longitude; the scene has both, too",
    {.besides = "north_km"});
  f("longitude_deg", longitude_deg, ranges::around, "of the camera, east positive", {.besides = "east_km"});
  f("altitude_km", view.altitude_km, {0, kHighest_km, "km"}, "above the ground");
  f("azimuth_deg", view.azimuth_deg, ranges::azimuth, "of the look, clockwise from north");
  f("azimuth_from_sun_deg", from_sun_deg, ranges::around, "of the look, clockwise from the sun",
    {.besides = "azimuth_deg"});
  f("elevation_deg", view.elevation_deg, ranges::elevation, "of the look above the horizontal; 90: straight up");
  f("fov_deg", view.fov_deg, {1, 170, "deg"}, "from the lower to the upper edge");
  must_be_unique(f, scene.views, "view");
  if (from_sun_deg) view.azimuth_deg = turned(scene.sun.azimuth_deg + *from_sun_deg);
  if (!latitude_deg && !longitude_deg) return;
  f.must(latitude_deg && longitude_deg && scene.sun.latitude_deg && scene.sun.longitude_deg,
         latitude_deg ? "latitude_deg" : "longitude_deg", "a place by half",
         "accepted are latitude_deg and longitude_deg together, of the scene's place in [sun] and of the view");
  place_at(view, scene.sun, *latitude_deg, *longitude_deg, scene.planet.ground_radius_km);
}

template <typename F>
void fields(F& f, Path& path, Scene& scene) {
  f("name", path.name, ranges::name, "each once", {.required = true});
  f("views", path.views, ranges::name, "names of views, in the order they are passed", {.required = true});
  f("time_s", path.time_s, {-1e6, 1e6, "s"}, "when each is passed, rising", {.required = true});
  f("moment_s", path.moment_s, ranges::time, "the scene's time_s then: a moving sun; without it that stands still");
  must_be_unique(f, scene.paths, "path");
  const auto known = [&](const std::string& name) {
    return std::any_of(scene.views.begin(), scene.views.end(), [&](const View& view) { return view.name == name; });
  };
  f.must(std::all_of(path.views.begin(), path.views.end(), known), "views", "path.views",
         "accepted are names of views");
  f.must(path.views.size() >= 2, "views", "path of one view", "accepted are two or more");
  for (const auto& [key, times] : {std::pair("time_s", &path.time_s), std::pair("moment_s", &path.moment_s)})
    f.must(!f.given(key) || times->size() == path.views.size(), key,
           fmt::format("path.{} has {} numbers", key, times->size()),
           fmt::format("accepted is one for each of the {} views", path.views.size()));
  const auto falls = std::adjacent_find(path.time_s.begin(), path.time_s.end(), std::greater_equal<>());
  f.must(falls == path.time_s.end(), "time_s", "path.time_s does not rise",
         "accepted are times each later than the one before");
  f.must(path.moment_s.empty() || scene.sun.latitude_deg, "moment_s", "path.moment_s in a scene without a latitude",
         kNeedsLatitude);
}

// Whether the map can be read is found out when it is drawn: most chapters have no terrain.
template <typename F>
void fields(F& f, Terrain& terrain, Scene& scene) {
  const double widest_km = std::min(scene.planet.ground_radius_km, 1000.0);
  const double highest_km = std::min(scene.planet.top_radius_km - scene.planet.ground_radius_km, 20.0);
  f("height_map", terrain.height_map, {1, 1000, "", {}, "the name of a 16-bit grayscale PNG file, quoted"},
    "square, 2 to 4096 samples a side, looked for beside the scene file; north is up. Without it hills are made");
  f("extent_km", terrain.extent_km, {1, widest_km, "km"}, "side of the square, at most the planet's radius");
  f("height_km", terrain.height_km, {0, highest_km, "km"}, "of a white pixel or the highest hill, at most the air's");
  f("size", terrain.size, {64, 4096, "samples"}, "a side of the map that is made", {.besides = "height_map"});
  f("seed", terrain.seed, {0, 1e6}, "of its noise", {.besides = "height_map"});
  f("shadows", terrain.shadows, {}, "terrain keeps the sun from itself and from the air");
  f("signs_azimuth_deg", terrain.signs_azimuth_deg, ranges::azimuth,
    "a row of signs 1, 2, 5, 10, 20, 50 and 100 km away in this direction");
  f.must(terrain.extent_km <= widest_km, "", fmt::format("terrain.extent_km = {}", terrain.extent_km),
         fmt::format("accepted is a number from 1 to {:g} km: no map is wider than the planet's radius", widest_km));
  f.must(terrain.height_km <= highest_km, "", fmt::format("terrain.height_km = {}", terrain.height_km),
         fmt::format("accepted is a number from 0 to {:g} km: no hill stands above the air", highest_km));
}

// How a body scatters: what its phase function does not have cannot be said.
template <typename F>
void phase_fields(F& f, Cloud& cloud) {
  f("extinction_per_km", cloud.extinction_per_km, {0, 1000, "km^-1"}, "where density is 1");
  f("single_scattering_albedo", cloud.single_scattering_albedo, ranges::share, "share of it that is scattering");
  f("phase", cloud.phase, {.choices = {"henyey_greenstein", "droplets", "draine_mixture"}}, "phase function");
  const bool mixture = cloud.phase == CloudPhase::draine_mixture, droplets = cloud.phase == CloudPhase::droplets;
  if (F::listing || !droplets) f("g", cloud.g, ranges::asymmetry, "asymmetry; of a mixture, that of its first lobe");
  if (F::listing || droplets)
    f("droplet_diameter_um", cloud.droplet_diameter_um, {1.5, 50, "um"}, "of the fit of Jendersie and d'Eon 2023");
  if (!F::listing && !mixture) return;
  f("weight", cloud.weight, ranges::share, "of the first lobe of draine_mixture, the second has the rest");
  f("alpha", cloud.alpha, {0, 100}, "of the first lobe; 0: Henyey-Greenstein, 1: Cornette-Shanks");
  f("second_g", cloud.second_g, ranges::asymmetry, "of the second lobe");
  f("second_alpha", cloud.second_alpha, {0, 100}, "of the second lobe");
}

// The altitude of a point of the tangent frame at the scene's place.
inline double altitude_above(const Planet& planet, double east_km, double north_km, double up_km) {
  return std::hypot(east_km, north_km, planet.ground_radius_km + up_km) - planet.ground_radius_km;
}

// A ball and a box stand in the tangent frame, which touches the ground at the scene's place only.
template <typename F>
void must_be_in_the_air(F& f, const Cloud& cloud, const Planet& planet) {
  const bool ball = cloud.kind == "sphere";
  const glm::dvec3 low{cloud.east_km, cloud.north_km, cloud.up_km}, size = ball ? glm::dvec3(0.0) : cloud.size_km;
  const double wide = ball ? cloud.radius_km : 0.0, highest_km = planet.top_radius_km - planet.ground_radius_km;
  const auto nearest = [](double from, double size_km) { return std::clamp(0.0, from, from + size_km); };
  const auto farthest = [](double a, double side) { return std::abs(a) > std::abs(a + side) ? a : a + side; };
  const double lowest_km = altitude_above(planet, nearest(low.x, size.x), nearest(low.y, size.y), low.z) - wide;
  const double top_km = altitude_above(planet, farthest(low.x, size.x), farthest(low.y, size.y), low.z + size.z) + wide;
  f.must(lowest_km >= -1e-9, "up_km", fmt::format("a cloud that reaches {:g} km below the ground", -lowest_km),
         "accepted is a cloud above the ground");
  f.must(top_km <= highest_km, "up_km", fmt::format("a cloud that reaches {:g} km high", top_km),
         fmt::format("accepted is a cloud below the top of the air, {:g} km", highest_km));
}

// What a body may say follows from its kind. Whether files can be read is found out when it is drawn.
template <typename F>
void fields(F& f, Cloud& cloud, Scene& scene) {
  const double radius_km = scene.planet.ground_radius_km, highest_km = scene.planet.top_radius_km - radius_km;
  const Range in_air{0, highest_km, "km"}, around{-4 * radius_km, 4 * radius_km, "km"};
  f("kind", cloud.kind, {.choices = {"layer", "disc", "sphere", "grid", "noise"}}, "a section for each body",
    {.required = true});
  const bool disc = cloud.kind == "disc", sphere = cloud.kind == "sphere", grid = cloud.kind == "grid",
             noise = cloud.kind == "noise";
  f.title += fmt::format(" '{}'", cloud.kind);
  f("name", cloud.name, ranges::name, "each once, where there is one");
  if (!sphere && !grid) {
    f("base_km", cloud.base_km, in_air, "altitude of its lower boundary", {.required = true});
    f("top_km", cloud.top_km, in_air, "altitude of its upper boundary", {.required = true});
    f.must(!f.reading || cloud.base_km + 0.000999 < cloud.top_km, "top_km",
           fmt::format("a cloud from {} km up to {} km", cloud.base_km, cloud.top_km),
           "accepted is a top at least a metre above the base");
  }
  if (disc || sphere || grid) {
    const char* where = disc     ? "arc at the base from the scene's place to its axis"
                        : sphere ? "of its centre, in the tangent frame of the scene's place"
                                 : "of its lowest corner, in the tangent frame of the scene's place";
    f("east_km", cloud.east_km, around, where);
    f("north_km", cloud.north_km, around, where);
    if (!disc) f("up_km", cloud.up_km, around, where, {.required = true});
  }
  if (disc)
    f("radius_km", cloud.radius_km, {0.001, 1.4 * radius_km, "km"}, "arc at the base to the rim", {.required = true});
  if (sphere) f("radius_km", cloud.radius_km, {0.001, highest_km, "km"}, "of the ball", {.required = true});
  if (grid) {
    f("file", cloud.file, {1, 1000, "", {}, "the name of a grid file, quoted"},
      "samples of density at corners, looked for beside the scene file", {.required = true});
    f("size_km", cloud.size_km, {0.001, 1000, "km"}, "of its box, eastwards, northwards and up", {.required = true});
  }
  if (noise) {
    f("weather", cloud.weather, {1, 1000, "", {}, "\"procedural\" or the name of a PNG file, quoted"},
      "coverage, height, type and wetness over the ground; one map for all bodies of a scene");
    const auto other_map = [&](const Cloud& other) { return other.kind == "noise" && other.weather != cloud.weather; };
    f.must(!f.reading || std::none_of(scene.clouds.begin(), scene.clouds.end(), other_map), "weather",
           "second weather map", "accepted is one for all bodies of a scene");
    f("extent_km", cloud.extent_km, {1, 4000, "km"}, "side of the weather map's square");
    f("coverage", cloud.coverage, ranges::share, "0: none; 0.5: as the weather map says; 1: the whole sky");
    f("type", cloud.type, ranges::share, "stratus 0 to nimbostratus 1 in seven steps; without it the weather map's");
    f("seed", cloud.seed, {0, 1e6}, "which part of noise and weather is seen");
  }
  phase_fields(f, cloud);
  if (!cloud.name.empty()) must_be_unique(f, scene.clouds, "cloud");
  f.must(!f.reading || scene.clouds.size() <= kMostClouds, "kind", "too many clouds",
         fmt::format("accepted are up to {}", kMostClouds));
  if (F::reading && (sphere || grid)) must_be_in_the_air(f, cloud, scene.planet);
}

// One word for a sky: chapters/17_cloud_shapes/cloud_bodies.cpp has the bodies.
template <typename F>
void fields(F& f, Weather& weather, Scene& scene) {
  f("preset", weather.preset, {.choices = {"clear", "fair", "broken", "overcast", "storm", "mackerel"}},
    "the clouds of a kind of weather", {.knob = "weather.preset"});
  f("seed", weather.seed, {0, 1e6}, "which part of noise and weather is seen");
  const auto own_map = [](const Cloud& cloud) { return cloud.weather != "procedural"; };
  f.must(!f.reading || std::none_of(scene.clouds.begin(), scene.clouds.end(), own_map), "",
         "[weather] beside a weather map", "accepted is one of the two");
}

template <typename F>
void fields(F& f, Post& post, Scene&) {
  f("exposure", post.manual, {.choices = {"auto", "manual"}}, "metered, from chapter 06 on, or set by hand",
    {.knob = "exposure.mode"});
  f("exposure_ev", post.exposure_ev, {-20, 30, "stops"}, "exposure set by hand", {.knob = "exposure.ev"});
  f("compensation_ev", post.compensation_ev, {-20, 20, "stops"}, "on top of what the meter finds",
    {.knob = "exposure.compensation"});
}

// The file itself: what stands before any section.
template <typename F>
void fields(F& f, Scene& scene, Scene&) {
  f("name", scene.name, ranges::name, "what the scene is called");
  f("time_s", scene.time_s, ranges::time, "the moment shown, after that of the sun's angles; --time sets it");
}

// The sections in the order in which they are read and written: visit(name, member).
template <typename Visit>
void sections(Scene& scene, Visit&& visit) {
  visit("planet", scene.planet);
  visit("medium", scene.media);
  visit("sun", scene.sun);
  visit("view", scene.views);
  visit("path", scene.paths);
  visit("terrain", scene.terrain);
  visit("cloud", scene.clouds);
  visit("weather", scene.weather);
  visit("post", scene.post);
}
// [/table]

}  // namespace welkin
