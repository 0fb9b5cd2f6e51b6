// The comparison report. See compare.hpp.
#include "common/measure/compare.hpp"

#include <glm/common.hpp>
#include <string_view>

#include "common/error.hpp"
#include "common/image/atomic_file.hpp"
#include "common/image/display.hpp"
#include "common/image/png.hpp"
#include "common/measure/metrics.hpp"

namespace welkin::measure {
namespace {

bool finite(const glm::vec4& p) { return std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b); }

// Largest channel difference of display values, 0..1; NaN where a pixel is not finite.
float difference(const glm::vec4& a, const glm::vec4& b, float exposure) {
  if (!finite(a) || !finite(b)) return std::nanf("");
  const glm::vec3 d = glm::abs(image::display(glm::vec3(a), exposure) - image::display(glm::vec3(b), exposure));
  return std::max({d.r, d.g, d.b});
}

void check_sizes(const Image& a, const Image& b, const char* what) {
  if (a.width != b.width || a.height != b.height || a.pixels.size() != b.pixels.size())
    throw Error(Exit::mismatch, fmt::format("{}: {}x{} against {}x{}", what, a.width, a.height, b.width, b.height));
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

// Names come from files and command lines: nothing in them is markup.
std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (std::string_view("&<>\"|*`[]\\\r\n").find(c) == text.npos)
      out += c;
    else
      out += fmt::format("&#{};", static_cast<int>(c));
  return out;
}

using Rows = std::vector<std::vector<std::string>>;  // the first is the heading

std::string table(const Rows& rows) {  // Markdown takes HTML's tables as they are
  std::string out = "<table>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (const std::string& cell : row) out += "<td>" + escape(cell) + "</td>";
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

std::vector<std::string> error_row(const std::string& name, const Errors& e) {
  if (!e.finite())
    return {name, fmt::format("{} values not finite", e.not_finite + e.not_finite_reference), "", "", "", ""};
  std::vector<std::string> row = {name};
  for (const double v : {e.relative_rmse, e.p99_relative, e.max_relative, e.mean_bias, e.rmse_255})
    row.push_back(fmt::format("{:.3g}", v));
  return row;
}

}  // namespace

float choose_exposure(const Image& picture) {
  std::vector<double> largest;
  for (const glm::vec4& p : picture.pixels)
    if (finite(p)) largest.push_back(std::max({p.r, p.g, p.b}));
  const double high = percentile(std::move(largest), 0.99);
  return high > 1e-30 ? static_cast<float>(2.3 / high) : 1.0f;
}

std::array<uint8_t, 3> scale_colour(float value) {
  static constexpr uint8_t stops[9][3] = {{68, 1, 84},    {71, 44, 122}, {59, 81, 139},  {44, 113, 142}, {33, 144, 141},
                                          {39, 173, 129}, {92, 200, 99}, {170, 220, 50}, {253, 231, 37}};  // viridis
  const float at = std::clamp(value, 0.0f, 1.0f) * 8.0f;
  const int below = std::min(static_cast<int>(at), 7);
  std::array<uint8_t, 3> out;
  for (size_t c = 0; c < 3; ++c)
    out[c] = image::quantise(
        (stops[below][c] + (at - static_cast<float>(below)) * (stops[below + 1][c] - stops[below][c])) / 255.0f);
  return out;
}

float choose_gain(const Image& a, const Image& b, float exposure) {
  std::vector<double> differences;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    if (const float d = difference(a.pixels[i], b.pixels[i], exposure); !std::isnan(d)) differences.push_back(d);
  const double high = percentile(std::move(differences), 0.99);
  for (const float gain : {1000.0f, 500.0f, 200.0f, 100.0f, 50.0f, 20.0f, 10.0f, 5.0f, 2.0f})
    if (high * gain <= 1.0) return gain;
  return 1.0f;
}

Image8 side_by_side(const Image& a, const Image& b, float exposure, float gain) {
  check_sizes(a, b, "pictures of different sizes");
  constexpr size_t kGap = 4;  // white pixels between the three
  const size_t width = a.width, wide = 3 * width + 2 * kGap;
  Image8 out{static_cast<uint32_t>(wide), a.height, std::vector<uint8_t>(wide * a.height * 4, 255)};
  const Image8 shown[] = {image::to_display(a, exposure), image::to_display(b, exposure)};
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const size_t at = (i / width * wide + i % width) * 4;
    for (size_t side = 0; side < 2; ++side)
      std::copy_n(&shown[side].rgba[i * 4], 4, &out.rgba[at + side * (width + kGap) * 4]);
    const float d = difference(a.pixels[i], b.pixels[i], exposure);
    const auto colour = std::isnan(d) ? std::array<uint8_t, 3>{255, 0, 255} : scale_colour(d * gain);
    std::copy_n(colour.data(), 3, &out.rgba[at + 2 * (width + kGap) * 4]);
  }
  return out;
}

void write_comparison(const std::filesystem::path& prefix, const std::string& title, const Side& a, const Side& b,
                      const std::optional<Image>& truth) {
  check_sizes(a.picture, b.picture, "pictures of different sizes cannot be compared");
  if (truth) check_sizes(a.picture, *truth, "the truth is of another size than the pictures");
  const float exposure = choose_exposure(truth ? *truth : a.picture);
  const float gain = choose_gain(a.picture, b.picture, exposure);
  const auto display = [&](const glm::vec3& radiance) { return image::display(radiance, exposure); };

  Rows errors = {{"error", "relative RMSE", "99 % below", "maximum", "bias", "RMSE 0-255"}};
  for (const Side* side : {&a, &b})
    if (truth) errors.push_back(error_row(side->name + " against the truth", compare(side->picture, *truth, display)));
  errors.push_back(error_row(b.name + " against " + a.name, compare(b.picture, a.picture, display)));
  Rows cost = {{"time and memory", "pass", "median ms", "min", "max", "bytes held"}};
  std::string devices;
  for (const Side* side : {&a, &b}) {
    const BenchResult& bench = side->bench;
    devices += fmt::format("{} ran on {}, {}{}, at {}x{}. ", side->name, bench.device, bench.driver,
                           bench.software ? " (software driver: its times say nothing about a GPU)" : "", bench.width,
                           bench.height);
    std::vector<PassTime> lines = bench.passes;
    lines.push_back({"wall time", bench.wall_ms});
    for (const auto& [pass, ms] : lines)
      cost.push_back({side->name, pass, fmt::format("{:.3f}", ms.median), fmt::format("{:.3f}", ms.minimum),
                      fmt::format("{:.3f}", ms.maximum), human_bytes(bench.bytes)});
  }
  const std::string legend = fmt::format(
      "Left {}, middle {}, right the largest channel difference of their display values times {:g} (dark violet: none; "
      "yellow: {:.3g} of full range, or more; magenta: not finite). Display: sRGB of 1 - exp(-{:.4g} L), the exposure "
      "chosen from {}.",
      a.name, b.name, gain, 1.0f / gain, exposure, truth ? "the truth" : a.name);

  const std::string base = prefix.string(), heading = escape(title);
  const std::string png = image::encode_png8(side_by_side(a.picture, b.picture, exposure, gain), {{"Title", title}});
  const std::string text =
      fmt::format("<p>{}</p>\n{}<p>{}</p>\n{}", escape(legend), table(errors), escape(devices), table(cost));
  const std::string markdown =
      fmt::format("# {}\n\n![{}]({}.png)\n\n{}", heading, heading, prefix.filename().string(), text);
  const std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>body{{font:16px sans-serif;color:#111;background:#fff;max-width:80em;margin:1em auto}}img{{width:100%}}"
      "table{{border-collapse:collapse}}td{{border:1px solid #999;padding:.2em .6em}}"
      "tr:first-child{{font-weight:bold}}</style></head>\n<body><h1>{0}</h1>\n"
      "<img alt=\"{0}\" src=\"data:image/png;base64,{1}\">\n{2}</body></html>\n",
      heading, base64(png), text);
  for (const auto& [ending, contents] : {std::pair{".png", png}, {".md", markdown}, {".html", html}})
    write_file_atomically(base + ending, contents);
}

}  // namespace welkin::measure
