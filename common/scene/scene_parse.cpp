// Reading a scene: strict TOML. Every message is one line with file:line:column (both counted from 1) and
// what is accepted. The format, its units, ranges and defaults are in docs/scenes.md.
#include <set>

#include "common/scene/scene.hpp"
#include "common/scene/strict_toml.hpp"
#include "common/scene/sun.hpp"

namespace welkin {
namespace {

using namespace strict_toml;

constexpr int kVersion = 1;
constexpr const char* kSections = "planet, medium, sun, view, terrain, post, settings";
// A dotted key nests one table per dot, and tables are destroyed recursively: bounded lines bound the
// recursion.
constexpr size_t kLongestLine = 1024;
constexpr size_t kMostViews = 64, kMostSettings = 256, kLongestValue = 200;

void check_top(const Section& root) {
  if (!has(root, "version"))
    fail_at(*root.file, root.table->source(), "no version", fmt::format("a scene says version = {}", kVersion));
  const toml::node& version = *root.table->get("version");
  if (!version.is_integer() || version.as_integer()->get() != kVersion)
    fail_at(*root.file, version.source(), fmt::format("version {}", describe(version)),
            fmt::format("this build knows version {}", kVersion));
  const toml::key* key =
      first_unknown(root, {"version", "name", "planet", "medium", "sun", "view", "terrain", "post", "settings"});
  if (!key) return;
  for (const char* later : {"clouds", "fog", "smoke", "night"})
    if (*key == later)
      fail_at(*root.file, key->source(), fmt::format("section '{}'", later),
              fmt::format("not known to this build, which knows {}", kSections));
  fail_at(*root.file, key->source(), fmt::format("unknown section or key '{}'", one_line(key->str(), 60)),
          fmt::format("known are version, name, {}", kSections));
}

void read_planet(const Section& section, Planet& planet) {
  check_keys(section, {"ground_radius_km", "top_radius_km", "ground_albedo"});
  read(section, "ground_radius_km", planet.ground_radius_km, {100, 1e5, "km"});
  if (has(section, "ground_radius_km") != has(section, "top_radius_km"))
    fail_at(*section.file, section.table->source(), "planet with one radius",
            "accepted is ground_radius_km and top_radius_km together, or neither");
  const double thinnest = planet.ground_radius_km + 1, thickest = planet.ground_radius_km + 2000;
  read(section, "top_radius_km", planet.top_radius_km, {thinnest, thickest, "km (1 to 2000 km above the ground)"});
  read(section, "ground_albedo", planet.ground_albedo, {0, 1});
}

constexpr Range kCoefficient{0, 100, "km^-1"};

void read_absorption(const Section& section, Medium& medium) {
  check_exclusive(section, "absorption_per_km", "extinction_per_km");
  read(section, "absorption_per_km", medium.absorption_per_km, kCoefficient);
  if (!has(section, "extinction_per_km")) return;
  glm::dvec3 extinction(0.0);
  read(section, "extinction_per_km", extinction, kCoefficient);
  medium.absorption_per_km = extinction - medium.scattering_per_km;
  for (int i = 0; i < 3; ++i)
    if (medium.absorption_per_km[i] < 0)
      fail_at(*section.file, place(section, "extinction_per_km"),
              fmt::format("medium.extinction_per_km[{}] = {} is less than scattering_per_km[{}] = {}", i, extinction[i],
                          i, medium.scattering_per_km[i]),
              "accepted is extinction = scattering + absorption, so at least the scattering");
}

void need(const Section& section, std::string_view key, const std::string& why) {
  if (!has(section, key))
    fail_at(*section.file, section.table->source(), fmt::format("no {} in {}", key, section.name), why);
}

// What a medium may say follows from its kind, so that nothing can be said that would not be simulated.
Medium read_medium(const Section& section) {
  need(section, "kind", "accepted is kind = \"rayleigh\", \"mie\" or \"ozone\"");
  const size_t kind = read_choice(section, "kind", {"rayleigh", "mie", "ozone"}, 0);
  const Section named{section.table,
                      kind == 0   ? "medium 'rayleigh'"
                      : kind == 1 ? "medium 'mie'"
                                  : "medium 'ozone'",
                      section.file};
  Medium medium;
  if (kind == 0) {
    medium.kind = "rayleigh";
    check_keys(named, {"kind", "scattering_per_km", "profile", "scale_height_km", "phase"});
    need(named, "scattering_per_km", "accepted is " + text_of(kCoefficient));
    read_choice(section, "phase", {"rayleigh"}, 0);
  } else if (kind == 1) {
    medium.kind = "mie";
    medium.scale_height_km = 1.2;
    check_keys(named, {"kind", "scattering_per_km", "absorption_per_km", "extinction_per_km", "profile",
                       "scale_height_km", "phase", "g", "draine_alpha", "second_g", "second_weight"});
    need(named, "scattering_per_km", "accepted is " + text_of(kCoefficient));
    constexpr Phase kPhases[] = {Phase::henyey_greenstein, Phase::cornette_shanks, Phase::draine, Phase::double_hg};
    medium.phase =
        kPhases[read_choice(section, "phase", {"henyey_greenstein", "cornette_shanks", "draine", "double_hg"}, 1)];
    medium.g = 0.8;
    read(section, "g", medium.g, {-0.999, 0.999});
    read(section, "draine_alpha", medium.draine_alpha, {0, 100});
    read(section, "second_g", medium.second_g, {-0.999, 0.999});
    read(section, "second_weight", medium.second_weight, {0, 1});
  } else {
    medium.kind = "ozone";
    medium.profile = Profile::tent;
    check_keys(named,
               {"kind", "absorption_per_km", "extinction_per_km", "profile", "peak_altitude_km", "half_width_km"});
    if (!has(section, "extinction_per_km")) need(named, "absorption_per_km", "accepted is " + text_of(kCoefficient));
  }
  read(section, "scattering_per_km", medium.scattering_per_km, kCoefficient);
  read_absorption(section, medium);
  read_choice(section, "profile", {kind == 2 ? "tent" : "exponential"}, 0);
  read(section, "scale_height_km", medium.scale_height_km, {0.01, 1000, "km"});
  read(section, "peak_altitude_km", medium.peak_altitude_km, {0, 2000, "km"});
  read(section, "half_width_km", medium.half_width_km, {0.01, 2000, "km"});
  return medium;
}

void read_sun(const Section& section, Sun& sun) {
  check_keys(section, {"zenith_deg", "azimuth_deg", "utc", "latitude_deg", "longitude_deg", "angular_radius_deg",
                       "irradiance", "disc"});
  read(section, "zenith_deg", sun.zenith_deg, {0, 180, "deg"});
  read_azimuth(section, "azimuth_deg", sun.azimuth_deg);
  read(section, "angular_radius_deg", sun.angular_radius_deg, {0.001, 45, "deg"});
  read(section, "irradiance", sun.irradiance, {0, 1e6});
  read(section, "disc", sun.disc);
  for (const char* key : {"latitude_deg", "longitude_deg"}) {
    const char *given = has(section, key) ? key : "utc", *missing = has(section, key) ? "utc" : key;
    if (has(section, given) && !has(section, missing))
      fail_at(*section.file, place(section, given), fmt::format("sun.{} without {}", given, missing),
              "accepted is zenith_deg and azimuth_deg, or utc, latitude_deg and longitude_deg together");
  }
  if (!has(section, "utc")) return;
  check_exclusive(section, "utc", "zenith_deg");
  check_exclusive(section, "utc", "azimuth_deg");
  read(section, "latitude_deg", sun.latitude_deg, {-90, 90, "deg"});
  read(section, "longitude_deg", sun.longitude_deg, {-360, 360, "deg"});
  const toml::node& utc = *section.table->get("utc");
  if (!utc.is_string()) fail_value(section, "utc", utc, "quoted text, for example \"2026-06-21T10:30:00\"");
  sun.utc = utc.as_string()->get();
  SunAngles angles;
  try {
    angles = sun_angles(*sun.utc, sun.latitude_deg, sun.longitude_deg);
  } catch (const Error& error) {
    fail_at(*section.file, utc.source(), "sun.utc", error.what());
  }
  sun.zenith_deg = angles.zenith_deg;
  sun.azimuth_deg = angles.azimuth_deg;
}

View read_view(const Section& section, double sun_azimuth_deg) {
  check_keys(section, {"name", "altitude_km", "azimuth_deg", "azimuth_from_sun_deg", "elevation_deg", "fov_deg"});
  need(section, "name", "every [[view]] has one, for example name = \"horizon\"");
  View view;
  read_name(section, "name", view.name);
  read(section, "altitude_km", view.altitude_km, {0, 1e6, "km"});
  check_exclusive(section, "azimuth_deg", "azimuth_from_sun_deg");
  read_azimuth(section, "azimuth_deg", view.azimuth_deg);
  read_azimuth(section, "azimuth_from_sun_deg", view.azimuth_deg, sun_azimuth_deg);
  read(section, "elevation_deg", view.elevation_deg, {-90, 90, "deg"});
  read(section, "fov_deg", view.fov_deg, {1, 170, "deg"});
  return view;
}

// Whether the map can be read is found out when it is drawn: most chapters have no terrain.
Terrain read_terrain(const Section& section) {
  check_keys(section, {"height_map", "extent_km", "height_km", "size", "seed", "shadows", "signs_azimuth_deg"});
  Terrain terrain;
  if (has(section, "height_map")) {
    const toml::node& map = *section.table->get("height_map");
    if (map.is_string()) terrain.height_map = map.as_string()->get();
    if (terrain.height_map.empty() || terrain.height_map.size() > 1000 ||
        one_line(terrain.height_map) != terrain.height_map)
      fail_value(section, "height_map", map, "the name of a 16-bit grayscale PNG file, quoted");
    check_exclusive(section, "height_map", "size");
    check_exclusive(section, "height_map", "seed");
  }
  read(section, "extent_km", terrain.extent_km, {1, 1000, "km"});
  read(section, "height_km", terrain.height_km, {0, 20, "km"});
  read(section, "size", terrain.size, {64, 4096, "samples"});
  read(section, "seed", terrain.seed, {0, 1e6});
  read(section, "shadows", terrain.shadows);
  if (has(section, "signs_azimuth_deg"))
    read_azimuth(section, "signs_azimuth_deg", terrain.signs_azimuth_deg.emplace());
  return terrain;
}

// Knob names belong to chapters, so only their spelling is checked here; the chapter checks the rest.
void read_settings(const Section& section, Scene& scene) {
  std::vector<const toml::key*> keys;
  for (auto&& entry : *section.table) keys.push_back(&entry.first);
  std::sort(keys.begin(), keys.end(), earlier);
  if (keys.size() > kMostSettings)
    fail_at(*section.file, keys[kMostSettings]->source(), fmt::format("{} settings", keys.size()),
            fmt::format("accepted are up to {}", kMostSettings));
  for (const toml::key* key : keys) {
    const std::string name(key->str());
    const toml::node& node = *section.table->get(name);
    const std::string shown = one_line(name, 60);
    if (node.is_table())
      fail_at(*section.file, key->source(), fmt::format("settings.{} is a table", shown),
              "a knob's name is quoted, for example \"mie.g\" = 0.8");
    if (name.empty() || name.size() > kLongestName ||
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.") != std::string::npos)
      fail_at(*section.file, key->source(), fmt::format("knob name '{}'", shown),
              fmt::format("accepted is 1 to {} lower-case letters, digits, _ and .", kLongestName));
    std::string value;
    if (node.is_string()) value = node.as_string()->get();
    if (node.is_boolean()) value = node.as_boolean()->get() ? "on" : "off";
    if (node.is_number()) value = describe(node);
    const bool finite = !node.is_floating_point() || std::isfinite(node.as_floating_point()->get());
    if (!finite || value.empty() || value.size() > kLongestValue || one_line(value) != value)
      fail_value(section, name, node,
                 fmt::format("a finite number, true, false or quoted text of 1 to {} characters", kLongestValue));
    scene.settings.emplace_back(name, value);
  }
}

void check_lines(const std::string& text, const std::string& file) {
  size_t start = 0;
  for (toml::source_index line = 1; start <= text.size(); ++line) {
    const size_t end = std::min(text.find('\n', start), text.size());
    if (end - start > kLongestLine)
      fail_at(file, {{line, static_cast<toml::source_index>(kLongestLine + 1)}, {}, {}}, "line too long",
              fmt::format("accepted are lines of up to {} bytes", kLongestLine));
    start = end + 1;
  }
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& file) {
  check_lines(text, file);
  const toml::table table = parse_table(text, file);
  const Section root{&table, "", &file};
  check_top(root);
  Scene scene;
  read_name(root, "name", scene.name);
  for_table(root, "planet", [&](const Section& section) { read_planet(section, scene.planet); });
  for_each_table(root, "medium", [&](const Section& section) {
    const Medium medium = read_medium(section);
    if (scene.medium(medium.kind))
      fail_at(file, place(section, "kind"), fmt::format("second medium '{}'", medium.kind), "each kind at most once");
    scene.media.push_back(medium);
  });
  for_table(root, "sun", [&](const Section& section) { read_sun(section, scene.sun); });
  std::set<std::string> names;
  for_each_table(root, "view", [&](const Section& section) {
    scene.views.push_back(read_view(section, scene.sun.azimuth_deg));
    if (!names.insert(scene.views.back().name).second)
      fail_at(file, place(section, "name"), fmt::format("second view '{}'", scene.views.back().name), "each name once");
    if (names.size() > kMostViews)
      fail_at(file, section.table->source(), "too many views", fmt::format("accepted are up to {}", kMostViews));
  });
  if (scene.views.empty()) fail_at(file, table.source(), "no views", "a scene has at least one [[view]]");
  for_table(root, "terrain", [&](const Section& section) { scene.terrain = read_terrain(section); });
  for_table(root, "post", [&](const Section& section) {
    check_keys(section, {"exposure", "exposure_ev", "compensation_ev"});
    scene.post.manual = read_choice(section, "exposure", {"auto", "manual"}, 0) == 1;
    read(section, "exposure_ev", scene.post.exposure_ev, {-20, 30, "stops"});
    read(section, "compensation_ev", scene.post.compensation_ev, {-20, 20, "stops"});
  });
  for_table(root, "settings", [&](const Section& section) { read_settings(section, scene); });
  return scene;
}

}  // namespace welkin
