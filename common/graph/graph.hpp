// The frame graph: passes bind resources to the names their shaders give them; the graph makes the resources, orders
// the passes, leaves out those whose results nobody needs, skips those whose inputs have not changed, derives
// descriptor sets and barriers, and times each.
//
// A pass is one or more steps (dispatches, draws, copies) with the barriers between them. A resource is written by one
// pass only; what that pass wrote before, its later steps may read (iteration). Contents, layouts and accesses are kept
// from frame to frame (one queue, submissions in order): a table computed once is made visible once.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/gpu/commands.hpp"
#include "common/gpu/named_pipeline.hpp"
#include "common/gpu/timer.hpp"
#include "common/graph/frame.hpp"

namespace welkin::graph {

using Resource = uint32_t;

struct ImageInfo {
  VkExtent2D size{};  // 0 x 0: the picture's
  VkFormat format = VK_FORMAT_R32G32B32A32_SFLOAT;
  uint32_t depth = 0, mips = 1, layers = 1;  // depth above 0: 3-D
  VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
};

struct BufferInfo {
  VkDeviceSize bytes = 0;
  VkBufferUsageFlags usage =
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  gpu::Where where = gpu::Where::device;
};

struct Sampling {
  gpu::Border u = gpu::Border::clamp, v = gpu::Border::clamp;
  VkFilter filter = VK_FILTER_LINEAR;
  gpu::Border w = gpu::Border::clamp;
};

inline constexpr int kAllMips = -1;

// A resource under the name the shader has for it. mip: of an image read or written mip by mip. last_frame: the older
// image of a history.
struct Binding {
  std::string name;
  Resource resource;
  Sampling sampling{};
  int mip = kAllMips;
  bool last_frame = false;
};

// A step touches a resource this way, without a binding: a copy, an attachment.
struct Access {
  Resource resource;
  gpu::Use use;
  int mip = kAllMips;
  bool last_frame = false;
};

class Graph;

// What a step records with; pipeline and descriptor set are bound already.
struct Recorder {
  const app::Frame& frame;
  const Graph& graph;
  const gpu::NamedPipeline* pipeline;  // nullptr: a step without shader

  template <typename Push>
  const Recorder& push(const Push& values) const {
    static_assert(sizeof(Push) <= 128, "push constants: 128 bytes is what every device has");
    push_bytes(&values, sizeof values);
    return *this;
  }
  void dispatch(uint32_t groups_x, uint32_t groups_y = 1, uint32_t groups_z = 1) const;
  void dispatch_over(VkExtent2D size) const;  // workgroups of 8x8

 private:
  void push_bytes(const void* values, uint32_t bytes) const;
};

// [step]
struct Step {
  std::string shader{};  // none: `record` copies or updates
  gpu::Constants constants{};
  std::vector<Binding> bindings{};
  std::vector<Access> accesses{};
  std::function<void(const Recorder&)> record;
  std::function<bool(const Recorder&)> when{};  // asked each frame; none: always
};
// [/step]

// [pass]
struct Pass {
  std::string name;  // in the table of times
  std::vector<Step> steps;
  // Asked each frame: has something changed that is not a resource (the camera, a pushed number)? Without it the pass
  // runs only when one of the resources it reads has been written.
  std::function<bool(const app::Frame&)> changed{};
  // Asked when it would run: does anybody need it in this frame? If not, it runs in the first frame that does.
  std::function<bool(const app::Frame&)> needed{};
  bool times_itself = false;  // its steps stamp passes of their own
};
// [/pass]

// A barrier that was derived, for people.
struct Barrier {
  std::string pass, resource;
  gpu::Use before, after;
};

class Graph {
 public:
  Graph() = default;  // for order and barriers alone: no step may have a shader
  // inject "missing-barrier": the fault the synchronization test plants, no barrier before a read.
  Graph(const gpu::Device& device, gpu::Pipelines& pipelines, const std::string& inject = {});

  // What is added from now on belongs to this effect; remove() takes all of it out again. No frame is in flight.
  void set_owner(uint32_t owner) { owner_ = owner; }
  void remove(uint32_t owner);

  Resource add_image(std::string name, ImageInfo info = {});
  Resource add_lasting_image(std::string name, ImageInfo info = {});  // of no effect: remove() leaves it
  Resource add_buffer(std::string name, BufferInfo info);
  // Two images that take turns: this frame's is written, last frame's is read with Binding::last_frame.
  Resource add_history(std::string name, ImageInfo info = {});
  // Filled before; no pass writes it, any may read it in layout GENERAL.
  Resource add_filled(std::string name, gpu::Image&& image);
  Resource add_filled(std::string name, gpu::Buffer&& buffer);
  // The same, made by `fill` when a pass that is needed reads it, outside of frames, and freed when none does any more.
  Resource add_filled(std::string name, ImageInfo info, std::function<gpu::Image()> fill);
  // Lives elsewhere. between_frames: who else touches it; with layout UNDEFINED its old content is not needed.
  Resource import(std::string name, const gpu::Image* image, gpu::Use between_frames = {});
  Resource import(std::string name, const gpu::Buffer* buffer);
  // Another image is taken for this resource, or (nullptr) one of the graph's own. compile() follows.
  void replace(Resource resource, const gpu::Image* image, gpu::Use between_frames = {});

  void add(Pass pass);
  void set_output(Resource resource, bool output = true);  // what the frame is for

  // Reflects, orders, culls; makes images, pipelines and descriptor sets of what is needed. No frame is in flight.
  // Throws Error on a cycle, a second writer, a pass that reads what it has not written, an output or a read resource
  // that no pass writes, a name the shader does not have or does not get, and a resource that does not fit it.
  void compile(VkExtent2D picture_size = {});

  // Records the passes that have to run. Allocates nothing. view_offset: of this frame's block in the view buffer.
  void execute(const app::Frame& frame, uint32_t view_offset = 0);
  void set_view(const gpu::Buffer* view, uint32_t bytes) { view_ = view, view_bytes_ = bytes; }

  void redo();  // every pass runs in the next frame
  // True if the other image of a history is the previous frame's: written in it, of the same size, no cut since.
  bool valid(Resource history) const;
  void cut();  // no history is valid in the next frame

  bool has(Resource resource) const { return held_.contains(resource); }
  const gpu::Image& image(Resource resource) const;
  // Another number whenever the image is another one: a driver may give a new image an old one's handle.
  uint64_t version(Resource resource) const { return held_.at(resource).version; }
  const gpu::Buffer& buffer(Resource resource) const;
  const gpu::Image* find_image(const std::string& name) const;  // that exists now; nullptr: none

  // Passes in order, how often each ran, which were left out, and the barriers of a first frame, in words.
  std::string explain() const;
  // The barriers of frame `frame` if every pass runs in each. Needs no device.
  std::vector<Barrier> barriers(int frame = 0) const;
  std::vector<std::string> order() const;
  std::vector<std::string> order(uint32_t owner) const;      // of one effect's
  std::vector<std::string> resources(uint32_t owner) const;  // of one effect's that exist
  uint64_t bytes() const;                                    // of all that are its own
  uint64_t runs(const std::string& pass) const;              // 0 for a pass there is not
  bool has_pass(uint32_t owner) const;  // whether this effect has a pass, or an image filled on demand, that is needed

 private:
  struct State {                            // what happened to a mip last
    gpu::Use written;                       // the last write
    VkPipelineStageFlags2 read_stages = 0;  // who has read it since
    std::array<gpu::Use, 4> visible{};      // and for whom that write has been made visible; more readers wait again
    uint32_t readers = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  };
  enum class Kind { image, history, buffer, filled, imported };
  struct Held {
    std::string name;
    uint32_t owner = 0;
    Kind kind = Kind::image;
    bool is_buffer = false;
    ImageInfo info;
    BufferInfo buffer_info;
    std::array<gpu::Image, 2> own_images;  // [1]: of a history
    gpu::Buffer own_buffer;
    std::function<gpu::Image()> fill;   // makes a filled image
    const gpu::Image* image = nullptr;  // imported
    const gpu::Buffer* buffer = nullptr;
    gpu::Use between_frames;
    bool output = false;
    bool written_now = false;  // in the frame being recorded
    bool last_valid = false;   // a history's: its other image is the previous frame's
    bool outdated = false;     // its content is gone or no longer right
    uint64_t version = 0;
    uint64_t written_frame = 0;  // of its last write, counted from 1
    std::array<std::vector<State>, 2> states;
  };
  struct Touch {
    Held* held;
    gpu::Use use;
    uint32_t first_mip, mips;
    bool last_frame;
  };
  struct Made {  // of a step
    std::shared_ptr<const gpu::NamedPipeline> pipeline;
    std::array<gpu::DescriptorSet, 2> sets;  // by parity of the frame; [1] only with a history
    bool alternates = false;
    std::vector<Touch> touches;
  };
  struct Counted {
    Pass pass;
    uint32_t owner = 0;
    bool used = false;
    bool fresh = true;  // it has never run for what is there now
    uint64_t runs = 0;
    std::vector<Made> steps;
  };

  Resource hold(Held held);
  static void start_states(Held& held);
  Held& held_of(Resource resource) { return held_.at(resource); }
  uint32_t parity() const { return static_cast<uint32_t>(frames_ & 1); }
  static const gpu::Image* image_of(const Held& held, bool second);
  static uint64_t bytes_of(const Held& held);
  void reflect(Counted& counted);
  void check_accesses(const Counted& counted);
  Counted* writer_of(const Held& held);
  void visit(Counted& counted, std::map<const Counted*, int>& mark);
  void cull();
  void make_all(VkExtent2D picture_size);
  void allocate(Held& held, VkExtent2D picture_size);
  void make(Counted& counted);
  void write_set(const Step& step, Made& made, uint32_t parity);
  void check_fit(const Step& step, const gpu::ShaderBinding& wanted, const Held& held) const;
  VkSampler sampler(const Sampling& sampling);
  std::vector<State>& states_of(Held& held, bool last_frame) {
    return held.states[held.kind == Kind::history && (last_frame != (parity() == 1)) ? 1 : 0];
  }
  // The dependency this use needs, and the state after it. False: none.
  static bool depend(State& state, const gpu::Use& use, gpu::Use& before);
  void touched_between_frames(Held& held);
  bool must_run(const Counted& counted, const app::Frame& frame) const;
  void record_barriers(const app::Frame& frame, const Made& made);
  void record(const app::Frame& frame, uint32_t view_offset, Counted& counted);

  const gpu::Device* device_ = nullptr;
  gpu::Pipelines* pipelines_ = nullptr;
  bool drops_barriers_ = false;
  uint32_t owner_ = 0;
  uint64_t frames_ = 0, versions_ = 0;
  bool cut_ = false;
  static constexpr uint32_t kNobody = ~0u;
  Resource next_ = 0;
  const gpu::Buffer* view_ = nullptr;
  uint32_t view_bytes_ = 0;
  std::map<Resource, Held> held_;
  std::vector<std::unique_ptr<Counted>> passes_;
  std::vector<Counted*> order_;                // of the passes that are needed
  std::map<std::string, uint64_t> past_runs_;  // of passes that were taken out
  std::map<std::array<int, 4>, gpu::Sampler> samplers_;
  std::vector<VkImageMemoryBarrier2> image_barriers_;
  std::vector<VkBufferMemoryBarrier2> buffer_barriers_;
};

// "compute shader, storage write, GENERAL": a use in words.
std::string describe(const gpu::Use& use);

}  // namespace welkin::graph
