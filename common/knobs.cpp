// Knob values: strict parsing and range checks. See knobs.hpp.
#include "common/knobs.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/error.hpp"

namespace welkin {
namespace {

std::string accepted(const Knob& knob) {
  if (!knob.choices.empty()) return fmt::format("one of {}", fmt::join(knob.choices, ", "));
  return fmt::format("{} from {:g} to {:g}{}{}", knob.integer ? "a whole number" : "a number", knob.minimum,
                     knob.maximum, knob.unit.empty() ? "" : " ", knob.unit);
}

}  // namespace

bool parse_number(std::string_view text, double& value) {
  const char* first = text.data();
  const char* last = first + text.size();
  if (last - first > 1 && *first == '+' && first[1] != '-') ++first;
  const auto [end, error] = std::from_chars(first, last, value);
  return error == std::errc() && end == last && first != last && std::isfinite(value);
}

std::pair<std::string, std::string> split_assignment(const std::string& text) {
  const size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    fail("--set {}: expected key=value, for example --set view.steps=64", text);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Settings::Settings(std::vector<Knob> knobs) : knobs_(std::move(knobs)) {
  for (const Knob& knob : knobs_) values_.push_back(knob.initial);
  explicit_.assign(knobs_.size(), false);
}

size_t Settings::index(std::string_view name) const {
  for (size_t i = 0; i < knobs_.size(); ++i)
    if (knobs_[i].name == name) return i;
  std::vector<std::string> names;
  for (const Knob& knob : knobs_) names.push_back(knob.name);
  fail("unknown knob '{}': this chapter has {}", name,
       names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")));
}

const Knob& Settings::knob(std::string_view name) const { return knobs_[index(name)]; }
double Settings::number(std::string_view name) const { return values_[index(name)]; }
bool Settings::was_set(std::string_view name) const { return explicit_[index(name)]; }

bool Settings::has(std::string_view name) const {
  return std::any_of(knobs_.begin(), knobs_.end(), [&](const Knob& knob) { return knob.name == name; });
}

const std::string& Settings::choice(std::string_view name) const {
  const size_t i = index(name);
  return knobs_[i].choices.at(static_cast<size_t>(values_[i]));
}

void Settings::set(std::string_view name, std::string_view text) {
  const Knob& knob = knobs_[index(name)];
  if (!knob.choices.empty()) {
    const auto found = std::find(knob.choices.begin(), knob.choices.end(), text);
    if (found == knob.choices.end()) fail("{}={}: accepted is {}", name, text, accepted(knob));
    set_number(name, static_cast<double>(found - knob.choices.begin()));
    return;
  }
  double value = 0.0;
  if (!parse_number(text, value)) fail("{}={}: not a finite number; accepted is {}", name, text, accepted(knob));
  set_number(name, value);
}

void Settings::set_number(std::string_view name, double value) {
  const size_t i = index(name);
  const Knob& knob = knobs_[i];
  const double maximum = knob.choices.empty() ? knob.maximum : static_cast<double>(knob.choices.size()) - 1.0;
  const double minimum = knob.choices.empty() ? knob.minimum : 0.0;
  const bool whole = knob.integer || !knob.choices.empty();
  if (!(value >= minimum && value <= maximum) || (whole && value != std::floor(value)))
    fail("{}={}: accepted is {}", name, value, accepted(knob));
  values_[i] = value;
  explicit_[i] = true;
}

std::vector<Knob> joined(std::vector<Knob> first, const std::vector<Knob>& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

std::string Settings::text(std::string_view name) const {
  const size_t i = index(name);
  if (!knobs_[i].choices.empty()) return choice(name);
  return fmt::format("{}", values_[i]);
}

}  // namespace welkin
