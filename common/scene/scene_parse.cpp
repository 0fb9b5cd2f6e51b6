// Reading a scene: strict TOML. Every message is one line with file:line:column (both counted from 1) and what is
// accepted. An absent key leaves the default. What a file may say is the table of fields.hpp.
#include <cmath>

#include "common/scene/fields.hpp"
#include "common/scene/scene_knobs.hpp"
#include "common/scene/strict_toml.hpp"

namespace welkin {
namespace {

using namespace strict_toml;

template <typename T>
constexpr bool is_triple = std::is_same_v<T, glm::dvec3> || std::is_same_v<T, std::optional<glm::dvec3>>;

constexpr int kVersion = 1;
// A dotted key nests one table per dot, and tables are destroyed recursively: bounded lines bound the recursion.
constexpr size_t kLongestLine = 1024, kLongestName = 64, kLongestValue = 200;

// One section of the file, read by the rows of the table as they pass.
class Reader : public Visitor {
 public:
  static constexpr bool reading = true;

  Reader(std::string name, const toml::table& table, const std::string& file)
      : Visitor{name}, name_(std::move(name)), table_(table), file_(file) {}

  template <typename T>
  void operator()(const char* key, T& value, const Range& range, const char*, const More& more = {}) {
    known_.push_back(key);
    const toml::node* node = table_.get(key);
    if (!node && more.required && missing_.empty()) {
      missing_ = fmt::format("no {} in {}", key, title), needed_ = accepted(value, range);
      if (!range.choices.empty()) fail_at(file_, table_.source(), missing_, needed_);  // what else is known follows
    }
    if (!node) return;
    must(!given(more.besides), key, fmt::format("{} given beside {}", full_name(key), more.besides),
         "accepted is one of the two");
    read(key, *node, value, range);
  }
  bool given(const char* key) const { return table_.contains(key); }
  void must(bool good, const char* key, const std::string& what, const std::string& accepted) const {
    const toml::node* node = table_.get(key);
    if (!good && missing_.empty()) fail_at(file_, node ? node->source() : table_.source(), what, accepted);
  }
  // The key furthest up in the file that no row of the table has (`more` keys are known, too); or a missing one.
  void finish(const char* what, const std::vector<const char*>& more = {}) {
    known_.insert(known_.end(), more.begin(), more.end());
    for (const toml::key* key : keys_of(table_))
      if (std::find(known_.begin(), known_.end(), key->str()) == known_.end())
        fail_at(file_, key->source(),
                fmt::format("unknown {} '{}'{}{}", what, one_line(key->str(), 60), title.empty() ? "" : " in ", title),
                fmt::format("known are {}", fmt::join(known_, ", ")));
    if (!missing_.empty()) fail_at(file_, table_.source(), missing_, needed_);
  }

 private:
  std::string full_name(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{}.{}", name_, key);
  }

  template <typename T>
  static std::string accepted(const T&, const Range& range) {
    const std::string numbers = text_of(range), name = fmt::format("1 to {} letters, digits, _, - or .", range.maximum);
    if (!range.choices.empty()) return fmt::format("accepted is one of \"{}\"", fmt::join(range.choices, "\", \""));
    if (*range.text) return fmt::format("accepted is {}", range.text);
    if constexpr (std::is_same_v<T, std::vector<double>>)
      return "accepted are up to 64, [a, b, ...], numbers from " + numbers;
    if constexpr (std::is_same_v<T, std::vector<std::string>>)
      return "accepted are up to 64, [a, b, ...], names of " + name;
    if constexpr (std::is_same_v<T, bool>) return "accepted is true or false";
    if constexpr (std::is_same_v<T, std::string>) return "accepted is quoted text of " + name;
    if constexpr (std::is_same_v<T, int>) return "accepted is a whole number from " + numbers;
    return "accepted is a number from " + numbers + (is_triple<T> ? " or three of them, [r, g, b]" : "");
  }
  template <typename T>
  [[noreturn]] void refuse(std::string_view key, const toml::node& node, const T& value, const Range& range) const {
    fail_at(file_, node.source(), fmt::format("{} = {}", full_name(key), describe(node)), accepted(value, range));
  }

  template <typename T>
  void read(const std::string& key, const toml::node& node, std::optional<T>& value, const Range& range) const {
    read(key, node, value.emplace(), range);
  }
  template <typename T>
  void read(const std::string& key, const toml::node& node, std::vector<T>& value, const Range& range) const {
    const toml::array* array = node.as_array();
    if (!array || array->empty() || array->size() > kMostViews) refuse(key, node, value, range);
    for (const toml::node& one : *array) read(key, one, value.emplace_back(), range);
  }
  template <typename T>
  void read(const std::string& key, const toml::node& node, T& value, const Range& range) const {
    if (!range.choices.empty()) {
      const auto same = [&](const char* choice) { return node.is_string() && node.as_string()->get() == choice; };
      const auto found = std::find_if(range.choices.begin(), range.choices.end(), same);
      if (found == range.choices.end()) refuse(key, node, value, range);
      choose(range, int(found - range.choices.begin()), value);
    } else if constexpr (std::is_same_v<T, bool>) {
      if (!node.is_boolean()) refuse(key, node, value, range);
      value = node.as_boolean()->get();
    } else if constexpr (std::is_same_v<T, std::string>) {
      value = node.is_string() ? node.as_string()->get() : "";
      const bool good = *range.text ? one_line(value, value.size()) == value : plain_name(value);
      if (!good || value.empty() || (range.maximum > 0 && value.size() > range.maximum))
        refuse(key, node, value, range);
    } else if constexpr (std::is_same_v<T, glm::dvec3>) {
      const toml::array* array = node.as_array();
      must(!array || array->size() == 3, key.c_str(),
           fmt::format("{} has {} numbers", full_name(key), array ? array->size() : 0), accepted(value, range));
      for (int i = 0; i < 3; ++i)
        value[i] = array ? number(fmt::format("{}[{}]", key, i), *array->get(size_t(i)), value, range)
                         : number(key, node, value, range);
    } else if constexpr (!std::is_enum_v<T>) {
      if (std::is_same_v<T, int> && !node.is_integer()) refuse(key, node, value, range);
      value = static_cast<T>(number(key, node, value, range));
    }
  }
  template <typename T>
  double number(const std::string& key, const toml::node& node, const T& value, const Range& range) const {
    const auto* whole = node.as_integer();
    const double number = whole              ? static_cast<double>(whole->get())
                          : node.is_number() ? node.as_floating_point()->get()
                                             : NAN;
    if (!(number >= range.minimum && number <= range.maximum)) refuse(key, node, value, range);
    return range.turns ? turned(number) : number + 0.0;  // -0 becomes 0
  }

  const std::string name_;
  const toml::table& table_;
  const std::string& file_;
  std::vector<const char*> known_;
  std::string missing_, needed_;
};

// The tables of the file that are sections of this name, in their order.
std::vector<const toml::table*> tables_of(const toml::table& root, const char* name, bool many,
                                          const std::string& file) {
  std::vector<const toml::table*> tables;
  const toml::node* node = root.get(name);
  const auto add = [&](const toml::node& one, bool right) {
    if (!right)
      fail_at(file, one.source(), fmt::format("{} = {}", name, describe(one)),
              many ? fmt::format("accepted is [[{}]], a section for each", name)
                   : fmt::format("accepted is a section, [{}]", name));
    tables.push_back(one.as_table());
  };
  if (node && many && node->is_array())
    for (const toml::node& one : *node->as_array()) add(one, one.is_table());
  else if (node)
    add(*node, !many && node->is_table());
  return tables;
}

// The section that is read next: a member, or one more of it.
template <typename T>
auto& begin_section(T& member) {
  if constexpr (is_many<T>)
    return member.emplace_back();
  else if constexpr (requires { member.emplace(); })
    return member.emplace();
  else
    return member;
}

// Knobs of the scene are its fields, checked here; those of chapters are theirs to check, so only their spelling is.
void read_settings(const toml::table& section, const std::string& file, Scene& scene) {
  const std::vector<const toml::key*> keys = keys_of(section);
  if (keys.size() > kMostSettings)
    fail_at(file, keys[kMostSettings]->source(), fmt::format("{} settings", keys.size()),
            fmt::format("accepted are up to {}", kMostSettings));
  Settings knobs(scene_knobs(scene));
  for (const toml::key* key : keys) {
    const std::string name(key->str()), shown = one_line(name, 60);
    const toml::node& node = *section.get(name);
    if (node.is_table())
      fail_at(file, key->source(), fmt::format("settings.{} is a table", shown),
              "a knob's name is quoted, for example \"view.steps\" = 64");
    if (name.empty() || name.size() > kLongestName ||
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.") != std::string::npos)
      fail_at(file, key->source(), fmt::format("knob name '{}'", shown),
              fmt::format("accepted is 1 to {} lower-case letters, digits, _ and .", kLongestName));
    std::string value;
    if (node.is_string()) value = node.as_string()->get();
    if (node.is_boolean()) value = node.as_boolean()->get() ? "on" : "off";
    if (node.is_number()) value = describe(node);
    const bool finite = !node.is_floating_point() || std::isfinite(node.as_floating_point()->get());
    if (!finite || value.empty() || value.size() > kLongestValue || one_line(value) != value)
      fail_at(
          file, node.source(), fmt::format("settings.{} = {}", shown, describe(node)),
          fmt::format("accepted is a finite number, true, false or quoted text of 1 to {} characters", kLongestValue));
    if (!knobs.has(name)) {
      scene.settings.emplace_back(name, value);
      continue;
    }
    try {
      knobs.set(name, value);
    } catch (const Error& error) {
      fail_at(file, node.source(), "settings", error.what());
    }
  }
  apply_scene_knobs(knobs, scene);
}

void check_lines(const std::string& text, const std::string& file) {
  size_t start = 0;
  for (toml::source_index line = 1; start <= text.size(); ++line) {
    const size_t end = std::min(text.find('\n', start), text.size());
    if (end - start > kLongestLine)
      fail_at(file, {{line, static_cast<toml::source_index>(kLongestLine + 1)}, {}, {}}, "line too long",
              fmt::format("accepted are lines of up to {} bytes", kLongestLine));
    start = end + 1;
  }
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& file) {
  check_lines(text, file);
  const toml::table table = parse_table(text, file);
  Reader root("", table, file);
  const toml::node* version = table.get("version");
  root.must(version, "", "no version", fmt::format("a scene says version = {}", kVersion));
  root.must(version->is_integer() && version->as_integer()->get() == kVersion, "version",
            fmt::format("version {}", describe(*version)), fmt::format("this build knows version {}", kVersion));
  Scene scene;
  fields(root, scene, scene);
  std::vector<const char*> known{"version"};
  sections(scene, [&](const char* name, auto&) { known.push_back(name); });
  known.push_back("settings");
  root.finish("section or key", known);
  sections(scene, [&](const char* name, auto& member) {
    for (const toml::table* section : tables_of(table, name, is_many<std::decay_t<decltype(member)>>, file)) {
      Reader reader(name, *section, file);
      fields(reader, begin_section(member), scene);
      reader.finish("key");
    }
  });
  const auto counted = [](const View& view) { return view.name != kRestoredView; };
  root.must(!scene.views.empty(), "", "no views", "a scene has at least one [[view]]");
  root.must(size_t(std::count_if(scene.views.begin(), scene.views.end(), counted)) <= kMostViews, "view",
            "too many views", fmt::format("accepted are up to {}", kMostViews));
  root.must(scene.time_s == 0.0 || scene.sun.latitude_deg, "time_s", "time_s in a scene without a latitude",
            kNeedsLatitude);
  for (const toml::table* settings : tables_of(table, "settings", false, file)) read_settings(*settings, file, scene);
  return scene;
}

}  // namespace welkin
