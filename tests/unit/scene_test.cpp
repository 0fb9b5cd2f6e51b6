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

namespace {

namespace fs = std::filesystem;
using welkin::Scene;

const fs::path kRoot = fs::path(__FILE__).parent_path().parent_path().parent_path();
const fs::path kScenes = kRoot / "chapters/scenes";
const char* const kNames[] = {"earth", "alien", "today", "noon", "sunset", "twilight", "orbit"};
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

bool same(const Scene& a, const Scene& b) {
  const auto media = [](const welkin::Medium& x, const welkin::Medium& y) {
    return x.kind == y.kind && x.scattering_per_km == y.scattering_per_km &&
           x.absorption_per_km == y.absorption_per_km && x.profile == y.profile &&
           x.scale_height_km == y.scale_height_km && x.peak_altitude_km == y.peak_altitude_km &&
           x.half_width_km == y.half_width_km && x.phase == y.phase && x.g == y.g && x.draine_alpha == y.draine_alpha &&
           x.second_g == y.second_g && x.second_weight == y.second_weight;
  };
  const auto views = [](const welkin::View& x, const welkin::View& y) {
    return x.name == y.name && x.altitude_km == y.altitude_km && x.azimuth_deg == y.azimuth_deg &&
           x.elevation_deg == y.elevation_deg && x.fov_deg == y.fov_deg;
  };
  const auto terrains = [](const welkin::Terrain& x, const welkin::Terrain& y) {
    return x.height_map == y.height_map && x.extent_km == y.extent_km && x.height_km == y.height_km &&
           x.size == y.size && x.seed == y.seed && x.shadows == y.shadows && x.signs_azimuth_deg == y.signs_azimuth_deg;
  };
  return a.terrain.has_value() == b.terrain.has_value() && (!a.terrain || terrains(*a.terrain, *b.terrain)) &&
         a.name == b.name && a.planet.ground_radius_km == b.planet.ground_radius_km &&
         a.planet.top_radius_km == b.planet.top_radius_km && a.planet.ground_albedo == b.planet.ground_albedo &&
         std::equal(a.media.begin(), a.media.end(), b.media.begin(), b.media.end(), media) &&
         a.sun.zenith_deg == b.sun.zenith_deg && a.sun.azimuth_deg == b.sun.azimuth_deg &&
         a.sun.angular_radius_deg == b.sun.angular_radius_deg && a.sun.irradiance == b.sun.irradiance &&
         a.sun.disc == b.sun.disc &&
         std::equal(a.views.begin(), a.views.end(), b.views.begin(), b.views.end(), views) &&
         a.post.manual == b.post.manual && a.post.exposure_ev == b.post.exposure_ev &&
         a.post.compensation_ev == b.post.compensation_ev && a.settings == b.settings;
}

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
    CHECK(same(scene, again));
    CHECK(welkin::write_scene(again) == text);
    CHECK_FALSE(again.sun.utc);  // the angles, never a date that means another sun tomorrow
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
  scene.settings = {{"zz.last_first", "64"}, {"a.text", "quote \" backslash \\ é"}, {"mie.phase", "draine"}};
  CHECK(same(scene, welkin::parse_scene(welkin::write_scene(scene), "written")));
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
  CHECK(scene.sun.utc == "2003-10-17T19:30:30");
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
  CHECK_FALSE(parse(kView).terrain);
  CHECK(parse(kView + "[terrain]\n").terrain->size == 1024);
}

TEST_CASE("settings become text in the file's order", "[scene]") {
  const Scene scene = parse(kView +
                            "[settings]\n\"view.steps\" = 64\n\"mie.g\" = 0.75\n\"sun.disc\" = "
                            "false\n\"mie.phase\" = \"draine\"\n");
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"view.steps", "64"}, {"mie.g", "0.75"}, {"sun.disc", "off"}, {"mie.phase", "draine"}};
  CHECK(scene.settings == expected);
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
        "unknown scene 'mars': known are alien, earth, noon, orbit, sunset, today, twilight; a file's name "
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
  CHECK(same(scene, welkin::load_scene(file.string(), kScenes)));
  fs::copy_file(file, directory.path / "shot.PNG");
  CHECK(same(scene, welkin::load_scene((directory.path / "shot.PNG").string(), kScenes)));
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
