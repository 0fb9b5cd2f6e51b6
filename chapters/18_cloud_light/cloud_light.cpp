// The march as an effect, its knobs, and the bounds of grids. See cloud_light.hpp.
#include "chapters/18_cloud_light/cloud_light.hpp"

#include <algorithm>
#include <cstring>

#include "chapters/04_air/air_block.hpp"
#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"
#include "chapters/11_aerial_perspective/relief.hpp"
#include "chapters/17_cloud_shapes/grid_file.hpp"

namespace welkin {
namespace {

constexpr int kBoundCells = 4;  // of cloud_flight.glsl

struct LightPush {
  CloudLightPush march;
  glm::vec4 sunlight;
};

// [bounds]
// Largest density of kBoundCells^3 cells, the corners around them included. A grid's begin at half of its first slice
// in the texture of all grids (chapter 17).
struct Bounds {
  VkExtent3D size{1, 1, 2};  // a volume of one slice could not be told from a map
  std::vector<float> texels{0.0f, 0.0f};
};

void add_bounds(Bounds& bounds, const DensityGrid& grid, uint32_t first_slice) {
  const auto at = [&](int i, int j, int k) {
    return grid.density[(static_cast<size_t>(k) * grid.corners[1] + j) * grid.corners[0] + i];
  };
  const auto last = [&](int axis, int cell) { return std::min(kBoundCells * (cell + 1), grid.corners[axis] - 1); };
  const auto cells = [&](int axis) { return (grid.corners[axis] - 1 + kBoundCells - 1) / kBoundCells; };
  for (int z = 0; z < cells(2); ++z)
    for (int y = 0; y < cells(1); ++y)
      for (int x = 0; x < cells(0); ++x) {
        float most = 0.0f;
        for (int k = kBoundCells * z; k <= last(2, z); ++k)
          for (int j = kBoundCells * y; j <= last(1, y); ++j)
            for (int i = kBoundCells * x; i <= last(0, x); ++i) most = std::max(most, at(i, j, k));
        bounds.texels[((first_slice / 2 + z) * bounds.size.height + y) * bounds.size.width + x] = most;
      }
}

Bounds bounds_of(const std::vector<Cloud>& bodies) {
  std::vector<DensityGrid> grids;
  VkExtent3D size{0, 0, 0};
  for (const Cloud& cloud : bodies) {
    if (cloud.kind != "grid") continue;
    const DensityGrid& grid = grids.emplace_back(read_grid(cloud.file));
    size.width = std::max(size.width, static_cast<uint32_t>(grid.corners[0] + 2) / kBoundCells);
    size.height = std::max(size.height, static_cast<uint32_t>(grid.corners[1] + 2) / kBoundCells);
    size.depth += static_cast<uint32_t>(grid.corners[2]);
  }
  Bounds bounds;
  if (grids.empty()) return bounds;
  bounds.size = {size.width, size.height, size.depth / 2 + 1};
  bounds.texels.assign(size_t{bounds.size.width} * bounds.size.height * bounds.size.depth, 0.0f);
  uint32_t first_slice = 0;
  for (const DensityGrid& grid : grids) {
    add_bounds(bounds, grid, first_slice);
    first_slice += static_cast<uint32_t>(grid.corners[2]);
  }
  return bounds;
}
// [/bounds]

app::Wanted light_wanted(const Scene& scene) {
  const bool any = !bodies_of(scene).empty();
  return {any, any ? "clouds lit by the sun" : "no clouds"};
}

}  // namespace

// [knobs]
std::vector<Knob> cloud_light_knobs() {
  return {{.name = "cloud.method",
           .meaning = "the real-time march, or paths of every order",
           .choices = {"march", "paths"}},
          {.name = "cloud.orders",
           .meaning = "what stands in for scattering above the first order",
           .initial = 2,
           .choices = {"none", "octaves", "escape"},
           .ladder = {0, 1, 2}},
          {.name = "cloud.octaves",
           .meaning = "terms of cloud.orders=octaves",
           .minimum = 1,
           .maximum = 8,
           .initial = 4,
           .integer = true,
           .ladder = {1, 2, 4, 8}},
          {.name = "cloud.octave_a", .meaning = "share of the extinction that the next octave has", .initial = 0.5},
          {.name = "cloud.octave_b", .meaning = "of the contribution; not above cloud.octave_a", .initial = 0.5},
          {.name = "cloud.octave_c", .meaning = "of the anisotropy", .initial = 0.5},
          {.name = "cloud.powder", .meaning = "strength of the powder term; 0 leaves it out", .initial = 0.0},
          {.name = "cloud.ambient", .meaning = "light of sky and ground", .initial = 1, .choices = {"off", "on"}},
          {.name = "cloud.view_steps",
           .unit = "steps",
           .meaning = "along a ray through the hulls of all clouds",
           .minimum = 2,
           .maximum = 1024,
           .initial = 64,
           .integer = true,
           .ladder = {16, 32, 64, 128, 256}},
          {.name = "cloud.light_samples",
           .unit = "samples",
           .meaning = "towards the sun, in grids and noise",
           .minimum = 1,
           .maximum = 64,
           .initial = 6,
           .integer = true,
           .ladder = {2, 4, 6, 12, 24}},
          {.name = "cloud.escape_directions", .meaning = "of cloud.orders=escape", .initial = 1, .choices = {"2", "4"}},
          {.name = "cloud.escape_samples",
           .unit = "samples",
           .meaning = "in each of these directions",
           .minimum = 1,
           .maximum = 9,
           .initial = 3,
           .integer = true},
          {.name = "cloud.escape_refresh",
           .meaning = "reduced optical depth after which they are asked again",
           .minimum = 0,
           .maximum = 10,
           .initial = 0.2},
          {.name = "orders",
           .meaning = "of scattering: 0 all, 1 converged single scattering whatever the method; others with paths",
           .minimum = 0,
           .maximum = 1000,
           .integer = true},
          {.name = "probe.samples",
           .unit = "paths",
           .meaning = "a ray of --probe with cloud.method=paths",
           .minimum = 64,
           .maximum = 1e8,
           .initial = 4096,
           .integer = true}};
}

CloudLightPush cloud_light_push(const Settings& settings) {
  const auto number = [&](const char* name) { return static_cast<float>(settings.number(name)); };
  CloudLightPush push{.columns = cloud_march(settings),
                      .view_steps = settings.integer("cloud.view_steps"),
                      .light_samples = settings.integer("cloud.light_samples"),
                      .escape_directions = settings.choice("cloud.escape_directions") == "2" ? 2 : 4,
                      .escape_samples = settings.integer("cloud.escape_samples"),
                      .method = settings.integer("cloud.orders"),
                      .octaves = settings.integer("cloud.octaves"),
                      .ambient = settings.choice("cloud.ambient") == "on",
                      .unused = 0,
                      .octave_a = number("cloud.octave_a"),
                      .octave_b = number("cloud.octave_b"),
                      .octave_c = number("cloud.octave_c"),
                      .powder = number("cloud.powder"),
                      .sun = glm::vec4(0.0f, 0.0f, 1.0f, number("cloud.escape_refresh"))};
  if (settings.integer("orders") == 1) push.method = 0;
  return push;
}
// [/knobs]

// [effects]
app::Effect cloud_bounds() {
  app::Effect effect{.name = "cloud bounds", .chapter = 18};
  effect.wanted = [](const Scene& scene, const Settings&) { return light_wanted(scene); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const gpu::Device& device = builder.context.device;
    const Bounds bounds = bounds_of(board.get<CloudBodies>("clouds").bodies);
    gpu::Image image =
        gpu::create_image(device, "cloud bounds", {bounds.size.width, bounds.size.height}, VK_FORMAT_R32_SFLOAT,
                          VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, bounds.size.depth);
    const gpu::Buffer staging = gpu::create_buffer(device, "staging", bounds.texels.size() * sizeof(float),
                                                   VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::Where::upload);
    std::memcpy(staging.mapped, bounds.texels.data(), staging.bytes);
    const gpu::CommandPool pool = gpu::create_command_pool(device);
    gpu::run_once(device, pool, [&](VkCommandBuffer commands) {
      gpu::image_barrier(commands, image.handle, {}, gpu::kTransferWrite);
      const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = bounds.size};
      vkCmdCopyBufferToImage(commands, staging.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
      gpu::image_barrier(commands, image.handle, gpu::kTransferWrite, gpu::kSampledRead);
    });
    board.offer(CloudBounds{builder.graph.add_filled("cloud bounds", std::move(image))});
  };
  return effect;
}

app::Effect cloud_light() {
  app::Effect effect{.name = "cloud light", .chapter = 18, .knobs = cloud_light_knobs()};
  effect.wanted = [](const Scene& scene, const Settings&) { return light_wanted(scene); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const app::Context& context = builder.context;
    const graph::Resource before = board.get<app::Picture>("a sky").image;
    const graph::Resource after = builder.picture(board, "cloud light");
    const TerrainMaps* terrain = board.find<TerrainMaps>();
    const CloudBodies& bodies = board.get<CloudBodies>("clouds");
    const AirBlock& air = board.get<AirBlock>("the air");
    const MultipleScatteringTable* table = board.find<MultipleScatteringTable>();
    graph::Step step{
        .shader = "18_cloud_light/light.comp",
        .constants = joined(air.constants, {{"HAS_TERRAIN", terrain != nullptr}, {"HAS_AIR", table != nullptr}}),
        .bindings = {{"Air", air.block},
                     {"multiple_scattering_table", table != nullptr ? table->image : bodies.weather},
                     {"behind", before},
                     {"terrain_distance", terrain != nullptr ? terrain->distance : before},
                     {"cloud_bounds", board.get<CloudBounds>("cloud bounds").image},
                     {"target", after}}};
    step.constants =
        joined(step.constants,
               table != nullptr ? table->constants : gpu::Constants{{"MS_METHOD", 0}, {"MS_MAP", 0}, {"MS_SIZE", 1}});
    bind_clouds(step, bodies);
    step.record = [context, after](const graph::Recorder& r) {
      r.push(LightPush{cloud_light_push(context.settings), glm::vec4(context.scene.sun.irradiance, 0.0)});
      r.dispatch_over(r.graph.image(after).size);
    };
    graph::Pass pass{.name = "cloud light", .changed = [](const app::Frame&) { return true; }};
    pass.steps.push_back(std::move(step));
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/effects]

}  // namespace welkin
