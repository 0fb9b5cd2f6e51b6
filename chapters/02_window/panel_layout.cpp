// The panel's sections and widgets. See panel_layout.hpp. A row is a name and a widget beside it, or below it where the
// panel is narrow; no text is wider than its place. Sizes are pixels of the window.
#include "chapters/02_window/panel_layout.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "common/measure/bench_json.hpp"

namespace welkin {
namespace {

constexpr float kMargin = 8.0f;
constexpr float kNarrow = 175.0f;    // below this a widget stands under its name
constexpr float kNameShare = 0.46f;  // of a row
constexpr float kTooltipWidth = 320.0f;
constexpr float kTall = 540.0f;  // a window from this height on has room for the times

// The text, or as much of it as fits, with two dots for the rest.
std::string fitted(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string cut = text;
  while (!cut.empty() && ImGui::CalcTextSize((cut + "..").c_str()).x > width) cut.pop_back();
  return cut + "..";
}

void tooltip(const std::string& text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(kTooltipWidth);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

bool narrow() { return ImGui::GetContentRegionAvail().x < kNarrow; }
float name_width() { return ImGui::GetContentRegionAvail().x * (narrow() ? 1.0f : kNameShare) - kMargin; }

// The name of a row; the widget that follows takes the rest of it.
void name_of_row(const std::string& name, const std::string& help) {
  const float room = name_width();
  const bool beside = !narrow();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(fitted(name, room).c_str());
  tooltip(help);
  if (beside) ImGui::SameLine(ImGui::GetCursorPosX() + room + kMargin);
  ImGui::SetNextItemWidth(-1.0f);
}

bool is_switch(const Knob& knob) { return knob.choices == std::vector<std::string>{"off", "on"}; }

// The value that a knob's widget shows or was given. Labels of widgets begin with ## and so are not drawn.
double knob_value(const Knob& knob, double before) {
  const std::string label = "##" + knob.name;
  if (is_switch(knob)) {
    bool on = before != 0.0;
    ImGui::Checkbox(label.c_str(), &on);
    return on ? 1.0 : 0.0;
  }
  if (!knob.choices.empty()) {
    double chosen = before;
    if (!ImGui::BeginCombo(label.c_str(), knob.choices.at(static_cast<size_t>(before)).c_str())) return before;
    for (size_t i = 0; i < knob.choices.size(); ++i)
      if (ImGui::Selectable(knob.choices[i].c_str(), before == static_cast<double>(i))) chosen = static_cast<double>(i);
    ImGui::EndCombo();
    return chosen;
  }
  const std::string unit = knob.unit.empty() ? "" : " " + knob.unit;
  if (knob.integer) {
    int value = static_cast<int>(before);
    ImGui::SliderInt(label.c_str(), &value, static_cast<int>(knob.minimum), static_cast<int>(knob.maximum),
                     ("%d" + unit).c_str(), ImGuiSliderFlags_AlwaysClamp);
    return value;
  }
  float value = static_cast<float>(before);
  const bool moved =
      ImGui::SliderFloat(label.c_str(), &value, static_cast<float>(knob.minimum), static_cast<float>(knob.maximum),
                         ("%.4g" + unit).c_str(), ImGuiSliderFlags_AlwaysClamp);
  return moved ? std::clamp(static_cast<double>(value), knob.minimum, knob.maximum) : before;
}

// A knob's name as it is read: without what its heading or its unit says, and without its first part where there is not
// room for all. The tooltip has the whole.
std::string shown_name(const Knob& knob, const std::string& heading, float width) {
  std::string name = knob.name;
  if (!heading.empty() && name.starts_with(heading + ".")) name.erase(0, heading.size() + 1);
  if (!knob.unit.empty() && name.ends_with("_" + knob.unit)) name.resize(name.size() - knob.unit.size() - 1);
  std::replace(name.begin(), name.end(), '_', ' ');
  if (fitted(name, width) != name) name.erase(0, name.find('.') + 1);
  return name;
}

// A knob in a row; under the heading of its effect its name goes without the effect's.
void knob_row(const Knob& knob, const std::string& heading, Settings& settings, PanelState& state) {
  const std::string help = fmt::format("{}\n--set {}={}", knob.meaning, knob.name, settings.text(knob.name));
  name_of_row(shown_name(knob, heading, name_width()), help);
  const double before = settings.number(knob.name), after = knob_value(knob, before);
  tooltip(help);
  if (after == before) return;
  settings.set_number(knob.name, after);
  state.changed.push_back(knob.name);
}

void choice_row(const char* name, const char* help, const std::string& now, std::span<const std::string> choices,
                std::string& asked) {
  name_of_row(name, help);
  if (!ImGui::BeginCombo((std::string("##") + name).c_str(), now.c_str())) return;
  for (const std::string& choice : choices)
    if (ImGui::Selectable(choice.c_str(), choice == now)) asked = choice;
  ImGui::EndCombo();
}

// The moment: hours from that of the scene's angles.
void time_rows(Scene& scene) {
  name_of_row("time", "turns the sky about the planet's axis: 15 degrees an hour (--time, in seconds)");
  if (!scene.sun.latitude_deg) return ImGui::TextDisabled("no latitude in [sun]");
  float hours = static_cast<float>(scene.time_s / 3600.0);
  if (ImGui::SliderFloat("##time", &hours, -12.0f, 12.0f, "%+.2f h")) scene.time_s = 3600.0 * hours;
}

// Of the scene rather than of a method: the scene's own values, and how a chapter with a light meter exposes it.
bool of_scene(const Chapter& chapter, const Knob& knob) {
  const auto same = [&](const Knob& own) { return own.name == knob.name; };
  return knob.name == "exposure.mode" || knob.name == "exposure.compensation" ||
         std::none_of(chapter.knobs.begin(), chapter.knobs.end(), same);
}

// What is to be seen, from where, in what light: in front; the rest of what a scene says is folded.
void scene_section(const PanelContext& shown, Settings& settings, PanelState& state) {
  if (!shown.chapter.sky || !ImGui::CollapsingHeader("Scene", ImGuiTreeNodeFlags_DefaultOpen)) return;
  std::vector<std::string> views;
  for (const View& view : shown.scene.views) views.push_back(view.name);
  choice_row("scene", "a shipped scene, loaded as --scene does; a scene file or a picture can be dropped on the window",
             shown.scene.name, shown.scenes, state.scene_asked);
  choice_row("view", "where to look from, and where to: --view", state.view_now, views, state.view_asked);
  const auto group = [](const Knob& knob) { return knob.name.substr(0, knob.name.find('.')); };
  const auto rows = [&](auto&& wanted) {
    for (const Knob& knob : settings.knobs())
      if (of_scene(shown.chapter, knob) && wanted(group(knob))) knob_row(knob, "", settings, state);
  };
  time_rows(shown.scene);
  rows([](const std::string& name) { return name == "sun"; });
  rows([](const std::string& name) { return name == "exposure"; });
  if (ImGui::TreeNodeEx("air and ground", ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_SpanAvailWidth))
    rows([](const std::string& name) { return name != "sun" && name != "exposure"; });
}

// This chapter's own knobs, open; then those of every effect it uses, folded.
void knob_sections(const PanelContext& shown, Settings& settings, PanelState& state) {
  std::vector<std::string> effects;
  for (const Knob& knob : shown.chapter.knobs)
    if (std::find(effects.begin(), effects.end(), knob.effect) == effects.end()) effects.push_back(knob.effect);
  std::stable_partition(effects.begin(), effects.end(), [](const std::string& effect) { return effect.empty(); });
  for (const std::string& effect : effects) {
    std::string title = effect.empty() ? "This chapter's knobs" : effect;
    std::replace(title.begin(), title.end(), '_', ' ');
    if (!ImGui::CollapsingHeader(title.c_str(), effect.empty() ? ImGuiTreeNodeFlags_DefaultOpen : 0)) continue;
    for (const Knob& knob : shown.chapter.knobs)
      if (knob.effect == effect && !of_scene(shown.chapter, knob)) knob_row(knob, effect, settings, state);
  }
}

void time_section(const PanelContext& shown, bool open, const PanelState& state) {
  const float total = shown.history_ms[(shown.oldest + shown.history_ms.size() - 1) % shown.history_ms.size()];
  // What follows ### is the header's name to the library, the rest is what is read.
  const std::string title = fmt::format("Time {:.{}f} ms###times", total, total < 10.0f ? 2 : total < 100.0f ? 1 : 0);
  if (!ImGui::CollapsingHeader(title.c_str(), open ? ImGuiTreeNodeFlags_DefaultOpen : 0)) return;
  const float width = ImGui::GetContentRegionAvail().x;
  for (const gpu::PassTime& pass : state.times) {
    const std::string milliseconds = fmt::format("{:.3f} ms", pass.milliseconds);
    const float number = ImGui::CalcTextSize(milliseconds.c_str()).x;
    ImGui::TextUnformatted(fitted(pass.name, width - number - 2.0f * kMargin).c_str());
    ImGui::SameLine(ImGui::GetCursorPosX() + width - number);
    ImGui::TextUnformatted(milliseconds.c_str());
  }
  ImGui::PlotLines("##history", shown.history_ms.data(), static_cast<int>(shown.history_ms.size()),
                   static_cast<int>(shown.oldest), nullptr, 0.0f,
                   1.1f * *std::max_element(shown.history_ms.begin(), shown.history_ms.end()), {width, 40.0f});
  tooltip(fmt::format("the last {} frames", shown.history_ms.size()));
  ImGui::TextWrapped("%s on %s", measure::human_bytes(shown.device.allocated_bytes()).c_str(),
                     shown.device.candidate().name.c_str());
}

std::string camera_text(const PanelContext& shown) {
  const double km = app::altitude_km(shown.pose, shown.scene.planet.ground_radius_km);
  return fmt::format("{:.4g} {}  az {:.0f}°  el {:+.0f}°", km < 1.0 ? 1000.0 * km : km, km < 1.0 ? "m" : "km",
                     shown.pose.azimuth_deg, shown.pose.elevation_deg);
}

// A button for a key, beside the one before if there is room.
void key_button(const char* label, int key, const char* help, PanelState& state) {
  const float width = ImGui::CalcTextSize(label).x + 2.0f * ImGui::GetStyle().FramePadding.x;
  const float edge = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  const float next = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + width;
  if (key != 'F' && next < edge) ImGui::SameLine();
  if (ImGui::Button(label)) state.keys.push_back(key);
  tooltip(help);
}

void keys(const PanelContext& shown, PanelState& state) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {3.0f, 2.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {3.0f, 3.0f});
  key_button(state.flying ? "F panel" : "F fly", 'F', "W A S D, Space, Ctrl, Shift and the mouse; F again ends it",
             state);
  key_button("P save", 'P', "saves a picture that restores this view", state);
  if (shown.chapter.truth) key_button("T truth", 'T', "path-traces this view: how far is the method from it?", state);
  key_button("R reload", 'R', "compiles the shaders anew", state);
  key_button("H hide", 'H', "hides the panel, and shows it again", state);
  ImGui::PopStyleVar(2);
}

// At the window's foot, as wide as the panel: were it a row of the panel, it would move the others under the mouse.
void message_box(PixelSize size, const PanelState& state) {
  if (state.message.empty()) return;
  ImGui::SetNextWindowPos({kMargin, size.height - kMargin}, ImGuiCond_Always, {0.0f, 1.0f});
  ImGui::SetNextWindowSize({state.width, 0.0f});
  if (ImGui::Begin("##message", nullptr,
                   ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing)) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextColored({1.0f, 0.82f, 0.4f, 1.0f}, "%s", state.message.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

}  // namespace

void set_style() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = style.FrameRounding = style.PopupRounding = 3.0f;
  style.FramePadding = {5.0f, 2.0f};
  style.ItemSpacing = {6.0f, 3.0f};
  style.WindowPadding = {8.0f, 6.0f};
  style.ScrollbarSize = 10.0f;
  style.Colors[ImGuiCol_WindowBg].w = 0.86f;
  style.Colors[ImGuiCol_SliderGrab].w = style.Colors[ImGuiCol_SliderGrabActive].w = 0.5f;  // the number shows through
}

void lay_out(const PanelContext& shown, PixelSize size, Settings& settings, PanelState& state) {
  // As wide as it was made, as tall as it was full in the frame before; the first time the library finds the height.
  const float most = std::max(size.width - 2.0f * kMargin, 1.0f),
              tallest = std::max(size.height - 2.0f * kMargin, 1.0f);
  if (state.width == 0.0f) state.width = std::clamp(0.25f * size.width, 250.0f, 330.0f);
  ImGui::SetNextWindowPos({kMargin, kMargin}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints({std::min(120.0f, most), 0.0f}, {most, tallest});
  ImGui::SetNextWindowSize({state.width, state.height});
  const std::string title = fmt::format("{:02} {}###panel", shown.chapter.number, shown.chapter.title);
  if (ImGui::Begin(title.c_str())) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(fitted(camera_text(shown), ImGui::GetContentRegionAvail().x).c_str());
    tooltip("the camera: height above the sphere; azimuth, from north over east; elevation");
    keys(shown, state);
    scene_section(shown, settings, state);
    knob_sections(shown, settings, state);
    time_section(shown, size.height >= kTall, state);
    if (ImGui::CollapsingHeader("About")) ImGui::TextWrapped("%s", shown.chapter.whats_new.c_str());
    ImGui::PopTextWrapPos();
    state.width = ImGui::GetWindowWidth();
    state.height = std::min(ImGui::GetCursorPosY() + ImGui::GetStyle().WindowPadding.y, tallest);
  }
  ImGui::End();
  message_box(size, state);
}

}  // namespace welkin
