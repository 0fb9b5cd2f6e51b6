// See progress.hpp.
#include "common/app/progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace welkin::app {

Progress::Progress(std::string what, size_t total)
    : what_(std::move(what)), total_(total == 0 ? 1 : total), terminal_(isatty(STDERR_FILENO) != 0) {}

void Progress::step() {
  ++done_;
  if (!terminal_) return;
  constexpr size_t width = 40;
  const size_t filled = width * done_ / total_;
  std::fprintf(stderr, "\r%s [%s%s] %zu/%zu", what_.c_str(), std::string(filled, '#').c_str(),
               std::string(width - filled, '.').c_str(), done_, total_);
}

Progress::~Progress() {
  if (terminal_ && done_ > 0) std::fprintf(stderr, "\r\033[K");
}

}  // namespace welkin::app
