#include "trade/plane_file.h"

#include <algorithm>

#include "io/image_io.h"

namespace hemibake {

void write_planes(const std::filesystem::path& path, const RunPlanes& planes, const Provenance& provenance) {
  std::vector<Plane> channels;
  int width = 0, height = 0;
  for (const NamedPlane& named : named_planes()) {
    const Grid<float>& plane = named.of(planes);
    if (plane.empty()) continue;
    width = plane.width;
    height = plane.height;
    channels.push_back({named.name, plane.values.data()});
  }
  write_image(path, width, height, channels, provenance);
}

RunPlanes read_run_planes(const std::filesystem::path& path, int width, int height) {
  const ImageHeader header = read_image_header(path);
  RunPlanes planes;
  std::vector<MutablePlane> channels;
  for (const NamedPlane& named : named_planes()) {
    if (std::ranges::find(header.channels, named.name) == header.channels.end()) continue;
    Grid<float>& plane = named.of(planes);
    plane = Grid<float>(width, height);
    channels.push_back({named.name, plane.values.data()});
  }
  read_planes(path, width, height, channels);
  return planes;
}

}  // namespace hemibake
