// Images as other programs write them.
#pragma once

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "io/image_io.h"
#include "io/io_testing.h"

namespace hemibake {

// Writes an image as some other program would: values interleaved, stored as T unless the
// spec says half floats, several of the same where `images`
// > 1.
template <class T>
void write_foreign(const std::filesystem::path& path, OIIO::ImageSpec spec, const std::vector<T>& values,
                   int images = 1) {
  if (spec.format != OIIO::TypeDesc::HALF) spec.set_format(OIIO::BaseTypeFromC<T>::value);
  const auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output) << OIIO::geterror();
  for (int i = 0; i < images; ++i) {
    if (images > 1 && i == 0 && output->supports("multiimage") && path.extension() == ".exr") {
      std::vector<OIIO::ImageSpec> specs(static_cast<size_t>(images), spec);
      for (size_t k = 0; k < specs.size(); ++k)
        specs[k].attribute("oiio:subimagename", fmt::format("part {}", k));
      ASSERT_TRUE(output->open(path.string(), images, specs.data())) << output->geterror();
    } else {
      const auto mode = i == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage;
      ASSERT_TRUE(output->open(path.string(), spec, mode)) << output->geterror();
    }
    ASSERT_TRUE(output->write_image(OIIO::BaseTypeFromC<T>::value, values.data())) << output->geterror();
  }
  ASSERT_TRUE(output->close());
}

inline OIIO::ImageSpec spec_of(int width, int height, const std::vector<std::string>& channels) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(channels.size()), OIIO::TypeDesc::UINT8);
  spec.channelnames = channels;
  const auto alpha = std::find(channels.begin(), channels.end(), "A");
  if (alpha != channels.end()) spec.alpha_channel = static_cast<int>(alpha - channels.begin());
  return spec;
}

class ImageIo : public testing::Test {
 protected:
  std::string refusal(const std::string& name, const std::string& channel = "") {
    return error_of<InputError>([&] { read_height_map(folder_ / name, channel); });
  }

  TemporaryFolder folder_;
};

}  // namespace hemibake
