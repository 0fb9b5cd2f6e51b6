// [[cloud]] and [weather] of a scene: what is read, what follows from a body's kind and phase function, and what is
// refused with which line.
#include <algorithm>
#include <catch2/catch.hpp>

#include "common/error.hpp"
#include "common/scene/scene.hpp"

namespace {

using welkin::Cloud;
using welkin::Scene;

const std::string kView = "version = 1\n[[view]]\nname = \"v\"\n";  // lines 1 to 3

Scene parse(const std::string& rest) { return welkin::parse_scene(kView + rest, "f"); }

std::string refused(const std::string& rest) {
  try {
    parse(rest);
  } catch (const welkin::Error& error) {
    REQUIRE(error.exit_code == welkin::Exit::usage);
    const std::string line = error.what();
    REQUIRE(std::none_of(line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }));
    return line;
  }
  return "accepted";
}

// The message for a [[cloud]] of a kind on line 5, with more lines behind it.
std::string cloud(const std::string& kind, const std::string& rest) {
  return refused("[[cloud]]\nkind = \"" + kind + "\"\n" + rest);
}

const std::string kShell = "base_km = 1.5\ntop_km = 4\n";

}  // namespace

TEST_CASE("clouds: every kind is read, and read back from what is written", "[scene]") {
  const Scene scene =
      parse("[[cloud]]\nkind = \"layer\"\nname = \"deck\"\n" + kShell +
            "extinction_per_km = 5\nsingle_scattering_albedo = 0.99\nphase = \"droplets\"\ndroplet_diameter_um = 1.5\n"
            "[[cloud]]\nkind = \"disc\"\n" +
            kShell + "north_km = -20\neast_km = 3\nradius_km = 60\ng = 0\n" +
            "[[cloud]]\nkind = \"sphere\"\neast_km = 4\nnorth_km = 5\nup_km = 6\nradius_km = 0.5\n" +
            "[[cloud]]\nkind = \"grid\"\nfile = \"sub/a b.grid\"\nup_km = 1\nsize_km = [2, 2, 1.5]\n"
            "phase = \"draine_mixture\"\nweight = 0.8\ng = 0.9\nalpha = 2\nsecond_g = 0.5\nsecond_alpha = 40\n" +
            "[[cloud]]\nkind = \"noise\"\n" + kShell +
            "coverage = 0.25\ntype = 0.5\nseed = 7\nextent_km = 64\n[weather]\npreset = \"storm\"\nseed = 3\n");
  REQUIRE(scene.clouds.size() == 5);
  const Cloud &layer = scene.clouds[0], &disc = scene.clouds[1], &sphere = scene.clouds[2], &grid = scene.clouds[3],
              &noise = scene.clouds[4];
  CHECK(layer.name == "deck");
  CHECK(layer.extinction_per_km == 5.0);
  CHECK(layer.phase == welkin::CloudPhase::droplets);
  CHECK(layer.droplet_diameter_um == 1.5);
  CHECK(disc.north_km == -20.0);
  CHECK(disc.extinction_per_km == 40.0);
  CHECK(disc.g == 0.0);
  CHECK(sphere.up_km == 6.0);
  CHECK(sphere.g == 0.85);
  CHECK(grid.size_km == glm::dvec3(2, 2, 1.5));
  CHECK(grid.second_alpha == 40.0);
  CHECK(noise.weather == "procedural");
  CHECK(noise.type == 0.5);
  REQUIRE(scene.weather);
  CHECK(scene.weather->preset == "storm");
  CHECK(scene == welkin::parse_scene(welkin::write_scene(scene), "written"));
  CHECK(parse("").clouds.empty());
  CHECK_FALSE(parse("").weather);
  CHECK_FALSE(parse("[[cloud]]\nkind = \"noise\"\n" + kShell).clouds[0].type);
}

TEST_CASE("clouds: each refusal names file, line, column and what is accepted", "[scene]") {
  CHECK(cloud("vdb", "") ==
        "cloud.kind = 'vdb' at f:5:8: accepted is one of \"layer\", \"disc\", \"sphere\", \"grid\", \"noise\"");
  CHECK_THAT(refused("[[cloud]]\n"), Catch::StartsWith("no kind in cloud at f:4:1: accepted is one of \"layer\""));
  CHECK(cloud("layer", "base_km = 4\ntop_km = 1.5\n") ==
        "a cloud from 4 km up to 1.5 km at f:7:10: accepted is a top at least a metre above the base");
  CHECK(cloud("layer", "base_km = 2\ntop_km = 2\n") ==
        "a cloud from 2 km up to 2 km at f:7:10: accepted is a top at least a metre above the base");
  CHECK(cloud("layer", "base_km = -0.5\n") == "cloud.base_km = -0.5 at f:6:11: accepted is a number from 0 to 100 km");
  CHECK(cloud("layer", "base_km = 1\ntop_km = 101\n") ==
        "cloud.top_km = 101 at f:7:10: accepted is a number from 0 to 100 km");
  CHECK(cloud("layer", "top_km = 4\n") ==
        "no base_km in cloud 'layer' at f:4:1: accepted is a number from 0 to 100 km");
  CHECK_THAT(cloud("layer", kShell + "radius_km = 5\n"),
             Catch::StartsWith("unknown key 'radius_km' in cloud 'layer' at f:8:1: known are kind, name, base_km"));
  CHECK_THAT(cloud("sphere", kShell),
             Catch::StartsWith("unknown key 'base_km' in cloud 'sphere' at f:6:1: known are kind, name, east_km"));
  for (const char* diameter : {"0", "60", "1.4", "nan"})
    CHECK_THAT(cloud("layer", kShell + "phase = \"droplets\"\ndroplet_diameter_um = " + diameter + "\n"),
               Catch::StartsWith("cloud.droplet_diameter_um = ") &&
                   Catch::EndsWith("at f:9:23: accepted is a number from 1.5 to 50 um"));
  CHECK_THAT(cloud("layer", kShell + "droplet_diameter_um = 10\n"),
             Catch::StartsWith("unknown key 'droplet_diameter_um' in cloud 'layer' at f:8:1"));
  CHECK_THAT(cloud("layer", kShell + "phase = \"droplets\"\ng = 0.5\n"),
             Catch::StartsWith("unknown key 'g' in cloud 'layer' at f:9:1"));
  CHECK(cloud("layer", kShell + "g = 1\n") == "cloud.g = 1 at f:8:5: accepted is a number from -0.999 to 0.999");
  CHECK(
      cloud("layer", kShell + "name = \"a\"\n[[cloud]]\nkind = \"sphere\"\nname = \"a\"\nup_km = 9\nradius_km = 1\n") ==
      "second cloud 'a' at f:11:8: each name once");
  CHECK(cloud("sphere", "up_km = 1\nradius_km = 1.5\n") ==
        "a cloud that reaches 0.5 km below the ground at f:6:9: accepted is a cloud above the ground");
  CHECK(cloud("sphere", "up_km = 99\nradius_km = 1.5\n") ==
        "a cloud that reaches 100.5 km high at f:6:9: accepted is a cloud below the top of the air, 100 km");
  CHECK(cloud("grid", "file = \"a.grid\"\nsize_km = [1, 1, 1]\nup_km = -1\n") ==
        "a cloud that reaches 1 km below the ground at f:8:9: accepted is a cloud above the ground");
  // 700 km away the tangent plane has left the ground 38 km below.
  CHECK(cloud("grid", "file = \"a.grid\"\nsize_km = [1, 1, 1]\nup_km = -1\neast_km = 700\n") == "accepted");
  CHECK(cloud("grid", "up_km = 1\nsize_km = [1, 1, 1]\n") ==
        "no file in cloud 'grid' at f:4:1: accepted is the name of a grid file, quoted");
  CHECK_THAT(cloud("grid", "file = \"a.grid\"\nup_km = 1\nsize_km = [1, 1]\n"),
             Catch::StartsWith("cloud.size_km has 2 numbers at f:8:11"));
  CHECK(cloud("noise", kShell + "coverage = 1.5\n") ==
        "cloud.coverage = 1.5 at f:8:12: accepted is a number from 0 to 1");
  CHECK(cloud("noise", kShell + "weather = \"a.png\"\n[[cloud]]\nkind = \"noise\"\n" + kShell) ==
        "second weather map at f:9:1: accepted is one for all bodies of a scene");
  CHECK(refused("[weather]\npreset = \"rain\"\n") ==
        "weather.preset = 'rain' at f:5:10: accepted is one of \"clear\", \"fair\", \"broken\", \"overcast\", "
        "\"storm\", \"mackerel\"");
  CHECK_THAT(refused("[cloud]\nkind = \"layer\"\n"), Catch::Contains("accepted is [[cloud]], a section for each"));
  std::string many;
  for (int i = 0; i < 65; ++i) many += "[[cloud]]\nkind = \"layer\"\n" + kShell;
  CHECK(refused(many) == "too many clouds at f:261:8: accepted are up to 64");
}
