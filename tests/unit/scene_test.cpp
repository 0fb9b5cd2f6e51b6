// Scenes: the shipped ones, round trips, sun and views, files that are no scenes. Refused text is in
// scene_errors_test.cpp.
#include "common/scene/scene.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>

#include "common/error.hpp"
#include "common/image/png.hpp"
#include "common/scene/scene_knobs.hpp"
#include "tests/hard/scene_fields.hpp"

namespace {

namespace fs = std::filesystem;
using welkin::Scene;

const fs::path kRoot = fs::path(__FILE__).parent_path().parent_path().parent_path();
const fs::path kScenes = kRoot / "chapters/scenes";
const char* const kNames[] = {"earth", "alien",    "today", "noon",     "sunset",
                              "fair",  "overcast", "storm", "twilight", "orbit"};
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

Scene parse(const std::string& rest) { return welkin::parse_scene("version = 1\n" + rest, "f"); }

struct TemporaryDirectory {
  fs::path path;
  TemporaryDirectory() {
    std::string name = (fs::temp_directory_path() / "welkin_scene_test_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path = name;
  }
  ~TemporaryDirectory() { fs::remove_all(path); }
  fs::path write(const std::string& name, const std::string& contents) const {
    std::ofstream(path / name, std::ios::binary) << contents;
    return path / name;
  }
};

}  // namespace

TEST_CASE("every shipped scene loads, and is read back from what is written", "[scene]") {
  for (const char* name : kNames) {
    INFO(name);
    const Scene scene = welkin::load_scene(name, kScenes);
    CHECK(scene.name == name);
    CHECK(scene.views.size() >= 3);
    const std::string text = welkin::write_scene(scene);
    const Scene again = welkin::parse_scene(text, "written");
    CHECK(scene == again);
    CHECK(welkin::write_scene(again) == text);
    CHECK(text.find("utc") == std::string::npos);  // the angles, never a date that means another sun tomorrow
  }
}

TEST_CASE("awkward values survive the round trip", "[scene]") {
  Scene scene = welkin::load_scene("earth", kScenes);
  scene.media[1].absorption_per_km = {1.0 / 3.0, 5e-324, 99.99999999999999};
  scene.media[1].phase = welkin::Phase::double_hg;
  scene.sun.zenith_deg = 1e-300;
  scene.sun.irradiance = {0, 1e6, 0.1};
  scene.views[0].altitude_km = 384399.9999999999;
  scene.terrain =
      welkin::Terrain{.height_map = "/a \"b\"/é.png", .extent_km = 1.1, .shadows = false, .signs_azimuth_deg = 0.1};
  scene.settings = {{"zz.last_first", "64"}, {"a.text", "quote \" backslash \\ é"}};
  scene.time_s = -86399.9;
  scene.views[1].east_km = -1e-300, scene.views[1].north_km = 19980.123456789;
  scene.paths = {{"p", {"horizon", "zenith", "horizon"}, {-1.5, 0.1, 1e6}, {0, -1e9, 0.3}}};
  scene.post = {true, -0.1, 1.0 / 3.0};
  CHECK(scene == welkin::parse_scene(welkin::write_scene(scene), "written"));
}

TEST_CASE("earth and alien are the planets of the reference tables", "[scene]") {
  const Scene earth = welkin::load_scene("earth", kScenes);
  CHECK(earth.planet.ground_radius_km == 6360);
  CHECK(earth.planet.top_radius_km == 6460);
  CHECK(earth.planet.ground_albedo == glm::dvec3(0.3));
  CHECK(earth.sun.angular_radius_deg == 0.2667);
  CHECK(earth.sun.irradiance == glm::dvec3(1.0));
  const welkin::Medium &gas = *earth.medium("rayleigh"), &haze = *earth.medium("mie"), &ozone = *earth.medium("ozone");
  CHECK(gas.scattering_per_km == glm::dvec3(5.802e-3, 13.558e-3, 33.1e-3));
  CHECK(gas.absorption_per_km == glm::dvec3(0.0));
  CHECK(haze.scattering_per_km == glm::dvec3(3.996e-3));
  CHECK(haze.g == 0.8);
  CHECK(ozone.absorption_per_km == glm::dvec3(0.650e-3, 1.881e-3, 0.085e-3));
  CHECK(ozone.scattering_per_km == glm::dvec3(0.0));
  // The slips that tables of this atmosphere carry would show here: albedo 0.9; columns 8, 1.2 and 15 km.
  const double extinction = haze.scattering_per_km.x + haze.absorption_per_km.x;
  CHECK(haze.scattering_per_km.x / extinction == Approx(0.9).epsilon(1e-12));
  const auto column = [](const welkin::Medium& medium) {  // midpoint rule, 1 m steps over 100 km
    double sum = 0;
    for (double h = 0.0005; h < 100; h += 0.001)
      sum += 0.001 * (medium.profile == welkin::Profile::exponential
                          ? std::exp(-h / medium.scale_height_km)
                          : std::max(0.0, 1 - std::abs(h - medium.peak_altitude_km) / medium.half_width_km));
    return sum;
  };
  CHECK(column(gas) == Approx(8.0).margin(1e-4));  // 3e-5 of the column lies above 100 km
  CHECK(column(haze) == Approx(1.2).margin(1e-6));
  CHECK(column(ozone) == Approx(15.0).margin(1e-6));

  const Scene alien = welkin::load_scene("alien", kScenes);
  CHECK(alien.medium("rayleigh")->scattering_per_km == glm::dvec3(0.149, 0.142, 0.051));
  CHECK(alien.medium("rayleigh")->scale_height_km == 18.416);
  CHECK(alien.medium("mie")->scattering_per_km == glm::dvec3(0.046, 0.047, 0.057));
  CHECK(alien.medium("mie")->absorption_per_km.x == Approx(0.036).epsilon(1e-12));
  CHECK(alien.medium("mie")->absorption_per_km.z == Approx(0.001).epsilon(1e-10));
  CHECK(alien.medium("mie")->scale_height_km == 13.143);
  CHECK(alien.medium("ozone")->absorption_per_km == ozone.absorption_per_km);
}

TEST_CASE("a scene without a section has the documented default and no more", "[scene]") {
  const Scene scene = parse(kView);
  CHECK(scene.media.empty());
  CHECK(scene.medium("mie") == nullptr);
  CHECK(scene.sun.zenith_deg == 45);
  CHECK(scene.views[0].fov_deg == 60);
  CHECK(scene.settings.empty());
  for (const welkin::Constituent& effect : welkin::constituents(scene)) {
    INFO(effect.name);
    CHECK(effect.on == (effect.name == "sun disc" || effect.name == "ground"));
    CHECK_FALSE(effect.why.empty());
  }
}

TEST_CASE("effects follow from what the scene contains", "[scene]") {
  Scene scene = welkin::load_scene("earth", kScenes);
  const auto on = [&](const std::string& name) {
    for (const welkin::Constituent& effect : welkin::constituents(scene))
      if (effect.name == name) return effect.on;
    throw std::out_of_range(name);
  };
  for (const char* name : {"rayleigh", "mie", "ozone", "sun disc", "ground"}) CHECK(on(name));
  scene.media.pop_back();
  CHECK_FALSE(on("ozone"));
  scene.medium("mie")->scattering_per_km = scene.medium("mie")->absorption_per_km = glm::dvec3(0);
  CHECK_FALSE(on("mie"));
  scene.sun.disc = false;
  CHECK_FALSE(on("sun disc"));
  scene.planet.ground_albedo = {0, 0, 0};
  CHECK_FALSE(on("ground"));
  CHECK(on("rayleigh"));
}

TEST_CASE("sun from date and place, and views that follow it", "[scene]") {
  const std::string sun = "[sun]\nutc = \"2003-10-17T19:30:30\"\nlatitude_deg = 39.742476\nlongitude_deg = -105.1786\n";
  const Scene scene = parse(sun + "[[view]]\nname = \"v\"\nazimuth_from_sun_deg = 200\n");
  CHECK(scene.sun.zenith_deg ==
        Approx(50.12795).margin(0.004));  // NREL's worked example, see tests/data/sun_almanac.csv
  CHECK(scene.sun.azimuth_deg == Approx(194.34024).margin(0.004));
  CHECK(scene.sun.latitude_deg ==
        39.742476);  // about its pole the sun turns, also when it is read from what is written
  CHECK(scene.views[0].azimuth_deg == Approx(scene.sun.azimuth_deg + 200 - 360).margin(1e-9));
  CHECK(parse("[sun]\nazimuth_deg = -90\n" + kView).sun.azimuth_deg == 270);
}

TEST_CASE("a height map lies beside the scene that names it", "[scene]") {
  const TemporaryDirectory directory;
  const std::string text = "version = 1\n" + kView + "[terrain]\nheight_map = ";
  const fs::path beside = directory.write("a.toml", text + "\"sub/../hills.png\"\n");
  CHECK(welkin::load_scene(beside.string(), kScenes).terrain->height_map == (directory.path / "hills.png").string());
  const fs::path absolute = directory.write("b.toml", text + "\"/hills.png\"\n");
  CHECK(welkin::load_scene(absolute.string(), kScenes).terrain->height_map == "/hills.png");
  // Moved together with the scene, it is found beside it; in a subdirectory that exists it is not looked for elsewhere.
  directory.write("hills.png", "");
  const fs::path moved = directory.write("c.toml", text + "\"/home/of/the/author/hills.png\"\n");
  CHECK(welkin::load_scene(moved.string(), kScenes).terrain->height_map == (directory.path / "hills.png").string());
  CHECK(welkin::portable_path((directory.path / "hills.png").string(), directory.path / "sub") == "../hills.png");
  CHECK(welkin::portable_path((directory.path / "hills.png").string(), directory.path) == "hills.png");
  CHECK(welkin::portable_path("/home/of/the/author/hills.png", directory.path) == "hills.png");
  CHECK(welkin::portable_path((directory.path / "a\nb/hills.png").string(), directory.path) == "hills.png");
  CHECK(welkin::portable_path("", directory.path).empty());
  CHECK_FALSE(parse(kView).terrain);
  CHECK(parse(kView + "[terrain]\n").terrain->size == 1024);
}

TEST_CASE("settings become text in the file's order", "[scene]") {
  const Scene scene =
      parse(kView + "[settings]\n\"view.steps\" = 64\n\"a.flag\" = false\n\"mie.g\" = 0.75\n\"a.choice\" = \"tall\"\n");
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"view.steps", "64"}, {"a.flag", "off"}, {"mie.g", "0.75"}, {"a.choice", "tall"}};
  CHECK(scene.settings == expected);  // mie.g: this scene has no aerosol, so it is nobody's yet
}

TEST_CASE("a knob of the scene is a field of the scene, wherever it is set", "[scene]") {
  const std::string mie = "[[medium]]\nkind = \"mie\"\nscattering_per_km = 0.004\ng = 0.8\n";
  const Scene scene =
      parse(mie + kView +
            "[settings]\n\"mie.g\" = 0.75\n\"sun.disc\" = false\n\"mie.phase\" = \"draine\"\n"
            "\"exposure.mode\" = \"manual\"\n\"exposure.compensation\" = 2\n\"sun.azimuth_deg\" = 360\n");
  CHECK(scene.settings.empty());
  CHECK(scene.medium("mie")->g == 0.75);
  CHECK(scene.medium("mie")->phase == welkin::Phase::draine);
  CHECK_FALSE(scene.sun.disc);
  CHECK(scene.sun.azimuth_deg == 0.0);
  CHECK(scene.post == welkin::Post{.manual = true, .compensation_ev = 2.0});
  CHECK(scene == welkin::parse_scene(welkin::write_scene(scene), "written"));
  // Every knob says what the scene says, and writing it changes the scene and nothing else.
  for (const welkin::Knob& knob : welkin::scene_knobs(scene)) {
    INFO(knob.name);
    const double wanted =
        knob.choices.empty() ? 0.5 * (knob.initial + knob.maximum) : 1.0 - std::min(knob.initial, 1.0);
    welkin::Settings settings(welkin::scene_knobs(scene));
    settings.set_number(knob.name, wanted);
    Scene changed = scene;
    welkin::apply_scene_knobs(settings, changed);
    CHECK_FALSE(changed == scene);
    for (const welkin::Knob& after : welkin::scene_knobs(changed))
      CHECK(after.initial ==
            Approx(after.name == knob.name ? wanted : welkin::Settings(welkin::scene_knobs(scene)).number(after.name)));
  }
  CHECK_THAT(refused([&] { parse(kView + "[settings]\n\"sun.zenith_deg\" = 200\n"); }),
             Catch::StartsWith("settings at f:5:20: sun.zenith_deg=200: accepted is"));
}

TEST_CASE("an exposure set by hand is by hand, unless the mode says otherwise", "[scene]") {
  CHECK(parse(kView + "[settings]\n\"exposure.ev\" = 3\n").post == welkin::Post{.manual = true, .exposure_ev = 3.0});
  CHECK(parse(kView + "[settings]\n\"exposure.ev\" = 3\n\"exposure.mode\" = \"auto\"\n").post ==
        welkin::Post{.exposure_ev = 3.0});
}

TEST_CASE("the place of a view, along the ground or by latitude and longitude", "[scene]") {
  const std::string place = "[sun]\nlatitude_deg = 43.6\nlongitude_deg = 16.47\n[[view]]\nname = \"v\"\n";
  const auto view = [&](const std::string& at) { return parse(place + at).views[0]; };
  CHECK(view("east_km = 3\nnorth_km = -4\n").east_km == 3.0);
  CHECK(view("latitude_deg = 43.6\nlongitude_deg = 16.47\n").north_km == Approx(0.0).margin(1e-9));
  constexpr double kDegree_km = 6360.0 * 3.14159265358979323846 / 180.0;
  CHECK(view("latitude_deg = 44.6\nlongitude_deg = 16.47\n").north_km == Approx(kDegree_km));
  CHECK(view("latitude_deg = 90\nlongitude_deg = 100\n").north_km == Approx(46.4 * kDegree_km));
  CHECK(view("latitude_deg = 90\nlongitude_deg = 100\n").east_km == Approx(0.0).margin(1e-9));
  CHECK(std::hypot(view("latitude_deg = -43.6\nlongitude_deg = 196.47\n").east_km,
                   view("latitude_deg = -43.6\nlongitude_deg = 196.47\n").north_km) == Approx(180.0 * kDegree_km));
  // One degree of longitude on the equator: east, as far as the latitude's cosine says, by the law of cosines.
  const welkin::View east = view("latitude_deg = 43.6\nlongitude_deg = 17.47\n");
  const double sine = std::sin(43.6 / kDegree_km * 6360.0 / 57.29577951308232 * kDegree_km / 6360.0),
               square = sine * sine;
  const double arc = std::acos(square + (1.0 - square) * std::cos(1.0 / 57.29577951308232));
  CHECK(std::hypot(east.east_km, east.north_km) == Approx(6360.0 * arc).epsilon(1e-9));
  CHECK(east.east_km > 80.0);
}

TEST_CASE("views are found by name", "[scene]") {
  const Scene scene = welkin::load_scene("noon", kScenes);
  CHECK(scene.view("").name == "horizon");
  CHECK(scene.view("zenith").elevation_deg == 90);
  CHECK(refused([&] { scene.view("nadir\n"); }) == "view 'nadir\\x0a': scene 'noon' has horizon, zenith, airliner");
}

TEST_CASE("files that are no scenes", "[scene]") {
  const TemporaryDirectory directory;
  const auto load = [&](const fs::path& path) { return refused([&] { welkin::load_scene(path.string(), kScenes); }); };
  CHECK_THAT(load(directory.path / "missing.toml"), Catch::Contains("missing.toml") && Catch::Contains("No such file"));
  CHECK_THAT(load(directory.path / "missing.png"), Catch::Contains("missing.png"));
  CHECK_THAT(load(directory.path), Catch::Contains("is a directory"));
  REQUIRE(mkfifo((directory.path / "pipe.toml").c_str(), 0600) == 0);
  CHECK_THAT(load(directory.path / "pipe.toml"),
             Catch::Contains("not a regular file"));  // and does not wait for a writer
  CHECK_THAT(load("/dev/zero"), Catch::Contains("not a regular file"));
  CHECK_THAT(load(directory.write("empty.toml", "")), Catch::Contains("empty.toml:1:1: a scene says version = 1"));
  CHECK_THAT(load(directory.write("large.toml", std::string((1 << 20) + 1, '\n'))), Catch::Contains("1048576"));
  CHECK_THAT(load(directory.write("binary.toml", std::string("\0\x01\xff\xfe", 4))),
             Catch::Contains("not valid TOML at") && Catch::Contains("binary.toml:1:"));
  CHECK_THAT(load(directory.write("garbage.png", "not a picture")), Catch::Contains("garbage.png"));
  CHECK_THAT(load("a\nb.toml"), Catch::Contains("a\\x0ab.toml"));
  CHECK_THAT(load(std::string("earth\0.toml", 11)), Catch::Contains("not a file name"));
  CHECK(load("mars") ==
        "unknown scene 'mars': known are alien, earth, fair, noon, orbit, overcast, storm, sunset, today, twilight; a "
        "file's name "
        "ends in .toml or .png");
  CHECK_THAT(load(""), Catch::StartsWith("no scene named: known are alien, earth"));
  CHECK_THAT(refused([&] { welkin::load_scene("earth", directory.path / "none"); }), Catch::Contains("known are none"));
}

TEST_CASE("a scene cut off anywhere is either whole or refused", "[scene]") {
  const std::string text = welkin::write_scene(welkin::load_scene("sunset", kScenes));
  int accepted = 0;
  for (size_t length = 0; length < text.size(); ++length)
    accepted += refused([&] { welkin::parse_scene(text.substr(0, length), "f"); }) == "accepted";
  CHECK(accepted > 0);  // cut after a view: fewer views, still a scene
  CHECK(accepted < static_cast<int>(text.size() / 2));
}

TEST_CASE("a picture restores the scene it carries", "[scene]") {
  const TemporaryDirectory directory;
  const Scene scene = welkin::load_scene("orbit", kScenes);
  welkin::Image8 picture;
  picture.width = picture.height = 1;
  picture.rgba = {1, 2, 3, 255};
  const fs::path file = directory.path / "shot.png";
  welkin::image::write_png8(file, picture, {{"welkin.scene", welkin::write_scene(scene)}});
  CHECK(scene == welkin::load_scene(file.string(), kScenes));
  fs::copy_file(file, directory.path / "shot.PNG");
  CHECK(scene == welkin::load_scene((directory.path / "shot.PNG").string(), kScenes));
  // A picture of chapter 05 that ImageMagick wrote again: its long text became a zTXt chunk.
  const Scene resaved = welkin::load_scene((kRoot / "tests/data/resaved.png").string(), kScenes);
  CHECK(resaved.sun.zenith_deg == 89.0);
  CHECK(resaved.views.size() == 5);
  welkin::image::write_png8(file, picture, {{"welkin.scene", "version = 3\n"}});
  CHECK_THAT(refused([&] { welkin::load_scene(file.string(), kScenes); }),
             Catch::StartsWith("version 3 at ") &&
                 Catch::Contains("shot.png (embedded scene):1:11: this build knows version 1"));
  welkin::image::write_png8(file, picture);
  CHECK_THAT(refused([&] { welkin::load_scene(file.string(), kScenes); }), Catch::Contains("carries no scene"));
}

TEST_CASE("the example in docs/scenes.md is a scene", "[scene]") {
  std::ifstream in(kRoot / "docs/scenes.md");
  const std::string page{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const size_t begin = page.find("```toml\n"), end = page.find("```\n", begin + 8);
  REQUIRE(begin != std::string::npos);
  REQUIRE(end != std::string::npos);
  const Scene scene = welkin::parse_scene(page.substr(begin + 8, end - begin - 8), "docs/scenes.md");
  CHECK(scene.medium("mie")->phase == welkin::Phase::double_hg);
  CHECK(scene.medium("ozone") == nullptr);
}

TEST_CASE("the tables of docs/scenes.md are those of the code", "[scene]") {
  std::ifstream in(kRoot / "docs/generated/scene_fields.csv");
  const std::string file{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  CHECK(file == welkin::test::scene_fields_csv());  // build/bin/scene_fuzz --fields docs/generated/scene_fields.csv
}
