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
    Knob knob{.name = more.knob,
              .unit = range.unit,
              .meaning = meaning,
              .minimum = more.azimuth ? 0.0 : range.minimum,
              .maximum = range.maximum,
              .initial = double(choice_of(range, value)),
              .choices = {range.choices.begin(), range.choices.end()}};
    if constexpr (std::is_same_v<T, double>) {
      if (set) value = more.azimuth ? turned(settings->number(more.knob)) : settings->number(more.knob);
      knob.initial = value;
    } else if constexpr (std::is_same_v<T, glm::dvec3>) {
      if (set) value = glm::dvec3(settings->number(more.knob));
      knob.initial = value.x;
    } else {
      Range off_on = range;
      if (range.choices.empty())
        off_on.choices = {"off", "on"}, knob.choices = {"off", "on"}, knob.initial = choice_of(off_on, value);
      if (set) choose(off_on, settings->integer(more.knob), value);
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

std::vector<Knob> scene_knobs(const Scene& scene) {
  KnobVisitor visitor;
  Scene copy = scene;
  visit(visitor, copy);
  return visitor.knobs;
}

void apply_scene_knobs(const Settings& settings, Scene& scene) {
  KnobVisitor visitor{.settings = &settings};
  if (settings.has("exposure.ev") && settings.was_set("exposure.ev"))
    scene.post.manual = true;  // or as exposure.mode says
  visit(visitor, scene);
}

}  // namespace welkin
