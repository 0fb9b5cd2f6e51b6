// The table of what a scene may say, as rows: for the fuzzer, and as the CSV that docs/scenes.md is woven from.
#pragma once

#include <string>
#include <vector>

#include "common/scene/fields.hpp"

namespace welkin::test {

struct Row {
  std::string section, key, kind, accepted, initial, meaning;
  Range range;
  bool number = false;  // a range decides what is accepted
};

struct RowVisitor : Visitor {
  static constexpr bool reading = true, listing = true;  // defaults of a kind are set
  std::string section, kind;
  std::vector<Row> rows;

  template <typename T>
  void operator()(const char* key, T& value, const Range& range, const char* meaning, const More& more = {}) {
    Row row{section, key,  kind, accepted(value, range), more.required ? "required" : initial(value, range),
            meaning, range};
    row.number = range.choices.empty() && (std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>> ||
                                           std::is_same_v<T, int> || std::is_same_v<T, glm::dvec3>);
    if (*more.besides) row.meaning += fmt::format(" (not beside `{}`)", more.besides);
    rows.push_back(row);
  }

 private:
  template <typename T>
  static std::string accepted(const T&, const Range& range) {
    if (!range.choices.empty()) return fmt::format("`\"{}\"`", fmt::join(range.choices, "\"`, `\""));
    if constexpr (std::is_same_v<T, bool>) return "`true`, `false`";
    if (*range.text) return range.text;
    if constexpr (std::is_same_v<T, std::string>) return "a name";
    if constexpr (std::is_same_v<T, std::vector<std::string>>) return "names";
    const bool triple = std::is_same_v<T, glm::dvec3> || std::is_same_v<T, std::optional<glm::dvec3>>;
    return (triple ? "three, " : std::is_same_v<T, std::vector<double>> ? "numbers, " : "") + text_of(range);
  }
  template <typename T>
  static std::string initial(const T& value, const Range& range) {
    if (!range.choices.empty()) return fmt::format("`\"{}\"`", range.choices[size_t(choice_of(range, value))]);
    if constexpr (std::is_same_v<T, bool>)
      return value ? "`true`" : "`false`";
    else if constexpr (std::is_same_v<T, glm::dvec3>)
      return fmt::format("{}", value.x);
    else if constexpr (std::is_arithmetic_v<T>)
      return fmt::format("{}", value);
    else if constexpr (std::is_same_v<T, std::string>)
      return value.empty() ? "none" : value;
    else
      return "none";
  }
};

// Every row, in the table's order; a medium's once for each of its kinds.
inline std::vector<Row> scene_rows() {
  RowVisitor visitor;
  Scene scene;
  fields(visitor, scene, scene);
  sections(scene, [&](const char* name, auto& member) {
    visitor.section = name;
    if constexpr (std::is_same_v<std::decay_t<decltype(member)>, std::vector<Medium>>)
      for (const char* kind : {"rayleigh", "mie", "ozone"}) {
        member = {Medium{.kind = kind}};
        visitor.kind = kind;
        fields(visitor, member.front(), scene);
      }
    else if constexpr (std::is_same_v<std::decay_t<decltype(member)>, std::vector<Cloud>>)
      for (const char* kind : {"layer", "disc", "sphere", "grid", "noise"}) {
        member = {Cloud{.kind = kind}};
        visitor.kind = kind;
        fields(visitor, member.front(), scene);
      }
    else if constexpr (requires { member.emplace_back(); })
      fields(visitor, member.emplace_back(), scene);
    else if constexpr (requires { member.emplace(); })
      fields(visitor, member.emplace(), scene);
    else
      fields(visitor, member, scene);
    visitor.kind.clear();
  });
  return visitor.rows;
}

// docs/generated/scene_fields.csv. Rows that differ in nothing but their kind are one.
inline std::string scene_fields_csv() {
  std::vector<Row> rows;
  for (const Row& row : scene_rows()) {
    const auto same = std::find_if(rows.begin(), rows.end(), [&](const Row& other) {
      return other.section == row.section && other.key == row.key && other.accepted == row.accepted &&
             other.initial == row.initial;
    });
    if (same == rows.end())
      rows.push_back(row);
    else
      same->kind += " " + row.kind;
  }
  std::string out = "section,key,kinds,accepted,default,meaning\n";
  for (const Row& row : rows) {
    for (std::string cell :
         {row.section, "`" + row.key + "`",
          row.kind == "rayleigh mie ozone" || row.kind == "layer disc sphere grid noise" ? "all" : row.kind,
          row.accepted, row.initial, row.meaning}) {
      for (size_t i = cell.find('"'); i != cell.npos; i = cell.find('"', i + 2)) cell.insert(i, 1, '"');
      out += '"' + cell + "\",";
    }
    out.back() = '\n';
  }
  return out;
}

}  // namespace welkin::test
