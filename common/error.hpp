// The one way Welkin reports that something is wrong: an Error carries one clear line (what was wrong, where, what is
// accepted) and the exit code the program ends with. Nothing between the fault and main() prints.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace welkin {

// What a program's exit code means. Scripts and tests rely on these numbers.
enum class Exit : int {
  ok = 0,
  mismatch = 1,    // a golden, a comparison or a reference does not agree
  usage = 2,       // bad command line, bad input file, missing feature, unwritable output
  validation = 3,  // the Vulkan validation layer had something to say
  skipped = 77,    // no Vulkan device on this machine: nothing was tested
};

struct Error : std::runtime_error {
  Exit exit_code;
  Error(Exit code, const std::string& line) : std::runtime_error(line), exit_code(code) {}
};

// Throws an Error with Exit::usage and a line formatted like fmt::format.
template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(Exit::usage, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace welkin
