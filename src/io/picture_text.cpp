#include "io/picture_text.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <filesystem>

namespace hemibake {
namespace {

// Debian's fonts-dejavu-core.
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

OIIO::ROI measure(std::string_view text, int size) {
  return OIIO::ImageBufAlgo::text_size(OIIO::string_view(text.data(), text.size()), size, kFont);
}

}  // namespace

bool has_font() {
  std::error_code not_there;
  static const bool found = std::filesystem::exists(kFont, not_there) && measure("x", 16).defined();
  return found;
}

TextSize text_size(std::string_view text, int size) {
  if (!has_font() || text.empty()) return {};
  const OIIO::ROI region = measure(text, size);
  return {region.width(), region.height()};
}

void draw_text(Grid<glm::vec3>& picture, int x, int y, std::string_view text, int size,
               const glm::vec3& color) {
  if (!has_font() || text.empty() || picture.empty()) return;
  OIIO::ImageBuf pixels(OIIO::ImageSpec(picture.width, picture.height, 3, OIIO::TypeDesc::FLOAT),
                        &picture.values[0].x);
  const float channels[] = {color.x, color.y, color.z};
  OIIO::ImageBufAlgo::render_text(pixels, x, y, OIIO::string_view(text.data(), text.size()), size, kFont,
                                  channels);
}

}  // namespace hemibake
