// The options of `hemibake render`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/command.h"
#include "lighting/sky.h"
#include "pictures/pictures.h"

namespace hemibake {

struct RenderOptions {
  std::filesystem::path bake, folder, links, fit;
  std::string albedo = "0.9,0.6,0.2";
  std::string albedo_encoding = "auto";
  std::vector<std::string> sky = {"uniform"};
  std::string sky_truth = "traced";
  int sky_rays = 256;
  std::string sun;
  std::string model = "bounded";
  std::string constants = "fit";
  std::vector<std::string> pictures = {"light",  "differences", "bounces", "saturation",
                                       "planes", "estimators",  "views"};
  std::string camera = "150,40";
  int view_width = 720;
  PictureOptions picture;

  bool wants(const std::string& subject) const;
  // The file of --sky; empty where it is uniform.
  std::filesystem::path sky_file() const;
  bool sky_is_harmonics() const { return sky[0] == "sh"; }
};

// They refer to `options`, which must outlive them.
std::vector<Field> render_fields(RenderOptions& options);

// Resolves what no option can know by itself. Throws InputError.
void resolve(RenderOptions& options);

// "R,G,B" or one number for all three, 0..1; nullopt where the text is no list of numbers, which is then a
// file's name. Throws InputError for numbers out of range.
std::optional<glm::vec3> albedo_from_text(const std::string& text);

// "AZIMUTH,ELEVATION,INTENSITY"; nullopt for an empty text.
std::optional<Sun> sun_from_text(const std::string& text);

}  // namespace hemibake
