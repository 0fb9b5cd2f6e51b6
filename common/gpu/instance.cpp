// Instance creation and validation wiring. See instance.hpp.
#include "common/gpu/instance.hpp"

#include <algorithm>
#include <cstdio>
#include <mutex>

namespace welkin::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  // Tool-information messages of the loader are not ours to fix: warnings and errors only.
  if (severity < VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT) return VK_FALSE;
  std::string line = data->pMessage != nullptr ? data->pMessage : "(no text)";
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::fprintf(stderr, "validation: %s\n", line.c_str());
  static std::mutex mutex;  // pipelines are made on threads
  const std::lock_guard lock(mutex);
  static_cast<std::vector<std::string>*>(user)->push_back(std::move(line));
  return VK_FALSE;
}

}  // namespace

// [create]
Instance::Instance(Validation validation, const std::vector<const char*>& window_extensions) {
  const VkApplicationInfo application{
      .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "welkin", .apiVersion = VK_API_VERSION_1_3};
  std::vector<const char*> extensions = window_extensions;
  std::vector<const char*> layers;
  if (validation != Validation::off) {
    layers.push_back(kValidationLayer);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }

  const VkDebugUtilsMessengerCreateInfoEXT messenger{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity =
          VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
      .pfnUserCallback = on_message,
      .pUserData = &messages_};
  const VkValidationFeatureEnableEXT sync = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  const VkValidationFeaturesEXT features{.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                         .pNext = &messenger,
                                         .enabledValidationFeatureCount = validation == Validation::sync ? 1u : 0u,
                                         .pEnabledValidationFeatures = &sync};

  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                  .pNext = layers.empty() ? nullptr : &features,
                                  .pApplicationInfo = &application,
                                  .enabledLayerCount = static_cast<uint32_t>(layers.size()),
                                  .ppEnabledLayerNames = layers.data(),
                                  .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                  .ppEnabledExtensionNames = extensions.data()};
  const VkResult result = vkCreateInstance(&info, nullptr, &instance_);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw Error(Exit::skipped,
                "no Vulkan driver on this machine: wanted Vulkan 1.3; a software driver is enough "
                "(on Debian: apt-get install mesa-vulkan-drivers); see docs/chapters/01_first_light.md");
  if (result == VK_ERROR_LAYER_NOT_PRESENT)
    fail(
        "--validation: the Khronos validation layer is not installed; on Debian: apt-get install "
        "vulkan-validationlayers");
  check(result, "vkCreateInstance");

  if (!layers.empty()) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    check(create(instance_, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
  }
}
// [/create]

Instance::~Instance() {
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
  }
  vkDestroyInstance(instance_, nullptr);
}

const char* result_name(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY: return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED: return "initialization failed";
    case VK_ERROR_DEVICE_LOST: return "device lost";
    case VK_ERROR_LAYER_NOT_PRESENT: return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT: return "extension not present";
    case VK_ERROR_FEATURE_NOT_PRESENT: return "feature not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER: return "incompatible driver";
    case VK_ERROR_FORMAT_NOT_SUPPORTED: return "format not supported";
    case VK_ERROR_SURFACE_LOST_KHR: return "surface lost";
    case VK_ERROR_OUT_OF_DATE_KHR: return "swapchain out of date";
    case VK_TIMEOUT: return "timed out";
    default: return "failed";
  }
}

void check(VkResult result, const char* call) {
  if (result < 0) fail("{}: {} (VkResult {})", call, result_name(result), static_cast<int>(result));
}

}  // namespace welkin::gpu
