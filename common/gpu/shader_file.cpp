// Finding, checking and recompiling shaders. See shader_file.hpp.
#include "common/gpu/shader_file.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include "common/error.hpp"

namespace welkin::gpu {
namespace fs = std::filesystem;

fs::path shader_directory() {
  if (const char* chosen = std::getenv("WELKIN_SHADERS"); chosen != nullptr && *chosen != '\0') return chosen;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error)
    fail("cannot tell where this program lies ({}): set WELKIN_SHADERS to the compiled shaders", error.message());
  return program.parent_path().parent_path() / "shaders";
}

fs::path source_directory() {
  // A build carried to another place still finds its data beside it.
  if (const char* chosen = std::getenv("WELKIN_SOURCE"); chosen != nullptr && *chosen != '\0') return chosen;
  return WELKIN_SOURCE_DIRECTORY;
}

std::vector<uint32_t> load_spirv(const std::string& name) {
  const fs::path path = shader_directory() / (name + ".spv");
  std::ifstream file(path, std::ios::binary);
  if (!file || fs::is_directory(path))
    fail("shader {}: cannot be read; build the chapter first (./welkin run builds it)", path.string());
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::vector<uint32_t> words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), 4 * words.size());
  if (words.size() < 5 || words[0] != 0x07230203u || bytes.size() % 4 != 0)
    fail("shader {}: not SPIR-V; delete it and build again", path.string());
  return words;
}

std::string recompile_shaders(int up_to_chapter) {
  const fs::path sources = source_directory() / "shaders";
  std::vector<std::pair<fs::path, fs::path>> finished;
  std::error_code ignored;
  const auto discard = [&] {
    for (const auto& [fresh, target] : finished) fs::remove(fresh, ignored);
  };
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(sources, ignored)) {
    const std::string extension = entry.path().extension();
    if (extension != ".comp" && extension != ".vert" && extension != ".frag") continue;
    const fs::path name = fs::relative(entry.path(), sources);
    if (std::atoi(name.c_str()) > up_to_chapter) continue;  // a folder without a number is the framework's
    const fs::path target = shader_directory() / (name.string() + ".spv");
    const fs::path fresh = target.string() + ".new";
    const std::string command =
        fmt::format("glslangValidator -V --target-env vulkan1.2 --quiet -I'{}' -o '{}' '{}' 2>&1", sources.string(),
                    fresh.string(), entry.path().string());
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return discard(), "cannot start glslangValidator";
    std::string message;
    for (std::array<char, 512> part; std::fgets(part.data(), part.size(), pipe) != nullptr;) message += part.data();
    finished.emplace_back(fresh, target);
    if (pclose(pipe) != 0) return discard(), message.empty() ? "glslangValidator failed" : message;
  }
  for (const auto& [fresh, target] : finished) {
    std::error_code error;
    fs::rename(fresh, target, error);
    if (error) return discard(), fmt::format("cannot write {}: {}", target.string(), error.message());
  }
  return {};
}

}  // namespace welkin::gpu
