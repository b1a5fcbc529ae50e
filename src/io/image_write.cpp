#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "core/context.h"
#include "core/error.h"
#include "core/parallel.h"
#include "io/image_io.h"
#include "io/output_file.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Values interleaved at a time: some MB, a few compression blocks for every thread.
constexpr int64_t kValuesPerBlock = int64_t{1} << 22;
constexpr int kMaxRowsPerBlock = 256;
constexpr int kPngLevel = 1;  // of textures (src/textures/README.md)
constexpr int kZipRows = 16;  // rows that EXR compresses together

// Lets OpenImageIO write into an OutputFile, and keeps the errno that it would lose.
class FileProxy final : public OIIO::Filesystem::IOProxy {
 public:
  explicit FileProxy(int descriptor) : IOProxy("", Write), descriptor_(descriptor) {}
  int error_number() const { return error_number_; }

  const char* proxytype() const override { return "hemibake"; }
  size_t write(const void* bytes, size_t size) override {
    const size_t written = pwrite(bytes, size, m_pos);
    m_pos += static_cast<int64_t>(written);
    return written;
  }
  size_t pwrite(const void* bytes, size_t size, int64_t offset) override {
    size_t done = 0;
    while (done < size) {
      const ssize_t written = ::pwrite(descriptor_, static_cast<const char*>(bytes) + done, size - done,
                                       offset + static_cast<int64_t>(done));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) {
        error_number_ = errno;
        break;
      }
      done += static_cast<size_t>(written);
    }
    end_ = std::max(end_, offset + static_cast<int64_t>(done));
    return done;
  }
  size_t size() const override { return static_cast<size_t>(end_); }

 private:
  int descriptor_;
  int error_number_ = 0;
  int64_t end_ = 0;
};

// value: an integer.
bool fits_int32(const Provenance& value) {
  if (value.is_number_unsigned()) return value.get<uint64_t>() <= uint64_t{INT32_MAX};
  return value.get<int64_t>() >= INT32_MIN && value.get<int64_t>() <= INT32_MAX;
}

void add_attributes(OIIO::ImageSpec& spec, const Provenance& provenance) {
  check_provenance(provenance);
  for (const auto& [name, value] : provenance.items()) {
    const std::string attribute = "hemibake:" + name;
    if (value.is_string()) {
      spec.attribute(attribute, value.get<std::string>());
    } else if (value.is_boolean()) {
      spec.attribute(attribute, value.get<bool>() ? 1 : 0);
    } else if (value.is_number_float()) {
      const double number = value.get<double>();
      spec.attribute(attribute, OIIO::TypeDesc::DOUBLE, &number);
    } else if (fits_int32(value)) {
      spec.attribute(attribute, value.get<int32_t>());
    } else {
      spec.attribute(attribute, value.dump());
    }
  }
  if (!provenance.empty()) spec.attribute("hemibake:provenance", provenance.dump());
}

enum class Holes { kNone, kOpen };

Holes holes_in(const Provenance& provenance) {
  return provenance.is_object() && provenance.value("holes", "") == "open" ? Holes::kOpen : Holes::kNone;
}

// Returns whether no plane has a value at a texel.
bool is_hole(std::span<const Plane> planes, size_t texel) {
  return std::ranges::all_of(
      planes, [&](const Plane& plane) { return std::isnan(plane.first[texel * plane.stride]); });
}

// Calls refuse("channel C is VALUE at texel X,Y") for every value that is not usable.
template <class Usable, class Refuse>
void check_values(int width, int height, std::span<const Plane> planes, Holes holes, Usable usable,
                  Refuse refuse) {
  const size_t texels = static_cast<size_t>(width) * static_cast<size_t>(height);
  for (const Plane& plane : planes)
    for (size_t i = 0; i < texels; ++i) {
      const float value = plane.first[i * plane.stride];
      if (usable(value) || (holes == Holes::kOpen && is_hole(planes, i))) continue;
      const auto columns = static_cast<size_t>(width);
      refuse(fmt::format("channel {} is {} at texel {},{}", plane.channel, value, i % columns, i / columns));
    }
}

void check_finite(const fs::path& path, int width, int height, std::span<const Plane> planes, Holes holes) {
  check_values(
      width, height, planes, holes, [](float value) { return std::isfinite(value); },
      [&](const std::string& what) {
        throw std::logic_error(
            fmt::format("internal check failed: {}: {}, expected a finite number", path.string(), what));
      });
}

// An image being written into an OutputFile, which the caller commits.
class Writer {
 public:
  Writer(const OutputFile& file, const std::string& format, const OIIO::ImageSpec& spec)
      : file_(file), proxy_(file.descriptor()), spec_(spec), output_(OIIO::ImageOutput::create(format)) {
    OIIO::attribute("threads", thread_count());
    OIIO::attribute("exr_threads", thread_count());
    if (!output_ || !output_->set_ioproxy(&proxy_))
      throw std::logic_error("OpenImageIO cannot write " + format);
    // libpng tells the terminal of a file that ends before its first row.
    throw_if_cancelled();
    if (!output_->open(file.path().string(), spec_)) fail();
  }

  // Interleaves and writes block by block.
  // convert: sample from value, plane and texel.
  template <class Sample, class Convert>
  void write(std::span<const Plane> planes, Convert convert) {
    const int rows = rows_per_block();
    const auto width = static_cast<size_t>(spec_.width);
    std::vector<Sample> block(static_cast<size_t>(rows) * width * planes.size());
    for (int begin = 0; begin < spec_.height; begin += rows) {
      const int end = std::min(spec_.height, begin + rows);
      const size_t first_texel = static_cast<size_t>(begin) * width;
      const size_t texels = static_cast<size_t>(end - begin) * width;
      for (size_t k = 0; k < planes.size(); ++k)
        for (size_t i = 0; i < texels; ++i)
          block[i * planes.size() + k] =
              convert(planes[k].first[(first_texel + i) * planes[k].stride], k, first_texel + i);
      if (!output_->write_scanlines(begin, end, 0, OIIO::BaseTypeFromC<Sample>::value, block.data())) fail();
      throw_if_cancelled();
    }
    const bool closed = output_->close();
    if (!closed || proxy_.error_number() != 0) fail();
  }

 private:
  int rows_per_block() const {
    const int64_t rows = kValuesPerBlock / (int64_t{spec_.width} * spec_.nchannels) / kZipRows * kZipRows;
    return static_cast<int>(std::clamp<int64_t>(rows, kZipRows, kMaxRowsPerBlock));
  }

  [[noreturn]] void fail() const {
    if (proxy_.error_number() != 0) fail_write(file_.path(), proxy_.error_number());
    throw InputError(fmt::format("{}: could not write: {}", file_.path().string(), output_->geterror()));
  }

  const OutputFile& file_;
  FileProxy proxy_;
  OIIO::ImageSpec spec_;
  std::unique_ptr<OIIO::ImageOutput> output_;
};

OIIO::ImageSpec make_spec(int width, int height, std::span<const Plane> planes, OIIO::TypeDesc format,
                          const Provenance& provenance) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(planes.size()), format);
  for (size_t k = 0; k < planes.size(); ++k) spec.channelnames[k] = planes[k].channel;
  spec.alpha_channel = -1;
  spec.z_channel = -1;
  add_attributes(spec, provenance);
  return spec;
}

float as_float(float value, size_t, size_t) { return value; }

// value: 0..1.
template <class Integer>
Integer to_nearest(float value, size_t, size_t) {
  return static_cast<Integer>(static_cast<double>(value) * std::numeric_limits<Integer>::max() + 0.5);
}

void write_exr(const OutputFile& file, int width, int height, std::span<const Plane> planes,
               const Provenance& provenance) {
  OIIO::ImageSpec spec = make_spec(width, height, planes, OIIO::TypeDesc::FLOAT, provenance);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // else it writes the time of day, and no two runs give the same bytes
  Writer(file, "openexr", spec).write<float>(planes, as_float);
}

void write_png16(const OutputFile& file, int width, int height, std::span<const Plane> planes,
                 const Provenance& provenance) {
  if (planes.size() > 4)
    throw InputError(fmt::format("{}: {} channels do not fit a PNG, expected an .exr", file.path().string(),
                                 planes.size()));
  check_values(
      width, height, planes, Holes::kNone, [](float value) { return value >= 0 && value <= 1; },
      [&](const std::string& what) {
        throw InputError(
            fmt::format("{}: {}, expected 0..1 in a PNG (an .exr takes any)", file.path().string(), what));
      });
  const OIIO::ImageSpec spec = make_spec(width, height, planes, OIIO::TypeDesc::UINT16, provenance);
  Writer(file, "png", spec).write<uint16_t>(planes, to_nearest<uint16_t>);
}

constexpr std::array kTextureFormats = {
    TextureFormatInfo{"png16", ".png", 16, false}, TextureFormatInfo{"png8", ".png", 8, false},
    TextureFormatInfo{"exr", ".exr", 32, true}, TextureFormatInfo{"tif", ".tif", 32, true}};

// Rounds 255 times the value up with the probability of its remainder.
uint8_t dithered(float value, size_t plane, size_t texel) {
  const double scaled = static_cast<double>(value) * 255;
  return static_cast<uint8_t>(std::min(255.0, scaled + unit_interval(mix_bits(0, plane, texel))));
}

void write_png_texture(const OutputFile& file, OIIO::ImageSpec spec, std::span<const Plane> planes,
                       const TextureCoding& coding) {
  spec.attribute("png:compressionLevel", kPngLevel);
  if (coding.format == TextureFormat::kPng16)
    return Writer(file, "png", spec).write<uint16_t>(planes, to_nearest<uint16_t>);
  spec.set_format(OIIO::TypeDesc::UINT8);
  if (coding.dither) return Writer(file, "png", spec).write<uint8_t>(planes, dithered);
  Writer(file, "png", spec).write<uint8_t>(planes, to_nearest<uint8_t>);
}

void write_tif_texture(const OutputFile& file, OIIO::ImageSpec spec, std::span<const Plane> planes,
                       const Provenance& provenance) {
  spec.set_format(OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");
  spec.attribute("ImageDescription", provenance.dump());
  Writer(file, "tiff", spec).write<float>(planes, as_float);
}

}  // namespace

std::span<const TextureFormatInfo> texture_formats() { return kTextureFormats; }

const TextureFormatInfo& texture_format_info(TextureFormat format) {
  return kTextureFormats.at(static_cast<size_t>(format));
}

void write_texture(OutputFile& file, int width, int height, std::span<const Plane> planes,
                   const TextureCoding& coding, const Provenance& provenance) {
  if (width < 1 || height < 1 || planes.empty()) throw std::logic_error("a texture to write is empty");
  const bool is_float = texture_format_info(coding.format).is_float;
  check_values(
      width, height, planes, is_float ? holes_in(provenance) : Holes::kNone,
      [&](float value) { return is_float ? std::isfinite(value) : value >= 0 && value <= 1; },
      [&](const std::string& what) {
        throw std::logic_error(fmt::format("internal check failed: {}: {}, expected {}", file.path().string(),
                                           what, is_float ? "a finite number" : "0..1"));
      });
  if (coding.format == TextureFormat::kExr) return write_exr(file, width, height, planes, provenance);
  const OIIO::ImageSpec spec = make_spec(width, height, planes, OIIO::TypeDesc::UINT16, provenance);
  if (coding.format == TextureFormat::kTif) return write_tif_texture(file, spec, planes, provenance);
  write_png_texture(file, spec, planes, coding);
}

void write_image(OutputFile& file, int width, int height, std::span<const Plane> planes,
                 const Provenance& provenance) {
  if (width < 1 || height < 1 || planes.empty()) throw std::logic_error("an image to write is empty");
  check_finite(file.path(), width, height, planes, holes_in(provenance));
  const std::string extension = lower_case_extension(file.path());
  if (extension == ".exr") return write_exr(file, width, height, planes, provenance);
  if (extension == ".png") return write_png16(file, width, height, planes, provenance);
  throw InputError(
      fmt::format("{}: cannot write '{}' files, expected .exr or .png", file.path().string(), extension));
}

void write_image(const fs::path& path, int width, int height, std::span<const Plane> planes,
                 const Provenance& provenance) {
  OutputFile file(path);
  write_image(file, width, height, planes, provenance);
  file.commit();
}

void write_height_map(const fs::path& path, const Grid<float>& heights, const Provenance& provenance) {
  const Plane plane{"Y", heights.values.data()};
  write_image(path, heights.width, heights.height, {&plane, 1}, provenance);
}

void write_png8_rgb(OutputFile& file, const Grid<glm::vec3>& picture, const Provenance& provenance) {
  if (picture.empty()) throw std::logic_error("a picture to write is empty");
  const std::array planes{Plane{"R", &picture.values[0].x, 3}, Plane{"G", &picture.values[0].y, 3},
                          Plane{"B", &picture.values[0].z, 3}};
  check_finite(file.path(), picture.width, picture.height, planes, Holes::kNone);
  OIIO::ImageSpec spec = make_spec(picture.width, picture.height, planes, OIIO::TypeDesc::UINT8, provenance);
  spec.attribute("oiio:ColorSpace", "sRGB");
  Writer(file, "png", spec).write<uint8_t>(planes, [](float value, size_t, size_t) {
    return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
  });
}

void write_png8_rgb(const fs::path& path, const Grid<glm::vec3>& picture, const Provenance& provenance) {
  OutputFile file(path);
  write_png8_rgb(file, picture, provenance);
  file.commit();
}

}  // namespace hemibake
