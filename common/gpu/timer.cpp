// Timestamp queries. See timer.hpp.
#include "common/gpu/timer.hpp"

#include <array>

namespace welkin::gpu {

static constexpr uint32_t kPassesOfPool = 16;
static constexpr uint32_t kQueries = 4 * kPassesOfPool;  // the second half: see stamp()

Timer::Timer(const Device& device) : device_(&device) { add_pool(); }

void Timer::add_pool() {
  const VkQueryPoolCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_TIMESTAMP, .queryCount = kQueries};
  pools_.push_back(create<QueryPool>(*device_, vkCreateQueryPool, info, "vkCreateQueryPool"));
  names_.resize(pools_.size() * kPassesOfPool);
  times_.reserve(names_.size());
}

void Timer::begin_frame(VkCommandBuffer commands) {
  count_ = 0;
  for (const QueryPool& pool : pools_) vkCmdResetQueryPool(commands, pool, 0, kQueries);
}

// [timestamps]
void Timer::stamp(VkCommandBuffer commands, size_t pass, uint32_t query) {
  const VkQueryPool pool = pools_[pass / kPassesOfPool];
  query += 2 * static_cast<uint32_t>(pass % kPassesOfPool);
  // ALL_COMMANDS: the clock is read when everything before has finished, so passes do not overlap in the table.
  vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool, query);
  // Where triangles are drawn too, lavapipe reads the clock only when the next timestamp is asked for, after the pass.
  if (device_->candidate().software)
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool, query + kQueries / 2);
}

void Timer::begin_pass(VkCommandBuffer commands, const std::string& name) {
  if (count_ == names_.size()) {
    add_pool();
    vkCmdResetQueryPool(commands, pools_.back(), 0, kQueries);
  }
  stamp(commands, count_, 0);
  names_[count_++] = name;
}

void Timer::end_pass(VkCommandBuffer commands) { stamp(commands, count_ - 1, 1); }
// [/timestamps]

const std::vector<PassTime>& Timer::read() {
  times_.resize(device_->timestamp_bits() == 0 ? 0 : count_);
  const uint64_t mask = device_->timestamp_bits() >= 64 ? ~uint64_t{0} : (uint64_t{1} << device_->timestamp_bits()) - 1;
  std::array<uint64_t, 2> ticks{};
  for (size_t i = 0; i < times_.size(); ++i) {
    check(vkGetQueryPoolResults(*device_, pools_[i / kPassesOfPool], 2 * static_cast<uint32_t>(i % kPassesOfPool), 2,
                                sizeof ticks, ticks.data(), sizeof(uint64_t),
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    times_[i].name = names_[i];
    times_[i].milliseconds = static_cast<double>((ticks[1] - ticks[0]) & mask) *
                             static_cast<double>(device_->limits().timestampPeriod) * 1e-6;
  }
  return times_;
}

}  // namespace welkin::gpu
