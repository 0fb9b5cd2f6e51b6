// The noise textures as effects. See noise.hpp and docs/chapters/16_noise.md.
#include "chapters/16_noise/noise.hpp"

#include <chrono>
#include <cstdio>

#include "chapters/16_noise/texture.hpp"
#include "chapters/16_noise/texture_cache.hpp"
#include "common/gpu/shader_file.hpp"

namespace welkin {
namespace {

// Where each texture of an effect came from, for --explain; by name.
using Stories = std::map<std::string, std::string>;

// Everything a texture's words follow from: the shaders that compute them, and the recipe.
uint64_t key_of(const TextureRecipe& recipe) {
  uint64_t key = checksum(recipe.text());
  for (const char* shader : {"fill", "extent_parts", "extent_whole", "average", "pack"}) {
    const std::vector<uint32_t> words = gpu::load_spirv(fmt::format("16_noise/{}.comp", shader));
    key = checksum({reinterpret_cast<const char*>(words.data()), 4 * words.size()}, key);
  }
  return key;
}

// [kept_or_made]
gpu::Image kept_or_made(const gpu::Device& device, const TextureRecipe& recipe, std::string& story) {
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed_ms = [&] {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  };
  const uint64_t key = key_of(recipe);
  std::string name = recipe.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  const std::filesystem::path file = cache_file(name, key);
  if (std::error_code none; !file.empty() && std::filesystem::exists(file, none)) {
    gpu::Buffer words = staging_for(device, recipe);
    const CacheRead read = read_cached(file, key, words.as<char>());
    if (read.found) {
      gpu::Image image = image_of(device, recipe, std::move(words));
      story = fmt::format("read in {:.1f} ms from {}", elapsed_ms(), file.string());
      return image;
    }
    fmt::print(stderr, "{}: {}; made anew\n", file.string(), read.fault);
  }
  TextureMaker maker(device, recipe, !file.empty());
  maker.run();
  const std::string unkept = write_cached(file, key, maker.words());
  story = fmt::format("made in {:.1f} ms, {:.1f} of them on the device; {}", elapsed_ms(), maker.milliseconds(),
                      unkept.empty() ? "kept in " + file.string() : "not kept: " + unkept);
  return maker.take_image();
}
// [/kept_or_made]

TexelFormat format_of(const Settings& settings) {
  const std::string& name = settings.choice("noise.format");
  return name == "8" ? TexelFormat::bits8 : name == "16" ? TexelFormat::bits16 : TexelFormat::half;
}

TextureRecipe recipe_of(const Settings& settings, const char* name, NoiseKind kind, const char* size, bool volume) {
  return {.name = name,
          .kind = kind,
          .side = static_cast<uint32_t>(std::stoi(settings.choice(size))),
          .volume = volume,
          .octaves = settings.integer("noise.octaves"),
          .seed = static_cast<uint32_t>(settings.integer("noise.seed") + 1000 * static_cast<int>(kind)),
          .format = format_of(settings)};
}

// [add_texture]
// A texture that is filled when a pass that is needed reads it. With noise.remake a pass of every frame makes it, to
// see what that costs.
graph::Resource add_texture(app::Builder& builder, const TextureRecipe& recipe,
                            const std::shared_ptr<Stories>& stories) {
  const gpu::Device& device = builder.context.device;
  check_filtered(device, recipe);
  if (builder.context.settings.choice("noise.remake") == "off")
    return builder.graph.add_filled(recipe.name, recipe.image_info(), [&device, recipe, stories] {
      return kept_or_made(device, recipe, (*stories)[recipe.name]);
    });
  const auto maker = std::make_shared<TextureMaker>(device, recipe, false);
  const graph::Resource image = builder.graph.import(recipe.name, &maker->image());
  graph::Pass pass{.name = recipe.name, .changed = [](const app::Frame&) { return true; }, .times_itself = true};
  pass.steps.push_back(
      {.accesses = {{image, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL}}},
       .record = [maker](const graph::Recorder& r) { maker->record(r.frame); }});
  builder.graph.add(std::move(pass));
  (*stories)[recipe.name] = "made in every frame (noise.remake)";
  return image;
}
// [/add_texture]

void explain_by(app::Builder& builder, const std::shared_ptr<Stories>& stories) {
  builder.explain = [stories] {
    std::string text;
    for (const auto& [name, story] : *stories) text += fmt::format("{}: {}\n", name, story);
    return text;
  };
}

Knob size_knob(const char* name, const char* meaning, std::vector<std::string> choices, double initial) {
  return {.name = name,
          .unit = "texels",
          .meaning = meaning,
          .initial = initial,
          .choices = std::move(choices),
          .rebuilds = true};
}

// What of the settings every texture was made for, in the key of effects whose knobs these are not.
std::string shared_key(const Settings& settings) {
  return fmt::format("{} {} {} {}", settings.text("noise.octaves"), settings.text("noise.format"),
                     settings.text("noise.seed"), settings.text("noise.remake"));
}

}  // namespace

// [knobs]
std::vector<Knob> noise_knobs() {
  std::vector<Knob> knobs = {
      size_knob("noise.base_size", "side of the volume that shapes clouds", {"32", "64", "128", "256"}, 2),
      size_knob("noise.detail_size", "side of the volume that erodes them", {"16", "32", "64", "128"}, 1),
      size_knob("noise.curl_size", "side of the map that stirs the detail", {"64", "128", "256"}, 1),
      {.name = "noise.octaves",
       .unit = "octaves",
       .meaning = "of fBm, each twice as fine and half as strong as the one before",
       .minimum = 1,
       .maximum = 6,
       .initial = 3,
       .integer = true,
       .ladder = {1, 3, 5},
       .rebuilds = true},
      {.name = "noise.format",
       .meaning = "bits of a number in the textures: 8, 16, or a half float",
       .initial = 0,
       .choices = {"8", "16", "half"},
       .ladder = {0, 1, 2},
       .rebuilds = true},
      {.name = "noise.seed",
       .meaning = "other noise, of the same kind",
       .minimum = 0,
       .maximum = 999,
       .initial = 0,
       .integer = true,
       .rebuilds = true},
      {.name = "noise.remake",
       .meaning = "textures are made in every frame, to see what they cost, and not kept on disk",
       .initial = 0,
       .choices = {"off", "on"},
       .rebuilds = true}};
  knobs.front().ladder = {0, 1, 2};
  return knobs;
}
// [/knobs]

// [effects]
app::Effect noise_textures() {
  app::Effect effect{.name = "noise textures", .chapter = 16, .knobs = noise_knobs()};
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const auto stories = std::make_shared<Stories>();
    const auto add = [&](const char* name, NoiseKind kind, const char* size, bool volume) {
      return add_texture(builder, recipe_of(builder.context.settings, name, kind, size, volume), stories);
    };
    board.offer(NoiseTextures{add("noise base", NoiseKind::base, "noise.base_size", true),
                              add("noise detail", NoiseKind::detail, "noise.detail_size", true),
                              add("noise curl", NoiseKind::curl, "noise.curl_size", false)});
    explain_by(builder, stories);
  };
  return effect;
}

app::Effect weather_texture() {
  app::Effect effect{.name = "weather texture", .chapter = 16};
  effect.knobs = {size_knob("weather.size", "side of the map of the weather", {"128", "256", "512", "1024"}, 2)};
  effect.key = [](const Scene&, const Settings& settings) { return shared_key(settings); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const auto stories = std::make_shared<Stories>();
    const TextureRecipe recipe =
        recipe_of(builder.context.settings, "weather", NoiseKind::weather, "weather.size", false);
    board.offer(WeatherTexture{add_texture(builder, recipe, stories)});
    explain_by(builder, stories);
  };
  return effect;
}

app::Effect alligator_texture() {
  app::Effect effect{.name = "alligator texture", .chapter = 16};
  effect.knobs = {size_knob("noise.alligator_size", "side of the volume of alligator noise", {"32", "64", "128"}, 1)};
  effect.key = [](const Scene&, const Settings& settings) { return shared_key(settings); };
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const auto stories = std::make_shared<Stories>();
    const TextureRecipe recipe =
        recipe_of(builder.context.settings, "alligator", NoiseKind::alligator, "noise.alligator_size", true);
    board.offer(AlligatorTexture{add_texture(builder, recipe, stories)});
    explain_by(builder, stories);
  };
  return effect;
}
// [/effects]

}  // namespace welkin
