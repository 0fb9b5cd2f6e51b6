// Time per pass, from timestamps the device writes.
#pragma once

#include <string>
#include <vector>

#include "common/gpu/device.hpp"

namespace welkin::gpu {

struct PassTime {
  std::string name;
  double milliseconds = 0.0;
};

// Named intervals of a frame, as many as there are. begin_frame, passes, then read after the frame's work has finished.
class Timer {
 public:
  explicit Timer(const Device& device);

  void begin_frame(VkCommandBuffer commands);
  void begin_pass(VkCommandBuffer commands, const std::string& name);
  void end_pass(VkCommandBuffer commands);

  // Times of the passes of the last recorded frame; the device must have finished it. Empty if it has no timestamps.
  const std::vector<PassTime>& read();

 private:
  void stamp(VkCommandBuffer commands, size_t pass, uint32_t query);
  void add_pool();

  const Device* device_;
  std::vector<QueryPool> pools_;    // one a kPassesOfPool passes
  std::vector<std::string> names_;  // as many as fit, so that a frame assigns and does not allocate
  size_t count_ = 0;                // of them in this frame
  std::vector<PassTime> times_;
};

// Times what is recorded during its life: `const gpu::TimedPass pass(timer, commands, "march");`
class TimedPass {
 public:
  TimedPass(Timer& timer, VkCommandBuffer commands, const std::string& name) : timer_(timer), commands_(commands) {
    timer_.begin_pass(commands_, name);
  }
  ~TimedPass() { timer_.end_pass(commands_); }
  TimedPass(const TimedPass&) = delete;
  TimedPass& operator=(const TimedPass&) = delete;

 private:
  Timer& timer_;
  VkCommandBuffer commands_;
};

}  // namespace welkin::gpu
