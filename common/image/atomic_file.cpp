// Whole-file reading and atomic writing, with the system's word for why they failed. See atomic_file.hpp.
#include "common/image/atomic_file.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "common/error.hpp"

namespace welkin {
namespace fs = std::filesystem;
namespace {

struct Close {
  void operator()(FILE* file) const { std::fclose(file); }
};

// Where a name leads: a symbolic link is written through, not replaced, also one that leads to nothing yet.
fs::path resolve_symlinks(const fs::path& name) {
  fs::path target = name;
  std::error_code error;
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    if (links == 40)
      fail("cannot write '{}': its symbolic links lead in a circle", name.string());  // Linux's own limit
    target = target.parent_path() / fs::read_symlink(target, error);
  }
  return target;
}

}  // namespace

void write_file_atomically(const fs::path& file_name, std::string_view contents) {
  const fs::path target = resolve_symlinks(file_name), parent = target.has_parent_path() ? target.parent_path() : ".";
  const std::string name = file_name.string();
  if (!target.has_filename()) fail("cannot write '{}': it names no file", name);
  std::error_code error;
  const fs::file_status there = fs::status(target, error);
  if (fs::exists(there) && !fs::is_regular_file(there))
    fail("cannot write '{}': it is {}, not a regular file", name,
         fs::is_directory(there) ? "a directory" : "a device or pipe");
  const bool in_directory = fs::is_directory(parent, error);
  if (error) fail("cannot write '{}': directory '{}': {}", name, parent.string(), error.message());
  if (!in_directory) fail("cannot write '{}': '{}' is not a directory", name, parent.string());

  static std::atomic<unsigned> counter{0};
  const std::string temporary = fmt::format("{}.{}-{}.tmp", target.string(), ::getpid(), counter++);
  FILE* file = std::fopen(temporary.c_str(), "wxe");  // x: a new file, e: not for programs started meanwhile
  if (file == nullptr) fail("cannot write '{}': {}", name, std::strerror(errno));
  // Who may read it stays as it was, from before there is anything to read.
  if (fs::exists(there)) fs::permissions(temporary, there.permissions(), error);
  const auto failed = [&] { error.assign(errno, std::generic_category()); };
  if (!error && std::fwrite(contents.data(), 1, contents.size(), file) != contents.size()) failed();
  if (std::fclose(file) != 0 && !error) failed();  // some disks report "full" only here
  if (!error) fs::rename(temporary, target, error);
  if (!error) return;
  ::unlink(temporary.c_str());
  fail("cannot write '{}' ({} bytes): {}", name, contents.size(), error.message());
}

std::string read_file(const fs::path& path, size_t max_bytes) {
  const std::string name = path.string();
  std::error_code error;
  // Asked before opening: opening a pipe that nobody writes to would wait for ever.
  const fs::file_status there = fs::status(path, error);
  if (error) fail("cannot read '{}': {}", name, error.message());
  if (fs::is_directory(there)) fail("cannot read '{}': it is a directory", name);
  if (!fs::is_regular_file(there)) fail("cannot read '{}': it is a device or pipe, not a regular file", name);
  const std::unique_ptr<FILE, Close> file(std::fopen(name.c_str(), "re"));
  if (!file) fail("cannot read '{}': {}", name, std::strerror(errno));

  std::string contents;
  for (size_t step = 65536, got = step; got == step;) {  // fewer bytes than asked for: the end, or an error
    const size_t done = contents.size();
    contents.resize(done + step);
    got = std::fread(contents.data() + done, 1, step, file.get());
    if (std::ferror(file.get()) != 0) fail("cannot read '{}': {}", name, std::strerror(errno));
    contents.resize(done + got);
    if (contents.size() > max_bytes) fail("cannot read '{}': it is larger than the {} bytes accepted", name, max_bytes);
  }
  return contents;
}

}  // namespace welkin
