// Reads and writes images as numbers: no colour transform, no premultiplication, ever. Integer formats hold
// 0..1 (value / largest value), float formats the values themselves.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/grid.h"
#include "io/output_file.h"
#include "io/provenance.h"

namespace hemibake {

// Reading a header takes no memory that depends on the size it claims.
struct ImageHeader {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;
  Provenance provenance;  // as given to write_image; null where the file has none
};

// A channel in memory: the value of texel i is first[i * stride].
template <class Value>
struct BasicPlane {
  std::string channel;
  Value* first;
  size_t stride = 1;
};
using Plane = BasicPlane<const float>;
using MutablePlane = BasicPlane<float>;

// Every reading function throws InputError naming the file where it is missing, a folder, not an image, cut
// short, empty, larger than kMaxTexels, deep, a volume, several images in one, or an EXR whose data window is
// not its display window; and naming channel and texel for a value read that is not finite. Overviews and
// masks of a TIFF are no images of their own. Images come right way up: orientation (EXIF, TIFF) is applied.

ImageHeader read_image_header(const std::filesystem::path& path);

// NaN in planes: an error, or texels without a value.
enum class MissingValues { kRefused, kNaN };

// Fills `planes`, each with room for width × height values, from the channels of their names in one pass.
// Throws InputError where a channel is missing or the image has another size.
void read_planes(const std::filesystem::path& path, int width, int height,
                 std::span<const MutablePlane> planes, MissingValues missing = MissingValues::kRefused);

// Reads one channel. Throws InputError listing the channels where `channel` does not choose one.
// channel: its name (any case where only one matches) or its index from 0; empty: the only one beside alpha,
//          else green (`G`), else the luminance (`Y`).
Grid<float> read_height_map(const std::filesystem::path& path, const std::string& channel = "");

struct NormalImage {
  Grid<glm::vec3> values;  // as stored: integers over the largest of their type, floats themselves
  bool stored_as_integers = false;
  std::vector<std::string> channels;  // the three taken: "R", "G", "B"
};

// Reads a normal map without decoding it: `normal.X`, `normal.Y`, `normal.Z` where it has them, as a bake
// does, else the first three channels. Throws InputError naming both sizes where it is not width × height,
// and where it is stored turned: which way its vectors point is open then. channels: two or three to take
// instead, each by name or index; of two the third value is 0.
NormalImage read_normal_map(const std::filesystem::path& path, int width, int height,
                            const std::vector<std::string>& channels = {});

struct ColorImage {
  Grid<glm::vec3> colors;
  bool stored_as_integers = false;  // mostly means sRGB-encoded; colors are not decoded
};

// Reads the first three channels; an image of fewer is grey with the first.
ColorImage read_color_image(const std::filesystem::path& path);

// Writes planes of width × height: `.exr` as 32-bit float (lossless), `.png` as 16-bit integers (one to four
// planes of 0..1, to nearest). The entries of `provenance` become attributes `hemibake:NAME`: strings,
// doubles and ints; booleans as 0 or 1; integers beyond 32 bits as decimal strings; and `hemibake:provenance`
// holds all of them as JSON, which is what read_image_header reads back. Throws std::logic_error naming
// channel and texel for a value that is not finite; InputError for another extension, a value outside 0..1 in
// a PNG, and where the file cannot be written. Provenance that says `holes` are `open` allows texels with NaN
// in every plane, also in write_texture.
void write_image(const std::filesystem::path& path, int width, int height, std::span<const Plane> planes,
                 const Provenance& provenance);

// Writes one channel `Y`, as write_image.
void write_height_map(const std::filesystem::path& path, const Grid<float>& heights,
                      const Provenance& provenance);

// Files of textures: PNG of 16 or 8 bits, EXR or TIFF of 32-bit floats.
enum class TextureFormat { kPng16, kPng8, kExr, kTif };

struct TextureFormatInfo {
  const char* name;       // "png16"
  const char* extension;  // ".png"
  int bits;               // of a channel
  bool is_float;
};

// In the order of the enumerators.
std::span<const TextureFormatInfo> texture_formats();
const TextureFormatInfo& texture_format_info(TextureFormat format);

struct TextureCoding {
  TextureFormat format = TextureFormat::kPng16;
  bool dither = false;  // 8 bits: rounds up with the probability of the remainder, which keeps the mean
};

// Writes planes of linear data (0..1; any finite number in float formats) into `file`, which stays to be
// committed. PNG is written to nearest, or dithered with a hash of channel and texel: the same bytes at every
// run. No colour space is claimed: no gAMA and no sRGB chunk. Metadata as write_image; a TIFF has the JSON as
// its ImageDescription. Throws std::logic_error for a value outside 0..1 or not finite, InputError where the
// file cannot be written. planes: 1, 3 or 4; any number in float formats.
void write_texture(OutputFile& file, int width, int height, std::span<const Plane> planes,
                   const TextureCoding& coding, const Provenance& provenance);

// Writes an 8-bit sRGB PNG of values already encoded for display, clamped to 0..1. Errors as write_image.
void write_png8_rgb(const std::filesystem::path& path, const Grid<glm::vec3>& picture,
                    const Provenance& provenance);

}  // namespace hemibake
