// An effect: one thing a scene may call for, as data and three functions. A chapter's main.cpp names an ordered list of
// them.
//
// To add one, write a function that returns an Effect, and name it in a chapter's list: the composition builds it where
// it is wanted, builds it anew when its key changes, and explains it. A test shows of each that without it nothing of
// it is there.
#pragma once

#include <any>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <typeindex>
#include <vector>

#include "common/app/program.hpp"
#include "common/graph/graph.hpp"

namespace welkin::app {

struct Wanted {
  bool on = true;
  std::string why;  // "[terrain] in scene", "orders is 1": in words
};

// What effects share, by type. An effect finds what stands before it in the list and does not know who made it.
class Board {
 public:
  template <typename T>
  void offer(T value) {
    offers_[typeid(T)].insert_or_assign(current_, std::any(std::move(value)));
  }
  // The last offer before the effect that asks; nullptr: there is none.
  template <typename T>
  const T* find() {
    const std::any* found = latest(typeid(T));
    return found != nullptr ? std::any_cast<T>(found) : nullptr;
  }
  // The same of what there must be. Throws Error naming the effect and what it misses.
  template <typename T>
  const T& get(const char* what) {
    const T* found = find<T>();
    if (found == nullptr) missing(what);
    return *found;
  }

 private:
  friend class Composition;
  const std::any* latest(std::type_index type);
  [[noreturn]] void missing(const char* what) const;
  std::set<std::type_index> withdraw(uint32_t effect);  // its offers; the types

  uint32_t current_ = 0;
  std::string current_name_;
  std::map<std::type_index, std::map<uint32_t, std::any>> offers_;  // by effect
  std::map<uint32_t, std::set<std::type_index>> asked_;             // by effect: found or not
};

// What an effect declares its resources and passes with.
struct Builder {
  const Context& context;
  graph::Graph& graph;

  // The picture after this effect: rgba32f of the picture's size. The last one is what the frame is for.
  // It stays the same resource when the effect is declared anew: what is drawn after it stands on no other picture.
  graph::Resource picture(Board& board, const std::string& name) const;
  // The 8-bit picture that is shown and saved; by one effect only.
  graph::Resource displayed(Board& board) const;
  // Called before every frame: may move the camera (out of the ground). position_km: global frame.
  std::function<void(CameraRays& camera, glm::dvec3& position_km)>& adjust_camera;
  std::function<std::string()>& explain;  // what --explain adds: whole lines
  graph::Resource displayed_resource;
  std::optional<graph::Resource>& picture_resource;  // of this effect
};

// [effect]
struct Effect {
  std::string name;
  int chapter = 0;            // that teaches it: in others its knobs have no ladder and stand behind theirs
  std::vector<Knob> knobs{};  // its own; a change of one that `rebuilds` declares it anew
  // On or off, and why. None: always on; whether anybody needs it, the graph finds out.
  std::function<Wanted(const Scene&, const Settings&)> wanted{};
  // What of the scene its passes were made for, as text, beside its own knobs.
  std::function<std::string(const Scene&, const Settings&)> key{};
  // Whether every pass of every effect runs in each frame, to see what they cost; also asked of one that is off.
  std::function<bool(const Settings&)> runs_everything{};
  std::function<void(Builder&, Board&)> declare;
};
// [/effect]

// The picture so far: surfaces and layers each take the one before and offer the next.
struct Picture {
  graph::Resource image;  // rgba32f, linear
};

// That somebody draws the picture that is shown.
struct Displayed {
  graph::Resource image;  // rgba8
};

// The knobs of a chapter: its own effects' first, then the others', without ladders and folded by effect.
std::vector<Knob> knobs_of(const std::vector<Effect>& effects, int chapter);

}  // namespace welkin::app
