// Bodies of cloud on the device. See clouds.hpp and docs/chapters/17_cloud_shapes.md.
#include "chapters/17_cloud_shapes/clouds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <span>

#include "chapters/11_aerial_perspective/relief.hpp"
#include "chapters/16_noise/noise.hpp"
#include "chapters/17_cloud_shapes/grid_file.hpp"
#include "common/image/png.hpp"
#include "common/scene/one_line.hpp"

namespace welkin {
namespace {

bool has_noise(const std::vector<Cloud>& bodies) { return (kinds_of(bodies) & interop::kCloudNoise) != 0; }

// The user's map, or "" where the weather is chapter 16's.
std::string painted_map(const std::vector<Cloud>& bodies) {
  for (const Cloud& cloud : bodies)
    if (cloud.kind == "noise" && cloud.weather != "procedural") return cloud.weather;
  return "";
}

// All grids in one texture, stacked along z: no filter reads across, because the outer samples of each lie at the
// centres of its outer texels.
struct StackedGrids {
  VkExtent3D size{0, 0, 0};
  std::vector<float> texels;
  bool as_bytes = false;
};

// Reads the files, and fills in what the block must know of them.
// [stack]
StackedGrids stack_grids(const std::vector<Cloud>& bodies, bool as_bytes, interop::CloudBlock& block) {
  std::vector<DensityGrid> grids;
  StackedGrids stack{.as_bytes = as_bytes};
  VkExtent3D& size = stack.size;
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].kind != "grid") continue;
    const DensityGrid& grid = grids.emplace_back(read_grid(bodies[i].file));
    interop::CloudBody& body = block.bodies[i];
    body.samples_x = grid.corners[0], body.samples_y = grid.corners[1], body.samples_z = grid.corners[2];
    body.first_slice = static_cast<int>(size.depth);
    body.largest_density = grid.largest;
    stack.as_bytes = stack.as_bytes && grid.largest <= 1.0f;
    size.width = std::max(size.width, static_cast<uint32_t>(grid.corners[0]));
    size.height = std::max(size.height, static_cast<uint32_t>(grid.corners[1]));
    size.depth += static_cast<uint32_t>(grid.corners[2]);
  }
  stack.texels.assign(size_t{size.width} * size.height * size.depth, 0.0f);
  size_t slice = 0;
  for (const DensityGrid& grid : grids)
    for (int k = 0; k < grid.corners[2]; ++k, ++slice)
      for (int j = 0; j < grid.corners[1]; ++j)
        std::copy_n(&grid.density[(static_cast<size_t>(k) * grid.corners[1] + j) * grid.corners[0]], grid.corners[0],
                    &stack.texels[(slice * size.height + j) * size.width]);
  return stack;
}
// [/stack]

gpu::Image upload_grids(const gpu::Device& device, const StackedGrids& stack) {
  const auto filled = [&](VkFormat format, std::span<const std::byte> texels) {
    return filled_image(device, "cloud grids", format, {stack.size.width, stack.size.height}, stack.size.depth, texels);
  };
  if (!stack.as_bytes) return filled(VK_FORMAT_R32_SFLOAT, std::as_bytes(std::span(stack.texels)));
  std::vector<uint8_t> bytes;
  for (const float density : stack.texels) bytes.push_back(static_cast<uint8_t>(std::lround(density * 255.0f)));
  return filled(VK_FORMAT_R8_UNORM, std::as_bytes(std::span(bytes)));
}

// When files were written, so that an edited one is read again.
std::string file_times(const std::vector<Cloud>& bodies) {
  std::string times;
  for (const Cloud& cloud : bodies)
    for (const std::string& file : {cloud.file, cloud.weather}) {
      if (file.empty() || file == "procedural") continue;
      std::error_code missing;
      const auto written = std::filesystem::last_write_time(file, missing);
      if (!missing) times += fmt::format("{} {} ", file, written.time_since_epoch().count());
    }
  return times;
}

app::Wanted clouds_wanted(const Scene& scene) {
  const size_t count = bodies_of(scene).size();
  if (count > 0) return {true, fmt::format("{} {} of cloud", count, count == 1 ? "body" : "bodies")};
  return {false, scene.weather ? "weather.preset is clear" : "no [[cloud]] and no [weather] in scene"};
}

std::string explain_bodies(const std::vector<Cloud>& bodies) {
  std::string text;
  for (const Cloud& cloud : bodies)
    text += fmt::format("cloud: {}{}{}, {} per km\n", cloud.kind, cloud.name.empty() ? "" : " ", cloud.name,
                        cloud.extinction_per_km);
  if (!has_noise(bodies)) text += "clouds: no body of noise, so no noise, weather or curl texture\n";
  return text;
}

}  // namespace

// [knobs]
std::vector<Knob> cloud_knobs() {
  return {{.name = "cloud.steps",
           .unit = "steps",
           .meaning = "of the march through noise, across a layer's thickness",
           .minimum = 2,
           .maximum = 1024,
           .initial = 32,
           .integer = true,
           .ladder = {8, 16, 32, 64}},
          {.name = "cloud.detail",
           .meaning = "of noise: its shape alone, eroded at the edges (cheap), or by curled detail (full)",
           .initial = 2,
           .choices = {"off", "cheap", "full"}},
          {.name = "cloud.grid",
           .meaning = "columns of a grid: exact, cell by cell, or marched through the sampler's filter",
           .initial = 1,
           .choices = {"exact", "march"}},
          {.name = "cloud.grid_steps",
           .unit = "steps",
           .meaning = "of cloud.grid=march, for the shortest edge of a cell; 4096 at most along a ray",
           .minimum = 1,
           .maximum = 16,
           .initial = 2,
           .integer = true},
          {.name = "cloud.grid_format",
           .meaning = "how samples are kept: float32, or bytes where all are 1 or less",
           .initial = 0,
           .choices = {"float", "bytes"},
           .rebuilds = true}};
}
// [/knobs]

CloudMarchPush cloud_march(const Settings& settings) {
  return {settings.integer("cloud.steps"), settings.integer("cloud.detail"), settings.integer("cloud.grid"),
          settings.integer("cloud.grid_steps")};
}

// [weather_map]
WeatherMap read_weather_map(const std::filesystem::path& file) {
  const std::string shown = one_line(file.string());
  const Image8 picture = image::read_png8(file);
  std::array<char, 26> head{};  // signature and IHDR, which end with the bits of a channel and the kind of colour
  std::ifstream(file, std::ios::binary).read(head.data(), head.size());
  const bool is_rgba8 = head[24] == 8 && head[25] == 6;
  if (!is_rgba8 || picture.width != picture.height || picture.width < 2 || picture.width > 4096)
    fail("weather map {}: {} x {} pixels{}; accepted is a square PNG of 2 to 4096 pixels a side, 8-bit RGBA", shown,
         picture.width, picture.height, is_rgba8 ? "" : ", not 8-bit RGBA");
  WeatherMap map{.size = static_cast<int>(picture.width)};
  for (size_t i = 0; i < picture.rgba.size(); i += 4)
    map.texels.push_back(glm::packHalf4x16(
        glm::vec4(picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2], picture.rgba[i + 3]) / 255.0f));
  return map;
}
// [/weather_map]

// [bind]
void bind_clouds(graph::Step& step, const CloudBodies& clouds) {
  const graph::Sampling around{.u = gpu::Border::repeat, .v = gpu::Border::repeat, .w = gpu::Border::repeat};
  step.constants = joined(step.constants, clouds.constants);
  step.bindings.insert(step.bindings.end(), {{"Clouds", clouds.block},
                                             {"cloud_grids", clouds.grids},
                                             {"weather_map", clouds.weather, around},
                                             {"noise_base", clouds.base, around},
                                             {"noise_detail", clouds.detail, around},
                                             {"noise_curl", clouds.curl, around}});
}
// [/bind]

// [clouds]
app::Effect clouds() {
  app::Effect effect{.name = "clouds", .chapter = 17, .knobs = cloud_knobs()};
  effect.wanted = [](const Scene& scene, const Settings&) { return clouds_wanted(scene); };
  effect.key = [](const Scene& scene, const Settings&) {
    const std::vector<Cloud> bodies = bodies_of(scene);
    const interop::CloudBlock block = make_cloud_block(bodies, scene.planet);
    return std::string(reinterpret_cast<const char*>(&block), sizeof block) + file_times(bodies);
  };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const gpu::Device& device = context.device;
    CloudBodies offered{.bodies = bodies_of(context.scene)};
    interop::CloudBlock block = make_cloud_block(offered.bodies, context.scene.planet);
    offered.kinds = kinds_of(offered.bodies), offered.ceiling_km = block.ceiling_km;
    offered.constants = {{"CLOUD_KINDS", offered.kinds}};
    const bool noise = has_noise(offered.bodies), grid = (offered.kinds & interop::kCloudGrid) != 0;
    // Made when a pass reads it. A texel where nothing is; a volume of one slice could not be told from a map.
    const auto add = [&](const char* name, std::shared_ptr<StackedGrids> stack) {
      const graph::ImageInfo info{.size = {stack->size.width, stack->size.height}, .depth = stack->size.depth};
      return builder.graph.add_filled(name, info, [&device, stack] { return upload_grids(device, *stack); });
    };
    const StackedGrids empty{.size = {1, 1, 2}, .texels = {0.0f, 0.0f}};
    const bool as_bytes = context.settings.choice("cloud.grid_format") == "bytes";
    offered.grids = add(grid ? "cloud grids" : "no grids",
                        std::make_shared<StackedGrids>(grid ? stack_grids(offered.bodies, as_bytes, block) : empty));
    const graph::Resource no_volume = noise ? 0 : add("no volume", std::make_shared<StackedGrids>(empty));
    const float nothing = 0.0f;
    const graph::Resource no_map =
        noise ? 0
              : builder.graph.add_filled("no map", filled_image(device, "no map", VK_FORMAT_R32_SFLOAT, {1, 1}, 0,
                                                                std::as_bytes(std::span(&nothing, 1))));
    const NoiseTextures none{no_volume, no_volume, no_map};
    const NoiseTextures& textures = noise ? board.get<NoiseTextures>("noise textures") : none;
    offered.base = textures.base, offered.detail = textures.detail, offered.curl = textures.curl;
    const std::string painted = painted_map(offered.bodies);
    if (!noise) {
      offered.weather = no_map;
    } else if (painted.empty()) {
      offered.weather = board.get<WeatherTexture>("a weather map").map;
    } else {
      const WeatherMap map = read_weather_map(painted);
      const uint32_t side = static_cast<uint32_t>(map.size);
      offered.weather =
          builder.graph.add_filled("weather map", filled_image(device, "weather map", VK_FORMAT_R16G16B16A16_SFLOAT,
                                                               {side, side}, 0, std::as_bytes(std::span(map.texels))));
    }
    gpu::Buffer buffer = gpu::create_buffer(device, "cloud bodies", sizeof block, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                                            gpu::Where::upload);
    std::memcpy(buffer.mapped, &block, sizeof block);
    offered.block = builder.graph.add_filled("cloud bodies", std::move(buffer));
    builder.explain = [bodies = offered.bodies] { return explain_bodies(bodies); };
    board.offer(std::move(offered));
  };
  return effect;
}
// [/clouds]

}  // namespace welkin
