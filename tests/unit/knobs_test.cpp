// Knobs: strict numbers, ranges, choices, and messages that say what is accepted.
#include "common/knobs.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/error.hpp"

namespace {

using welkin::Knob;
using welkin::Settings;

Settings some() {
  return Settings({Knob{.name = "view.steps",
                        .unit = "steps",
                        .meaning = "",
                        .minimum = 1,
                        .maximum = 512,
                        .initial = 32,
                        .integer = true,
                        .choices = {},
                        .ladder = {}},
                   Knob{.name = "mie.g",
                        .unit = "",
                        .meaning = "",
                        .minimum = -0.999,
                        .maximum = 0.999,
                        .initial = 0.8,
                        .choices = {},
                        .ladder = {}},
                   Knob{.name = "rule",
                        .unit = "",
                        .meaning = "",
                        .initial = 1,
                        .choices = {"left", "midpoint", "gauss"},
                        .ladder = {}}});
}

template <typename Call>
std::string refused(const Call& call) {
  try {
    call();
  } catch (const welkin::Error& error) {
    REQUIRE(error.exit_code == welkin::Exit::usage);
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("defaults hold until set, and only then count as set", "[knobs]") {
  Settings settings = some();
  CHECK(settings.integer("view.steps") == 32);
  CHECK(settings.number("mie.g") == 0.8);
  CHECK(settings.choice("rule") == "midpoint");
  CHECK_FALSE(settings.was_set("view.steps"));
  settings.set("view.steps", "32");
  CHECK(settings.was_set("view.steps"));
  CHECK_FALSE(settings.was_set("mie.g"));
  CHECK(settings.has("rule"));
  CHECK_FALSE(settings.has("rules"));
}

TEST_CASE("a knob accepts its whole range, ends included, and nothing beyond", "[knobs]") {
  Settings settings = some();
  for (const char* text : {"1", "512", "+7", "1e2", "64.0"}) {
    INFO(text);
    CHECK(refused([&] { settings.set("view.steps", text); }) == "accepted");
  }
  CHECK(settings.integer("view.steps") == 64);
  settings.set("mie.g", "-0.999");
  CHECK(settings.number("mie.g") == -0.999);
  CHECK(refused([&] { settings.set("view.steps", "0"); }) ==
        "view.steps=0: accepted is a whole number from 1 to 512 steps");
  CHECK(refused([&] { settings.set("view.steps", "513"); }) ==
        "view.steps=513: accepted is a whole number from 1 to 512 steps");
  CHECK(refused([&] { settings.set("view.steps", "2.5"); }) ==
        "view.steps=2.5: accepted is a whole number from 1 to 512 steps");
  CHECK(refused([&] { settings.set("mie.g", "1"); }) == "mie.g=1: accepted is a number from -0.999 to 0.999");
  CHECK(settings.integer("view.steps") == 64);  // a refused value changes nothing
  CHECK(settings.number("mie.g") == -0.999);
}

TEST_CASE("what is no finite decimal number is refused", "[knobs]") {
  Settings settings = some();
  for (const char* text : {"", " ", "nan", "NaN", "-nan", "inf", "-inf", "infinity", "0x10", "1e999", "12 ", " 12",
                           "1,5", "12km", "++1", "--1", "1e", "."}) {
    INFO("'" << text << "'");
    CHECK_THAT(refused([&] { settings.set("mie.g", text); }),
               Catch::Contains("not a finite number; accepted is a number from -0.999 to 0.999"));
    double value = 7;
    CHECK_FALSE(welkin::parse_number(text, value));
  }
  for (const double value :
       {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()})
    CHECK_THAT(refused([&] { settings.set_number("mie.g", value); }), Catch::Contains("accepted is a number from"));
  CHECK_FALSE(settings.was_set("mie.g"));
}

TEST_CASE("a choice is taken by name, and numbers address it within bounds", "[knobs]") {
  Settings settings = some();
  settings.set("rule", "gauss");
  CHECK(settings.choice("rule") == "gauss");
  CHECK(settings.integer("rule") == 2);
  CHECK(refused([&] { settings.set("rule", "simpson"); }) == "rule=simpson: accepted is one of left, midpoint, gauss");
  CHECK(refused([&] { settings.set("rule", "2"); }) == "rule=2: accepted is one of left, midpoint, gauss");
  CHECK(refused([&] { settings.set_number("rule", 3); }) == "rule=3: accepted is one of left, midpoint, gauss");
  CHECK(refused([&] { settings.set_number("rule", 0.5); }) == "rule=0.5: accepted is one of left, midpoint, gauss");
  CHECK(settings.choice("rule") == "gauss");
}

TEST_CASE("an unknown knob lists the known ones", "[knobs]") {
  Settings settings = some();
  const std::string expected = "unknown knob 'view.step': this chapter has view.steps, mie.g, rule";
  CHECK(refused([&] { settings.set("view.step", "1"); }) == expected);
  CHECK(refused([&] { (void)settings.number("view.step"); }) == expected);
  CHECK(refused([&] { (void)settings.knob("view.step"); }) == expected);
  CHECK(refused([] { Settings().set("a", "1"); }) == "unknown knob 'a': this chapter has none");
}

TEST_CASE("the text of a value sets it again exactly", "[knobs]") {
  Settings settings = some();
  for (const double value : {0.1, 1.0 / 3.0, -0.9989999999999999, 1e-17, 0.0}) {
    settings.set_number("mie.g", value);
    Settings other = some();
    other.set("mie.g", settings.text("mie.g"));
    CHECK(other.number("mie.g") == value);
  }
  CHECK(settings.text("rule") == "midpoint");
  CHECK(settings.text("view.steps") == "32");
}

TEST_CASE("an assignment splits at its first equals sign", "[knobs]") {
  CHECK(welkin::split_assignment("a=b=c") == std::pair<std::string, std::string>("a", "b=c"));
  CHECK(welkin::split_assignment("a=") == std::pair<std::string, std::string>("a", ""));
  CHECK_THAT(refused([] { welkin::split_assignment("view.steps"); }), Catch::Contains("expected key=value"));
  CHECK_THAT(refused([] { welkin::split_assignment("=64"); }), Catch::Contains("expected key=value"));
}
