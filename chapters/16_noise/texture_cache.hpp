// What was made once is kept: files in the user's cache directory, named by what they hold and keyed by everything it
// was made from. A file that is not exactly what it should be is as good as none. CPU only.
//
// The directory: $WELKIN_CACHE if set ("off": nothing is kept), else $XDG_CACHE_HOME/welkin, else $HOME/.cache/welkin.
// A file: eight letters of magic, a version, the key, the number of bytes, a checksum of them, and the bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace welkin {

// FNV-1a over 64-bit words (the last one filled up with zeros, and the length at the end): a file of 10 MB in 5 ms.
// Finds accidents, not forgeries.
uint64_t checksum(std::string_view bytes, uint64_t seed = 0xCBF29CE484222325ull);

// Empty: nothing is kept.
std::filesystem::path cache_directory();

// Where a texture of this name and key is kept.
std::filesystem::path cache_file(const std::string& name, uint64_t key);

// Fills `into` from the file if that holds as many bytes, made from `key`. If not, what `into` holds then is undefined.
// Straight into its place, which may be a device's: touching fresh memory is most of what reading costs. Never throws.
struct CacheRead {
  bool found = false;  // and good
  std::string fault;   // of a file that is there
};
CacheRead read_cached(const std::filesystem::path& file, uint64_t key, std::span<char> into);

// Keeps them, making the directory if need be. Returns why they are not kept, or nothing. Never throws.
std::string write_cached(const std::filesystem::path& file, uint64_t key, std::string_view bytes);

}  // namespace welkin
