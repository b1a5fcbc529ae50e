#include "io/image_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string_view>

#include "core/context.h"
#include "core/memory_limit.h"
#include "core/parallel.h"
#include "io/byte_reader.h"
#include "io/file_context.h"
#include "io/png_check.h"
#include "io/targa_check.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Values (texels × channels) read at a time: a few MB, some compression blocks for the threads.
constexpr int64_t kValuesPerBlock = int64_t{1} << 21;
constexpr int kMaxRowsPerBlock = 64;
constexpr int kMaxParts = 10000;
constexpr int kMaxChannels = 4096;
// Resolutions are rounded to whole pixels per metre: less than this is rounding.
constexpr double kLeastAspect = 1e-3;

void check_regular_file(const ChannelReader& reader) {
  std::error_code error;
  const fs::file_status status = fs::status(reader.path(), error);
  if (!fs::exists(status)) reader.refuse(error.message() + ", expected an image");
  if (fs::is_directory(status)) reader.refuse("is a folder, expected an image");
  if (!fs::is_regular_file(status)) reader.refuse("is not a regular file, expected an image");
  if (fs::file_size(reader.path(), error) == 0 && !error) reader.refuse("is empty, expected an image");
}

void check_size(const ChannelReader& reader, int64_t width, int64_t height) {
  const auto texels = static_cast<uint64_t>(std::max<int64_t>(0, width)) *
                      static_cast<uint64_t>(std::max<int64_t>(0, height));
  if (texels == 0) reader.refuse(fmt::format("holds {} x {} texels, expected at least one", width, height));
  if (texels > kMaxTexels)
    reader.refuse(fmt::format("claims {} x {} texels, expected at most {}", width, height, kMaxTexels));
}

void check_usable(const ChannelReader& reader, const OIIO::ImageSpec& spec) {
  check_size(reader, spec.width, spec.height);
  if (spec.nchannels < 1 || spec.nchannels > kMaxChannels)
    reader.refuse(fmt::format("holds {} channels, expected 1 to {}", spec.nchannels, kMaxChannels));
  if (spec.deep) reader.refuse("is a deep image, expected one value per texel and channel");
  if (spec.depth > 1)
    reader.refuse(fmt::format("is a volume of {} slices, expected a flat image", spec.depth));
}

void check_windows(const ChannelReader& reader, const OIIO::ImageSpec& spec, const ImageChoice& choice) {
  if (choice.window == ImageWindow::kData) return;
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height)
    reader.refuse(
        fmt::format("has a data window of {} x {} at ({}, {}) in a display window of {} x {} at ({}, {}), "
                    "expected the same window for both{}",
                    spec.width, spec.height, spec.x, spec.y, spec.full_width, spec.full_height, spec.full_x,
                    spec.full_y, choice.is_offered ? ", or --window data" : ""));
}

// Refuses TIFFs that OpenImageIO 2.4 reads wrongly without an error (tiffinput.cpp: unusual depths stay in a
// scratch buffer, and only 8-bit values are inverted).
void check_tiff(const ChannelReader& reader, const OIIO::ImageSpec& spec) {
  const int bits = spec.get_int_attribute("oiio:BitsPerSample");
  if (spec.format.is_floating_point() && bits != 16 && bits != 32)
    reader.refuse(fmt::format("holds {}-bit floats, which cannot be read, expected 32-bit floats", bits));
  constexpr int kMinIsWhite = 0;
  if (spec.get_int_attribute("tiff:PhotometricInterpretation", 1) == kMinIsWhite &&
      spec.format != OIIO::TypeDesc::UINT8)
    reader.refuse("stores white as the least value in more than 8 bits, expected black there");
}

// Throws InputError naming the file where the image takes more memory than there is for it.
void check_memory(const ChannelReader& reader, double bytes, int64_t width, int64_t height) {
  with_file_context(reader.path(),
                    [&] { require_memory(bytes, fmt::format("{} x {} texels", width, height)); });
}

// Refuses a BMP in run lengths that claims more texels than its bytes can hold: two bytes make 255 of them at
// most, and the library sets memory aside for all on opening.
void check_bmp_runs(const ChannelReader& reader) {
  ByteReader file(reader.path());
  constexpr uint64_t kLongHeader = 40, kMostTexelsPerByte = 128;
  const uint64_t compression = file.at(30, 4);
  if (file.at(14, 4) < kLongHeader || (compression != 1 && compression != 2)) return;
  const auto side = [&](uint64_t place) {
    return std::abs(int64_t{static_cast<int32_t>(static_cast<uint32_t>(file.at(place, 4)))});
  };
  const int64_t width = side(18), height = side(22);
  check_size(reader, width, height);
  check_memory(reader, static_cast<double>(width) * static_cast<double>(height), width, height);
  std::error_code gone;
  const uint64_t bytes = std::filesystem::file_size(reader.path(), gone);
  if (gone || static_cast<uint64_t>(width) * static_cast<uint64_t>(height) > kMostTexelsPerByte * bytes)
    reader.refuse(fmt::format("claims {} x {} texels and has only {} bytes, expected a whole BMP", width,
                              height, bytes));
}

// Refuses what a header claims before the library, which would take its memory on opening, sees the file.
void check_before_opening(const ChannelReader& reader, const ImageFormat& format) {
  if (format.reader == std::string_view("jpeg2000")) {
    const ImageClaim claim = jpeg2000_claim(reader.path());
    if (claim.width < 1 || claim.height < 1 || claim.channels < 1)
      reader.refuse("has a damaged header, expected a whole JPEG 2000");
    check_size(reader, claim.width, claim.height);
    check_memory(reader,
                 static_cast<double>(claim.width * claim.height) * static_cast<double>(claim.channels) *
                     format.held_per_sample,
                 claim.width, claim.height);
  }
  if (format.reader == std::string_view("openexr")) {
    const ExrClaim claim = exr_claim(reader.path());
    if (!claim.is_whole)
      reader.refuse(
          "is not an image that can be read (its header is damaged or cut short), expected a whole OpenEXR");
    check_size(reader, claim.width, claim.height);
    constexpr double kBytesPerRow = 32;  // of the table of offsets, and copies of it
    check_memory(reader, kBytesPerRow * static_cast<double>(claim.height), claim.width, claim.height);
  }
  if (format.reader == std::string_view("bmp")) check_bmp_runs(reader);
  if (format.reader == std::string_view("targa"))
    if (const std::string fault = targa_error(reader.path()); !fault.empty()) reader.refuse(fault);
  if (format.reader != std::string_view("png")) return;
  PngHeader header;
  if (const std::string fault = png_header_error(reader.path(), header); !fault.empty()) reader.refuse(fault);
  check_size(reader, header.width, header.height);
  // The reader holds the whole of an interlaced image, its palette as colours.
  const double samples = static_cast<double>(header.width) * header.height * (header.channels + 3);
  check_memory(reader, header.is_interlaced ? samples * std::max(1, header.bits / 8) : 0, header.width,
               header.height);
  if (const std::string fault = png_error(reader.path(), header); !fault.empty()) reader.refuse(fault);
}

// Opens the image with the reader of its format and no other.
InputPointer open_image(const ChannelReader& reader, const ImageFormat& format) {
  OIIO::ImageSpec hints, spec;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  InputPointer input(OIIO::ImageInput::create(format.reader).release());
  OIIO::geterror();  // clears it: the library prints what nobody asked for
  if (!input)
    reader.refuse(fmt::format("is {}, which this machine's OpenImageIO cannot read, expected another format",
                              format.name));
  bool is_open = false;
  try {
    is_open = input->open(reader.path().string(), spec, hints);
  } catch (const std::exception&) {  // some readers believe lengths in a damaged file
  }
  if (!is_open)
    reader.refuse(
        fmt::format("is not an image that can be read (its header is damaged, cut short, or of a kind that "
                    "is not read), expected a whole {}",
                    format.name));
  return input;
}

// Counts with a reader of its own: seeking an image that is not there leaves some readers with an error.
int count_images(const ChannelReader& reader, const ImageFormat& format) {
  const InputPointer input = open_image(reader, format);
  int count = 1;
  while (count < kMaxParts && input->seek_subimage(count, 0)) ++count;
  return count;
}

// Refuses files far too short for what they claim, and images whose reader would take too much memory.
void check_claim(const ChannelReader& reader, const OIIO::ImageSpec& spec, const ImageFormat& format) {
  const auto sample_bytes = static_cast<double>(spec.format.size());
  const double samples = static_cast<double>(spec.width) * spec.height * spec.nchannels;
  std::error_code ignored;
  const auto size = static_cast<double>(fs::file_size(reader.path(), ignored));
  if (format.most_expansion > 0 && samples * sample_bytes > format.most_expansion * size)
    reader.refuse(fmt::format("is cut short: {:.0f} bytes cannot hold {} x {} texels, expected a whole {}",
                              size, spec.width, spec.height, format.name));
  double held = samples * format.held_per_sample;
  if (format.reader == std::string_view("tiff")) {
    const int rows =
        spec.tile_width > 0 ? spec.tile_height : spec.get_int_attribute("tiff:RowsPerStrip", spec.height);
    held = static_cast<double>(std::min(rows, spec.height)) * spec.width * spec.nchannels * sample_bytes;
  }
  check_memory(reader, held, spec.width, spec.height);
}

// Returns the bits of an integer as stored: 12 for what is widened to 16. Palettes index whole colours.
int integer_bits(const OIIO::ImageSpec& spec, const std::string& format) {
  const int bits = spec.get_int_attribute("oiio:BitsPerSample");
  const auto most = static_cast<int>(spec.format.size() * 8);
  constexpr int kPalette = 3;
  const bool is_trusted =
      format != "png" && spec.get_int_attribute("tiff:PhotometricInterpretation", 1) != kPalette;
  return is_trusted && bits > 1 && bits < most ? bits : most;
}

void note_samples(const OIIO::ImageSpec& spec, const std::string& format, ChannelFacts& facts) {
  if (spec.format.is_floating_point()) {
    facts.sample_type = spec.format == OIIO::TypeDesc::HALF
                            ? "half floats"
                            : fmt::format("{}-bit floats", spec.format.size() * 8);
    return;
  }
  const bool is_signed = spec.format.is_signed();
  const int bits = integer_bits(spec, format);
  facts.sample_type = fmt::format("{}{}-bit integers", is_signed ? "signed " : "", bits);
  facts.full_scale = std::ldexp(1.0, is_signed ? bits - 1 : bits) - 1;
}

// Returns width over height of a texel. OpenImageIO's PixelAspectRatio is that in EXR, and elsewhere one or
// the other; resolutions are texels per length.
double pixel_aspect_of(const OIIO::ImageSpec& spec, const std::string& format) {
  const double x = spec.get_float_attribute("XResolution"), y = spec.get_float_attribute("YResolution");
  const double aspect = format == "openexr" ? spec.get_float_attribute("PixelAspectRatio", 1) : y / x;
  return std::isfinite(aspect) && aspect > 0 && std::abs(aspect - 1) > kLeastAspect ? aspect : 1;
}

}  // namespace

void InputCloser::operator()(OIIO::ImageInput* input) const {
  input->geterror();
  OIIO::ImageInput::unique_ptr owner(input);
}

ImageReader::ImageReader(const fs::path& path, const ImageChoice& choice) : ChannelReader(path) {
  check_regular_file(*this);
  format_ = with_file_context(path, [&] { return &image_format_of(path); });
  check_before_opening(*this, *format_);
  OIIO::attribute("threads", thread_count());
  OIIO::attribute("exr_threads", thread_count());
  input_ = open_image(*this, *format_);
  const std::string format = format_->reader;
  const std::vector<TiffPage> pages = format == "tiff" ? tiff_pages(path) : std::vector<TiffPage>();
  check_usable(*this, input_->spec());
  subimage_ = find_part(choice, pages);
  if (subimage_ != 0 && !input_->seek_subimage(subimage_, 0))
    refuse(fmt::format("has an image {} that cannot be read, expected a whole {}", subimage_, format_->name));
  spec_ = input_->spec();
  check_usable(*this, spec_);
  check_claim(*this, spec_, *format_);
  if (format == "openexr") check_windows(*this, spec_, choice);
  if (format == "tiff") check_tiff(*this, spec_);
  note_facts(pages);
  if (format == "webp" && facts_.alpha) check_binary_alpha();
}

// Refuses partial transparency: OpenImageIO 2.4 multiplies the colours of a WebP by alpha, whatever it is
// told.
void ImageReader::check_binary_alpha() {
  bool is_partial = false, is_seen = false;
  read(*facts_.alpha, *facts_.alpha + 1, [&](size_t, std::span<const float> values) {
    for (const float alpha : values) {
      is_partial = is_partial || (alpha != 0 && alpha != 1);
      is_seen = is_seen || alpha != 0;
    }
  });
  if (is_partial || !is_seen)
    refuse(
        "is a WebP with partial or no opacity, which loses its values in reading, expected it opaque, or as "
        "PNG");
}

// Returns the subimage that is read: overviews and masks are none of their own.
int ImageReader::find_part(const ImageChoice& choice, const std::vector<TiffPage>& pages) const {
  std::vector<int> whole;
  for (size_t i = 0; i < pages.size(); ++i)
    if (!pages[i].is_reduced && !pages[i].is_mask) whole.push_back(static_cast<int>(i));
  if (whole.empty()) {
    whole.resize(static_cast<size_t>(count_images(*this, *format_)));
    std::iota(whole.begin(), whole.end(), 0);
  }
  if (!choice.part && whole.size() > 1)
    refuse(fmt::format("holds {} images, expected one{}", whole.size(),
                       choice.is_offered ? fmt::format(", or --part 0 to {}", whole.size() - 1) : ""));
  const auto part = static_cast<size_t>(choice.part.value_or(0));
  if (part >= whole.size())
    refuse(fmt::format("holds {} image(s), counted from 0, expected one of them, not --part {}", whole.size(),
                       part));
  return whole[part];
}

void ImageReader::note_facts(const std::vector<TiffPage>& pages) {
  const std::string format = format_->reader;
  facts_.width = spec_.width;
  facts_.height = spec_.height;
  facts_.channels = spec_.channelnames;
  if (spec_.alpha_channel >= 0) facts_.alpha = spec_.alpha_channel;
  facts_.format = format_->name;
  note_samples(spec_, format, facts_);
  const int orientation =
      format == "webp" ? webp_orientation(path()) : spec_.get_int_attribute("Orientation", 1);
  facts_.orientation = orientation >= 1 && orientation <= 8 ? orientation : 1;
  facts_.pixel_aspect = pixel_aspect_of(spec_, format);
  if (facts_.orientation > 4) facts_.pixel_aspect = 1 / facts_.pixel_aspect;
  if (static_cast<size_t>(subimage_) < pages.size())
    facts_.no_data = pages[static_cast<size_t>(subimage_)].no_data;
}

bool ImageReader::read_rows(const Window& window, OIIO::TypeDesc type, void* values) try {
  const int top = spec_.y + window.row_begin, bottom = spec_.y + window.row_end;
  if (spec_.tile_width > 0)
    return input_->read_tiles(subimage_, 0, spec_.x, spec_.x + spec_.width, top, bottom, spec_.z, spec_.z + 1,
                              window.channel_begin, window.channel_end, type, values);
  return input_->read_scanlines(subimage_, 0, top, bottom, spec_.z, window.channel_begin, window.channel_end,
                                type, values);
} catch (const std::exception&) {  // some readers believe lengths in a damaged file
  return false;
}

void ImageReader::read(int begin, int end, const BlockVisitor& visit) {
  const int channels = end - begin;
  const int rows = spec_.tile_width > 0
                       ? spec_.tile_height
                       : static_cast<int>(std::clamp<int64_t>(
                             kValuesPerBlock / (int64_t{spec_.width} * channels), 1, kMaxRowsPerBlock));
  const size_t row_values = static_cast<size_t>(spec_.width) * static_cast<size_t>(channels);
  // 8 bits widen to 16 exactly (v · 257), so that one division gives the nearest float for both.
  const bool integers = spec_.format == OIIO::TypeDesc::UINT8 || spec_.format == OIIO::TypeDesc::UINT16;
  const double block_values = static_cast<double>(rows) * static_cast<double>(row_values);
  check_memory(*this, block_values * (sizeof(float) + sizeof(uint16_t)), spec_.width, spec_.height);
  std::vector<float> block(static_cast<size_t>(rows) * row_values);
  std::vector<uint16_t> stored(integers ? block.size() : 0);
  for (int row = 0; row < spec_.height; row += rows) {
    throw_if_cancelled();
    const Window window{row, std::min(spec_.height, row + rows), begin, end};
    const bool is_read = integers ? read_rows(window, OIIO::TypeDesc::UINT16, stored.data())
                                  : read_rows(window, OIIO::TypeDesc::FLOAT, block.data());
    if (!is_read || input_->has_error())
      refuse(fmt::format("is damaged or cut short near row {}, expected a whole {}", row, format_->name));
    const size_t count = static_cast<size_t>(window.row_end - row) * row_values;
    for (size_t i = 0; i < (integers ? count : 0); ++i) block[i] = static_cast<float>(stored[i] / 65535.0);
    visit(static_cast<size_t>(row) * static_cast<size_t>(spec_.width), std::span(block).first(count));
  }
}

void ImageReader::fill(std::span<const MutablePlane> planes, std::span<const int> indices,
                       MissingValues missing) {
  const auto [low, high] = std::minmax_element(indices.begin(), indices.end());
  const int begin = *low;
  const auto channels = static_cast<size_t>(*high + 1 - begin);
  read(begin, *high + 1, [&](size_t first, std::span<const float> values) {
    for (size_t k = 0; k < planes.size(); ++k) {
      const auto offset = static_cast<size_t>(indices[k] - begin);
      for (size_t i = 0; i < values.size() / channels; ++i) {
        const size_t texel = upright(first + i);
        const float value = values[i * channels + offset];
        const bool is_missing = missing == MissingValues::kNaN && std::isnan(value);
        if (!std::isfinite(value) && !is_missing) refuse_value(*this, planes[k].channel, texel, value);
        planes[k].first[texel * planes[k].stride] = value;
      }
    }
  });
}

}  // namespace hemibake
