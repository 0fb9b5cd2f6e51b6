// The window. See window.hpp and docs/chapters/02_window.md.
#include "chapters/02_window/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "chapters/02_window/panel.hpp"
#include "chapters/02_window/present.hpp"
#include "common/app/session.hpp"
#include "common/gpu/shader_file.hpp"
#include "common/measure/metrics.hpp"
#include "common/scene/one_line.hpp"
#include "common/scene/path.hpp"
#include "common/scene/scene_knobs.hpp"

namespace welkin {
namespace {

using namespace app;

constexpr VkExtent2D kSoftwareSize{640, 360};  // what a software driver draws a few times a second

std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

// Xlib ends the process without a word of ours when the display goes away: say what happened, and mean the exit code.
int on_display_lost(void*) {
  std::fprintf(stderr, "the display was lost: the connection to the window system broke; --headless needs none\n");
  _exit(static_cast<int>(Exit::usage));
}

void handle_display_loss() {
  void* xlib = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
  if (xlib == nullptr) return;  // another window system
  using SetHandler = int (*(*)(int (*)(void*)))(void*);
  if (const auto set = reinterpret_cast<SetHandler>(dlsym(xlib, "XSetIOErrorHandler")); set != nullptr)
    set(on_display_lost);
}

struct Surface {
  VkInstance instance;
  VkSurfaceKHR handle = VK_NULL_HANDLE;
  ~Surface() { vkDestroySurfaceKHR(instance, handle, nullptr); }
};

struct Window {
  GLFWwindow* handle = nullptr;
  bool resized = false;
  std::vector<int> keys;             // pressed since the last frame
  std::vector<std::string> dropped;  // files
  double mouse_x = 0.0, mouse_y = 0.0;
  ~Window() { glfwDestroyWindow(handle); }
};

Window& window_of(GLFWwindow* handle) { return *static_cast<Window*>(glfwGetWindowUserPointer(handle)); }

void open_window(Window& window, const std::string& title, VkExtent2D size) {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window.handle =
      glfwCreateWindow(static_cast<int>(size.width), static_cast<int>(size.height), title.c_str(), nullptr, nullptr);
  if (window.handle == nullptr)
    fail("cannot open a window of {}x{}: {}; --headless needs none", size.width, size.height, last_glfw_error());
  glfwSetWindowUserPointer(window.handle, &window);
  glfwSetFramebufferSizeCallback(window.handle, [](GLFWwindow* w, int, int) { window_of(w).resized = true; });
  glfwSetKeyCallback(window.handle, [](GLFWwindow* w, int key, int, int action, int) {
    if (action == GLFW_PRESS) window_of(w).keys.push_back(key);
  });
  glfwSetDropCallback(window.handle, [](GLFWwindow* w, int count, const char** paths) {
    window_of(w).dropped.assign(paths, paths + count);
  });
}

// Framebuffer, not window, size: they differ on displays with a scale.
VkExtent2D framebuffer_size(GLFWwindow* window) {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

void move_camera(Window& window, const Panel& panel, PanelState& state, CameraPose& pose, double seconds,
                 double ground_radius_km) {
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window.handle, &x, &y);
  const bool dragging =
      glfwGetMouseButton(window.handle, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS && !panel.wants_mouse();
  if (state.flying || dragging) {
    const double degrees_per_pixel = pose.fov_deg / framebuffer_size(window.handle).height;
    turn(pose, (x - window.mouse_x) * degrees_per_pixel, (window.mouse_y - y) * degrees_per_pixel);
  }
  window.mouse_x = x, window.mouse_y = y;
  if (!state.flying || panel.wants_keyboard()) return;
  const auto down = [&](int key) { return glfwGetKey(window.handle, key) == GLFW_PRESS ? 1.0 : 0.0; };
  const glm::dvec3 axes(down(GLFW_KEY_D) - down(GLFW_KEY_A), down(GLFW_KEY_W) - down(GLFW_KEY_S),
                        down(GLFW_KEY_SPACE) - down(GLFW_KEY_LEFT_CONTROL));
  if (axes != glm::dvec3(0.0)) fly(pose, axes, seconds, down(GLFW_KEY_LEFT_SHIFT) > 0.0, ground_radius_km);
}

// A running window: what its loop and its keys share.
struct Loop {
  Session& session;
  Window& window;
  WindowSwapchain swapchain;
  std::unique_ptr<Program> program;
  Drawing drawing;
  PresentPass present;
  Targets targets;
  Panel panel;
  PanelState state;
  CameraPose pose;
  bool cut = false;                // the next frame has nothing to do with the one before
  std::optional<double> played_s;  // of the path that is shown, over and over until the camera is taken
  gpu::CommandPool pool;           // for screenshots

  Loop(Session& s, Window& w, VkSurfaceKHR surface)
      : session(s),
        window(w),
        swapchain(s.device, surface, framebuffer_size(w.handle)),
        program(s.make_program()),
        drawing(s.context, s.chapter, *program),
        present(s.device, swapchain.format()),
        targets(create_targets(s.device, swapchain.size())),
        panel(w.handle, s.instance, s.device, swapchain),
        pose(s.first_pose()),
        pool(gpu::create_command_pool(s.device)) {
    state.view_now = s.scene.view(s.options.view).name;
    if (!s.options.path.empty()) played_s = 0.0;
    use_targets();
  }
  ~Loop() { swapchain.wait_for_presentation(); }

  void use_targets() {
    present.set_image(session.device, targets.displayed);
    drawing.set_targets(targets);
  }

  void resize() {
    const VkExtent2D size = framebuffer_size(window.handle);
    window.resized = false;
    if (size.width == 0 || size.height == 0) return;  // minimised
    swapchain.recreate(size);
    panel.swapchain_changed(swapchain);
    targets = create_targets(session.device, swapchain.size());
    use_targets();
  }

  std::string save(std::string file) {
    swapchain.wait_for_all_frames();
    Session now = {session.chapter,  session.options, session.scene,  session.settings,
                   session.instance, session.device,  session.context};
    write_output(now, file, pose, read_picture(session.device, pool, targets.picture),
                 read_displayed(session.device, pool, targets.displayed));
    return file;
  }

  void restore(const std::string& file) {
    Scene scene;
    Settings settings;
    load_scene_and_settings(session.chapter, file, {}, {}, scene, settings);  // throws before anything here changes
    swapchain.wait_for_all_frames();
    std::swap(session.scene, scene);
    std::swap(session.settings, settings);
    try {
      drawing.follow();
    } catch (...) {  // its height map is missing, its images do not fit: the old scene stays
      std::swap(session.scene, scene);
      std::swap(session.settings, settings);
      drawing.follow();
      throw;
    }
    pose = pose_of(session.scene.view(""), session.scene.planet.ground_radius_km);
    state.view_now = session.scene.view("").name;
    played_s.reset();  // a path of the scene before
    cut = true;
  }

  // What is asked for while a view stands may fail: the panel says why, and the view stays.
  template <typename Action>
  void attempt(Action&& action) {
    try {
      action();
    } catch (const std::exception& error) {
      state.message = one_line(error.what());
      std::fprintf(stderr, "%s: %s\n", session.chapter.name.c_str(), state.message.c_str());
    }
  }
  void say(const std::string& message) {
    state.message = message;
    std::printf("%s\n", message.c_str());
    std::fflush(stdout);
  }

  void play(double seconds) {
    if (!played_s) return;
    const Path& path = session.scene.path(session.options.path);
    const double length_s = path.time_s.back() - path.time_s.front();
    played_s = std::fmod(*played_s + seconds, length_s);
    const PathPoint point = point_on(session.scene, path, path.time_s.front() + *played_s);
    session.scene.time_s = point.moment_s;
    pose = pose_of(point.view, session.scene.planet.ground_radius_km);
  }

  std::string error_of_what_is_shown() const;
  void save_next();
  void reload_shaders();
  void on_key(int key);
  void do_what_was_asked();
  bool draw(uint32_t index, double seconds);
};

// Path-traces the present view, small, and says how far the method is from it: and how far two such truths are from
// each other, because noise is not error. Without the sun's disc, whose few pixels would be all a mean of squares sees.
std::string Loop::error_of_what_is_shown() const {
  if (!session.chapter.truth) return "this chapter has no path tracer to be measured against; those from 09 on have";
  constexpr VkExtent2D kSize{48, 27};
  Scene scene = session.scene;
  scene.sun.disc = false;
  const Session still{session.chapter,
                      session.options,
                      scene,
                      session.settings,
                      session.instance,
                      session.device,
                      {session.device, scene, session.settings, session.options.inject}};
  const std::unique_ptr<Program> method = still.make_program();
  Renderer renderer(still.context, still.chapter, *method, kSize);
  renderer.draw(pose, scene.time_s, still.options.seed, 0);
  const Image truth = draw_truth(still, pose, kSize, 1), again = draw_truth(still, pose, kSize, 2);
  const auto as_it_is = [](const glm::vec3& value) { return value; };
  return fmt::format(
      "relative RMSE {:.2g} % against {} frames of path tracing at {}x{}; two of those differ by {:.2g} %",
      100.0 * measure::compare(renderer.picture(), truth, as_it_is).relative_rmse, session.chapter.truth->frames,
      kSize.width, kSize.height, 100.0 * measure::compare(again, truth, as_it_is).relative_rmse);
}

// Into out/, under the next number that is free.
void Loop::save_next() {
  std::error_code error;
  std::filesystem::create_directories("out", error);
  if (error) fail("cannot save a picture: directory 'out': {}", error.message());
  int number = 1;
  const auto name = [&] { return fmt::format("out/{}_{:03}.png", session.chapter.name, number); };
  while (std::filesystem::exists(name(), error)) ++number;
  say("saved " + save(name()));
}

void Loop::reload_shaders() {
  const std::string refusal = gpu::recompile_shaders(session.chapter.number);
  if (!refusal.empty()) {
    state.message = refusal;  // as many lines as the compiler wrote; the old pipelines stay
    return;
  }
  swapchain.wait_for_all_frames();
  drawing.reload();
  state.message = "shaders reloaded";
}

void Loop::on_key(int key) {
  switch (key) {
    case GLFW_KEY_ESCAPE: glfwSetWindowShouldClose(window.handle, GLFW_TRUE); break;
    case GLFW_KEY_H: state.visible = !state.visible; break;
    case GLFW_KEY_F:
      state.flying = !state.flying;
      played_s.reset();
      glfwSetInputMode(window.handle, GLFW_CURSOR, state.flying ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
      glfwGetCursorPos(window.handle, &window.mouse_x, &window.mouse_y);
      break;
    case GLFW_KEY_P: attempt([&] { save_next(); }); break;
    case GLFW_KEY_R: attempt([&] { reload_shaders(); }); break;
    case GLFW_KEY_T:
      swapchain.wait_for_all_frames();
      attempt([&] { say(error_of_what_is_shown()); });
      break;
    default: break;
  }
}

// Keys, buttons, what was chosen in the panel, dropped files: between two frames.
void Loop::do_what_was_asked() {
  if (!panel.wants_keyboard())
    for (const int key : std::exchange(window.keys, {})) on_key(key);
  window.keys.clear();
  for (const int key : std::exchange(state.keys, {})) on_key(key);
  if (!state.scene_asked.empty()) window.dropped.push_back(std::exchange(state.scene_asked, {}));
  for (const std::string& file : std::exchange(window.dropped, {})) attempt([&] { restore(file); });
  if (const std::string view = std::exchange(state.view_asked, {}); !view.empty()) {
    pose = pose_of(session.scene.view(view), session.scene.planet.ground_radius_km);
    state.view_now = view;
  }
}

bool Loop::draw(uint32_t index, double seconds) {
  uint32_t image = 0;
  FrameSlot* slot = swapchain.begin_frame(image);
  if (slot == nullptr) return false;
  state.times = slot->timer.read();  // of this slot's earlier frame, finished now
  const VkExtent2D size = swapchain.size();
  state.changed.clear();
  panel.layout(session.chapter, session.scene, session.settings, session.device, pose, state);
  if (!state.changed.empty()) apply_scene_knobs(session.settings, session.scene);
  if (drawing.stale()) {
    swapchain.wait_for_all_frames();
    attempt([&] { drawing.follow(); });
  }
  // After the panel: what is drawn is what a picture saved next says it shows.
  const CameraRays camera =
      camera_rays(pose, session.scene, session.scene.time_s, {size.width, size.height}, session.options.seed, index);
  gpu::begin_commands(slot->commands);
  drawing.record({slot->commands, targets.picture, camera, slot->timer, index, session.options.seed, seconds,
                  pose.position_km, std::exchange(cut, false)});
  present.record(slot->commands, targets.displayed, swapchain.image(image), swapchain.view(image), size);
  panel.record(slot->commands, image);
  gpu::end_commands(slot->commands);
  return swapchain.end_frame(*slot, image);
}

Exit run_window(Session& session) {
  const VkExtent2D wanted =
      session.options.size_given || !session.device.candidate().software ? session.options.size : kSoftwareSize;
  Window window;
  open_window(window, fmt::format("Welkin {:02}: {}", session.chapter.number, session.chapter.title), wanted);
  Surface surface{session.instance};
  gpu::check(glfwCreateWindowSurface(session.instance, window.handle, nullptr, &surface.handle),
             "glfwCreateWindowSurface");
  Loop loop(session, window, surface.handle);
  fmt::print("window on {} ({}); F flies, H hides the panel, P saves a picture, T asks the truth, Esc quits\n",
             session.device.candidate().name, session.device.candidate().driver);
  std::fflush(stdout);

  // [loop]
  double last = glfwGetTime();
  for (uint32_t index = 0; glfwWindowShouldClose(window.handle) == GLFW_FALSE;) {
    glfwPollEvents();
    const VkExtent2D framebuffer = framebuffer_size(window.handle);
    if (framebuffer.width == 0 || framebuffer.height == 0) {  // minimised: nothing to draw into
      glfwWaitEventsTimeout(0.1);
      continue;
    }
    if (window.resized) loop.resize();
    loop.do_what_was_asked();
    const double now = glfwGetTime(), seconds = now - last;
    move_camera(window, loop.panel, loop.state, loop.pose, seconds, session.scene.planet.ground_radius_km);
    loop.play(seconds);
    last = now;
    if (!loop.draw(index, index == 0 ? 0.0 : seconds)) {
      window.resized = true;
      continue;
    }
    if (++index == session.options.frames) break;
  }
  // [/loop]
  for (const gpu::PassTime& pass : loop.state.times)
    fmt::print("  {:<20} {:>10.3f} ms\n", pass.name, pass.milliseconds);
  if (!session.options.output.empty()) fmt::print("wrote {}\n", loop.save(session.options.output));
  return Exit::ok;
}

// Initialised first and terminated last: it outlives the instance and everything made from it.
class GlfwWindowSystem : public app::WindowSystem {
 public:
  GlfwWindowSystem() {
    if (glfwInit() != GLFW_TRUE)
      fail("cannot open the display: {}; unset DISPLAY or use --headless to draw into a file", last_glfw_error());
    handle_display_loss();
    if (glfwVulkanSupported() != GLFW_TRUE)
      fail("the window library finds no Vulkan loader for windows ({}); use --headless", last_glfw_error());
  }
  ~GlfwWindowSystem() override { glfwTerminate(); }

  std::vector<const char*> vulkan_extensions() const override {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr) fail("this display offers no Vulkan surface ({}); use --headless", last_glfw_error());
    return {names, names + count};
  }

  Exit show(Session& session) override { return run_window(session); }
};

}  // namespace

std::unique_ptr<app::WindowSystem> open_window_system() { return std::make_unique<GlfwWindowSystem>(); }

}  // namespace welkin
