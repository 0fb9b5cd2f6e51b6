// Scene values as knobs. See scene_knobs.hpp.
#include "common/scene/scene_knobs.hpp"

#include "common/scene/fields.hpp"

namespace welkin {
namespace {

// Collects the knobs of the fields that pass, or writes those that were set into them.
struct KnobVisitor : Visitor {
  std::vector<Knob> knobs;
  const Settings* settings = nullptr;

  template <typename T>
  void operator()(const char*, T& value, const Range& range, const char* meaning, const More& more = {}) {
    const bool set = settings != nullptr && *more.knob && settings->has(more.knob) && settings->was_set(more.knob);
    Knob knob{.name = more.knob, .unit = range.unit, .meaning = meaning};
    if constexpr (std::is_same_v<T, double>) {
      if (set) value = range.turns ? turned(settings->number(more.knob)) : settings->number(more.knob);
      knob.initial = value, knob.minimum = range.turns ? 0.0 : range.minimum, knob.maximum = range.maximum;
    } else if constexpr (std::is_same_v<T, glm::dvec3>) {
      if (set) value = glm::dvec3(settings->number(more.knob));
      knob.initial = value.x, knob.minimum = range.minimum, knob.maximum = range.maximum;
    } else {
      Range choices = range;
      if (choices.choices.empty()) choices.choices = {"off", "on"};
      if (set) choose(choices, settings->integer(more.knob), value);
      knob.initial = choice_of(choices, value), knob.choices = {choices.choices.begin(), choices.choices.end()};
      knob.rebuilds = true;  // what is chosen is compiled into shaders
    }
    if (*more.knob) knobs.push_back(std::move(knob));
  }
};

void visit(KnobVisitor& visitor, Scene& scene) {
  sections(scene, [&](const char*, auto& member) {
    each_of(member, [&](auto& section) { fields(visitor, section, scene); });
  });
}

}  // namespace

std::vector<Knob> scene_knobs(const Scene& scene, bool metered) {
  KnobVisitor visitor;
  Scene copy = scene;
  visit(visitor, copy);
  if (!metered)
    std::erase_if(visitor.knobs, [](const Knob& knob) {
      return knob.name == "exposure.mode" || knob.name == "exposure.compensation";
    });
  return visitor.knobs;
}

void apply_scene_knobs(const Settings& settings, Scene& scene) {
  KnobVisitor visitor{.settings = &settings};
  if (settings.has("exposure.ev") && settings.was_set("exposure.ev"))
    scene.post.manual = true;  // or as exposure.mode says
  visit(visitor, scene);
}

}  // namespace welkin
