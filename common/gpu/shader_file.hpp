// SPIR-V beside the program, and the compiler behind the reload key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace welkin::gpu {

// The directory with the compiled shaders: $WELKIN_SHADERS if set, else ../shaders seen from the running program.
std::filesystem::path shader_directory();

// Words of the SPIR-V of `name` ("05_single_scattering/image.comp"). Throws Error if missing or not SPIR-V.
std::vector<uint32_t> load_spirv(const std::string& name);

// Recompiles from the source tree the framework's shaders and those of chapters up to the given one. On success
// replaces the SPIR-V files and returns an empty string; on failure changes nothing and returns the compiler's message.
std::string recompile_shaders(int up_to_chapter);

// Root of the source tree this program was built from (scenes, goldens and shader sources live there).
std::filesystem::path source_directory();

}  // namespace welkin::gpu
