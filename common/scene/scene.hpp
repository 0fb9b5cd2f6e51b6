// What exists: planet, media, sun, cameras. A scene file says it; nothing it does not say is simulated.
//
// Units: km, km^-1, degrees where a name says _deg. Radiance is per unit of solar irradiance at the top of the
// atmosphere. Frame at a view: x = east, y = north, z = up; azimuth in degrees clockwise from north (0 = north, 90 =
// east). What a file may say of each, its ranges and meanings, is one table: fields.hpp.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace welkin {

// Nothing is placed higher: a camera, a view, the beginning of a probe's ray. Two and a half times the Moon's distance.
inline constexpr double kHighest_km = 1e6;

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
  // At the scene's place, when its time is 0. A file may give date and time instead (sun.hpp), from which they follow.
  double zenith_deg = 45.0;
  double azimuth_deg = 180.0;
  // Of the scene's place, north and east positive. Without a latitude the sun stands still: nobody knows where it goes.
  std::optional<double> latitude_deg, longitude_deg;
  double angular_radius_deg = 0.2667;
  glm::dvec3 irradiance{1.0};
  bool disc = true;
  bool operator==(const Sun&) const = default;
};

struct View {
  std::string name = "view";
  double east_km = 0.0, north_km = 0.0;  // of the scene's place, to where the camera is overhead: along the ground
  double altitude_km = 0.0005;           // above the ground
  double azimuth_deg = 180.0;            // look direction
  double elevation_deg = 10.0;           // above the horizontal; 90 is straight up
  double fov_deg = 60.0;                 // vertical
  bool operator==(const View&) const = default;
};

// A moving camera: views of the scene, passed one after the other (path.hpp).
struct Path {
  std::string name = "path";
  std::vector<std::string> views;  // at least two
  std::vector<double> time_s;      // when each is passed, rising
  std::vector<double> moment_s;    // the scene's time then; empty: it stands still
  bool operator==(const Path&) const = default;
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

enum class CloudPhase { henyey_greenstein, droplets, draine_mixture };

// A body of cloud. What its kind does not have is not said. Chapters below 17 have none.
struct Cloud {
  std::string kind;  // "layer", "disc", "sphere", "grid" or "noise"
  std::string name;
  double base_km = 1.5, top_km = 4.0;                  // layer, disc, noise: altitudes
  double east_km = 0.0, north_km = 0.0, up_km = 20.0;  // sphere: centre; grid: lowest corner; disc: arcs to its axis
  double radius_km = 1.0;                              // sphere; disc: arc at the base
  std::string file;                                    // grid
  glm::dvec3 size_km{1.0};                             // grid
  std::string weather = "procedural";                  // noise: or a PNG
  double extent_km = 96.0;                             // noise: side of the weather's square
  double coverage = 0.5;                               // noise
  std::optional<double> type;                          // noise: without it the weather's
  int seed = 1;                                        // noise
  double extinction_per_km = 40.0, single_scattering_albedo = 1.0;
  CloudPhase phase = CloudPhase::henyey_greenstein;
  double g = 0.85, droplet_diameter_um = 20.0;
  double weight = 0.9, alpha = 0.0, second_g = -0.3, second_alpha = 0.0;  // of a mixture
  bool operator==(const Cloud&) const = default;
};

// Clouds by one word (chapter 17): bodies of noise that need not be written.
struct Weather {
  std::string preset = "fair";  // clear, fair, broken, overcast, storm, mackerel
  int seed = 1;
  bool operator==(const Weather&) const = default;
};

struct Post {
  bool manual = false;           // exposure set by hand even where a chapter has a light meter (06 on)
  double exposure_ev = 0.0;      // set by hand: stops, on top of the chapter's base exposure
  double compensation_ev = 0.0;  // metered: stops, on top of what the meter finds
  bool operator==(const Post&) const = default;
};

struct Scene {
  std::string name = "earth";
  double time_s = 0.0;  // the moment shown, after that of the sun's angles; --time and the window's slider move it
  Planet planet;
  std::vector<Medium> media;  // absent medium: it does not exist (no term, no variant)
  Sun sun;
  std::vector<View> views;  // at least one; the first is the default
  std::vector<Path> paths;
  std::optional<Terrain> terrain;
  std::vector<Cloud> clouds;
  std::optional<Weather> weather;
  Post post;
  // [settings] knob = value, applied before --set: knobs of chapters only, those of the scene are its fields
  std::vector<std::pair<std::string, std::string>> settings;
  bool operator==(const Scene&) const = default;

  const Medium* medium(const std::string& kind) const;  // nullptr if the scene has none
  Medium* medium(const std::string& kind);
  const View& view(const std::string& name) const;  // "" = first; throws listing the names
  const Path& path(const std::string& name) const;  // throws listing the names
};

// Names that need no file: earth, alien, today, noon, sunset, twilight, orbit (chapters/scenes/NAME.toml), a path to a
// .toml file, or a .png written by a chapter (its embedded scene). Throws Error with file:line:column.
Scene load_scene(const std::string& name_or_file, const std::filesystem::path& scenes_directory);

// Parses TOML text strictly; `file` names it in messages.
Scene parse_scene(const std::string& text, const std::string& file);

// The scene as TOML that parse_scene reads back to the same scene (used by restoring screenshots).
std::string write_scene(const Scene& scene);

// The number of views and settings a file may have. The view that a picture adds to its scene is not counted.
inline constexpr size_t kMostViews = 64, kMostSettings = 256, kMostClouds = 64;
inline constexpr const char* kRestoredView = "restored";
// What is said where time should pass and nobody knows how the sun moves.
inline constexpr const char* kNeedsLatitude = "accepted beside latitude_deg in [sun], about whose pole the sun turns";

// The name of a file as a scene in `directory` may carry it: the way from there, or the file's own name where that
// would tell how the disk around both is laid out. A scene finds it by either.
std::string portable_path(const std::string& file, const std::filesystem::path& directory);
// Calls visit(name) for the files that a scene names: maps, grids.
void each_file(Scene& scene, const std::function<void(std::string&)>& visit);

// One effect of the scene and whether it is simulated, for --explain: "ozone", on, "medium 'ozone' in scene".
struct Constituent {
  std::string name;
  bool on = false;
  std::string why;
};
std::vector<Constituent> constituents(const Scene& scene);

}  // namespace welkin
