// The frame graph: passes say what they read and write; it orders them, leaves out those whose results nobody needs,
// skips those whose inputs have not changed, derives the barriers between the rest, and times each.
//
// A resource is written by one pass only, and no pass reads what it writes: an image that is to be changed is two
// images. Layouts and accesses are kept from frame to frame (one queue, submissions in order), so that a table computed
// once is made visible once, and a frame that reads it again waits for nothing.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "common/app/chapter.hpp"

namespace welkin::graph {

using Resource = uint32_t;

// A pass touches a resource this way. With a write bit in use.access the pass replaces the whole content.
struct Access {
  Resource resource;
  gpu::Use use;
};

struct Pass {
  std::string name;  // in the table of times
  std::vector<Access> accesses;
  std::function<void(const app::Frame&)> record;
  // Asked each frame: has something changed that is not a resource (a knob, the camera, the scene)? Without it the pass
  // runs only when one of the resources it reads has been written.
  std::function<bool(const app::Frame&)> changed;
  // Asked when it would run: does nobody need it in this frame? It then runs in the first frame that does.
  std::function<bool(const app::Frame&)> idle;
};

// A barrier that was derived, for people.
struct Barrier {
  std::string pass, resource;
  gpu::Use before, after;
};

class Graph {
 public:
  // `inject` "graph-barrier": the fault the synchronization test plants, no barrier before a read.
  explicit Graph(const std::string& inject = {}) : drops_barriers_(inject == "graph-barrier") {}

  // Resources live elsewhere and must keep their address. `outside` says who else touches an image between frames, and
  // with layout UNDEFINED that its old content is not needed: the picture that is displayed and read back.
  Resource add(std::string name, const gpu::Image& image, gpu::Use outside = {});
  Resource add(std::string name, const gpu::Buffer& buffer);
  // The image at this address was made anew, or another image takes its place: its pass runs in the next frame. No
  // frame is in flight.
  void replace(Resource resource, const gpu::Image& image);

  void add(Pass pass);
  void want(Resource resource);  // what the frame is for

  // Orders and culls; throws Error on a cycle, a second writer, a pass that reads what it writes, and on a wanted or
  // read resource that no pass writes.
  void compile();
  void redo() { all_again_ = true; }  // every pass runs in the next frame
  void redo(Resource resource) {
    resources_[resource].outdated = true;
  }  // the pass that writes it does: it has another pipeline

  // Records the passes that have to run, with barriers and timestamps. Allocates nothing.
  void execute(const app::Frame& frame);

  // Passes in order, how often each ran, which were left out, and the barriers of a first frame, in words.
  std::string explain() const;
  // The barriers of frame `frame` if every pass runs in each. Needs no device.
  std::vector<Barrier> barriers(int frame = 0) const;
  std::vector<std::string> order() const;
  uint64_t runs(const std::string& pass) const;

 private:
  struct State {                            // what happened to a resource last
    gpu::Use written;                       // the last write
    VkPipelineStageFlags2 read_stages = 0;  // who has read it since
    std::array<gpu::Use, 4> visible{};      // and for whom that write has been made visible; more readers wait again
    uint32_t readers = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  };
  struct Held {
    std::string name;
    const gpu::Image* image = nullptr;
    const gpu::Buffer* buffer = nullptr;
    gpu::Use outside;
    bool wanted = false;
    bool written_now = false;  // in the frame being recorded
    bool outdated = false;     // its content is gone or no longer right
    State state;
  };
  struct Counted {
    Pass pass;
    bool needed = false;
    uint64_t runs = 0;
  };

  Resource hold(Held held);
  gpu::Use use_of(const Access& access) const;
  size_t writer_of(Resource resource) const;
  void visit(size_t pass, std::vector<int>& mark);
  // The dependency this use needs, and the state after it. False: none.
  static bool depend(State& state, const gpu::Use& use, gpu::Use& before);
  static void touched_outside(Held& held);
  bool must_run(const Counted& counted, const app::Frame& frame) const;
  void record_barriers(const app::Frame& frame, const Pass& pass);

  bool drops_barriers_;
  bool all_again_ = true;
  uint64_t frames_ = 0;
  std::vector<Held> resources_;
  std::vector<Counted> passes_;
  std::vector<size_t> order_;  // of the passes that are needed
  std::vector<VkImageMemoryBarrier2> image_barriers_;
  std::vector<VkBufferMemoryBarrier2> buffer_barriers_;
};

// "compute shader, storage write, GENERAL": a use in words.
std::string describe(const gpu::Use& use);

}  // namespace welkin::graph
