// Whole files in, whole files out: nothing half-written is ever seen under the target's name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace welkin {

// Writes to "<target>.<pid>-<n>.tmp" in the target's directory and renames that over the target, which is the file
// behind a symbolic link, and keeps its permissions. On any failure the temporary file is removed, the target is as it
// was, and Error says in one line what stood in the way (directory missing, target a directory or a device, no
// permission, disk full). The directory is not made.
void write_file_atomically(const std::filesystem::path& target, std::string_view contents);
void write_file_atomically(const std::filesystem::path& target, std::span<const std::byte> contents);

// The whole file as bytes. Error if it is missing, not a regular file, unreadable or larger than max_bytes.
std::string read_file(const std::filesystem::path& file, size_t max_bytes);

}  // namespace welkin
