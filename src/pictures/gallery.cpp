#include "pictures/gallery.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/color.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

constexpr const char* kColors[3] = {"R", "G", "B"};
constexpr const char* kAxes[3] = {"X", "Y", "Z"};
// Panels of figures of numbers, and single pictures of small maps, are brought to about this size.
constexpr int kSide = 512;

// A scale bar as wide as its picture, or wide enough to be read.
Grid<glm::vec3> with_bar(const Grid<glm::vec3>& shown, const ColorScale& scale) {
  const Grid<glm::vec3> bar = scale_bar(scale, std::max(shown.width, 256));
  const std::vector<Panel> row{{shown, ""}};
  return make_figure({&row, 1}, {&bar, 1});
}

}  // namespace

nlohmann::ordered_json& Gallery::record(const std::string& name, bool with_exr) {
  nlohmann::ordered_json entry{{"name", name}, {"files", nlohmann::ordered_json::array()}};
  if (with_exr) entry["files"].push_back(name + ".exr");
  entry["files"].push_back(name + ".png");
  pictures_.push_back(entry);
  return pictures_.back();
}

void Gallery::write_exr(const std::string& name, const Grid<glm::vec3>& values,
                        const char* const channels[3]) {
  std::array<Plane, 3> planes;
  for (int c = 0; c < 3; ++c) planes[static_cast<size_t>(c)] = {channels[c], &values.values[0][c], 3};
  write_image(folder_ / (name + ".exr"), values.width, values.height, planes, provenance_);
}

void Gallery::write_png(const std::string& name, const Grid<glm::vec3>& shown) {
  write_png8_rgb(folder_ / (name + ".png"), shown, provenance_);
}

void Gallery::add_light(const std::string& name, const Grid<glm::vec3>& linear, double exposure_ev) {
  Clipping clipping;
  const Grid<glm::vec3> shown = encode_srgb(linear, exposure_ev, clipping);
  write_exr(name, linear, kColors);
  write_png(name, shown);
  auto& entry = record(name, true);
  entry["exposure_ev"] = exposure_ev;
  entry["clipped_above_white"] = clipping.above_white;
  entry["clipped_below_black"] = clipping.below_black;
}

void Gallery::add_numbers(const std::string& name, const Grid<float>& values, const ColorScale& scale) {
  const Plane plane{"Y", values.values.data()};
  write_image(folder_ / (name + ".exr"), values.width, values.height, {&plane, 1}, provenance_);
  size_t clipped = 0;
  colored(values, scale, clipped);
  size_t clipped_shown = 0;
  write_png(name, with_bar(colored(scaled(values, kSide), scale, clipped_shown), scale));
  auto& entry = record(name, true);
  entry["scale"] = {{"low", scale.low}, {"high", scale.high}, {"of", scale.label}};
  entry["clipped"] = clipped;
}

void Gallery::add_numbers(const std::string& name, const Grid<glm::vec3>& values, const Grid<float>& shown,
                          const ColorScale& scale) {
  write_exr(name, values, kColors);
  size_t clipped = 0, clipped_shown = 0;
  colored(shown, scale, clipped);
  write_png(name, with_bar(colored(scaled(shown, kSide), scale, clipped_shown), scale));
  auto& entry = record(name, true);
  entry["scale"] = {{"low", scale.low}, {"high", scale.high}, {"of", scale.label}};
  entry["clipped"] = clipped;
}

void Gallery::add_values(const std::string& name, const Grid<float>& values) {
  const Plane plane{"Y", values.values.data()};
  write_image(folder_ / (name + ".exr"), values.width, values.height, {&plane, 1}, provenance_);
  Grid<glm::vec3> shown(values.width, values.height);
  size_t clipped = 0;
  for (size_t i = 0; i < shown.size(); ++i) {
    clipped += values[i] < 0 || values[i] > 1;
    shown[i] = glm::vec3(values[i]);
  }
  write_png(name, shown);
  auto& entry = record(name, true);
  entry["shown_as"] = "value 0..1 as it is, not sRGB-encoded";
  entry["clipped"] = clipped;
}

void Gallery::add_vectors(const std::string& name, const Grid<glm::vec3>& vectors,
                          const Grid<glm::vec3>& shown) {
  write_exr(name, vectors, kAxes);
  write_png(name, shown);
  record(name, true)["shown_as"] = "(v + 1)/2, green along the rows downwards";
}

void Gallery::add_figure(const std::string& name, std::span<const std::vector<Panel>> rows,
                         std::span<const Grid<glm::vec3>> below) {
  write_png(name, make_figure(rows, below));
  record(name, false);
}

void Gallery::report_missing(const std::string& name, const std::string& reason) {
  missing_.push_back({{"name", name}, {"reason", reason}});
}

nlohmann::ordered_json Gallery::json() const { return {{"pictures", pictures_}, {"missing", missing_}}; }

std::string Gallery::text() const {
  std::string text;
  for (const auto& picture : pictures_) {
    text += fmt::format("  {:18}", picture["name"].get<std::string>());
    if (picture.contains("exposure_ev"))
      text += fmt::format("exposure {:+.2f} EV, {} pixels above white, {} below black",
                          picture["exposure_ev"].get<double>(), picture["clipped_above_white"].get<size_t>(),
                          picture["clipped_below_black"].get<size_t>());
    if (picture.contains("scale"))
      text += fmt::format("{:.3g} to {:.3g}, {} pixels beyond: {}", picture["scale"]["low"].get<double>(),
                          picture["scale"]["high"].get<double>(), picture["clipped"].get<size_t>(),
                          picture["scale"]["of"].get<std::string>());
    text += '\n';
  }
  for (const auto& missing : missing_)
    text += fmt::format("  {:18}missing: {}\n", missing["name"].get<std::string>(),
                        missing["reason"].get<std::string>());
  return text;
}

}  // namespace hemibake
