// Knobs: the settings of a chapter, each declared once.
//
// A declaration carries the name, the unit, the meaning, the accepted range, the ladder from cheap to converged and the
// default. The command line (--set, --help), the panel's sliders, the sweep and the table in the docs are all made from
// it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace welkin {

struct Knob {
  std::string name;      // "view.steps": dotted, lower case, unit last where there is one ("sun.zenith_deg")
  std::string unit;      // "steps", "deg", "km"; empty for a pure number or a choice
  std::string meaning;   // one line
  double minimum = 0.0;  // accepted range, inclusive
  double maximum = 1.0;
  double initial = 0.0;              // the default
  bool integer = false;              // whole numbers only
  std::vector<std::string> choices;  // if not empty, the value is an index into these names
  std::vector<double> ladder;        // cheap → converged; empty: the sweep leaves this knob at its default
  bool rebuilds = false;             // true: a change makes new pipelines (it is compiled into the shader)
  std::string effect;                // the effect that declares it; empty: the chapter's own
};

// One list after the other: a chapter's own knobs and those of the chapters it uses.
std::vector<Knob> joined(std::vector<Knob> first, const std::vector<Knob>& more);

// The values of a chapter's knobs, by name. Only declared names exist.
class Settings {
 public:
  Settings() = default;
  explicit Settings(std::vector<Knob> knobs);

  const std::vector<Knob>& knobs() const { return knobs_; }
  const Knob& knob(std::string_view name) const;  // throws Error listing the known names

  double number(std::string_view name) const;  // value (index for a choice)
  int integer(std::string_view name) const { return static_cast<int>(number(name)); }
  bool on(std::string_view name) const { return number(name) != 0.0; }
  const std::string& choice(std::string_view name) const;  // name of the chosen entry
  bool has(std::string_view name) const;
  bool was_set(std::string_view name) const;  // set explicitly, rather than by default

  // Sets from text ("64", "midpoint", "on"); throws Error naming the knob, the text and what is accepted.
  void set(std::string_view name, std::string_view text);
  void set_number(std::string_view name, double value);  // same checks
  std::string text(std::string_view name) const;         // round-trips through set()

 private:
  size_t index(std::string_view name) const;
  std::vector<Knob> knobs_;
  std::vector<double> values_;
  std::vector<bool> explicit_;
};

// "key=value" split at the first '='; throws Error if there is none.
std::pair<std::string, std::string> split_assignment(const std::string& text);

// Strict decimal number: the whole text, finite. Returns false otherwise.
bool parse_number(std::string_view text, double& value);

}  // namespace welkin
