#include "pictures/gallery.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "io/image_io.h"

namespace hemibake {
namespace {

constexpr const char* kColors[3] = {"R", "G", "B"};
constexpr const char* kAxes[3] = {"X", "Y", "Z"};
// Side of a picture of numbers, pixels.
constexpr int kSide = 512;

// Puts a scale bar under a picture, as wide as it or wide enough to be read.
Grid<glm::vec3> with_bar(const Grid<glm::vec3>& shown, const ColorScale& scale) {
  const Grid<glm::vec3> bar = scale_bar(scale, std::max(shown.width, 256));
  const std::vector<Panel> row{{shown, ""}};
  return make_figure({&row, 1}, {&bar, 1});
}

}  // namespace

PictureRecord& Gallery::record(const std::string& name, bool has_exr) {
  PictureRecord& picture = pictures_.emplace_back();
  picture.name = name;
  picture.has_exr = has_exr;
  return picture;
}

OutputFile& Gallery::add_file(const std::string& name) {
  written_.push_back(&files_.add(folder_ / name));
  return *written_.back();
}

void Gallery::write_exr(const std::string& name, const Grid<float>& values) {
  const Plane plane{"Y", values.values.data()};
  write_image(add_file(name + ".exr"), values.width, values.height, {&plane, 1}, provenance_);
}

void Gallery::write_exr(const std::string& name, const Grid<glm::vec3>& values,
                        const char* const channels[3]) {
  std::array<Plane, 3> planes;
  for (int c = 0; c < 3; ++c) planes[static_cast<size_t>(c)] = {channels[c], &values.values[0][c], 3};
  write_image(add_file(name + ".exr"), values.width, values.height, planes, provenance_);
}

void Gallery::write_png(const std::string& name, const Grid<glm::vec3>& shown) {
  write_png8_rgb(add_file(name + ".png"), shown, provenance_);
}

void Gallery::add_light(const std::string& name, const Grid<glm::vec3>& linear, double exposure_ev) {
  PictureRecord& picture = record(name, true);
  picture.exposure_ev = exposure_ev;
  write_exr(name, linear, kColors);
  write_png(name, encode_srgb(linear, exposure_ev, picture.clipping));
}

void Gallery::show_numbers(const std::string& name, const Grid<float>& shown, const ColorScale& scale) {
  size_t clipped = 0, clipped_shown = 0;
  colored(shown, scale, clipped);
  write_png(name, with_bar(colored(scaled(shown, kSide), scale, clipped_shown), scale));
  PictureRecord& picture = record(name, true);
  picture.scale = scale;
  picture.clipped = clipped;
}

void Gallery::add_numbers(const std::string& name, const Grid<float>& values, const ColorScale& scale) {
  write_exr(name, values);
  show_numbers(name, values, scale);
}

void Gallery::add_numbers(const std::string& name, const Grid<glm::vec3>& values, const Grid<float>& shown,
                          const ColorScale& scale) {
  write_exr(name, values, kColors);
  show_numbers(name, shown, scale);
}

void Gallery::add_values(const std::string& name, const Grid<float>& values) {
  write_exr(name, values);
  Grid<glm::vec3> shown(values.width, values.height);
  size_t clipped = 0;
  for (size_t i = 0; i < shown.size(); ++i) {
    clipped += values[i] < 0 || values[i] > 1;
    shown[i] = glm::vec3(values[i]);
  }
  write_png(name, shown);
  PictureRecord& picture = record(name, true);
  picture.shown_as = "value 0..1 as it is, not sRGB-encoded";
  picture.clipped = clipped;
}

void Gallery::add_vectors(const std::string& name, const Grid<glm::vec3>& vectors,
                          const Grid<glm::vec3>& shown) {
  write_exr(name, vectors, kAxes);
  write_png(name, shown);
  record(name, true).shown_as = "(v + 1)/2, green along the rows downwards";
}

void Gallery::add_figure(const std::string& name, std::span<const std::vector<Panel>> rows,
                         std::span<const Grid<glm::vec3>> below) {
  write_png(name, make_figure(rows, below));
  record(name, false);
}

void Gallery::report_missing(const std::string& name, const std::string& reason) {
  missing_.push_back({name, reason});
}

nlohmann::ordered_json Gallery::json() const {
  nlohmann::ordered_json json = {{"pictures", nlohmann::ordered_json::array()},
                                 {"missing", nlohmann::ordered_json::array()}};
  for (const PictureRecord& picture : pictures_) {
    nlohmann::ordered_json entry = {{"name", picture.name}, {"files", nlohmann::ordered_json::array()}};
    if (picture.has_exr) entry["files"].push_back(picture.name + ".exr");
    entry["files"].push_back(picture.name + ".png");
    if (picture.exposure_ev) {
      entry["exposure_ev"] = *picture.exposure_ev;
      entry["clipped_above_white"] = picture.clipping.above_white;
      entry["clipped_below_black"] = picture.clipping.below_black;
    }
    if (const auto& scale = picture.scale)
      entry["scale"] = {{"low", scale->low}, {"high", scale->high}, {"of", scale->label}};
    if (!picture.shown_as.empty()) entry["shown_as"] = picture.shown_as;
    if (picture.clipped) entry["clipped"] = *picture.clipped;
    json["pictures"].push_back(entry);
  }
  for (const auto& [name, reason] : missing_) json["missing"].push_back({{"name", name}, {"reason", reason}});
  return json;
}

std::string Gallery::text() const {
  std::string text;
  for (const PictureRecord& picture : pictures_) {
    text += fmt::format("  {:26} ", picture.name);
    if (picture.exposure_ev)
      text += fmt::format("exposure {:+.2f} EV, {} pixels above white, {} below black", *picture.exposure_ev,
                          picture.clipping.above_white, picture.clipping.below_black);
    if (const auto& scale = picture.scale)
      text += fmt::format("{:.3g} to {:.3g}, {} pixels beyond: {}", scale->low, scale->high, *picture.clipped,
                          scale->label);
    text += '\n';
  }
  for (const auto& [name, reason] : missing_) text += fmt::format("  {:26} missing: {}\n", name, reason);
  return text;
}

}  // namespace hemibake
