// Pipelines whose bindings and constants have names: those their shader gives them. Used by the frame graph.
#pragma once

#include <future>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "common/gpu/pipeline.hpp"
#include "common/gpu/spirv.hpp"

namespace welkin::gpu {

// The value of a specialization constant. `shared` constants are handed to every shader that might have them (what the
// air is made of); others must be there.
struct Constant {
  std::string name;
  std::variant<bool, int, float> value;
  bool shared = false;
  bool operator==(const Constant&) const = default;
};
using Constants = std::vector<Constant>;

Constants joined(Constants first, const Constants& more);

struct NamedPipeline {
  std::string shader;
  std::vector<ShaderBinding> bindings;
  uint32_t push_constant_bytes = 0;
  SetLayout set_layout;
  PipelineLayout layout;
  PipelineHandle handle;
};

// The uniform block of this name is bound with an offset that changes from frame to frame.
inline constexpr const char* kViewBlock = "View";

// Every pipeline that was asked for, by shader and the constants it has: asked for again, it is the same one. A device
// has one of these.
class Pipelines {
 public:
  // kept: above this number those that nobody holds may go.
  explicit Pipelines(const Device& device, size_t kept = 128) : device_(device), kept_(kept) {}
  // shader: as in load_spirv. Throws Error on a constant the shader does not have or that has another type there,
  // saying which it has.
  std::shared_ptr<const NamedPipeline> get(const std::string& shader, const Constants& constants);
  // Begins to make one on another thread, if it is not there: several that are begun before the first is asked for are
  // made beside each other.
  using Making = std::shared_future<std::shared_ptr<const NamedPipeline>>;
  const Making& begin(const std::string& shader, const Constants& constants);
  const ShaderInterface& interface_of(const std::string& shader);
  void forget();       // shaders were compiled anew
  void drop_unused();  // those that nobody holds, if there are many; while no frame is in flight
  size_t count() const { return made_.size(); }

 private:
  struct Stage {
    std::vector<uint32_t> words;
    ShaderInterface interface;
  };
  const Stage& stage(const std::string& shader);
  std::shared_ptr<const NamedPipeline> make(const std::string& shader, const Stage& read,
                                            const SpecializationMap& special) const;

  const Device& device_;
  const size_t kept_;
  std::map<std::string, Stage> stages_;
  std::map<std::string, Making> made_;
};

}  // namespace welkin::gpu
