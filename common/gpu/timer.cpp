// Timestamp queries. See timer.hpp.
#include "common/gpu/timer.hpp"

#include <array>

namespace welkin::gpu {

Timer::Timer(const Device& device) : device_(&device) {
  const VkQueryPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                   .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                   .queryCount = 4 * kMaximumPasses};  // the second half: see stamp()
  VkQueryPool pool = VK_NULL_HANDLE;
  check(vkCreateQueryPool(device, &info, nullptr, &pool), "vkCreateQueryPool");
  queries_ = QueryPool(device, pool);
  names_.resize(kMaximumPasses);
  times_.reserve(kMaximumPasses);
}

void Timer::begin_frame(VkCommandBuffer commands) {
  count_ = 0;
  vkCmdResetQueryPool(commands, queries_, 0, 4 * kMaximumPasses);
}

// [timestamps]
void Timer::stamp(VkCommandBuffer commands, uint32_t query) {
  // ALL_COMMANDS: the clock is read when everything before has finished, so passes do not overlap in the table.
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, query);
  // Where triangles are drawn too, lavapipe reads the clock only when the next timestamp is asked for, after the pass.
  if (device_->candidate().software)
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, query + 2 * kMaximumPasses);
}

void Timer::begin_pass(VkCommandBuffer commands, const std::string& name) {
  if (count_ == kMaximumPasses) fail("timer: more than {} passes in a frame", kMaximumPasses);
  stamp(commands, 2 * static_cast<uint32_t>(count_));
  names_[count_++] = name;
}

void Timer::end_pass(VkCommandBuffer commands) { stamp(commands, 2 * static_cast<uint32_t>(count_) - 1); }
// [/timestamps]

const std::vector<PassTime>& Timer::read() {
  times_.resize(device_->timestamp_bits() == 0 ? 0 : count_);
  if (times_.empty()) return times_;
  std::array<uint64_t, 2 * kMaximumPasses> ticks{};
  const uint32_t count = 2 * static_cast<uint32_t>(count_);
  check(vkGetQueryPoolResults(*device_, queries_, 0, count, sizeof ticks, ticks.data(), sizeof(uint64_t),
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  const uint64_t mask = device_->timestamp_bits() >= 64 ? ~uint64_t{0} : (uint64_t{1} << device_->timestamp_bits()) - 1;
  for (size_t i = 0; i < count_; ++i) {
    times_[i].name = names_[i];
    times_[i].milliseconds = static_cast<double>((ticks[2 * i + 1] - ticks[2 * i]) & mask) *
                             static_cast<double>(device_->limits().timestampPeriod) * 1e-6;
  }
  return times_;
}

}  // namespace welkin::gpu
