// One run of a chapter: the scene as set, the settings, the device, the program; and what each mode does with them.
#pragma once

#include <filesystem>
#include <memory>

#include "common/app/options.hpp"
#include "common/app/renderer.hpp"

namespace welkin::app {

// A frame to draw: the camera, the scene's time, and the seconds since the frame before.
struct Shot {
  CameraPose pose;
  double time_s;
  double seconds;
};

struct Session {
  const Chapter& chapter;
  const Options& options;
  Scene& scene;
  Settings& settings;
  gpu::Instance& instance;
  gpu::Device& device;
  Context context;

  std::unique_ptr<Program> make_program() const { return app::make_program(chapter, context); }
  CameraPose first_pose() const { return shot(0).pose; }
  // Frame `index` of what is asked for: of a view, all alike; of a path, frame_count() of them over its times.
  Shot shot(uint32_t index) const;
  uint32_t frame_count() const;  // --frames, else 1, or 24 a second of a path
};

// Another scene and settings in a session of the same device. A program made of it can follow it to further scenes:
// what it compiled for one serves the next.
struct OtherScene {
  Scene scene;
  Settings settings;
  Options options;
  Session session;
  explicit OtherScene(const Session& from);
  OtherScene(const OtherScene&) = delete;
  void load(const StandardView& view);
};

// "noon/horizon", or with frame and frames of a path.
std::string name_of(const StandardView& view, char between);

std::filesystem::path scenes_directory();
std::vector<std::string> shipped_scenes();  // their names, in the order of the alphabet

// Scene by name or file with its [settings], then --set and --time, all checked. Fills settings with the chapter's
// knobs and the scene's, and applies the scene's knobs to the scene.
void load_scene_and_settings(const Chapter& chapter, const std::string& scene_name,
                             const std::vector<std::pair<std::string, std::string>>& set, std::optional<double> time_s,
                             Scene& scene, Settings& settings);

// The scene with the camera and every explicit setting, as the text that a screenshot in `directory` carries: read
// back, it is the same scene. Throws Error if it is not.
std::string restoring_text(const Session& session, const CameraPose& pose, const std::filesystem::path& directory);

// Writes the picture where --output says: .exr linear, .png displayed and restoring.
void write_output(const Session& session, const std::string& file, const CameraPose& pose, const Image& picture,
                  const Image8& displayed);

// Draws frame `index` of what is asked for; the scene's time is that frame's.
void draw_frame(const Session& session, Renderer& renderer, uint32_t index);

// A frame of a path, after those before it, which it may remember.
void draw_up_to(const Session& session, Renderer& renderer, uint32_t frame);

size_t count_not_finite(const Image& picture);  // pixels with a NaN or an infinity

// Throws Error if the chapter has no standard views.
void must_have_standard_views(const Session& session);

// A view as the chapter's truth shows it; the chapter has one. Without its display pass, whatever that is.
Image draw_truth(const Session& session, const CameraPose& pose, VkExtent2D size, uint32_t seed);

// Modes; each returns the program's exit code (before validation messages are looked at).
Exit run_picture(const Session& session);  // headless
Exit run_bench(const Session& session);
Exit run_sweep(const Session& session);
Exit run_probe(const Session& session);
Exit run_golden(const Session& session);
Exit run_survey(const Session& session);

}  // namespace welkin::app
