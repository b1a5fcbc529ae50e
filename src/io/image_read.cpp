#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.h"
#include "io/image_io.h"
#include "io/image_reader.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Throws InputError naming both sizes. like: " as the height map is", or empty.
void check_size(const ImageReader& reader, int width, int height, const char* like) {
  if (reader.width() != width || reader.height() != height)
    reader.refuse(fmt::format("is {} x {} texels, expected {} x {}{}", reader.width(), reader.height(), width,
                              height, like));
}

// Returns the indices of the channels that hold normals, as read_normal_map says.
std::vector<int> normal_channels(const std::vector<std::string>& channels) {
  const auto x = find_channel(channels, "normal.X"), y = find_channel(channels, "normal.Y"),
             z = find_channel(channels, "normal.Z");
  return x && y && z ? std::vector{*x, *y, *z} : std::vector{0, 1, 2};
}

// Returns what a TIFF of this program says, in the one text that the format has; null for any other.
Provenance provenance_in_description(const OIIO::ImageSpec& spec) {
  const std::string text(spec.get_string_attribute("ImageDescription"));
  if (!text.starts_with('{')) return {};
  try {
    Provenance provenance = parse_provenance(text, "");
    return provenance.contains("texture") ? provenance : Provenance();
  } catch (const InputError&) {
    return {};  // of another program
  }
}

}  // namespace

ImageHeader read_image_header(const fs::path& path) {
  const ImageReader reader(path);
  const OIIO::ImageSpec& spec = reader.spec();
  ImageHeader header{reader.width(), reader.height(), spec.channelnames, nullptr};
  const std::string text(spec.get_string_attribute("hemibake:provenance"));
  header.provenance = text.empty()
                          ? provenance_in_description(spec)
                          : parse_provenance(text, path.string() + ": attribute hemibake:provenance");
  return header;
}

void read_planes(const fs::path& path, int width, int height, std::span<const MutablePlane> planes,
                 MissingValues missing) {
  ImageReader reader(path);
  check_size(reader, width, height, "");
  const std::vector<std::string>& channels = reader.facts().channels;
  std::vector<int> indices;
  for (const MutablePlane& plane : planes) {
    const auto found = std::ranges::find(channels, plane.channel);
    if (found == channels.end())
      reader.refuse(fmt::format("has no channel '{}', only {}", plane.channel, fmt::join(channels, ", ")));
    indices.push_back(static_cast<int>(found - channels.begin()));
  }
  if (!planes.empty()) reader.fill(planes, indices, missing);
}

Grid<float> read_height_map(const fs::path& path, const std::string& channel) {
  ImageReader reader(path);
  const std::optional<int> chosen = choose_channel(reader.facts(), channel);
  if (!chosen) refuse_channel(reader, channel);
  Grid<float> heights(reader.width(), reader.height());
  const MutablePlane plane{reader.facts().channels[static_cast<size_t>(*chosen)], heights.values.data()};
  reader.fill({&plane, 1}, {&*chosen, 1});
  return heights;
}

NormalImage read_normal_map(const fs::path& path, int width, int height,
                            const std::vector<std::string>& channels) {
  ImageReader reader(path);
  const ChannelFacts& facts = reader.facts();
  check_size(reader, width, height, " as the height map is");
  if (channels.empty() && facts.channels.size() < 3)
    reader.refuse(
        fmt::format("has {} channel(s), expected the three of a normal map", facts.channels.size()));
  if (facts.orientation != 1)
    reader.refuse(
        fmt::format("is stored turned (orientation {}), which leaves the directions of its normals "
                    "open, expected a normal map saved upright",
                    facts.orientation));
  NormalImage image{
      Grid<glm::vec3>(width, height, glm::vec3(0)), !reader.spec().format.is_floating_point(), {}};
  std::vector<int> indices = channels.empty() ? normal_channels(facts.channels) : std::vector<int>();
  for (const std::string& channel : channels) {
    const std::optional<int> chosen = choose_channel(facts, channel);
    if (!chosen) refuse_channel(reader, channel);
    indices.push_back(*chosen);
  }
  std::vector<MutablePlane> planes;
  for (size_t c = 0; c < indices.size(); ++c) {
    image.channels.push_back(facts.channels[static_cast<size_t>(indices[c])]);
    planes.push_back({image.channels.back(), &image.values.values[0][static_cast<int>(c)], 3});
  }
  reader.fill(planes, indices);
  return image;
}

ColorImage read_color_image(const fs::path& path) {
  ImageReader reader(path);
  const OIIO::ImageSpec& spec = reader.spec();
  ColorImage image{Grid<glm::vec3>(reader.width(), reader.height()), !spec.format.is_floating_point()};
  std::vector<MutablePlane> planes;
  std::vector<int> indices;
  for (int c = 0; c < 3; ++c) {
    indices.push_back(spec.nchannels < 3 ? 0 : c);
    planes.push_back({spec.channelnames[static_cast<size_t>(indices.back())], &image.colors.values[0][c], 3});
  }
  reader.fill(planes, indices);
  return image;
}

}  // namespace hemibake
