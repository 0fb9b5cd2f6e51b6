// TOML as a table of nodes with places, or one line with file:line:column. Included by scene_parse.cpp alone, which is
// the only unit that compiles toml++.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "common/error.hpp"
#include "common/scene/one_line.hpp"

namespace welkin::strict_toml {

// toml++ 3.3 states what it believes of its input as assertions, which release builds turn into undefined
// behaviour. Some beliefs are wrong ("[[[" in a header): here each becomes an exception, in every build.
struct ParserFault {};
constexpr void believe(bool belief) {
  if (!belief) throw ParserFault();
}

}  // namespace welkin::strict_toml

// Header-only, so that the limit on nesting is ours: toml++ recurses once per nested value, a scene nests
// three deep.
#undef TOML_HEADER_ONLY
#undef TOML_SHARED_LIB
#define TOML_HEADER_ONLY 1
#define TOML_MAX_NESTED_VALUES 8
#include <toml++/impl/preprocessor.h>
#undef TOML_ASSERT
#undef TOML_ASSERT_ASSUME
#define TOML_ASSERT(belief) welkin::strict_toml::believe(static_cast<bool>(belief))
#define TOML_ASSERT_ASSUME(belief) TOML_ASSERT(belief)
#include <toml++/toml.h>

namespace welkin::strict_toml {

[[noreturn]] inline void fail_at(const std::string& file, const toml::source_region& where, const std::string& what,
                                 const std::string& accepted) {
  // Something without a place of its own (an empty file) is reported at the start.
  const auto line = std::max<unsigned>(where.begin.line, 1), column = std::max<unsigned>(where.begin.column, 1);
  fail("{} at {}:{}:{}: {}", one_line(what, 200), one_line(file), line, column, one_line(accepted));
}

inline std::string describe(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("'{}'", one_line(text->get(), 60));
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_array()) return "an array";
  return node.is_table() ? "a table" : "a date or time";
}

// The keys in the file's order: toml++ keeps them in alphabetical order.
inline std::vector<const toml::key*> keys_of(const toml::table& table) {
  std::vector<const toml::key*> keys;
  for (auto&& entry : table) keys.push_back(&entry.first);
  std::sort(keys.begin(), keys.end(), [](const toml::key* a, const toml::key* b) {
    const auto &x = a->source().begin, &y = b->source().begin;
    return std::pair(x.line, x.column) < std::pair(y.line, y.column);
  });
  return keys;
}

// The file as a table, or one line with its place.
inline toml::table parse_table(const std::string& text, const std::string& file) {
  // True if the parser's own assumptions fail within the first `size` bytes.
  const auto faults = [&](size_t size) {
    try {
      (void)toml::parse(std::string_view(text).substr(0, size));
    } catch (const toml::parse_error&) {
    } catch (const ParserFault&) {
      return true;
    }
    return false;
  };
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    fail_at(file, error.source(), "not valid TOML", std::string(error.description()));
  } catch (const ParserFault&) {
  }
  // A fault has no place, but the parser never looks back: the shortest beginning that faults ends where it
  // is.
  size_t sound = 0, faulty = text.size();
  while (faulty - sound > 1) {
    const size_t middle = sound + (faulty - sound) / 2;
    (faults(middle) ? faulty : sound) = middle;
  }
  const auto line =
      static_cast<toml::source_index>(1 + std::count(text.begin(), text.begin() + static_cast<long>(sound), '\n'));
  const size_t start = sound == 0 ? 0 : text.rfind('\n', sound - 1) + 1;
  fail_at(file, {{line, static_cast<toml::source_index>(sound - start + 1)}, {}, {}}, "not valid TOML",
          "this character does not belong here");
}

}  // namespace welkin::strict_toml
