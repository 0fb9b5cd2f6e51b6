// Device choice and creation. See device.hpp.
#include "common/gpu/device.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <tuple>

#include "common/gpu/named_pipeline.hpp"

namespace welkin::gpu {
namespace {

// One queue does everything here: compute, triangles, copies. Every desktop driver and lavapipe has such a family
// first. Its index, and how many bits its timestamps have.
std::optional<std::pair<uint32_t, uint32_t>> find_queue_family(VkPhysicalDevice device) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  const VkQueueFlags wanted = VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT;
  for (uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & wanted) == wanted) return std::pair(i, families[i].timestampValidBits);
  return std::nullopt;
}

// [wanted]
std::vector<std::string> missing_features(VkPhysicalDevice device, uint32_t api_version) {
  std::vector<std::string> lacks;
  if (api_version < VK_API_VERSION_1_3)
    return {
        fmt::format("Vulkan 1.3 (offers {}.{})", VK_API_VERSION_MAJOR(api_version), VK_API_VERSION_MINOR(api_version))};
  VkPhysicalDeviceVulkan13Features v13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13};
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v12};
  vkGetPhysicalDeviceFeatures2(device, &features);
  if (!v13.dynamicRendering) lacks.push_back("dynamicRendering");
  if (!v13.synchronization2) lacks.push_back("synchronization2");
  if (!v12.timelineSemaphore) lacks.push_back("timelineSemaphore");
  if (!find_queue_family(device)) lacks.push_back("a queue with compute and graphics");
  return lacks;
}
// [/wanted]

// Lower is preferred.
auto rank(const Candidate& candidate) {
  constexpr std::array order{VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU,
                             VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU};
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(candidate.handle, &properties);
  return std::find(order.begin(), order.end(), properties.deviceType) - order.begin();
}

std::string offered(const std::vector<Candidate>& candidates) {
  std::vector<std::string> lines;
  for (size_t i = 0; i < candidates.size(); ++i)
    lines.push_back(fmt::format(
        "{} {}{}", i, candidates[i].name,
        candidates[i].lacks.empty() ? "" : fmt::format(" (lacks {})", fmt::join(candidates[i].lacks, ", "))));
  return fmt::format("{}", fmt::join(lines, "; "));
}

}  // namespace

std::vector<Candidate> list_devices(VkInstance instance, const std::string& inject_fault) {
  uint32_t count = 0;
  const VkResult result = vkEnumeratePhysicalDevices(instance, &count, nullptr);
  std::vector<VkPhysicalDevice> handles(result >= 0 ? count : 0);
  if (!handles.empty())
    check(vkEnumeratePhysicalDevices(instance, &count, handles.data()), "vkEnumeratePhysicalDevices");
  std::vector<Candidate> candidates;
  for (VkPhysicalDevice handle : handles) {
    VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vkGetPhysicalDeviceProperties2(handle, &properties);
    Candidate candidate{.handle = handle,
                        .name = properties.properties.deviceName,
                        .driver = fmt::format("{} {}", driver.driverName, driver.driverInfo),
                        .software = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU,
                        .lacks = missing_features(handle, properties.properties.apiVersion)};
    if (inject_fault == "missing-feature") candidate.lacks.push_back("synchronization2 (injected)");
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

// [choose]
const Candidate& choose_device(const std::vector<Candidate>& candidates, const std::string& wanted) {
  constexpr const char* page = "see docs/chapters/01_first_light.md";
  if (candidates.empty())
    throw Error(Exit::skipped,
                fmt::format("no Vulkan device on this machine: wanted one with Vulkan 1.3, offered none; a "
                            "software driver is enough (on Debian: apt-get install mesa-vulkan-drivers); {}",
                            page));
  if (!wanted.empty()) {
    size_t number = candidates.size();
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    const bool is_number = error == std::errc() && end == wanted.data() + wanted.size();
    for (size_t i = 0; i < candidates.size(); ++i) {
      if (is_number ? i != number : candidates[i].name.find(wanted) == std::string::npos) continue;
      if (candidates[i].lacks.empty()) return candidates[i];
      fail("--gpu {}: {} lacks {}; {}", wanted, candidates[i].name, fmt::join(candidates[i].lacks, ", "), page);
    }
    fail("--gpu {}: no such device; offered: {}", wanted, offered(candidates));
  }
  const Candidate* best = nullptr;
  for (const Candidate& candidate : candidates)
    if (candidate.lacks.empty() && (best == nullptr || rank(candidate) < rank(*best))) best = &candidate;
  if (best == nullptr)
    fail(
        "no usable Vulkan device: wanted Vulkan 1.3 with dynamicRendering, synchronization2, timelineSemaphore; "
        "offered: {}; {}",
        offered(candidates), page);
  return *best;
}
// [/choose]

// [create]
Device::Device(const Instance& instance, const Candidate& candidate, bool swapchain) : candidate_(candidate) {
  std::tie(queue_family_, timestamp_bits_) = find_queue_family(candidate.handle).value();
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = queue_family_,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  VkPhysicalDeviceVulkan13Features v13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                       .synchronization2 = VK_TRUE,
                                       .dynamicRendering = VK_TRUE};
  VkPhysicalDeviceVulkan12Features v12{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13, .timelineSemaphore = VK_TRUE};
  const char* extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = &v12,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = swapchain ? 1u : 0u,
                                .ppEnabledExtensionNames = &extension};
  check(vkCreateDevice(candidate.handle, &info, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  pipelines_ = std::make_unique<Pipelines>(*this);
  vkGetPhysicalDeviceMemoryProperties(candidate.handle, &memory_);
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(candidate.handle, &properties);
  limits_ = properties.limits;
  if (instance.debug_names())
    set_name_ = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
        vkGetDeviceProcAddr(device_, "vkSetDebugUtilsObjectNameEXT"));
}
// [/create]

Device::~Device() {
  vkDeviceWaitIdle(device_);  // at shutdown only: never in a frame
  pipelines_.reset();
  vkDestroyDevice(device_, nullptr);
}

std::optional<uint32_t> Device::memory_type(uint32_t type_bits, VkMemoryPropertyFlags properties) const {
  for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
    if ((type_bits & (1u << i)) != 0 && (memory_.memoryTypes[i].propertyFlags & properties) == properties) return i;
  return std::nullopt;
}

void Device::set_name(VkObjectType type, const void* handle, const std::string& name) const {
  if (set_name_ == nullptr) return;
  const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .objectType = type,
                                           .objectHandle = reinterpret_cast<uint64_t>(handle),
                                           .pObjectName = name.c_str()};
  set_name_(device_, &info);
}

uint64_t Device::allocated_bytes() const {
  return std::accumulate(allocations_.begin(), allocations_.end(), uint64_t{0},
                         [](uint64_t sum, const Allocation& allocation) { return sum + allocation.bytes; });
}

}  // namespace welkin::gpu
