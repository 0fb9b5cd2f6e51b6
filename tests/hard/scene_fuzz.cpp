// Mutated scene files: each must parse to a scene whose every invariant holds and that survives being written
// and read again, or be refused by one non-empty line. Anything else (another exception, a crash, a hang)
// fails.
//
//   scene_fuzz [files=20000] [seed=1]
//   scene_fuzz --fields FILE.csv          the table of fields, which docs/scenes.md is woven from
//
// The same seed gives the same files everywhere: std::mt19937_64 is fixed by the standard, and no
// distribution is used. Run from any directory. A hang ends by SIGALRM after 300 s; an ordinary run takes a
// few seconds.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "tests/hard/scene_fields.hpp"
#include "tests/hard/scene_pieces.hpp"

namespace {

namespace fs = std::filesystem;
using welkin::Scene;
using welkin::test::kExtremes;
using welkin::test::kPieces;

const fs::path kScenes = fs::path(__FILE__).parent_path().parent_path().parent_path() / "chapters/scenes";

std::mt19937_64 random_bits;
size_t below(size_t n) { return n == 0 ? 0 : static_cast<size_t>(random_bits() % n); }
const std::vector<welkin::test::Row> rows = welkin::test::scene_rows();
template <typename List>
const auto& any_of(const List& list) {
  return list[below(std::size(list))];
}

// Replaces one number of the text, if a random place hits one.
void replace_number(std::string& text) {
  const char* digits = "0123456789";
  size_t start = text.find_first_of(digits, below(text.size()));
  if (start == std::string::npos) return;
  const size_t end = std::min(text.find_first_not_of("0123456789.eE+-_", start), text.size());
  text.replace(start, end - start, any_of(kExtremes));
}

void replace_value(std::string& text) {
  const size_t equals = text.find('=', below(text.size()));
  if (equals == std::string::npos) return;
  const size_t end = std::min(text.find('\n', equals), text.size());
  text.replace(equals + 1, end - equals - 1, any_of(kExtremes));
}

// A field of the table, said once more or in a section of its own.
std::string piece_of_table() {
  const welkin::test::Row& row = any_of(rows);
  const std::string value =
      row.number && below(2) ? fmt::format("{}", below(2) ? row.range.minimum : row.range.maximum) : any_of(kExtremes);
  const bool many = row.section == "view" || row.section == "medium" || row.section == "path" || row.section == "cloud";
  const std::string head =
      below(2) || row.section.empty() ? "\n" : fmt::format(fmt::runtime(many ? "\n[[{}]]\n" : "\n[{}]\n"), row.section);
  return fmt::format("{}{} = {}\n", head, row.key, value);
}

void mutate(std::string& text, const std::vector<std::string>& corpus) {
  const size_t at = below(text.size() + 1), length = below(std::min<size_t>(text.size() - at, 200) + 1);
  switch (below(16)) {
    case 0:
      if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
      break;
    case 1:
      if (at < text.size()) text[at] = static_cast<char>(below(256));
      break;
    case 2: text.erase(at, length); break;
    case 3: text.insert(at, text.substr(below(text.size() + 1), length)); break;
    case 4: text.insert(at, below(2) ? any_of(kPieces) : piece_of_table()); break;
    case 5: replace_number(text); break;
    case 6: replace_value(text); break;
    case 7: text.resize(at); break;
    case 8: {  // splice: the head of this file, the tail of another
      const std::string& other = any_of(corpus);
      text = text.substr(0, at) + other.substr(below(other.size() + 1));
      break;
    }
    case 9: {  // a whole line twice, or gone
      const size_t start = text.rfind('\n', at) == std::string::npos ? 0 : text.rfind('\n', at) + 1;
      const size_t end = std::min(text.find('\n', start), text.size());
      const std::string line = text.substr(start, end - start) + "\n";
      if (below(2))
        text.insert(start, line);
      else
        text.erase(start, line.size());
      break;
    }
    case 10:
      replace_number(text);
      replace_number(text);
      replace_value(text);
      break;
    case 11: text.insert(at, std::string(1 + below(40), any_of(std::string("[{\"'.,=#\n\\ a1")))); break;
    default: {  // another digit: most often still a scene
      const size_t digit = text.find_first_of("0123456789", at);
      if (digit != std::string::npos) text[digit] = static_cast<char>('0' + below(10));
    }
  }
  if (text.size() > 100000) text.resize(100000);
}

// Files made to exhaust a stack, a counter or patience; up to the 1 MiB a scene may have.
std::string hostile(size_t which) {
  const auto repeat = [](const std::string& piece, size_t times) {
    std::string out;
    for (size_t i = 0; i < times; ++i) out += piece;
    return out;
  };
  const std::string head = "version = 1\n";
  switch (which) {
    case 0: return head + "a = " + repeat("[", 500000);
    case 1: return head + "a = " + repeat("{a=", 300000);
    case 2: return head + repeat("a.", 500000) + "a = 1";
    case 3: return head + "[" + repeat("a.", 500000) + "a]";
    case 4: return head + repeat("[" + repeat("a.", 500) + "b]\n", 900);
    case 5: return head + repeat(repeat("b.", 500) + "c = [\n", 900);
    case 6: return head + repeat("[[view]]\n", 100000);
    case 7: {
      std::string views = head;
      for (int i = 0; i < 40000; ++i) views += fmt::format("[[view]]\nname = \"v{}\"\n", i);
      return views;
    }
    case 8: {
      std::string settings = head + "[[view]]\nname = \"v\"\n[settings]\n";
      for (int i = 0; i < 60000; ++i) settings += fmt::format("k{} = {}\n", i, i);
      return settings;
    }
    case 9: return head + "a = \"\"\"" + repeat("\n", 1000000);
    case 10: return repeat("#\n", 500000) + head;
    case 11: return std::string(1 << 20, '\0');
    case 12: return head + "a = [" + repeat("1,\n", 300000) + "]";
    default: return head + repeat("[[medium]]\nkind = \"mie\"\n" + repeat("c.", 500) + "c = {a = [[[1]]]}\n", 900);
  }
}

// A body of each kind and phase function.
std::vector<welkin::Cloud> clouds() {
  using enum welkin::CloudPhase;
  return {{.kind = "layer", .name = "deck", .phase = droplets},
          {.kind = "disc", .name = "coin", .radius_km = 5.0, .phase = draine_mixture},
          {.kind = "sphere", .up_km = 9.0},
          {.kind = "grid", .up_km = 1.0, .file = "a.grid"},
          {.kind = "noise", .type = 0.5}};
}

bool within(double value, double minimum, double maximum) { return value >= minimum && value <= maximum; }
bool within(const glm::dvec3& v, double minimum, double maximum) {
  return within(v.x, minimum, maximum) && within(v.y, minimum, maximum) && within(v.z, minimum, maximum);
}

// Nothing, or the invariant that an accepted scene breaks. Written out again here: the reader's own table is
// what is on trial.
std::string broken(const Scene& scene) {
  const double height = scene.planet.top_radius_km - scene.planet.ground_radius_km;
  if (!within(scene.planet.ground_radius_km, 100, 1e5) || !within(height, 1, 2000)) return "radii";
  if (!within(scene.planet.ground_albedo, 0, 1)) return "albedo";
  std::set<std::string> kinds, names;
  for (const welkin::Medium& m : scene.media) {
    if (!kinds.insert(m.kind).second || (m.kind != "rayleigh" && m.kind != "mie" && m.kind != "ozone")) return "kind";
    if (!within(m.scattering_per_km, 0, 100) || !within(m.absorption_per_km, 0, 100)) return "coefficients";
    if (!(m.scale_height_km > 0) || !(m.half_width_km > 0) || !within(m.peak_altitude_km, 0, 2000)) return "profile";
    if (!within(m.g, -0.999, 0.999) || !within(m.second_g, -0.999, 0.999) || !within(m.second_weight, 0, 1)) return "g";
    if (!within(m.draine_alpha, 0, 100)) return "draine_alpha";
    if ((m.kind == "ozone") != (m.profile == welkin::Profile::tent)) return "profile of kind";
    if ((m.kind == "mie") == (m.phase == welkin::Phase::rayleigh)) return "phase of kind";
  }
  if (!within(scene.sun.zenith_deg, 0, 180) || !within(scene.sun.azimuth_deg, 0, 360)) return "sun angles";
  if (!within(scene.sun.angular_radius_deg, 0.001, 45) || !within(scene.sun.irradiance, 0, 1e6)) return "sun";
  if (scene.views.empty()) return "no views";
  for (const welkin::View& v : scene.views) {
    if (v.name.empty() || !names.insert(v.name).second) return "view name";
    if (!within(v.altitude_km, 0, 1e6) || !within(v.azimuth_deg, 0, 360) || !within(v.elevation_deg, -90, 90))
      return "view";
    if (!within(v.fov_deg, 1, 170) || !within(v.east_km, -4e5, 4e5) || !within(v.north_km, -4e5, 4e5)) return "fov";
  }
  if (!within(scene.post.exposure_ev, -20, 30) || !within(scene.post.compensation_ev, -20, 20)) return "exposure";
  if (scene.time_s != 0.0 && !scene.sun.latitude_deg) return "time without latitude";
  for (const welkin::Path& path : scene.paths) {
    if (path.views.size() < 2 || path.time_s.size() != path.views.size()) return "path";
    if (!path.moment_s.empty() && path.moment_s.size() != path.views.size()) return "moments";
    for (size_t i = 1; i < path.time_s.size(); ++i)
      if (!(path.time_s[i] > path.time_s[i - 1])) return "path's times";
    for (const std::string& name : path.views)
      if (!names.contains(name)) return "path's views";
  }
  if (const auto& terrain = scene.terrain) {
    if (!within(terrain->extent_km, 1, std::min(1000.0, scene.planet.ground_radius_km))) return "extent";
    if (!within(terrain->height_km, 0, std::min(20.0, height))) return "height of terrain";
    if (!within(terrain->size, 64, 4096) || !within(terrain->seed, 0, 1e6)) return "size";
  }
  if (scene.clouds.size() > 64) return "number of clouds";
  for (const welkin::Cloud& cloud : scene.clouds) {
    if (!within(cloud.extinction_per_km, 0, 1000) || !within(cloud.single_scattering_albedo, 0, 1)) return "extinction";
    if (!within(cloud.droplet_diameter_um, 1.5, 50) || !within(cloud.coverage, 0, 1)) return "droplets, coverage";
    if (!within(cloud.base_km, 0, height) && cloud.kind != "sphere" && cloud.kind != "grid") return "base";
    if ((cloud.kind == "layer" || cloud.kind == "noise") && !(cloud.top_km > cloud.base_km)) return "top";
    if (cloud.kind == "sphere" && !within(cloud.radius_km, 0.001, 0.5 * height)) return "radius";
  }
  for (const auto& [knob, value] : scene.settings)
    if (knob.empty() || value.empty() || value.find('\n') != std::string::npos) return "settings";
  const std::string written = welkin::write_scene(scene);
  if (!(welkin::parse_scene(written, "written") == scene)) return "round trip";
  return welkin::constituents(scene).size() == 5 ? "" : "effects";
}

// Each number of the table at its limits, and just outside them, in a file that says everything: within, the file is
// read or another value is in the way; outside, it is refused, and told what is accepted.
bool limits_hold() {
  Scene whole = welkin::parse_scene(welkin::read_file(kScenes / "earth.toml", 1 << 20), "earth");
  whole.terrain = welkin::Terrain{.signs_azimuth_deg = 1.0};
  whole.clouds = clouds();
  whole.weather.emplace();
  whole.sun.latitude_deg = 1.0, whole.sun.longitude_deg = 1.0;
  const std::string text = welkin::write_scene(whole);
  size_t tried = 0;
  for (const welkin::test::Row& row : rows) {
    const std::string head = row.kind.empty() ? "" : fmt::format("kind = \"{}\"\n", row.kind);
    const std::string section = row.section.empty() ? "version" : fmt::format("[{}]", row.section);
    size_t start = text.find(section);
    if (!head.empty()) start = text.find(head, start);
    const size_t line = text.find("\n" + row.key + " = ", start);
    const size_t next = text.find("\n[", start + section.size());
    if (!row.number || start == text.npos || line > next) continue;
    ++tried;
    for (const double limit : {row.range.minimum, row.range.maximum})
      for (const bool outside : {false, true}) {
        const double value = outside ? std::nextafter(limit, limit == row.range.minimum ? -1e300 : 1e300) : limit;
        std::string changed = text;
        changed.replace(line + 1, text.find('\n', line + 1) - line - 1, fmt::format("{} = {}", row.key, value));
        std::string message;
        try {
          welkin::parse_scene(changed, "f");
        } catch (const welkin::Error& error) {
          message = error.what();
        }
        const bool told = message.find(row.key + " = ") != message.npos && message.find("accepted is") != message.npos;
        if (outside == told) continue;
        if (!outside && message.find(row.key) == message.npos) continue;  // the value of another key is in the way
        fmt::print("{} {} = {}: {}\n", row.section, row.key, value, message.empty() ? "accepted" : message);
        return false;
      }
  }
  fmt::print("{} of {} fields at their limits\n", tried, rows.size());
  return tried > 30;
}

struct Counts {
  size_t accepted = 0, refused = 0, not_toml = 0;  // not_toml: of the refused
};

// False if the file does anything but parse soundly or be refused in one line.
bool survives(const std::string& text, Counts& counts) {
  std::string fault;
  try {
    const Scene scene = welkin::parse_scene(text, "mutated.toml");
    fault = broken(scene);
    ++counts.accepted;
  } catch (const welkin::Error& error) {
    const std::string line = error.what();
    const bool one_line = std::none_of(line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; });
    if (line.empty() || !one_line || line.size() > 1200) fault = "message: " + line;
    if (line.find(" at mutated.toml:") == std::string::npos) fault = "message without its place: " + line;
    ++counts.refused;
    counts.not_toml += line.starts_with("not valid TOML");
  } catch (const std::exception& error) {
    fault = std::string("exception: ") + error.what();
  }
  if (!fault.empty()) fmt::print("FAILED ({}):\n{}\n", fault, text.substr(0, 4000));
  return fault.empty();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "--fields") {
    welkin::write_file_atomically(argv[2], welkin::test::scene_fields_csv());
    return 0;
  }
  const size_t files = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 20000;
  const size_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  random_bits.seed(seed);
  alarm(300);

  std::vector<fs::path> paths(fs::directory_iterator{kScenes}, fs::directory_iterator{});
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> corpus;
  for (const fs::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    Scene scene = welkin::parse_scene(corpus.back(), path.string());
    scene.paths = {{"p", {scene.views[0].name, scene.views[1].name}, {0.0, 2.5}, {0.0, 60.0}}};
    scene.clouds = clouds();
    scene.weather = welkin::Weather{.preset = "storm"};
    corpus.push_back(welkin::write_scene(scene));
  }
  Counts counts;
  bool good = files > 0 && corpus.size() >= 14 && limits_hold();
  for (size_t which = 0; which < 14; ++which) good = survives(hostile(which), counts) && good;
  for (size_t i = 0; i < files && good; ++i) {
    std::string text = any_of(corpus);
    for (size_t rounds = 1 + below(i % 4 == 0 ? 8 : 2); rounds > 0; --rounds) mutate(text, corpus);
    good = survives(text, counts);
    if (!good) fmt::print("file {} of seed {}\n", i, seed);
  }
  // Every outcome must be common, or the mutations test nothing.
  const size_t few = files / 20, read = counts.refused - counts.not_toml;
  if (files >= 1000) good = good && counts.accepted > few && counts.not_toml > few && read > few;
  fmt::print("{} files: {} accepted, {} no TOML, {} no scene, {}\n", counts.accepted + counts.refused, counts.accepted,
             counts.not_toml, read, good ? "none misbehaved" : "FAILED");
  return good ? 0 : 1;
}
