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

// Up to kMaximumPasses named intervals per frame. begin_frame, passes, then read after the frame's work has finished.
class Timer {
 public:
  static constexpr uint32_t kMaximumPasses = 16;
  explicit Timer(const Device& device);

  void begin_frame(VkCommandBuffer commands);
  void begin_pass(VkCommandBuffer commands, const std::string& name);
  void end_pass(VkCommandBuffer commands);

  // Times of the passes of the last recorded frame; the device must have finished it. Empty if it has no timestamps.
  const std::vector<PassTime>& read();

 private:
  void stamp(VkCommandBuffer commands, uint32_t query);

  const Device* device_;
  QueryPool queries_;
  std::vector<std::string> names_;  // kMaximumPasses of them, so that a frame assigns and does not allocate
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
