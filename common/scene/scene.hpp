// What exists: planet, media, sun, cameras. A scene file says it; nothing it does not say is simulated.
//
// Units: km, km^-1, degrees where a name says _deg. Radiance is per unit of solar irradiance at the top of the
// atmosphere. Frame at a view: x = east, y = north, z = up; azimuth in degrees clockwise from north (0 = north, 90 =
// east).
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace welkin {

enum class Profile { exponential, tent };
enum class Phase { henyey_greenstein, cornette_shanks, draine, double_hg, rayleigh };

// One constituent of the air. Coefficients are those where its profile is 1 (the ground, or the tent's peak).
struct Medium {
  std::string kind;  // "rayleigh", "mie" or "ozone": each at most once in a scene
  glm::dvec3 scattering_per_km{0.0};
  glm::dvec3 absorption_per_km{0.0};
  Profile profile = Profile::exponential;
  double scale_height_km = 8.0;    // exponential: exp(-h / scale height)
  double peak_altitude_km = 25.0;  // tent: max(0, 1 - |h - peak| / half width)
  double half_width_km = 15.0;
  Phase phase = Phase::rayleigh;
  double g = 0.0;             // asymmetry, |g| < 1
  double draine_alpha = 0.5;  // Draine's alpha (0: Henyey-Greenstein, 1: Cornette-Shanks)
  double second_g = -0.3;     // double HG: asymmetry and weight of the second lobe
  double second_weight = 0.1;
  bool operator==(const Medium&) const = default;
};

struct Planet {
  double ground_radius_km = 6360.0;
  double top_radius_km = 6460.0;
  glm::dvec3 ground_albedo{0.3};
  bool operator==(const Planet&) const = default;
};

struct Sun {
  // Either angles at the views, or date + time + place, from which the angles are computed (sun.hpp).
  double zenith_deg = 45.0;
  double azimuth_deg = 180.0;
  std::optional<std::string> utc;  // "2026-06-21T10:30:00" or "today 10:30" / "now"
  double latitude_deg = 0.0;       // north positive
  double longitude_deg = 0.0;      // east positive
  double angular_radius_deg = 0.2667;
  glm::dvec3 irradiance{1.0};
  bool disc = true;
  bool operator==(const Sun&) const = default;
};

struct View {
  std::string name = "view";
  double altitude_km = 0.0005;  // above the ground
  double azimuth_deg = 180.0;   // look direction
  double elevation_deg = 10.0;  // above the horizontal
  double fov_deg = 60.0;        // vertical
  bool operator==(const View&) const = default;
};

// Relief on the sphere, from a height map that is a square around the scene's place. Chapters below 11 have none.
struct Terrain {
  std::string height_map;                   // a 16-bit grayscale PNG; empty: hills are made from noise
  double extent_km = 128.0;                 // side of the square
  double height_km = 3.0;                   // of a white pixel, or of the highest hill
  int size = 1024;                          // samples a side of the map that is made
  int seed = 1;                             // of its noise
  bool shadows = true;                      // it keeps the sun from itself and from the air
  std::optional<double> signs_azimuth_deg;  // a row of signs at 1 to 100 km in this direction
  bool operator==(const Terrain&) const = default;
};

struct Post {
  bool manual = false;           // exposure set by hand even where a chapter has a light meter (06 on)
  double exposure_ev = 0.0;      // set by hand: stops, on top of the chapter's base exposure
  double compensation_ev = 0.0;  // metered: stops, on top of what the meter finds
  bool operator==(const Post&) const = default;
};

struct Scene {
  std::string name = "earth";
  Planet planet;
  std::vector<Medium> media;  // absent medium: it does not exist (no term, no variant)
  Sun sun;
  std::vector<View> views;  // at least one; the first is the default
  std::optional<Terrain> terrain;
  Post post;
  std::vector<std::pair<std::string, std::string>> settings;  // [settings] knob = value, applied before --set

  const Medium* medium(const std::string& kind) const;  // nullptr if the scene has none
  Medium* medium(const std::string& kind);
  const View& view(const std::string& name) const;  // "" = first; throws listing the names
  bool operator==(const Scene&) const = default;
};

// Names that need no file: earth, alien, today, noon, sunset, twilight, orbit (chapters/scenes/NAME.toml), a path to a
// .toml file, or a .png written by a chapter (its embedded scene). Throws Error with file:line:column.
Scene load_scene(const std::string& name_or_file, const std::filesystem::path& scenes_directory);

// Parses TOML text strictly; `file` names it in messages.
Scene parse_scene(const std::string& text, const std::string& file);

// The scene as TOML that parse_scene reads back to the same values (used by restoring screenshots).
std::string write_scene(const Scene& scene);

// One effect of the scene and whether it is simulated, for --explain: "ozone", on, "medium 'ozone' in scene".
struct Constituent {
  std::string name;
  bool on = false;
  std::string why;
};
std::vector<Constituent> constituents(const Scene& scene);

}  // namespace welkin
