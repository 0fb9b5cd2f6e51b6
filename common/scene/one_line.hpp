// Text from files and command lines, made safe for a one-line message: control characters (and the two
// Unicode line separators) become \xNN, and very long text is cut. Nothing a file contains can split a
// message or drive a terminal.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace welkin {

// Letters, digits, '_', '-' and '.': a name is typed on the command line and may become part of a file's name.
inline bool plain_name(std::string_view text) {
  return !text.empty() && text.find_first_not_of(
                              "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                              "0123456789_-.") == text.npos;
}

inline std::string one_line(std::string_view text, size_t longest = 400) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (out.size() >= longest) {
      // Stop between characters, never inside a UTF-8 sequence.
      while (i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80) out += text[i++];
      return i < text.size() ? out + "..." : out;
    }
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool c1 = byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    const bool separator = text.substr(i, 3) == "\u2028" || text.substr(i, 3) == "\u2029";
    if (byte < 0x20 || byte == 0x7F || c1 || separator)
      out += fmt::format("\\x{:02x}", byte);
    else
      out += text[i];
  }
  return out;
}

}  // namespace welkin
