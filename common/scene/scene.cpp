// Scenes by name or file, look-ups inside a scene, the list of effects, and writing a scene as TOML. Reading
// the TOML is in scene_parse.cpp; the format is described in docs/scenes.md.
#include "common/scene/scene.hpp"

#include <strings.h>

#include <algorithm>
#include <system_error>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "common/image/png.hpp"
#include "common/scene/fields.hpp"
#include "common/scene/one_line.hpp"

namespace welkin {
namespace {

namespace fs = std::filesystem;
constexpr size_t kLargestFile = 1u << 20;  // bytes: a scene is a page of text

std::string known_scenes(const fs::path& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator i(directory, error), end; !error && i != end; i.increment(error))
    if (i->path().extension() == ".toml") names.push_back(one_line(i->path().stem().string()));
  std::sort(names.begin(), names.end());
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

// The one of that name, or the first for "".
template <typename List>
const auto& named(const List& list, const std::string& wanted, const char* what, const std::string& scene) {
  std::vector<std::string> names;
  for (const auto& one : list) {
    if (wanted.empty() || one.name == wanted) return one;
    names.push_back(one.name);
  }
  fail("{} '{}': scene '{}' has {}", what, one_line(wanted, 60), scene,
       names.empty() ? fmt::format("no {}s", what) : fmt::format("{}", fmt::join(names, ", ")));
}

// A map lies where the scene says, from the scene's own directory; else, moved together with it, beside it.
std::string find_beside(const fs::path& directory, const fs::path& said) {
  std::error_code error;
  const fs::path whole = fs::absolute(directory / said, error).lexically_normal();
  const fs::path beside = fs::absolute(directory / said.filename(), error).lexically_normal();
  return (!fs::exists(whole, error) && fs::exists(beside, error) ? beside : whole).string();
}

// Values as TOML; nothing for what is not said. The shortest text that reads back as the same number; + 0.0 because
// "-0" would be read as the whole number 0.
std::string toml(double value) { return fmt::format("{}", value + 0.0); }
std::string toml(int value) { return fmt::format("{}", value); }
std::string toml(bool value) { return value ? "true" : "false"; }
std::string toml(const glm::dvec3& v) { return fmt::format("[{}, {}, {}]", toml(v.x), toml(v.y), toml(v.z)); }
std::string toml(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    out += control ? fmt::format("\\u{:04X}", static_cast<unsigned>(c)) : std::string(1, c);
  }
  return '"' + out + '"';
}
template <typename T>
std::string toml(const std::optional<T>& value) {
  return value ? toml(*value) : "";
}
template <typename T>
std::string toml(const std::vector<T>& values) {  // one to a line: a file's lines are not long
  std::string out;
  for (const T& value : values) out += (out.empty() ? "[" : ",\n  ") + toml(value);
  return out.empty() ? out : out + "]";
}

struct Writer : Visitor {
  std::string text;
  std::vector<std::string> keys;

  template <typename T>
  void operator()(const char* key, const T& value, const Range& range, const char*, const More& more = {}) {
    std::string said;
    if (!range.choices.empty())
      said = toml(std::string(range.choices[size_t(choice_of(range, value))]));
    else if constexpr (!std::is_enum_v<T>)
      said = toml(value);
    if (said.empty() || said == "\"\"" || std::find(keys.begin(), keys.end(), more.besides) != keys.end()) return;
    text += fmt::format("{} = {}\n", key, said);
    keys.push_back(key);
  }
};

bool any(const glm::dvec3& v) { return v.x != 0.0 || v.y != 0.0 || v.z != 0.0; }

}  // namespace

const Medium* Scene::medium(const std::string& kind) const {
  const auto found = std::find_if(media.begin(), media.end(), [&](const Medium& m) { return m.kind == kind; });
  return found == media.end() ? nullptr : &*found;
}

Medium* Scene::medium(const std::string& kind) {
  return const_cast<Medium*>(static_cast<const Scene*>(this)->medium(kind));
}

const View& Scene::view(const std::string& wanted) const { return named(views, wanted, "view", name); }
const Path& Scene::path(const std::string& wanted) const { return named(paths, wanted, "path", name); }

Scene load_scene(const std::string& name_or_file, const fs::path& scenes_directory) {
  if (name_or_file.empty()) fail("no scene named: known are {}", known_scenes(scenes_directory));
  fs::path path = name_or_file;
  if (name_or_file.find('\0') != std::string::npos) fail("scene file {}: not a file name", one_line(name_or_file));
  if (plain_name(name_or_file) && name_or_file.find('.') == std::string::npos) {
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
  each_file(scene, [&](std::string& file) { file = find_beside(path.parent_path(), file); });
  return scene;
}

void each_file(Scene& scene, const std::function<void(std::string&)>& visit) {
  if (scene.terrain && !scene.terrain->height_map.empty()) visit(scene.terrain->height_map);
  for (Cloud& cloud : scene.clouds) {
    if (!cloud.file.empty()) visit(cloud.file);
    if (cloud.weather != "procedural") visit(cloud.weather);
  }
}

std::string portable_path(const std::string& file, const fs::path& directory) {
  if (file.empty()) return {};
  std::error_code error;
  const fs::path from = fs::absolute(directory, error).lexically_normal(),
                 to = fs::absolute(file, error).lexically_normal();
  const auto split = std::mismatch(from.begin(), from.end(), to.begin(), to.end()).first;
  const std::string way = to.lexically_relative(from).string();
  const bool near = std::distance(from.begin(), split) > 1;  // more than the root in common
  return (near && way.size() <= 400 && one_line(way) == way) ? way : to.filename().string();
}

std::string write_scene(const Scene& scene) {
  Writer writer{.text = "version = 1\n"};
  Scene written = scene;
  fields(writer, written, written);
  sections(written, [&](const char* name, auto& member) {
    constexpr bool many = is_many<std::decay_t<decltype(member)>>;
    each_of(member, [&](auto& section) {
      writer.text += fmt::format(many ? "\n[[{}]]\n" : "\n[{}]\n", name);
      writer.keys.clear();
      fields(writer, section, written);
    });
  });
  if (!scene.settings.empty()) writer.text += "\n[settings]\n";
  for (const auto& [knob, value] : scene.settings) writer.text += fmt::format("{} = {}\n", toml(knob), toml(value));
  return writer.text;
}

std::vector<Constituent> constituents(const Scene& scene) {
  std::vector<Constituent> list;
  for (const char* kind : {"rayleigh", "mie", "ozone"}) {
    const Medium* medium = scene.medium(kind);
    const bool on = medium && (any(medium->scattering_per_km) || any(medium->absorption_per_km));
    const char* but = medium && !on ? ", but its coefficients are 0" : "";
    list.push_back({kind, on, fmt::format("{}medium '{}' in scene{}", medium ? "" : "no ", kind, but)});
  }
  const bool ground = any(scene.planet.ground_albedo), disc = scene.sun.disc, lit = any(scene.sun.irradiance);
  list.push_back({"sun disc", disc && lit,
                  !disc ? "sun.disc = false"
                  : lit ? "sun.disc = true"
                        : "sun.irradiance is 0"});
  list.push_back(
      {"ground", ground,
       ground ? "planet.ground_albedo is above 0" : "planet.ground_albedo is 0: the ground reflects nothing"});
  return list;
}

}  // namespace welkin
