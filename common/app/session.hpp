// One run of a chapter: the scene as set, the settings, the device, the program; and what each mode does with them.
#pragma once

#include <filesystem>
#include <memory>

#include "common/app/options.hpp"
#include "common/app/renderer.hpp"

namespace welkin::app {

struct Session {
  const Chapter& chapter;
  const Options& options;
  Scene& scene;
  Settings& settings;
  gpu::Instance& instance;
  gpu::Device& device;
  Context context;

  std::unique_ptr<Program> make_program() const { return app::make_program(chapter, context); }
  CameraPose first_pose() const { return pose_of(scene.view(options.view)); }
};

std::filesystem::path scenes_directory();

// Scene by name or file with its [settings], then --set, all checked. Fills settings with the chapter's knobs and the
// scene's, and applies the scene's knobs to the scene.
void load_scene_and_settings(const Chapter& chapter, const std::string& scene_name,
                             const std::vector<std::pair<std::string, std::string>>& set, Scene& scene,
                             Settings& settings);

// The scene with the camera and every explicit setting, as the text a screenshot carries.
std::string restoring_text(const Session& session, const CameraPose& pose);

// Writes the picture where --output says: .exr linear, .png displayed and restoring.
void write_output(const Session& session, const std::string& file, const CameraPose& pose, const Image& picture,
                  const Image8& displayed);

// A view as the chapter's truth shows it; the chapter has one. Without its display pass, whatever that is.
Image draw_truth(const Session& session, const CameraPose& pose, VkExtent2D size, uint32_t seed);

// Modes; each returns the program's exit code (before validation messages are looked at).
Exit run_picture(const Session& session);  // headless
Exit run_bench(const Session& session);
Exit run_sweep(const Session& session);
Exit run_probe(const Session& session);
Exit run_golden(const Session& session);

}  // namespace welkin::app
