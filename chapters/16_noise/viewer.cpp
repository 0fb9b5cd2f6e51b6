// The viewer of noise textures. See viewer.hpp and docs/chapters/16_noise.md.
#include "chapters/16_noise/viewer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "chapters/16_noise/noise.hpp"

namespace welkin {
namespace {

constexpr uint32_t kRowsApart = 64;  // as in histogram.glsl
constexpr int kColor = 4;            // channel: the first three as colours

struct ViewPush {
  int32_t x, y, width, height;
  int32_t channel;
  float tiles, slice, mip;
  int32_t is_signed, histogram;
};

struct Texture {
  std::string name;
  graph::Resource resource;
  bool volume, is_signed;
};

// A rectangle of the picture: in sixteenths of its width and ninths of its height.
struct Place {
  float x = 0.0f, y = 0.0f, width = 16.0f, height = 9.0f;
};

// What is shown there.
struct Shown {
  Texture texture;
  int channel;
  float tiles, slice;
  int mip;  // below 0: the one whose texels are about as large as pixels
  Place place;
  bool deck = false;  // as a body, where its numbers exceed `slice`
};

// The pixels of a place.
ViewPush push_of(const Place& place, VkExtent2D size) {
  const auto at = [](float share, float of, uint32_t pixels) {
    return static_cast<int32_t>(std::lround(share / of * static_cast<float>(pixels)));
  };
  ViewPush push{.x = at(place.x, 16.0f, size.width), .y = at(place.y, 9.0f, size.height)};
  push.width = at(place.x + place.width, 16.0f, size.width) - push.x;
  push.height = at(place.y + place.height, 9.0f, size.height) - push.y;
  return push;
}

void draw(const graph::Recorder& r, const ViewPush& push) {
  r.push(push).dispatch_over({static_cast<uint32_t>(push.width), static_cast<uint32_t>(push.height)});
}

graph::Step step_of(const Shown& shown, graph::Resource picture) {
  constexpr gpu::Border around = gpu::Border::repeat;
  return {.shader = shown.deck             ? "16_noise/view_deck.comp"
                    : shown.texture.volume ? "16_noise/view_volume.comp"
                                           : "16_noise/view_map.comp",
          .bindings = {{"noise", shown.texture.resource, {.u = around, .v = around, .w = around}}, {"target", picture}},
          .record = [shown, picture](const graph::Recorder& r) {
            ViewPush push = push_of(shown.place, r.graph.image(picture).size);
            push.channel = shown.channel, push.tiles = shown.tiles, push.slice = shown.slice;
            push.is_signed = shown.texture.is_signed ? 1 : 0;
            const float texels = static_cast<float>(r.graph.image(shown.texture.resource).size.width) * shown.tiles;
            push.mip = shown.mip >= 0
                           ? static_cast<float>(shown.mip)
                           : std::max(0.0f, std::log2(texels / static_cast<float>(std::max(push.height, 1))));
            draw(r, push);
          }};
}

// Everything at once: the shape of clouds large, beside it twelve squares.
std::vector<Shown> sheet(const std::vector<Texture>& textures, float slice) {
  const Texture &base = textures[0], &detail = textures[1], &curl = textures[2], &weather = textures[3],
                &alligator = textures[4];
  std::vector<Shown> all = {{base, 0, 1.0f, slice, -1, {0.0f, 0.0f, 9.25f, 9.0f}}};
  const std::vector<std::pair<Texture, int>> squares = {
      {base, 1},      {base, 2},    {base, 3},         {detail, 0},    {detail, 1},    {detail, 2},
      {curl, kColor}, {weather, 0}, {weather, kColor}, {alligator, 0}, {alligator, 1}, {alligator, 3}};
  for (size_t i = 0; i < squares.size(); ++i)
    all.push_back({squares[i].first,
                   squares[i].second,
                   1.0f,
                   slice,
                   -1,
                   {9.25f + 2.25f * static_cast<float>(i % 3), 2.25f * static_cast<float>(i / 3), 2.25f, 2.25f}});
  return all;
}

}  // namespace

// [knobs]
std::vector<Knob> viewer_knobs() {
  return {{.name = "noise.show",
           .meaning = "a texture, all of them on one sheet, or the base as a deck of lumps",
           .initial = 0,
           .choices = {"all", "base", "detail", "curl", "weather", "alligator", "deck"},
           .rebuilds = true},
          {.name = "noise.channel",
           .meaning = "one of its numbers in grey, or three as colours",
           .initial = 0,
           .choices = {"r", "g", "b", "a", "rgb"},
           .rebuilds = true},
          {.name = "noise.slice",
           .meaning = "height of the slice through a volume",
           .minimum = 0,
           .maximum = 1,
           .initial = 0.25,
           .rebuilds = true},
          {.name = "noise.tiles",
           .meaning = "textures that fit into the picture's height",
           .minimum = 0.125,
           .maximum = 16,
           .initial = 1,
           .rebuilds = true},
          {.name = "noise.level",
           .meaning = "the number above which there is a lump, at the deck's foot",
           .minimum = 0,
           .maximum = 1,
           .initial = 0.36,
           .rebuilds = true},
          {.name = "noise.histogram",
           .meaning = "of the channel, below the texture",
           .initial = 0,
           .choices = {"off", "on"},
           .rebuilds = true},
          {.name = "noise.mip",
           .meaning = "which mip; -1: the one whose texels are as large as pixels",
           .minimum = -1,
           .maximum = 10,
           .initial = -1,
           .integer = true,
           .rebuilds = true}};
}
// [/knobs]

// [histogram]
// Counts a channel of the texture when that is new, and draws the counts into a place of the picture.
static graph::Resource add_histogram(app::Builder& builder, const Shown& shown) {
  const graph::Resource bins = builder.graph.add_buffer("noise histogram", {.bytes = 256 * sizeof(uint32_t)});
  graph::Pass pass{.name = "noise histogram"};
  pass.steps.push_back({.accesses = {{bins, gpu::kUpdate}}, .record = [bins](const graph::Recorder& r) {
                          vkCmdFillBuffer(r.frame.commands, r.graph.buffer(bins).handle, 0, VK_WHOLE_SIZE, 0);
                        }});
  pass.steps.push_back(
      {.shader = shown.texture.volume ? "16_noise/histogram_volume.comp" : "16_noise/histogram_map.comp",
       .bindings = {{"noise", shown.texture.resource}, {"Histogram", bins}},
       .record = [shown](const graph::Recorder& r) {
         r.push(std::array<int32_t, 2>{shown.channel, shown.texture.is_signed ? 1 : 0});
         r.dispatch(kRowsApart);
       }});
  builder.graph.add(std::move(pass));
  return bins;
}

static graph::Step histogram_step(const Shown& shown, graph::Resource bins, graph::Resource picture, Place place) {
  return {.shader = "16_noise/view_histogram.comp",
          .bindings = {{"Histogram", bins}, {"target", picture}},
          .record = [=](const graph::Recorder& r) {
            ViewPush push = push_of(place, r.graph.image(picture).size);
            const gpu::Image& image = r.graph.image(shown.texture.resource);
            const uint32_t texels = image.size.width * image.size.height * image.depth;
            push.histogram = static_cast<int32_t>(texels * (shown.channel == kColor ? 3 : 1));
            draw(r, push);
          }};
}
// [/histogram]

// [viewer]
app::Effect noise_viewer() {
  app::Effect effect{.name = "noise viewer", .chapter = 16, .knobs = viewer_knobs()};
  effect.declare = [](app::Builder& builder, app::Board& board) {
    const Settings& settings = builder.context.settings;
    const NoiseTextures& noise = board.get<NoiseTextures>("noise textures");
    const std::vector<Texture> textures = {
        {"base", noise.base, true, false},
        {"detail", noise.detail, true, false},
        {"curl", noise.curl, false, true},
        {"weather", board.get<WeatherTexture>("a weather texture").map, false, false},
        {"alligator", board.get<AlligatorTexture>("an alligator texture").volume, true, false}};
    const std::string& name = settings.choice("noise.show");
    const float slice = static_cast<float>(settings.number("noise.slice"));
    std::vector<Shown> shown = sheet(textures, slice);
    if (name == "deck") {
      const float level = static_cast<float>(settings.number("noise.level"));
      shown = {{textures[0], static_cast<int>(settings.number("noise.channel")), 1.0f, level, 0, {}, true}};
    } else if (name != "all") {
      const auto texture =
          std::find_if(textures.begin(), textures.end(), [&](const Texture& t) { return t.name == name; });
      shown = {{*texture,
                static_cast<int>(settings.number("noise.channel")),
                static_cast<float>(settings.number("noise.tiles")),
                slice,
                settings.integer("noise.mip"),
                {}}};
    }
    const graph::Resource picture = builder.picture(board, "noise viewer");
    graph::Pass pass{.name = "noise viewer", .changed = [](const app::Frame&) { return true; }};
    if (settings.choice("noise.histogram") == "on" && shown.size() == 1 && !shown[0].deck) {
      constexpr Place below{0.0f, 7.0f, 16.0f, 2.0f};
      shown[0].place.height = below.y;
      pass.steps.push_back(histogram_step(shown[0], add_histogram(builder, shown[0]), picture, below));
    }
    for (const Shown& one : shown) pass.steps.push_back(step_of(one, picture));
    builder.graph.add(std::move(pass));
  };
  return effect;
}
// [/viewer]

}  // namespace welkin
