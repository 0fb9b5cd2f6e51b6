// One program for every list of effects. See composition.hpp, effect.hpp and docs/chapters/08_transmittance_lut.md.
#include "common/graph/composition.hpp"

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>

#include "common/app/camera.hpp"

namespace welkin::app {
namespace {

constexpr uint32_t kViewsInFlight = 4;  // more than any window has frames
constexpr gpu::Use kBetweenFrames{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                                  VK_PIPELINE_STAGE_2_COPY_BIT};

}  // namespace

const std::any* Board::latest(std::type_index type) {
  asked_[current_].insert(type);
  const auto offers = offers_.find(type);
  if (offers == offers_.end()) return nullptr;
  const auto after = offers->second.lower_bound(current_);
  return after == offers->second.begin() ? nullptr : &std::prev(after)->second;
}

void Board::missing(const char* what) const {
  fail("effect '{}' needs {}, which no effect before it offers", current_name_, what);
}

std::set<std::type_index> Board::withdraw(uint32_t effect) {
  std::set<std::type_index> types;
  for (auto& [type, offers] : offers_)
    if (offers.erase(effect) > 0) types.insert(type);
  asked_.erase(effect);
  return types;
}

graph::Resource Builder::picture(Board& board, const std::string& name) const {
  if (!picture_resource) picture_resource = graph.add_lasting_image(name);
  board.offer(Picture{*picture_resource});
  return *picture_resource;
}

graph::Resource Builder::displayed(Board& board) const {
  board.offer(Displayed{displayed_resource});
  return displayed_resource;
}

std::vector<Knob> knobs_of(const std::vector<Effect>& effects, int chapter) {
  std::vector<Knob> own, others;
  for (const Effect& effect : effects)
    for (Knob knob : effect.knobs) {
      if (effect.chapter == chapter) {
        own.push_back(std::move(knob));
        continue;
      }
      knob.ladder.clear();  // climbed in its own chapter
      knob.effect = effect.name;
      others.push_back(std::move(knob));
    }
  return joined(std::move(own), others);
}

Composition::Composition(const Context& context, std::vector<Effect> effects, ProbeFunction probe)
    : context_(context), probe_(std::move(probe)), graph_(context.device, context.inject) {
  const uint32_t alignment =
      std::max(static_cast<uint32_t>(context.device.limits().minUniformBufferOffsetAlignment), 1u);
  view_stride_ = (static_cast<uint32_t>(sizeof(ViewBlock)) + alignment - 1) / alignment * alignment;
  views_ = gpu::create_buffer(context.device, "view blocks", kViewsInFlight * view_stride_,
                              VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, gpu::Where::stream);
  graph_.set_view(&views_, sizeof(ViewBlock));
  for (Effect& effect : effects) states_.push_back({.effect = std::move(effect)});
  graph_.set_owner(static_cast<uint32_t>(states_.size()));
  displayed_resource_ = graph_.import("displayed", static_cast<const gpu::Image*>(nullptr), kBetweenFrames);
  rebuild();
}

// [key]
// Everything an effect was declared for: whether it is on, its knobs that are compiled in, and what it says of the
// scene.
std::string Composition::key_of(const State& state, const Wanted& wanted) const {
  if (!wanted.on) return "off";
  std::string key = "on";
  for (const Knob& knob : state.effect.knobs)
    if (knob.rebuilds) key += fmt::format(" {}", context_.settings.number(knob.name));
  if (state.effect.key) key += " " + state.effect.key(context_.scene, context_.settings);
  return key;
}
// [/key]

Wanted Composition::wanted_of(const State& state) const {
  return state.effect.wanted ? state.effect.wanted(context_.scene, context_.settings) : Wanted{};
}

bool Composition::stale() {
  if (context_.settings.values() == values_ && context_.scene == scene_) return false;
  for (const State& state : states_)
    if (key_of(state, wanted_of(state)) != state.key) return true;
  scene_ = context_.scene, values_ = context_.settings.values();  // others, but nothing was made for them
  return false;
}

void Composition::rebuild() {
  try {
    follow();
  } catch (...) {
    for (State& state : states_) state.built = false;  // half of it may be gone: next time all of it is declared
    throw;
  }
}

// [rebuild]
void Composition::follow() {
  scene_ = context_.scene, values_ = context_.settings.values();
  bool anything = false;
  std::set<std::type_index> changed;  // what is offered otherwise than before
  for (uint32_t i = 0; i < states_.size(); ++i) {
    State& state = states_[i];
    state.wanted = wanted_of(state);
    std::string key = key_of(state, state.wanted);
    const std::set<std::type_index>& asked = board_.asked_[i];
    const bool stands_on_it =
        std::any_of(asked.begin(), asked.end(), [&](std::type_index type) { return changed.contains(type); });
    if (state.built && key == state.key && !stands_on_it) continue;
    anything = true;
    state.key = std::move(key), state.built = true;
    graph_.remove(i);
    state.adjust_camera = {}, state.explain = {};
    std::set<std::type_index> withdrawn = board_.withdraw(i);
    const bool drew = withdrawn.contains(typeid(Picture)), other_picture = changed.contains(typeid(Picture));
    changed.merge(withdrawn);
    if (!state.wanted.on) continue;
    declare(i);
    for (const auto& [type, offers] : board_.offers_)
      if (offers.contains(i)) changed.insert(type);
    if (drew && !other_picture && board_.offers_[typeid(Picture)].contains(i))
      changed.erase(typeid(Picture));  // the same one, with other light in it
  }
  if (anything) connect();
}
// [/rebuild]

void Composition::declare(uint32_t index) {
  State& state = states_[index];
  board_.current_ = index, board_.current_name_ = state.effect.name;
  graph_.set_owner(index);
  Builder builder{context_, graph_, state.adjust_camera, state.explain, displayed_resource_, state.picture};
  state.effect.declare(builder, board_);
  ++state.declared;
}

// [connect]
// The last picture is drawn into the target, all others into images of the graph's own; then everything is made.
void Composition::connect() {
  if (target_ == nullptr && find<Picture>() != nullptr) return;  // set_target() follows
  const Picture* last = find<Picture>();
  if (picture_ && graph_.has(*picture_)) {
    graph_.set_output(*picture_, false);
    if (last == nullptr || last->image != *picture_) graph_.replace(*picture_, nullptr);
  }
  picture_.reset();
  if (last != nullptr) {
    picture_ = last->image;
    graph_.replace(*picture_, target_, kBetweenFrames);
    graph_.set_output(*picture_);
  }
  if (displayed_ != nullptr) graph_.replace(displayed_resource_, displayed_, kBetweenFrames);
  graph_.set_output(displayed_resource_, displayed_ != nullptr && find<Displayed>() != nullptr);
  graph_.compile(size_);
}
// [/connect]

void Composition::reload() {
  context_.device.pipelines().forget();
  for (State& state : states_) state.built = false;
  rebuild();
}

void Composition::set_target(const gpu::Image& target) {
  target_ = &target, size_ = target.size, cut_ = true;
  connect();
}

bool Composition::set_displayed(const gpu::Image& displayed) {
  displayed_ = &displayed;
  return find<Displayed>() != nullptr;
}

ViewBlock Composition::view_of(const Frame& frame, const CameraRays& camera, const glm::dvec3& position_km) const {
  const LocalFrame local = local_frame({.position_km = position_km}, context_.scene.planet.ground_radius_km);
  const glm::vec3 position(position_km);
  const bool cut = cut_ || frame.cut;
  ViewBlock view{.camera = camera,
                 .last_camera = cut ? camera : last_.camera,
                 .position_km = position,
                 .delta_s = static_cast<float>(frame.seconds),
                 .position_rest_km = position_km - glm::dvec3(position),
                 .cut = cut,
                 .east = local.east,
                 .north = local.north};
  view.last_position_km = cut ? view.position_km : last_.position_km;
  view.last_position_rest_km = cut ? view.position_rest_km : last_.position_rest_km;
  return view;
}

// [draw]
void Composition::draw(const Frame& frame) {
  CameraRays camera = frame.camera;
  glm::dvec3 position_km = frame.position_km;
  for (const State& state : states_) {
    if (state.adjust_camera) state.adjust_camera(camera, position_km);
    if (state.effect.runs_everything && state.effect.runs_everything(context_.settings)) graph_.redo();
  }
  if (cut_ || frame.cut) graph_.cut();
  const uint32_t offset = static_cast<uint32_t>(frames_++ % kViewsInFlight) * view_stride_;
  last_ = view_of(frame, camera, position_km);
  std::memcpy(static_cast<char*>(views_.mapped) + offset, &last_, sizeof last_);
  cut_ = false;
  graph_.execute({frame.commands, frame.target, camera, frame.timer, frame.index, frame.seed, frame.seconds,
                  position_km, frame.cut},
                 offset);
}
// [/draw]

void Composition::execute_once(const CameraRays& camera) {
  const gpu::CommandPool pool = gpu::create_command_pool(context_.device);
  gpu::Timer timer(context_.device);
  const gpu::Image no_target;
  gpu::run_once(context_.device, pool, [&](VkCommandBuffer commands) {
    timer.begin_frame(commands);
    draw({commands, no_target, camera, timer, 0, 0, 0.0});
  });
}

std::vector<ProbeResult> Composition::probe(std::span<const ProbeRay> rays) {
  return probe_ ? probe_(context_, rays) : Program::probe(rays);
}

uint32_t Composition::index_of(const std::string& effect) const {
  for (uint32_t i = 0; i < states_.size(); ++i)
    if (states_[i].effect.name == effect) return i;
  fail("no effect '{}' in this composition", effect);
}

std::string Composition::explain() const {
  std::string text = "effects:\n";
  for (uint32_t i = 0; i < states_.size(); ++i) {
    const State& state = states_[i];
    const bool serves = graph_.serves(i) || state.adjust_camera;
    const std::string why = !state.wanted.why.empty() ? state.wanted.why
                            : serves                  ? "what is shown needs it"
                                                      : "nothing that is shown needs it";
    text += fmt::format("  {:<22} {:<4} {}\n", state.effect.name, serves ? "on" : "off", why);
  }
  text += graph_.explain();
  for (const State& state : states_)
    if (state.explain) text += state.explain();
  return text;
}

const gpu::Image* Composition::image(const std::string& name) const {
  std::string resource = name;
  std::replace(resource.begin(), resource.end(), '_', ' ');
  return graph_.find_image(resource);
}

}  // namespace welkin::app
