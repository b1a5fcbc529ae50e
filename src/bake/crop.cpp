#include "bake/crop.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/statistics.h"

namespace hemibake {
namespace {

template <class T>
void crop(Grid<T>& plane, int margin) {
  plane = crop_plane(plane, margin);
}

// Leaves the texels inside, numbered anew.
void crop_texels(std::vector<uint32_t>& texels, int margin, int width, int height) {
  std::vector<uint32_t> inner;
  for (const uint32_t texel : texels) {
    const int x = static_cast<int>(texel) % width - margin, y = static_cast<int>(texel) / width - margin;
    const int inner_width = width - 2 * margin;
    if (x >= 0 && y >= 0 && x < inner_width && y < height - 2 * margin)
      inner.push_back(static_cast<uint32_t>(y) * static_cast<uint32_t>(inner_width) +
                      static_cast<uint32_t>(x));
  }
  texels = std::move(inner);
}

}  // namespace

void check_margin(int margin, int width, int height) {
  if (2 * margin >= std::min(width, height))
    throw SettingError(
        fmt::format("{{margin}}: {} texels off every side leave nothing of {} x {}, expected at most {}",
                    margin, width, height, (std::min(width, height) - 1) / 2));
}

void crop_bake(int margin, BakeResult& result) {
  if (margin == 0) return;
  Bake& planes = result.planes;
  if (result.bounces) {
    crop_texels(result.bounces->unconverged_texels, margin, planes.width, planes.height);
    crop_texels(result.bounces->enclosed_texels, margin, planes.width, planes.height);
  }
  planes.width -= 2 * margin;
  planes.height -= 2 * margin;
  for (Grid<float>* plane :
       {&planes.visible_fraction, &planes.visibility, &planes.total, &planes.residual, &planes.bounce})
    crop(*plane, margin);
  for (Grid<float>& plane : planes.irradiance) crop(plane, margin);
  crop(planes.normals, margin);
  crop(planes.bent_normals, margin);
  if (!result.bounces || planes.residual.empty()) return;
  result.bounces->mean_residual = mean(planes.residual.values);
  result.bounces->worst_residual = static_cast<double>(*std::ranges::max_element(planes.residual.values));
}

}  // namespace hemibake
