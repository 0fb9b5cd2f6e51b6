// A directory of a test's own, removed when the test ends.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>

struct TemporaryDirectory {
  std::filesystem::path path;
  TemporaryDirectory() {
    static std::atomic<int> count{0};
    path = std::filesystem::temp_directory_path() /
           ("welkin-test-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path / name; }
};
