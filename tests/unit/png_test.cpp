// PNG and whole-file writing: round trips, text chunks, and files that are missing, cut short or damaged.
#include "common/image/png.hpp"

#include <lodepng.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <random>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "temporary.hpp"

using namespace welkin;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

Image8 noise8(uint32_t width, uint32_t height) {
  std::mt19937 random(7);
  Image8 picture{width, height, {}};
  for (size_t i = 0; i < size_t{width} * height * 4; ++i) picture.rgba.push_back(static_cast<uint8_t>(random()));
  return picture;
}

void put(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

// Runs `read`; anything but success or a one-line Error fails the test. True if it succeeded.
template <typename Read>
bool survives(Read&& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
    return false;
  }
}

uint32_t crc_of(const std::string& bytes, size_t at, size_t count) {  // bit by bit: independent of the table in png.cpp
  uint32_t crc = ~0u;
  for (size_t i = at; i < at + count; ++i) {
    crc ^= static_cast<uint8_t>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
  }
  return ~crc;
}

std::string deflated(const std::string& text) {
  std::vector<uint8_t> out;
  const std::vector<uint8_t> in(text.begin(), text.end());
  REQUIRE(lodepng::compress(out, in) == 0);
  return {out.begin(), out.end()};
}

// A PNG with one more chunk behind its header.
std::string with_chunk(const std::string& png, const std::string& type, const std::string& data) {
  const auto big_endian = [](uint32_t v) {
    return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                       static_cast<char>(v)};
  };
  const std::string covered = type + data;
  return png.substr(0, 33) + big_endian(static_cast<uint32_t>(data.size())) + covered +
         big_endian(crc_of(covered, 0, covered.size())) + png.substr(33);
}

}  // namespace

TEST_CASE("8-bit PNG round trips exactly, odd sizes too", "[png]") {
  const TemporaryDirectory dir;
  for (const auto& [w, h] : {std::pair{1u, 1u}, {3u, 5u}, {5u, 3u}, {64u, 1u}, {1u, 64u}, {257u, 129u}}) {
    const Image8 wrote = noise8(w, h);
    image::write_png8(dir / "a.png", wrote);
    const Image8 read = image::read_png8(dir / "a.png");
    CHECK(read.width == w);
    CHECK(read.height == h);
    CHECK(read.rgba == wrote.rgba);
  }
}

TEST_CASE("16-bit grayscale keeps all sixteen bits, and is the only kind a height map may be", "[png]") {
  const TemporaryDirectory dir;
  std::vector<uint16_t> wrote;
  std::vector<uint8_t> raw, packed;
  for (int i = 0; i < 15; ++i) {
    wrote.push_back(static_cast<uint16_t>(i * 4369 + 1));
    raw.insert(raw.end(), {static_cast<uint8_t>(wrote.back() >> 8), static_cast<uint8_t>(wrote.back())});
  }
  REQUIRE(lodepng::encode(packed, raw, 3, 5, LCT_GREY, 16) == 0);
  put(dir / "a.png", {packed.begin(), packed.end()});
  const Image16 read = image::read_png16(dir / "a.png");
  CHECK(read.width == 3);
  CHECK(read.height == 5);
  CHECK(read.gray == wrote);
  const Image8 narrowed = image::read_png8(dir / "a.png");  // the high byte
  for (size_t i = 0; i < 15; ++i) CHECK(int(narrowed.rgba[i * 4]) == wrote[i] >> 8);
  image::write_png8(dir / "b.png", {1, 1, {0x12, 0x80, 0xFF, 0xFF}});
  CHECK_THROWS_WITH(image::read_png16(dir / "b.png"), Contains("b.png: 8 bits a sample, not grayscale alone"));
}

TEST_CASE("text chunks round trip with line breaks and UTF-8", "[png]") {
  const TemporaryDirectory dir;
  const std::string scene = "name = \"today\"\n\n[sun]\n\tzenith_deg = 45\n",
                    place = "Pometeno brdo, 43.60° N — Пометено брдо ☀";
  image::write_png8(dir / "a.png", noise8(3, 2),
                    {{"welkin.scene", scene}, {"place", place}, {"empty", ""}, {"Place", "other"}});
  CHECK(image::read_png_text(dir / "a.png", "welkin.scene") == scene);
  CHECK(image::read_png_text(dir / "a.png", "place") == place);
  CHECK(image::read_png_text(dir / "a.png", "empty") == "");
  CHECK(image::read_png_text(dir / "a.png", "Place") == "other");
  CHECK_FALSE(image::read_png_text(dir / "a.png", "welkin").has_value());
  CHECK_FALSE(image::read_png_text(dir / "a.png", "").has_value());
  CHECK(image::read_png8(dir / "a.png").rgba == noise8(3, 2).rgba);
  const std::string most(1 << 20, 'x');
  image::write_png8(dir / "b.png", noise8(1, 1), {{"k", most}});
  CHECK(image::read_png_text(dir / "b.png", "k") == most);
  for (const auto& [key, text] : image::TextChunks{
           {"", "t"}, {std::string(80, 'k'), "t"}, {"k\n", "t"}, {"k", most + "x"}, {"k", std::string(3, '\0')}})
    CHECK_THROWS_AS(image::write_png8(dir / "c.png", noise8(1, 1), {{key, text}}), Error);
  CHECK_FALSE(fs::exists(dir / "c.png"));
}

TEST_CASE("text is found however another program stored it", "[png]") {
  const TemporaryDirectory dir;
  const std::string sound = image::encode_png8(noise8(3, 2)), scene = "version = 1\nname = \"M\u00fcnchen 43\u00b0\"\n";
  const auto read = [&](const std::string& type, const std::string& data) {
    put(dir / "a.PNG", with_chunk(sound, type, "scene" + data));
    return image::read_png_text(dir / "a.PNG", "scene").value();
  };
  const std::string zero(1, '\0'), one(1, '\1');
  CHECK(read("tEXt", zero + scene) == scene);  // UTF-8, as many write it
  CHECK(read("zTXt", zero + zero + deflated(scene)) == scene);
  CHECK(read("iTXt", zero + zero + zero + "en" + zero + "Szene" + zero + scene) == scene);
  CHECK(read("iTXt", zero + one + zero + "en" + zero + zero + deflated(scene)) == scene);
  CHECK_THROWS_WITH(read("zTXt", zero + one + deflated(scene)), Contains("a.PNG: text 'scene' of the PNG is damaged"));
  CHECK_THROWS_WITH(read("zTXt", zero + zero + "no deflate"), Contains("text 'scene' of the PNG is damaged"));
}

TEST_CASE("PNG: what would inflate beyond all bounds is refused", "[png]") {
  const TemporaryDirectory dir;
  const std::string sound = image::encode_png8(noise8(3, 2)), bomb = deflated(std::string(size_t{64} << 20, 'x'));
  REQUIRE(bomb.size() < 400'000);
  put(dir / "text.png", with_chunk(sound, "zTXt", std::string("scene\0\0", 7) + bomb));
  CHECK_THROWS_WITH(image::read_png_text(dir / "text.png", "scene"), Contains("unreasonably large"));
  CHECK_NOTHROW(image::read_png8(dir / "text.png"));  // which does not look at it
  put(dir / "long.png", with_chunk(sound, "tEXt", std::string("scene\0", 6) + std::string((1 << 20) + 1, 'x')));
  CHECK_THROWS_WITH(image::read_png_text(dir / "long.png", "scene"), Contains("larger than 1048576 bytes"));
  put(dir / "pixels.png", with_chunk(sound.substr(0, 33) + sound.substr(sound.size() - 12), "IDAT", bomb));
  CHECK_THROWS_WITH(image::read_png8(dir / "pixels.png"), Contains("larger than desired"));
}

TEST_CASE("PNG: bad files are named, with what is wrong", "[png]") {
  const TemporaryDirectory dir;
  CHECK_THROWS_WITH(image::read_png8(dir / "none.png"), Contains("none.png") && Contains("No such file"));
  CHECK_THROWS_WITH(image::read_png8(dir.path), Contains("it is a directory"));
  put(dir / "empty.png", "");
  CHECK_THROWS_WITH(image::read_png8(dir / "empty.png"), Contains("not a PNG"));
  put(dir / "text.png", "this is no picture, but it is long enough to be one");
  CHECK_THROWS_WITH(image::read_png8(dir / "text.png"), Contains("not a PNG"));
  REQUIRE(mkfifo((dir / "pipe.png").c_str(), 0600) == 0);  // must not wait for a writer
  CHECK_THROWS_WITH(image::read_png8(dir / "pipe.png"), Contains("pipe"));

  const std::string good = image::encode_png8(noise8(3, 2));
  const auto with_size = [&](uint32_t width, uint32_t height) {
    std::string bytes = good;
    for (size_t i = 0; i < 4; ++i) {
      bytes[16 + i] = static_cast<char>(width >> (24 - 8 * i));
      bytes[20 + i] = static_cast<char>(height >> (24 - 8 * i));
    }
    const uint32_t crc = crc_of(bytes, 12, 17);
    for (size_t i = 0; i < 4; ++i) bytes[29 + i] = static_cast<char>(crc >> (24 - 8 * i));
    put(dir / "size.png", bytes);
    return dir / "size.png";
  };
  CHECK_NOTHROW(image::read_png8(with_size(3, 2)));  // the CRC above is right
  CHECK_THROWS_WITH(image::read_png8(with_size(0, 2)), Contains("0x2"));
  CHECK_THROWS_WITH(image::read_png8(with_size(3, 0)), Contains("3x0"));
  CHECK_THROWS_WITH(image::read_png8(with_size(16385, 2)), Contains("accepted is 1 to 16384"));
  CHECK_THROWS_WITH(image::read_png8(with_size(0xFFFFFFFF, 0xFFFFFFFF)), Contains("accepted is 1 to 16384"));
  CHECK_THROWS_WITH(image::read_png8(with_size(16384, 16384)),
                    Contains("bytes of data"));  // 1 GiB promised by 100 bytes

  std::string odd = good;  // a chunk of an unknown type with a line break in it, its CRC right
  odd.replace(odd.find("IDAT"), 4, "A\nAA");
  const size_t at = odd.find("A\nAA"), length = static_cast<uint8_t>(odd[at - 1]);
  for (size_t i = 0; i < 4; ++i)
    odd[at + 4 + length + i] = static_cast<char>(crc_of(odd, at, length + 4) >> (24 - 8 * i));
  put(dir / "odd.png", odd);
  CHECK_THROWS_WITH(image::read_png8(dir / "odd.png"), Contains("odd.png: PNG is damaged: unknown chunk type"));

  CHECK_THROWS_WITH(image::write_png8(dir / "out.png", {0, 0, {}}), Contains("0x0"));
  CHECK_THROWS_WITH(image::write_png8(dir / "out.png", {16385, 1, {}}), Contains("16385x1"));
  CHECK_THROWS_WITH(image::write_png8(dir / "out.png", {2, 2, {1, 2, 3}}), Contains("3 bytes"));
  CHECK_FALSE(fs::exists(dir / "out.png"));
}

TEST_CASE("PNG: every truncation is an Error", "[png]") {
  const TemporaryDirectory dir;
  const std::string good = image::encode_png8(noise8(3, 2), {{"scene", "a\nb"}, {"place", "43° N"}});
  for (size_t length = 0; length < good.size(); ++length) {
    put(dir / "cut.png", good.substr(0, length));
    REQUIRE_FALSE(survives([&] { image::read_png8(dir / "cut.png"); }));
    REQUIRE_FALSE(survives([&] { image::read_png16(dir / "cut.png"); }));
    REQUIRE_FALSE(survives([&] { image::read_png_text(dir / "cut.png", "absent"); }));
  }
}

TEST_CASE("PNG: damaged files end in Error or success, nothing else", "[png]") {
  const TemporaryDirectory dir;
  const std::string good = image::encode_png8(noise8(9, 7), {{"scene", "a\nb"}, {"place", "43° N"}});
  std::mt19937 random(11);
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::string bytes = good;
    const int flips = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < flips; ++i) bytes[8 + random() % (bytes.size() - 8)] ^= static_cast<char>(1 + random() % 255);
    if (round % 2 == 1) {  // repair each CRC, so that the damage reaches what lies behind the check
      for (size_t at = 8; at + 12 <= bytes.size();) {
        size_t length = 0;
        for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<uint8_t>(bytes[at + i]);
        if (length > bytes.size() - at - 12) break;
        const uint32_t crc = crc_of(bytes, at + 4, length + 4);
        for (size_t i = 0; i < 4; ++i) bytes[at + 8 + length + i] = static_cast<char>(crc >> (24 - 8 * i));
        at += 12 + length;
      }
    }
    put(dir / "bad.png", bytes);
    refused += !survives([&] { image::read_png8(dir / "bad.png"); });
    survives([&] { image::read_png16(dir / "bad.png"); });
    for (const char* key : {"scene", "place", ""}) survives([&] { image::read_png_text(dir / "bad.png", key); });
  }
  CHECK(refused > 2000);  // a single flip never passes the CRC
}

TEST_CASE("atomic writing: all or nothing, and no litter", "[atomic_file]") {
  const TemporaryDirectory dir;
  const auto files = [&] { return std::distance(fs::directory_iterator(dir.path), fs::directory_iterator()); };
  write_file_atomically(dir / "a", std::string_view("first"));
  write_file_atomically(dir / "a", std::string_view("second, longer"));
  CHECK(read_file(dir / "a", 100) == "second, longer");
  const std::byte raw[] = {std::byte{0}, std::byte{255}};
  write_file_atomically(dir / "b", std::span(raw));
  CHECK(read_file(dir / "b", 2) == std::string("\0\xFF", 2));
  CHECK(files() == 2);

  CHECK_THROWS_WITH(write_file_atomically(dir / "no/x", std::string_view("x")),
                    Contains("/no': No such file or directory"));
  CHECK_THROWS_WITH(write_file_atomically(dir / "a/x", std::string_view("x")), Contains("not a directory"));
  CHECK_THROWS_WITH(write_file_atomically(dir.path, std::string_view("x")), Contains("it is a directory"));
  CHECK_THROWS_WITH(write_file_atomically("/dev/full", std::string_view("x")), Contains("device"));
  CHECK_THROWS_AS(write_file_atomically("/proc/welkin", std::string_view("x")), Error);
  CHECK_THROWS_WITH(write_file_atomically("", std::string_view("x")), Contains("names no file"));
  CHECK_THROWS_WITH(write_file_atomically(dir / std::string(300, 'n'), std::string_view("x")), Contains("too long"));

  // A full disk, as far as a process can make one for itself: no file may grow beyond 1000 bytes.
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const rlimit small{1000, before.rlim_max};
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
  std::string message;
  try {
    write_file_atomically(dir / "a", std::string(5000, 'x'));
  } catch (const Error& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  CHECK_THAT(message, Contains("File too large"));
  CHECK(read_file(dir / "a", 100) == "second, longer");
  CHECK(files() == 2);

  CHECK_THROWS_WITH(read_file(dir / "a", 13), Contains("13 bytes accepted"));
  CHECK_NOTHROW(read_file(dir / "a", 14));
  CHECK_THROWS_WITH(read_file(dir / "a/b", 14), Contains("Not a directory"));
  CHECK_THROWS_WITH(read_file("/dev/zero", 14), Contains("device"));
}

TEST_CASE("atomic writing goes through symbolic links and keeps permissions", "[atomic_file]") {
  const TemporaryDirectory dir;
  fs::create_directory(dir / "far");
  write_file_atomically(dir / "far/target", std::string_view("first"));
  fs::permissions(dir / "far/target", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("far/target", dir / "link");
  fs::create_symlink("link", dir / "link_to_link");
  for (const char* name : {"link", "link_to_link"}) {
    write_file_atomically(dir / name, std::string_view(name));
    CHECK(fs::is_symlink(dir / name));
    CHECK(read_file(dir / "far/target", 100) == name);
  }
  CHECK(fs::status(dir / "far/target").permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  fs::create_symlink("far/new", dir / "to_nothing");
  write_file_atomically(dir / "to_nothing", std::string_view("made"));
  CHECK(read_file(dir / "far/new", 100) == "made");
  CHECK(fs::is_symlink(dir / "to_nothing"));
  fs::create_symlink("b", dir / "a");
  fs::create_symlink("a", dir / "b");
  CHECK_THROWS_WITH(write_file_atomically(dir / "a", std::string_view("x")), Contains("/a': its symbolic links"));
  fs::create_symlink("gone/x", dir / "astray");
  CHECK_THROWS_WITH(write_file_atomically(dir / "astray", std::string_view("x")), Contains("/gone': No such file"));
  fs::create_symlink("far", dir / "folder");
  CHECK_THROWS_WITH(write_file_atomically(dir / "folder", std::string_view("x")), Contains("a directory"));
  CHECK(std::distance(fs::directory_iterator(dir / "far"), fs::directory_iterator()) == 2);  // no litter
}
