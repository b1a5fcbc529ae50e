#include "io/height_file.h"

#include "io/geo_read.h"
#include "io/image_io.h"

namespace hemibake {

HeightFile read_height_file(const std::filesystem::path& path, const HeightFileOptions& options) {
  if (std::optional<HeightFile> terrain = read_geo_file(path, options)) return *std::move(terrain);
  HeightFile file;
  file.values = read_height_map(path, options.channel);
  return file;
}

}  // namespace hemibake
