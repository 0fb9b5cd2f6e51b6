// The program that serves every chapter from its list of effects: one graph, built from the effects that are wanted.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/graph/effect.hpp"
#include "shaders/interop/view.h"

namespace welkin::app {

using ProbeFunction = std::function<std::vector<ProbeResult>(const Context&, std::span<const ProbeRay>)>;

class Composition : public Program {
 public:
  // probe: radiance along rays, or none.
  Composition(const Context& context, std::vector<Effect> effects, ProbeFunction probe = {});
  Composition(const Composition&) = delete;

  void set_target(const gpu::Image& target) override;
  bool set_displayed(const gpu::Image& displayed) override;
  void draw(const Frame& frame) override;
  bool stale() override;
  void rebuild() override;  // declares anew the effects whose keys changed, and what stands on them
  void reload() override;   // everything, from shaders compiled anew
  std::vector<ProbeResult> probe(std::span<const ProbeRay> rays) override;
  std::string explain() const override;
  const gpu::Image* image(const std::string& name) const override;  // a resource's, its name with _ for blanks

  graph::Graph& graph() { return graph_; }
  // What the effects offer, for tests and probes; nullptr: nobody does.
  template <typename T>
  const T* find() {
    board_.current_ = static_cast<uint32_t>(states_.size());
    return board_.find<T>();
  }
  // Executes the graph once outside of any frame, for a camera, and waits.
  void execute_once(const CameraRays& camera = {});
  // Of the effect of this name: how often it was declared; its passes that are needed, its resources that exist.
  uint64_t declared(const std::string& effect) const { return states_.at(index_of(effect)).declared; }
  std::vector<std::string> passes_of(const std::string& effect) const { return graph_.order(index_of(effect)); }
  std::vector<std::string> resources_of(const std::string& effect) const { return graph_.resources(index_of(effect)); }
  uint64_t bytes() const { return graph_.bytes(); }  // of all resources of the graph's own

 private:
  struct State {
    Effect effect;
    Wanted wanted;
    std::string key;
    bool built = false;
    uint64_t declared = 0;
    std::function<void(CameraRays&, glm::dvec3&)> adjust_camera;
    std::function<std::string()> explain;
    std::optional<graph::Resource> picture;  // that it draws, whenever it does
  };
  uint32_t index_of(const std::string& effect) const;
  Wanted wanted_of(const State& state) const;
  std::string key_of(const State& state, const Wanted& wanted) const;
  void follow();
  void declare(uint32_t index);
  void connect();
  ViewBlock view_of(const Frame& frame, const CameraRays& camera, const glm::dvec3& position_km) const;

  const Context context_;
  ProbeFunction probe_;
  graph::Graph graph_;
  Board board_;
  std::vector<State> states_;
  Scene scene_;                 // what everything was built for
  std::vector<double> values_;  // of the knobs
  gpu::Buffer views_;           // the view blocks of the frames in flight
  uint32_t view_stride_ = 0;
  uint64_t frames_ = 0;
  ViewBlock last_{};
  bool cut_ = true;
  const gpu::Image* target_ = nullptr;
  const gpu::Image* displayed_ = nullptr;
  graph::Resource displayed_resource_ = 0;
  VkExtent2D size_{};
  std::optional<graph::Resource> picture_;  // that is drawn into the target
};

}  // namespace welkin::app
