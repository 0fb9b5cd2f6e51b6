// Dear ImGui 1.86 on its GLFW and Vulkan backends: what the panel is drawn with. What it shows is in panel_layout.cpp.
#include "chapters/02_window/panel.hpp"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>

#include "chapters/02_window/panel_layout.hpp"
#include "common/app/session.hpp"

namespace welkin {
namespace {

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

constexpr size_t kHistory = 120;

// The names that --scene takes for the scenes that come with the tree; none if they cannot be read.
}  // namespace

struct Panel::State {
  const gpu::Device& device;
  gpu::RenderPass pass;
  gpu::DescriptorPool pool;
  std::vector<gpu::Framebuffer> framebuffers;
  VkExtent2D size{};
  std::vector<float> history = std::vector<float>(kHistory);  // milliseconds a frame
  size_t next = 0;
  std::vector<std::string> scenes = app::shipped_scenes();
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
  set_style();
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
  float total_ms = 0.0f;
  for (const gpu::PassTime& pass : state.times) total_ms += static_cast<float>(pass.milliseconds);
  state_->history[state_->next++ % kHistory] = total_ms;
  if (state.visible) {
    const PanelContext shown{chapter, scene, device, pose, state_->scenes, state_->history, state_->next % kHistory};
    lay_out(shown, {static_cast<float>(state_->size.width), static_cast<float>(state_->size.height)}, settings, state);
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
