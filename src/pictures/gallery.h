// Writes the pictures of a render, each as linear EXR and as PNG, and records how each is shown and what is
// missing.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/color.h"
#include "core/grid.h"
#include "io/output_file.h"
#include "io/provenance.h"
#include "pictures/figure.h"

namespace hemibake {

// Records how a picture is shown; what does not apply is empty.
struct PictureRecord {
  std::string name;
  bool has_exr = false;
  std::optional<double> exposure_ev;  // of light
  Clipping clipping;                  // of light
  std::optional<ColorScale> scale;    // of numbers
  std::string shown_as;               // of values and vectors
  std::optional<size_t> clipped;      // pixels beyond the scale, or values outside 0..1
};

class Gallery {
 public:
  // files: takes the pictures and stays to be committed; must outlive the gallery.
  Gallery(std::filesystem::path folder, Provenance provenance, OutputSet& files)
      : folder_(std::move(folder)), provenance_(std::move(provenance)), files_(files) {}

  // Writes NAME.exr with the light itself, channels R, G, B, and NAME.png at an exposure, in stops.
  void add_light(const std::string& name, const Grid<glm::vec3>& linear, double exposure_ev);

  // Writes NAME.exr with the numbers, and NAME.png in the colours of `scale` with its bar.
  void add_numbers(const std::string& name, const Grid<float>& values, const ColorScale& scale);
  // Writes three numbers a pixel into NAME.exr; `shown` are those that NAME.png shows.
  void add_numbers(const std::string& name, const Grid<glm::vec3>& values, const Grid<float>& shown,
                   const ColorScale& scale);

  // Writes NAME.exr with the values, and NAME.png with the values clamped to 0..1.
  void add_values(const std::string& name, const Grid<float>& values);
  // Writes NAME.exr with the vectors, and NAME.png with `shown`, 0..1.
  void add_vectors(const std::string& name, const Grid<glm::vec3>& vectors, const Grid<glm::vec3>& shown);

  // Writes NAME.png of panels that are pictures by themselves too.
  void add_figure(const std::string& name, std::span<const std::vector<Panel>> rows,
                  std::span<const Grid<glm::vec3>> below = {});

  // Returns the files written.
  const std::vector<OutputFile*>& files() const { return written_; }

  void report_missing(const std::string& name, const std::string& reason);

  // Returns {"pictures": [{"name", "files", …}], "missing": [{"name", "reason"}]}.
  nlohmann::ordered_json json() const;
  // Returns a line for each picture and each that is missing.
  std::string text() const;

 private:
  struct Missing {
    std::string name, reason;
  };

  PictureRecord& record(const std::string& name, bool has_exr);
  void show_numbers(const std::string& name, const Grid<float>& shown, const ColorScale& scale);
  OutputFile& add_file(const std::string& name);
  void write_exr(const std::string& name, const Grid<float>& values);
  void write_exr(const std::string& name, const Grid<glm::vec3>& values, const char* const channels[3]);
  void write_png(const std::string& name, const Grid<glm::vec3>& shown);

  std::filesystem::path folder_;
  Provenance provenance_;
  OutputSet& files_;
  std::vector<OutputFile*> written_;
  std::vector<PictureRecord> pictures_;
  std::vector<Missing> missing_;
};

}  // namespace hemibake
