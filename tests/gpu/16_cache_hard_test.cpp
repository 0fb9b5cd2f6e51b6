// What must not upset the cache of made textures, and what it must not upset: whole frames in an empty directory.
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "chapters/16_noise/texture_cache.hpp"
#include "common/image/atomic_file.hpp"
#include "tests/gpu/16_viewer.hpp"
#include "tests/unit/temporary.hpp"

using namespace welkin;
using namespace welkin::test;
namespace fs = std::filesystem;

namespace {

// A variable of the environment for as long as this lives. "": not set.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Variable() { set(before_); }

 private:
  void set(const std::string& value) const { value.empty() ? unsetenv(name_) : setenv(name_, value.c_str(), 1); }
  const char* name_;
  std::string before_;
};

fs::path only_file(const fs::path& directory) {
  fs::path found;
  size_t count = 0;
  for (const auto& entry : fs::directory_iterator(directory)) found = entry.path(), ++count;
  REQUIRE(count == 1);
  return found;
}

}  // namespace

TEST_CASE("hard: a texture from the cache has the words that were made") {
  const TemporaryDirectory directory;
  const Variable cache("WELKIN_CACHE", (directory.path / "not" / "there" / "yet").string());
  ViewerFixture cold;
  const Image made = cold.picture();
  CHECK(cold.says("noise base: made in "));
  CHECK(cold.says("kept in "));
  ViewerFixture warm;
  CHECK(warm.picture().pixels == made.pixels);
  for (const char* texture : {"noise base", "noise detail", "noise curl", "weather", "alligator"})
    CHECK(warm.says(std::string(texture) + ": read in "));
  const Variable off("WELKIN_CACHE", "off");
  ViewerFixture without;
  CHECK(without.picture().pixels == made.pixels);
  CHECK(without.says("not kept: nothing is to be kept"));
}

TEST_CASE("hard: a file of the cache that is cut short, changed, older or not one at all is made anew") {
  const TemporaryDirectory directory;
  const Variable cache("WELKIN_CACHE", directory.path.string());
  const Image right = ViewerFixture({"noise.show=curl"}).picture();
  const fs::path file = only_file(directory.path);
  const std::string good = read_file(file, 1 << 20);
  const auto changed = [&](size_t at) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    return bytes;
  };
  for (const std::string& bad : {std::string(), good.substr(0, 7), good.substr(0, 40), good.substr(0, good.size() - 1),
                                 good + "x", changed(0) /* magic */, changed(8) /* version */, changed(16) /* key */,
                                 changed(24) /* count */, changed(32) /* checksum */, changed(40) /* the first word */,
                                 changed(good.size() - 1), std::string(good.size(), '\0')}) {
    std::ofstream(file, std::ios::binary | std::ios::trunc).write(bad.data(), static_cast<std::streamsize>(bad.size()));
    ViewerFixture again({"noise.show=curl"});
    CHECK(again.picture().pixels == right.pixels);
    CHECK(again.says("noise curl: made in "));
    CHECK((read_file(file, 1 << 20) == good));  // mended
    CHECK(only_file(directory.path) == file);
  }
  fs::remove(file);
  REQUIRE(mkfifo(file.c_str(), 0600) == 0);  // a pipe that nobody writes to would be waited for
  ViewerFixture pipe({"noise.show=curl"});
  CHECK(pipe.picture().pixels == right.pixels);
  CHECK(pipe.says("not kept: "));
  fs::remove(file);
  fs::create_directory(file);
  ViewerFixture blocked({"noise.show=curl"});
  CHECK(blocked.picture().pixels == right.pixels);
  CHECK(blocked.says("not kept: "));
}

TEST_CASE("hard: a cache that cannot be written is no error") {
  const TemporaryDirectory directory;
  const fs::path file = directory.path / "file";
  std::ofstream(file) << "in the way";
  for (const std::string& place : {(file / "below").string(), std::string("/proc/no/such/place")}) {
    const Variable cache("WELKIN_CACHE", place);
    ViewerFixture frame({"noise.show=curl"});
    frame.picture();
    CHECK(frame.says("not kept: cannot write"));
  }
}

TEST_CASE("hard: where the cache is") {
  const Variable chosen("WELKIN_CACHE", ""), caches("XDG_CACHE_HOME", ""), home("HOME", "");
  CHECK(cache_directory().empty());
  CHECK(cache_file("noise", 1).empty());
  CHECK_FALSE(read_cached({}, 1, {}).found);
  const Variable with_home("HOME", "/home/someone");
  CHECK(cache_directory() == "/home/someone/.cache/welkin");
  const Variable with_caches("XDG_CACHE_HOME", "/caches");
  CHECK(cache_directory() == "/caches/welkin");
  CHECK(cache_file("noise", 0xAB) == "/caches/welkin/noise_00000000000000ab.bin");
  const Variable moved("WELKIN_CACHE", "/elsewhere");
  CHECK(cache_directory() == "/elsewhere");
  const Variable off("WELKIN_CACHE", "off");
  CHECK(cache_directory().empty());
}

TEST_CASE("hard: each knob makes another texture, and another file") {
  const TemporaryDirectory directory;
  const Variable cache("WELKIN_CACHE", directory.path.string());
  size_t files = 0;
  std::vector<Image> pictures;
  for (const char* knob : {"noise.seed=0", "noise.seed=1", "noise.octaves=2", "noise.format=16", "noise.format=half",
                           "noise.curl_size=128"}) {
    ViewerFixture frame({"noise.show=curl", knob});
    pictures.push_back(frame.picture());
    ++files;
    CAPTURE(knob);
    CHECK(std::distance(fs::directory_iterator(directory.path), {}) == static_cast<std::ptrdiff_t>(files));
    for (size_t i = 0; i + 1 < pictures.size(); ++i) CHECK(pictures[i].pixels != pictures.back().pixels);
  }
}

TEST_CASE("hard: only what is shown is made, allocated and kept, and given back when it is no longer") {
  const TemporaryDirectory directory;
  const Variable cache("WELKIN_CACHE", directory.path.string());
  ViewerFixture frame({"noise.show=curl"});
  frame.picture();
  using Names = std::vector<std::string>;
  CHECK(frame.program->resources_of("noise textures") == Names{"noise curl"});
  CHECK(frame.program->resources_of("weather texture").empty());
  CHECK(frame.says("weather texture        off  nothing that is shown needs it"));
  CHECK(frame.says("noise textures         on   what is shown needs it"));
  const uint64_t bytes = frame.program->bytes();
  only_file(directory.path);
  frame.set("noise.show=base");
  const Image base = frame.picture();
  CHECK(frame.program->resources_of("noise textures") == Names{"noise base"});
  frame.set("noise.show=curl");
  frame.picture();
  CHECK(frame.program->bytes() == bytes);
  frame.set("noise.show=base");  // filled anew, after it was given back
  CHECK(frame.picture().pixels == base.pixels);
  frame.set("noise.remake=on");  // and as a pass of every frame
  CHECK(frame.picture().pixels == base.pixels);
  CHECK(frame.picture().pixels == base.pixels);
  CHECK(frame.says("noise base           ran in "));
}
