// The pictures of a render: each written as linear EXR and as PNG, with what was done to show it; and what
// there was no picture of, and why.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/grid.h"
#include "io/provenance.h"
#include "pictures/figure.h"

namespace hemibake {

class Gallery {
 public:
  Gallery(std::filesystem::path folder, Provenance provenance)
      : folder_(std::move(folder)), provenance_(std::move(provenance)) {}

  // NAME.exr with the light itself, channels R, G, B, and NAME.png at an exposure, in stops.
  void add_light(const std::string& name, const Grid<glm::vec3>& linear, double exposure_ev);

  // NAME.exr with the numbers, and NAME.png in the colours of `scale` with its bar.
  void add_numbers(const std::string& name, const Grid<float>& values, const ColorScale& scale);
  // The same with three numbers in the EXR, of which `shown` is what the PNG shows.
  void add_numbers(const std::string& name, const Grid<glm::vec3>& values, const Grid<float>& shown,
                   const ColorScale& scale);

  // NAME.exr with the values themselves, NAME.png with `shown`, 0..1, as it is.
  void add_values(const std::string& name, const Grid<float>& values);
  void add_vectors(const std::string& name, const Grid<glm::vec3>& vectors, const Grid<glm::vec3>& shown);

  // NAME.png of pictures that are there by themselves too.
  void add_figure(const std::string& name, std::span<const std::vector<Panel>> rows,
                  std::span<const Grid<glm::vec3>> below = {});

  void report_missing(const std::string& name, const std::string& reason);

  // {"pictures": [{"name", "files", …}], "missing": [{"name", "reason"}]}
  nlohmann::ordered_json json() const;
  std::string text() const;

 private:
  nlohmann::ordered_json& record(const std::string& name, bool with_exr);
  void write_exr(const std::string& name, const Grid<glm::vec3>& values, const char* const channels[3]);
  void write_png(const std::string& name, const Grid<glm::vec3>& shown);

  std::filesystem::path folder_;
  Provenance provenance_;
  nlohmann::ordered_json pictures_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json missing_ = nlohmann::ordered_json::array();
};

}  // namespace hemibake
