// Reads channels of any format that OpenImageIO knows, with every check that the header allows.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>

#include "io/channel_reader.h"
#include "io/image_io.h"
#include "io/tiff_pages.h"

namespace hemibake {

// Which image of a file is read.
struct ImageChoice {
  std::optional<int> part;  // from 0, overviews and masks not counted; absent: the only one
  ImageWindow window = ImageWindow::kDisplay;
  bool is_offered = false;  // the user can choose: errors name the options
};

class ImageReader : public ChannelReader {
 public:
  // Opens the image. Throws InputError as io/image_io.h says.
  explicit ImageReader(const std::filesystem::path& path, const ImageChoice& choice = {});

  const OIIO::ImageSpec& spec() const { return spec_; }

  void read(int begin, int end, const BlockVisitor& visit) override;

  // Fills planes[k], right way up, from channel indices[k], all in one pass. Throws InputError naming channel
  // and texel for a value that is not finite, but for NaN where `missing` allows it.
  void fill(std::span<const MutablePlane> planes, std::span<const int> indices,
            MissingValues missing = MissingValues::kRefused);

 private:
  struct Window {
    int row_begin, row_end, channel_begin, channel_end;
  };

  int find_part(const ImageChoice& choice, const std::vector<TiffPage>& pages) const;
  void check_binary_alpha();
  void note_facts(const std::vector<TiffPage>& pages);
  bool read_rows(const Window& window, OIIO::TypeDesc type, void* values);

  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
  int subimage_ = 0;
};

}  // namespace hemibake
