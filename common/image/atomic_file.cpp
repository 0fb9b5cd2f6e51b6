// Whole-file reading and atomic writing over POSIX calls, which say why they failed. See atomic_file.hpp.
#include "common/image/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/error.hpp"

namespace welkin {
namespace {

struct Descriptor {
  int fd;
  explicit Descriptor(int opened) : fd(opened) {}
  Descriptor(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

// Where a name leads: a symbolic link is written through, not replaced, also one that leads to nothing yet.
std::filesystem::path resolve_symlinks(const std::filesystem::path& name) {
  std::filesystem::path target = name;
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(target, error); ++links) {
    if (links == 40)
      fail("cannot write '{}': its symbolic links lead in a circle", name.string());  // Linux's own limit
    target = target.parent_path() / std::filesystem::read_symlink(target, error);
  }
  return target;
}

}  // namespace

void write_file_atomically(const std::filesystem::path& file_name, std::string_view contents) {
  const std::filesystem::path target = resolve_symlinks(file_name);
  const std::string name = file_name.string(), target_name = target.string();
  if (!target.has_filename()) fail("cannot write '{}': it names no file", name);
  struct stat info {};
  const bool replaces = ::stat(target_name.c_str(), &info) == 0;
  const mode_t mode = info.st_mode;
  if (replaces && !S_ISREG(mode))
    fail("cannot write '{}': it is {}, not a regular file", name, S_ISDIR(mode) ? "a directory" : "a device or pipe");
  const std::string parent = target.has_parent_path() ? target.parent_path().string() : ".";
  if (::stat(parent.c_str(), &info) != 0)
    fail("cannot write '{}': directory '{}': {}", name, parent, std::strerror(errno));
  if (!S_ISDIR(info.st_mode)) fail("cannot write '{}': '{}' is not a directory", name, parent);

  static std::atomic<unsigned> counter{0};
  const std::string temporary = fmt::format("{}.{}-{}.tmp", target_name, ::getpid(), counter++);
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.fd < 0) fail("cannot write '{}': {}", name, std::strerror(errno));

  int error = replaces && ::fchmod(file.fd, mode & 07777) != 0 ? errno : 0;  // who may read it stays as it was
  for (size_t done = 0; done < contents.size() && error == 0;) {
    const ssize_t written = ::write(file.fd, contents.data() + done, contents.size() - done);
    if (written > 0)
      done += static_cast<size_t>(written);
    else if (written == 0)
      error = ENOSPC;
    else if (errno != EINTR)
      error = errno;
  }
  if (::close(std::exchange(file.fd, -1)) != 0 && error == 0) error = errno;  // some disks report "full" only here
  if (error == 0 && ::rename(temporary.c_str(), target_name.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(temporary.c_str());
  fail("cannot write '{}' ({} bytes): {}", name, contents.size(), std::strerror(error));
}

std::string read_file(const std::filesystem::path& path, size_t max_bytes) {
  const std::string name = path.string();
  struct stat info {};
  // Asked before opening: opening a pipe that nobody writes to would wait for ever.
  if (::stat(name.c_str(), &info) != 0) fail("cannot read '{}': {}", name, std::strerror(errno));
  if (S_ISDIR(info.st_mode)) fail("cannot read '{}': it is a directory", name);
  if (!S_ISREG(info.st_mode)) fail("cannot read '{}': it is a device or pipe, not a regular file", name);
  Descriptor file(::open(name.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.fd < 0) fail("cannot read '{}': {}", name, std::strerror(errno));

  std::string contents;
  for (size_t step = 65536;;) {
    const size_t done = contents.size();
    contents.resize(done + step);
    const ssize_t got = ::read(file.fd, contents.data() + done, step);
    if (got < 0 && errno != EINTR) fail("cannot read '{}': {}", name, std::strerror(errno));
    contents.resize(done + static_cast<size_t>(got > 0 ? got : 0));
    if (got == 0) return contents;
    if (contents.size() > max_bytes) fail("cannot read '{}': it is larger than the {} bytes accepted", name, max_bytes);
  }
}

}  // namespace welkin
