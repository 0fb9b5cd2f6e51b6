// The panel, with Dear ImGui 1.86 on its GLFW and Vulkan backends. See panel.hpp.
#include "chapters/02_window/panel.hpp"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>

#include "common/measure/bench_json.hpp"

namespace welkin {
namespace {

constexpr size_t kHistory = 120;

void check_imgui(VkResult result) { gpu::check(result, "Dear ImGui"); }

gpu::RenderPass create_render_pass(const gpu::Device& device, VkFormat format) {
  const VkAttachmentDescription attachment{.format = format,
                                           .samples = VK_SAMPLE_COUNT_1_BIT,
                                           .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                           .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                           .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                           .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                           .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                           .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkSubpassDescription subpass{
      .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS, .colorAttachmentCount = 1, .pColorAttachments = &reference};
  // The picture beneath was drawn by the same stage just before.
  const VkSubpassDependency dependency{
      .srcSubpass = VK_SUBPASS_EXTERNAL,
      .dstSubpass = 0,
      .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
      .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
      .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
      .dstAccessMask = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT};
  const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                    .attachmentCount = 1,
                                    .pAttachments = &attachment,
                                    .subpassCount = 1,
                                    .pSubpasses = &subpass,
                                    .dependencyCount = 1,
                                    .pDependencies = &dependency};
  VkRenderPass pass = VK_NULL_HANDLE;
  gpu::check(vkCreateRenderPass(device, &info, nullptr, &pass), "vkCreateRenderPass");
  return {device, pass};
}

bool knob_widget(const Knob& knob, Settings& settings) {
  const double before = settings.number(knob.name);
  double after = before;
  if (!knob.choices.empty()) {
    if (ImGui::BeginCombo(knob.name.c_str(), settings.choice(knob.name).c_str())) {
      for (size_t i = 0; i < knob.choices.size(); ++i)
        if (ImGui::Selectable(knob.choices[i].c_str(), before == static_cast<double>(i)))
          after = static_cast<double>(i);
      ImGui::EndCombo();
    }
  } else if (knob.integer) {
    int value = static_cast<int>(before);
    if (ImGui::SliderInt(knob.name.c_str(), &value, static_cast<int>(knob.minimum), static_cast<int>(knob.maximum),
                         "%d", ImGuiSliderFlags_AlwaysClamp))
      after = value;
  } else {
    float value = static_cast<float>(before);
    if (ImGui::SliderFloat(knob.name.c_str(), &value, static_cast<float>(knob.minimum),
                           static_cast<float>(knob.maximum), "%.3f", ImGuiSliderFlags_AlwaysClamp))
      after = std::clamp(static_cast<double>(value), knob.minimum, knob.maximum);
  }
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s%s%s", knob.meaning.c_str(), knob.unit.empty() ? "" : ", ", knob.unit.c_str());
  if (after == before) return false;
  settings.set_number(knob.name, after);
  return true;
}

}  // namespace

struct Panel::State {
  const gpu::Device& device;
  gpu::RenderPass pass;
  gpu::DescriptorPool pool;
  std::vector<gpu::Framebuffer> framebuffers;
  VkExtent2D size{};
  std::array<float, kHistory> history{};
  size_t next = 0;
};

Panel::Panel(GLFWwindow* window, const gpu::Instance& instance, const gpu::Device& device,
             const WindowSwapchain& swapchain)
    : state_(new State{.device = device, .pass = create_render_pass(device, swapchain.format())}) {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
  const VkDescriptorPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                             .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                             .maxSets = 8,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size};
  VkDescriptorPool pool = VK_NULL_HANDLE;
  gpu::check(vkCreateDescriptorPool(device, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
  state_->pool = gpu::DescriptorPool(device, pool);

  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
  ImGui_ImplGlfw_InitForVulkan(window, true);
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = instance;
  info.PhysicalDevice = device.physical();
  info.Device = device;
  info.QueueFamily = device.queue_family();
  info.Queue = device.queue();
  info.DescriptorPool = pool;
  info.MinImageCount = 2;
  info.ImageCount = std::max(2u, swapchain.image_count());
  info.CheckVkResultFn = check_imgui;
  ImGui_ImplVulkan_Init(&info, state_->pass);
  const gpu::CommandPool commands = gpu::create_command_pool(device);
  gpu::run_once(device, commands, [](VkCommandBuffer c) { ImGui_ImplVulkan_CreateFontsTexture(c); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
  swapchain_changed(swapchain);
}

Panel::~Panel() {
  ImGui_ImplVulkan_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Panel::swapchain_changed(const WindowSwapchain& swapchain) {
  state_->framebuffers.clear();
  state_->size = swapchain.size();
  for (uint32_t i = 0; i < swapchain.image_count(); ++i) {
    const VkImageView view = swapchain.view(i);
    const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                       .renderPass = state_->pass,
                                       .attachmentCount = 1,
                                       .pAttachments = &view,
                                       .width = swapchain.size().width,
                                       .height = swapchain.size().height,
                                       .layers = 1};
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    gpu::check(vkCreateFramebuffer(state_->device, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
    state_->framebuffers.emplace_back(state_->device, framebuffer);
  }
}

bool Panel::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Panel::wants_keyboard() const { return ImGui::GetIO().WantTextInput; }

void Panel::layout(const Chapter& chapter, Scene& scene, Settings& settings, const gpu::Device& device,
                   const CameraPose& pose, PanelState& state) {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  if (state.visible) {
    ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints(
        {0, 0}, {static_cast<float>(state_->size.width), static_cast<float>(state_->size.height) - 16.0f});
    ImGui::Begin(fmt::format("{:02} {}", chapter.number, chapter.title).c_str(), nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushTextWrapPos(340.0f);
    ImGui::TextUnformatted(chapter.whats_new.c_str());
    ImGui::TextDisabled(state.flying ? "F: back to the panel" : "F: fly (WASD, Space, Ctrl, Shift, mouse)");
    ImGui::TextDisabled("R reload shaders  P screenshot  H hide  Esc quit");
    if (chapter.truth && ImGui::Button("T: path-trace this view")) state.truth_asked = true;
    ImGui::Text("altitude %.4g km\nazimuth %.1f, elevation %.1f", app::altitude_km(pose, scene.planet.ground_radius_km),
                pose.azimuth_deg, pose.elevation_deg);
    if (!settings.knobs().empty() && ImGui::CollapsingHeader("Knobs", ImGuiTreeNodeFlags_DefaultOpen))
      for (const Knob& knob : settings.knobs())
        if (knob_widget(knob, settings)) state.changed.push_back(knob.name);
    if (chapter.sky && !scene.sun.latitude_deg) ImGui::TextDisabled("no time of day: the scene's sun has no latitude");
    if (chapter.sky && scene.sun.latitude_deg) {
      float hours = static_cast<float>(scene.time_s / 3600.0);
      if (ImGui::SliderFloat("time, hours from the scene's", &hours, -12.0f, 12.0f, "%.2f"))
        scene.time_s = 3600.0 * hours;
    }
    if (ImGui::CollapsingHeader("Time per pass", ImGuiTreeNodeFlags_DefaultOpen)) {
      float total = 0.0f;
      for (const gpu::PassTime& pass : state.times) {
        ImGui::Text("%-16s %9.3f ms", pass.name.c_str(), pass.milliseconds);
        total += static_cast<float>(pass.milliseconds);
      }
      state_->history[state_->next++ % kHistory] = total;
      ImGui::PlotLines("total", state_->history.data(), static_cast<int>(kHistory),
                       static_cast<int>(state_->next % kHistory), fmt::format("{:.3f} ms", total).c_str(), 0.0f,
                       *std::max_element(state_->history.begin(), state_->history.end()) * 1.1f, {0, 48});
      ImGui::Text("%s held on %s", measure::human_bytes(device.allocated_bytes()).c_str(),
                  device.candidate().name.c_str());
    }
    if (!state.message.empty()) ImGui::TextUnformatted(state.message.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
  }
  ImGui::Render();
}

void Panel::record(VkCommandBuffer commands, uint32_t image_index) {
  const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                    .renderPass = state_->pass,
                                    .framebuffer = state_->framebuffers[image_index],
                                    .renderArea = {{0, 0}, state_->size}};
  vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
  vkCmdEndRenderPass(commands);
}

}  // namespace welkin
