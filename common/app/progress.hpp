// A progress bar on standard error for work that takes a while; silent unless it is a terminal.
#pragma once

#include <cstddef>
#include <string>

namespace welkin::app {

class Progress {
 public:
  Progress(std::string what, size_t total);
  ~Progress();
  void step();

 private:
  std::string what_;
  size_t total_, done_ = 0;
  bool terminal_;
};

}  // namespace welkin::app
