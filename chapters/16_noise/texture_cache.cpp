// Keeping made textures on disk. See texture_cache.hpp.
#include "chapters/16_noise/texture_cache.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"

namespace welkin {
namespace fs = std::filesystem;
namespace {

struct Header {
  char magic[8] = {'W', 'L', 'K', 'N', 'O', 'I', 'S', 'E'};
  uint64_t version = 1, key = 0, count = 0, checksum = 0;
};
static_assert(sizeof(Header) == 40);

const char* variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : nullptr;
}

std::string fault_of(const Header& header, uint64_t key, uint64_t wanted, uint64_t there) {
  const Header expected;
  if (std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0) return "it is not one of ours";
  if (header.version != expected.version) return fmt::format("its version is {}", header.version);
  if (header.key != key) return "it was made from something else";
  if (header.count != wanted)
    return fmt::format("it is said to have {} bytes, and {} are wanted", header.count, wanted);
  if (there != wanted) return fmt::format("it has {} of {} bytes", there, wanted);
  return {};
}

}  // namespace

// [checksum]
uint64_t checksum(std::string_view bytes, uint64_t seed) {
  uint64_t sum = seed;
  const auto add = [&](uint64_t word) {
    sum = (sum ^ word) * 0x100000001B3ull;
    sum ^= sum >> 32;
  };
  size_t at = 0;
  for (uint64_t word = 0; at + 8 <= bytes.size(); at += 8) std::memcpy(&word, bytes.data() + at, 8), add(word);
  uint64_t rest = 0;
  std::memcpy(&rest, bytes.data() + at, bytes.size() - at);
  add(rest);
  add(bytes.size());
  return sum;
}
// [/checksum]

fs::path cache_directory() {
  if (const char* chosen = variable("WELKIN_CACHE")) return std::string_view(chosen) == "off" ? fs::path() : chosen;
  if (const char* caches = variable("XDG_CACHE_HOME")) return fs::path(caches) / "welkin";
  if (const char* home = variable("HOME")) return fs::path(home) / ".cache" / "welkin";
  return {};
}

fs::path cache_file(const std::string& name, uint64_t key) {
  const fs::path directory = cache_directory();
  return directory.empty() ? fs::path() : directory / fmt::format("{}_{:016x}.bin", name, key);
}

// [cache]
CacheRead read_cached(const fs::path& file, uint64_t key, std::span<char> into) {
  std::error_code error;
  const fs::file_status there = fs::status(file, error);
  if (file.empty() || !fs::exists(there)) return {};
  if (!fs::is_regular_file(there)) return {.fault = "it is not a file"};  // a pipe would be waited for
  const uint64_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  Header header;
  if (!stream) return {.fault = "it cannot be read"};
  if (!stream.read(reinterpret_cast<char*>(&header), sizeof header)) return {.fault = "it is cut short"};
  std::string fault = fault_of(header, key, into.size(), size - sizeof header);
  if (!fault.empty()) return {.fault = std::move(fault)};
  if (!stream.read(into.data(), static_cast<std::streamsize>(into.size()))) return {.fault = "it is cut short"};
  if (header.checksum != checksum({into.data(), into.size()})) return {.fault = "its checksum is wrong"};
  return {.found = true};
}

std::string write_cached(const fs::path& file, uint64_t key, std::string_view bytes) {
  if (file.empty()) return "nothing is to be kept";
  try {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);  // what stands in the way is said by writing
    Header header;
    header.key = key, header.count = bytes.size(), header.checksum = checksum(bytes);
    std::string contents(reinterpret_cast<const char*>(&header), sizeof header);
    contents.append(bytes);
    write_file_atomically(file, contents);
    return {};
  } catch (const Error& unwritable) {
    return unwritable.what();
  }
}
// [/cache]

}  // namespace welkin
