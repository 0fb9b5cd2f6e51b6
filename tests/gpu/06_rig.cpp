// See 06_rig.hpp.
#include "tests/gpu/06_rig.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/scene/scene_knobs.hpp"

namespace welkin::test {

std::vector<Answer> evaluate_items(const std::vector<Item>& items) {
  std::vector<float> inputs(items.size() * 8);
  std::memcpy(inputs.data(), items.data(), inputs.size() * sizeof(float));
  const std::vector<float> outputs = evaluate("tests/06_display.comp", inputs, 8, 4);
  std::vector<Answer> answers(items.size());
  std::memcpy(answers.data(), outputs.data(), outputs.size() * sizeof(float));
  return answers;
}

namespace {

// A picture from a buffer, copied in every frame.
app::Effect given(const gpu::Buffer& from) {
  app::Effect effect{.name = "given", .chapter = 6};
  effect.declare = [&from](app::Builder& builder, app::Board& board) {
    const graph::Resource picture = builder.picture(board, "picture");
    graph::Pass pass{.name = "given", .changed = [](const app::Frame&) { return true; }, .times_itself = true};
    pass.steps.push_back(
        {.accesses = {{picture, gpu::kTransferWrite}}, .record = [&from, picture](const graph::Recorder& r) {
           const gpu::Image& image = r.graph.image(picture);
           const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                          .imageExtent = {image.size.width, image.size.height, 1}};
           vkCmdCopyBufferToImage(r.frame.commands, from.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                                  &region);
         }});
    builder.graph.add(std::move(pass));
  };
  return effect;
}

}  // namespace

DisplayRig::DisplayRig(VkExtent2D size, const std::vector<std::pair<std::string, std::string>>& knobs, const Post& post)
    : settings_(joined(joined(exposure_knobs(), display_knobs()), scene_knobs(Scene{}))),
      context_{device(), scene_, settings_, inject_},
      pool_(gpu::create_command_pool(device())),
      commands_(gpu::allocate_commands(device(), pool_)),
      timer_(device()) {
  scene_.post = post;
  for (const auto& [name, text] : knobs) settings_.set(name, text);
  apply_scene_knobs(settings_, scene_);
  constexpr VkImageUsageFlags kUsage =
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  picture_ = gpu::create_image(device(), "picture", size, VK_FORMAT_R32G32B32A32_SFLOAT, kUsage);
  displayed_ = gpu::create_image(device(), "displayed", size, VK_FORMAT_R8G8B8A8_UNORM, kUsage);
  given_ = gpu::create_buffer(device(), "given", size_t{16} * size.width * size.height,
                              VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Where::upload);
  display_ =
      std::make_unique<app::Composition>(context_, std::vector<app::Effect>{given(given_), exposure(), display()});
  const uint64_t before = device().allocated_bytes();  // the view blocks are counted already
  display_->set_displayed(displayed_);
  display_->set_target(picture_);
  bytes_ = device().allocated_bytes() - before;
}

void DisplayRig::set_picture(const Image& picture) {
  std::memcpy(given_.mapped, picture.pixels.data(), picture.pixels.size() * sizeof(glm::vec4));
}

bool DisplayRig::metered() {
  if (display_->stale()) display_->rebuild();
  return display_->find<Exposure>() != nullptr;
}

void DisplayRig::draw(uint32_t index, double seconds) {
  metered();
  gpu::begin_commands(commands_);
  timer_.begin_frame(commands_);
  const CameraRays no_camera{};
  display_->draw({commands_, picture_, no_camera, timer_, index, 0, seconds});
  gpu::end_commands(commands_);
  gpu::submit_and_wait(device(), commands_);
}

template <typename T>
std::vector<T> DisplayRig::read(const gpu::Buffer& buffer) const {
  const gpu::Buffer host =
      gpu::create_buffer(device(), "readback", buffer.bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Where::readback);
  gpu::run_once(device(), pool_, [&](VkCommandBuffer commands) {
    gpu::buffer_barrier(commands, buffer.handle, gpu::kComputeWrite, gpu::kTransferRead);
    const VkBufferCopy region{0, 0, buffer.bytes};
    vkCmdCopyBuffer(commands, buffer.handle, host.handle, 1, &region);
    gpu::buffer_barrier(commands, host.handle, gpu::kTransferWrite, gpu::kHostRead);
  });
  const std::span<T> values = host.as<T>();
  return {values.begin(), values.end()};
}

std::vector<uint32_t> DisplayRig::histogram() const {
  return read<uint32_t>(display_->graph().buffer(display_->find<Exposure>()->histogram));
}
ExposureState DisplayRig::state() const {
  return read<ExposureState>(display_->graph().buffer(display_->find<Exposure>()->state)).front();
}
Image8 DisplayRig::displayed() const { return app::read_displayed(device(), pool_, displayed_); }

Image flat_picture(uint32_t width, uint32_t height, glm::vec3 color) {
  return {width, height, std::vector<glm::vec4>(size_t{width} * height, glm::vec4(color, 1.0f))};
}

double pixel_noise_reference(uint32_t x, uint32_t y, uint32_t seed) {
  const auto mixed = [](uint64_t v) {
    v ^= v >> 16, v = v * 0x7feb352du & 0xffffffffu;
    v ^= v >> 15, v = v * 0x846ca68bu & 0xffffffffu;
    return static_cast<uint32_t>(v ^ v >> 16);
  };
  return std::ldexp(static_cast<double>(mixed(x ^ mixed(y ^ mixed(seed))) / 256), -24);
}

std::optional<double> trimmed_mean_log2(const Image& picture, double low, double high) {
  std::vector<double> logs;
  for (const glm::vec4& p : picture.pixels) {
    const double light = 0.2126729 * p.r + 0.7151522 * p.g + 0.0721750 * p.b;
    if (light > 0.0) logs.push_back(std::clamp(std::log2(light), -30.0, 20.0));
  }
  if (logs.empty()) return std::nullopt;
  std::sort(logs.begin(), logs.end());
  const double first = low * logs.size(), last = high * logs.size();
  double sum = 0.0, weight = 0.0;
  for (size_t i = 0; i < logs.size(); ++i) {
    const double share = std::max(std::min(i + 1.0, last) - std::max(double(i), first), 0.0);
    sum += share * logs[i];
    weight += share;
  }
  return sum / weight;
}

}  // namespace welkin::test
