// Scenes by name or file, look-ups inside a scene, the list of effects, and writing a scene as TOML. Reading
// the TOML is in scene_parse.cpp; the format is described in docs/scenes.md.
#include "common/scene/scene.hpp"

#include <strings.h>

#include <algorithm>
#include <system_error>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "common/image/png.hpp"
#include "common/scene/one_line.hpp"

namespace welkin {
namespace {

namespace fs = std::filesystem;
constexpr size_t kLargestFile = 1u << 20;  // bytes: a scene is a page of text

bool plain_name(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string known_scenes(const fs::path& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator i(directory, error), end; !error && i != end; i.increment(error))
    if (i->path().extension() == ".toml") names.push_back(one_line(i->path().stem().string()));
  std::sort(names.begin(), names.end());
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// The shortest text that reads back as the same value; + 0.0 because "-0" would be read as the whole number
// 0.
std::string number(double value) { return fmt::format("{}", value + 0.0); }
std::string triple(const glm::dvec3& v) { return fmt::format("[{}, {}, {}]", number(v.x), number(v.y), number(v.z)); }

// A TOML basic string.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      out += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

const char* text(Phase phase) {
  switch (phase) {
    case Phase::henyey_greenstein: return "henyey_greenstein";
    case Phase::cornette_shanks: return "cornette_shanks";
    case Phase::draine: return "draine";
    case Phase::double_hg: return "double_hg";
    case Phase::rayleigh: return "rayleigh";
  }
  return "rayleigh";
}

bool any(const glm::dvec3& v) { return v.x != 0.0 || v.y != 0.0 || v.z != 0.0; }

}  // namespace

const Medium* Scene::medium(const std::string& kind) const {
  const auto found = std::find_if(media.begin(), media.end(), [&](const Medium& m) { return m.kind == kind; });
  return found == media.end() ? nullptr : &*found;
}

Medium* Scene::medium(const std::string& kind) {
  return const_cast<Medium*>(static_cast<const Scene*>(this)->medium(kind));
}

const View& Scene::view(const std::string& wanted) const {
  std::vector<std::string> names;
  for (const View& view : views) {
    if (wanted.empty() || view.name == wanted) return view;
    names.push_back(view.name);
  }
  fail("view '{}': scene '{}' has {}", one_line(wanted, 60), name,
       names.empty() ? "no views" : fmt::format("{}", fmt::join(names, ", ")));
}

Scene load_scene(const std::string& name_or_file, const fs::path& scenes_directory) {
  if (name_or_file.empty()) fail("no scene named: known are {}", known_scenes(scenes_directory));
  fs::path path = name_or_file;
  if (name_or_file.find('\0') != std::string::npos) fail("scene file {}: not a file name", one_line(name_or_file));
  if (plain_name(name_or_file)) {
    path = scenes_directory / (name_or_file + ".toml");
    std::error_code error;
    if (!fs::exists(path, error))
      fail("unknown scene '{}': known are {}; a file's name ends in .toml or .png", one_line(name_or_file, 100),
           known_scenes(scenes_directory));
  }
  const std::string shown = one_line(path.string());
  const bool picture = strcasecmp(path.extension().c_str(), ".png") == 0;
  std::optional<std::string> text;
  try {
    text = picture ? image::read_png_text(path, "welkin.scene") : read_file(path, kLargestFile);
  } catch (const Error& error) {  // those name the file as it is, line breaks included
    throw Error(error.exit_code, one_line(error.what()));
  }
  if (!text) fail("scene file {}: this picture carries no scene; accepted is a .png that a chapter wrote", shown);
  Scene scene = parse_scene(*text, picture ? shown + " (embedded scene)" : shown);
  // A height map lies beside the scene that names it.
  if (scene.terrain && !scene.terrain->height_map.empty()) {
    const fs::path map = path.parent_path() / scene.terrain->height_map;  // an absolute name stays as it is
    std::error_code error;
    const fs::path whole = fs::absolute(map, error);
    scene.terrain->height_map = (error ? map : whole).lexically_normal().string();
  }
  return scene;
}

std::string write_scene(const Scene& scene) {
  std::string out = fmt::format("version = 1\nname = {}\n\n", quoted(scene.name));
  const auto line = [&out](const char* key, const std::string& value) { out += fmt::format("{} = {}\n", key, value); };
  out += "[planet]\n";
  line("ground_radius_km", number(scene.planet.ground_radius_km));
  line("top_radius_km", number(scene.planet.top_radius_km));
  line("ground_albedo", triple(scene.planet.ground_albedo));
  for (const Medium& medium : scene.media) {
    out += "\n[[medium]]\n";
    line("kind", quoted(medium.kind));
    if (medium.kind != "ozone") line("scattering_per_km", triple(medium.scattering_per_km));
    if (medium.kind != "rayleigh") line("absorption_per_km", triple(medium.absorption_per_km));
    if (medium.profile == Profile::tent) {
      line("profile", "\"tent\"");
      line("peak_altitude_km", number(medium.peak_altitude_km));
      line("half_width_km", number(medium.half_width_km));
    } else {
      line("profile", "\"exponential\"");
      line("scale_height_km", number(medium.scale_height_km));
    }
    if (medium.kind == "mie") {  // all of them: --set mie.phase can switch to a form that needs the others
      line("phase", quoted(text(medium.phase)));
      line("g", number(medium.g));
      line("draine_alpha", number(medium.draine_alpha));
      line("second_g", number(medium.second_g));
      line("second_weight", number(medium.second_weight));
    }
  }
  // Angles, never the date they came from: "today" would be another sun tomorrow.
  out += "\n[sun]\n";
  line("zenith_deg", number(scene.sun.zenith_deg));
  line("azimuth_deg", number(scene.sun.azimuth_deg));
  line("angular_radius_deg", number(scene.sun.angular_radius_deg));
  line("irradiance", triple(scene.sun.irradiance));
  line("disc", scene.sun.disc ? "true" : "false");
  for (const View& view : scene.views) {
    out += "\n[[view]]\n";
    line("name", quoted(view.name));
    line("altitude_km", number(view.altitude_km));
    line("azimuth_deg", number(view.azimuth_deg));
    line("elevation_deg", number(view.elevation_deg));
    line("fov_deg", number(view.fov_deg));
  }
  if (scene.terrain) {
    const Terrain& terrain = *scene.terrain;
    out += "\n[terrain]\n";
    line("extent_km", number(terrain.extent_km));
    line("height_km", number(terrain.height_km));
    if (!terrain.height_map.empty())
      line("height_map", quoted(terrain.height_map));
    else
      line("size", fmt::format("{}", terrain.size)), line("seed", fmt::format("{}", terrain.seed));
    line("shadows", terrain.shadows ? "true" : "false");
    if (terrain.signs_azimuth_deg) line("signs_azimuth_deg", number(*terrain.signs_azimuth_deg));
  }
  out += "\n[post]\n";
  line("exposure", scene.post.manual ? "\"manual\"" : "\"auto\"");
  line("exposure_ev", number(scene.post.exposure_ev));
  line("compensation_ev", number(scene.post.compensation_ev));
  if (!scene.settings.empty()) out += "\n[settings]\n";
  for (const auto& [knob, value] : scene.settings) line(quoted(knob).c_str(), quoted(value));
  return out;
}

std::vector<Constituent> constituents(const Scene& scene) {
  std::vector<Constituent> list;
  for (const char* kind : {"rayleigh", "mie", "ozone"}) {
    const Medium* medium = scene.medium(kind);
    if (!medium)
      list.push_back({kind, false, fmt::format("no medium '{}' in scene", kind)});
    else if (!any(medium->scattering_per_km) && !any(medium->absorption_per_km))
      list.push_back({kind, false, fmt::format("medium '{}' in scene, but its coefficients are 0", kind)});
    else
      list.push_back({kind, true, fmt::format("medium '{}' in scene", kind)});
  }
  const Sun& sun = scene.sun;
  list.push_back({"sun disc", sun.disc && any(sun.irradiance),
                  !sun.disc             ? "sun.disc = false"
                  : any(sun.irradiance) ? "sun.disc = true"
                                        : "sun.irradiance is 0"});
  const bool ground = any(scene.planet.ground_albedo);
  list.push_back({"ground", ground,
                  fmt::format("planet.ground_albedo is {}{}", ground ? "" : "0: the ground reflects nothing",
                              ground ? triple(scene.planet.ground_albedo) : "")});
  return list;
}

}  // namespace welkin
