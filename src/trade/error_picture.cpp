#include "trade/error_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "io/image_io.h"

namespace hemibake {
namespace {

// Ends of a map that is read well by the colour-blind too (Brewer's RdBu), in sRGB.
constexpr glm::vec3 kDark{0.02f, 0.19f, 0.38f}, kMiddleDark{0.26f, 0.58f, 0.76f}, kRight{0.97f, 0.97f, 0.97f},
    kMiddleBright{0.84f, 0.38f, 0.30f}, kBright{0.40f, 0.0f, 0.12f}, kUnknown{0.5f, 0.5f, 0.5f};

glm::vec3 color_of(double error) {
  const float size = static_cast<float>(std::min(std::abs(error) / kErrorPictureScale, 1.0));
  const glm::vec3 &middle = error < 0 ? kMiddleDark : kMiddleBright, &end = error < 0 ? kDark : kBright;
  return size < 0.5f ? glm::mix(kRight, middle, 2 * size) : glm::mix(middle, end, 2 * size - 1);
}

// Small maps are shown with squares for texels, so that there is something to see.
constexpr int kSmallestSide = 256;

Grid<glm::vec3> enlarged(const Grid<glm::vec3>& picture) {
  const int scale = std::max(1, kSmallestSide / std::max(picture.width, picture.height));
  Grid<glm::vec3> result(scale * picture.width, scale * picture.height);
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) result(x, y) = picture(x / scale, y / scale);
  return result;
}

}  // namespace

void write_error_pictures(const std::filesystem::path& folder, const std::string& id, const RunPlanes& planes,
                          const RunPlanes& truth, const Provenance& provenance) {
  for (const NamedPlane& named : named_planes()) {
    const Grid<float>& plane = named.of(planes);
    const bool drawn = named.name == "ao" || named.name == "direct" || named.name == "light.50";
    if (plane.empty() || !drawn) continue;
    Grid<glm::vec3> picture(plane.width, plane.height, kUnknown);
    for (size_t i = 0; i < plane.size(); ++i)
      if (planes.known.empty() || planes.known[i] != 0)
        picture[i] = color_of(static_cast<double>(plane[i]) - static_cast<double>(named.of(truth)[i]));
    write_png8_rgb(folder / (id + "-" + named.name + ".png"), enlarged(picture), provenance);
  }
}

}  // namespace hemibake
