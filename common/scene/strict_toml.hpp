// Strict readers for one table of a TOML file: each checks type and range and reports file:line:column and
// what is accepted. An absent key leaves the value as it is. Included by scene_parse.cpp alone, which is the
// only unit that compiles toml++.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <string>
#include <string_view>

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

constexpr size_t kLongestName = 64;  // bytes, of scenes, views and knobs

struct Range {
  double minimum, maximum;
  const char* unit = "";
};

// One table of the file: where messages about it point, and what it is called in them.
struct Section {
  const toml::table* table;
  std::string name;  // "sun"; empty for the file itself
  const std::string* file;
};

using Names = std::initializer_list<const char*>;

[[noreturn]] inline void fail_at(const std::string& file, const toml::source_region& where, const std::string& what,
                                 const std::string& accepted) {
  // Something without a place of its own (an empty file) is reported at the start.
  const auto line = std::max<unsigned>(where.begin.line, 1), column = std::max<unsigned>(where.begin.column, 1);
  fail("{} at {}:{}:{}: {}", one_line(what, 200), one_line(file), line, column, one_line(accepted));
}

inline std::string full_name(const Section& section, std::string_view key) {
  return section.name.empty() ? std::string(key) : fmt::format("{}.{}", section.name, key);
}

inline std::string describe(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("'{}'", one_line(text->get(), 60));
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_array()) return "an array";
  return node.is_table() ? "a table" : "a date or time";
}

[[noreturn]] inline void fail_value(const Section& section, std::string_view key, const toml::node& node,
                                    const std::string& accepted) {
  fail_at(*section.file, node.source(), fmt::format("{} = {}", full_name(section, key), describe(node)),
          "accepted is " + accepted);
}

inline bool has(const Section& section, std::string_view key) { return section.table->contains(key); }

// toml++ keeps keys in alphabetical order; what is said about them follows the file's.
inline bool earlier(const toml::key* a, const toml::key* b) {
  const auto &x = a->source().begin, &y = b->source().begin;
  return std::pair(x.line, x.column) < std::pair(y.line, y.column);
}

// The key furthest up in the file that is not one of `known`, or nullptr.
inline const toml::key* first_unknown(const Section& section, const Names& known) {
  const toml::key* first = nullptr;
  for (auto&& entry : *section.table) {
    const toml::key& key = entry.first;
    if (std::any_of(known.begin(), known.end(), [&](const char* name) { return key == name; })) continue;
    if (!first || earlier(&key, first)) first = &key;
  }
  return first;
}

inline void check_keys(const Section& section, const Names& known) {
  if (const toml::key* key = first_unknown(section, known))
    fail_at(*section.file, key->source(), fmt::format("unknown key '{}' in {}", one_line(key->str(), 60), section.name),
            fmt::format("known are {}", fmt::join(known, ", ")));
}

inline std::string text_of(const Range& range) {
  return fmt::format("{:g} to {:g}{}{}", range.minimum, range.maximum, *range.unit ? " " : "", range.unit);
}

inline double checked(const Section& section, std::string_view key, const toml::node& node, const Range& range,
                      const std::string& accepted) {
  if (!node.is_number()) fail_value(section, key, node, accepted);
  const double value =
      node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  if (!(value >= range.minimum && value <= range.maximum)) fail_value(section, key, node, accepted);  // NaN too
  return value + 0.0;                                                                                 // -0 becomes 0
}

inline void read(const Section& section, std::string_view key, double& value, const Range& range) {
  if (const toml::node* node = section.table->get(key))
    value = checked(section, key, *node, range, "a number from " + text_of(range));
}

// A whole number.
inline void read(const Section& section, std::string_view key, int& value, const Range& range) {
  const toml::node* node = section.table->get(key);
  if (!node) return;
  const std::string accepted = "a whole number from " + text_of(range);
  if (!node->is_integer()) fail_value(section, key, *node, accepted);
  value = static_cast<int>(checked(section, key, *node, range, accepted));
}

// An azimuth, from `origin_deg`, brought to 0 <= azimuth < 360.
inline void read_azimuth(const Section& section, std::string_view key, double& value, double origin_deg = 0.0) {
  if (!has(section, key)) return;
  read(section, key, value, {-360, 360, "deg"});
  value = std::fmod(origin_deg + value, 360.0);
  if (value < 0) value += 360.0;
  if (value >= 360.0) value = 0.0;  // -1e-20 + 360 rounds to 360
}

inline void read(const Section& section, std::string_view key, glm::dvec3& value, const Range& range) {
  const toml::node* node = section.table->get(key);
  if (!node) return;
  const std::string accepted = fmt::format("a number from {} or three of them, [r, g, b]", text_of(range));
  const toml::array* array = node->as_array();
  if (!array) {
    value = glm::dvec3(checked(section, key, *node, range, accepted));
    return;
  }
  if (array->size() != 3)
    fail_at(*section.file, node->source(), fmt::format("{} has {} numbers", full_name(section, key), array->size()),
            "accepted is " + accepted);
  for (int i = 0; i < 3; ++i)
    value[i] = checked(section, fmt::format("{}[{}]", key, i), *array->get(static_cast<size_t>(i)), range, accepted);
}

inline void read(const Section& section, std::string_view key, bool& value) {
  const toml::node* node = section.table->get(key);
  if (!node) return;
  if (!node->is_boolean()) fail_value(section, key, *node, "true or false");
  value = node->as_boolean()->get();
}

// Letters, digits, '_', '-' and '.': a name is typed on the command line and may become part of a file's
// name.
inline void read_name(const Section& section, std::string_view key, std::string& value) {
  const toml::node* node = section.table->get(key);
  if (!node) return;
  const std::string accepted = fmt::format("quoted text of 1 to {} letters, digits, _, - or .", kLongestName);
  if (!node->is_string()) fail_value(section, key, *node, accepted);
  value = node->as_string()->get();
  const bool good = std::all_of(value.begin(), value.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  });
  if (!good || value.empty() || value.size() > kLongestName) fail_value(section, key, *node, accepted);
}

// Index of the text in `choices`; `otherwise` when absent.
inline size_t read_choice(const Section& section, std::string_view key, const Names& choices, size_t otherwise) {
  const toml::node* node = section.table->get(key);
  if (!node) return otherwise;
  size_t i = 0;
  for (const char* choice : choices) {
    if (node->is_string() && node->as_string()->get() == choice) return i;
    ++i;
  }
  fail_value(section, key, *node, fmt::format("one of \"{}\"", fmt::join(choices, "\", \"")));
}

inline const toml::source_region& place(const Section& section, std::string_view key) {
  const toml::node* node = section.table->get(key);
  return node ? node->source() : section.table->source();
}

// Two ways to say the same thing: at most one may be used.
inline void check_exclusive(const Section& section, std::string_view key, std::string_view other) {
  if (has(section, key) && has(section, other))
    fail_at(*section.file, place(section, other), fmt::format("{} given beside {}", full_name(section, other), key),
            "accepted is one of the two");
}

// The tables of an [[array]]; calls `each` for every one in the file's order.
template <typename Each>
void for_each_table(const Section& root, const char* key, const Each& each) {
  const toml::node* node = root.table->get(key);
  if (!node) return;
  const std::string accepted = fmt::format("[[{}]], a section for each", key);
  if (!node->is_array()) fail_value(root, key, *node, accepted);
  for (const toml::node& item : *node->as_array()) {
    if (!item.is_table()) fail_value(root, key, item, accepted);
    each(Section{item.as_table(), key, root.file});
  }
}

template <typename Each>
void for_table(const Section& root, const char* key, const Each& each) {
  const toml::node* node = root.table->get(key);
  if (!node) return;
  if (!node->is_table()) fail_value(root, key, *node, fmt::format("a section, [{}]", key));
  each(Section{node->as_table(), key, root.file});
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
