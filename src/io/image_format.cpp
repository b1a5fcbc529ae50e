// First bytes: the specification of each format.
#include "io/image_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "io/byte_reader.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

using std::string_view_literals::operator""sv;

// Run lengths of TGA hold 128 texels of 4 bytes in 2.
constexpr ImageFormat kPng{"png", "PNG", 0, 0};
constexpr ImageFormat kJpeg{"jpeg", "JPEG", 0, 3};
constexpr ImageFormat kTiff{"tiff", "TIFF", 0, 0};
constexpr ImageFormat kExr{"openexr", "OpenEXR", 0, 0};
constexpr ImageFormat kWebp{"webp", "WebP", 0, 2};
constexpr ImageFormat kHdr{"hdr", "Radiance HDR", 0, 0};
constexpr ImageFormat kBmp{"bmp", "BMP", 0, 1};
constexpr ImageFormat kPnm{"pnm", "PNM", 0, 1};
constexpr ImageFormat kJpeg2000{"jpeg2000", "JPEG 2000", 0, 16};
constexpr ImageFormat kFits{"fits", "FITS", 1, 0};
constexpr ImageFormat kTarga{"targa", "TGA", 256, 1};

constexpr size_t kHeadBytes = 26;

struct Mark {
  size_t at;
  std::string_view bytes;
};

struct ReadMark {
  Mark mark;
  const ImageFormat* format;
};

constexpr ReadMark kRead[] = {
    {{0, "\x89PNG\r\n\x1a\n"sv}, &kPng},
    {{0, "\xFF\xD8\xFF"sv}, &kJpeg},
    {{0, "II*\0"sv}, &kTiff},
    {{0, "MM\0*"sv}, &kTiff},
    {{0, "II+\0"sv}, &kTiff},
    {{0, "MM\0+"sv}, &kTiff},
    {{0, "\x76\x2F\x31\x01"sv}, &kExr},
    {{8, "WEBP"sv}, &kWebp},
    {{0, "#?RADIANCE"sv}, &kHdr},
    {{0, "#?RGBE"sv}, &kHdr},
    {{0, "BM"sv}, &kBmp},
    {{0, "\0\0\0\x0CjP  \r\n\x87\n"sv}, &kJpeg2000},
    {{0, "\xFF\x4F\xFF\x51"sv}, &kJpeg2000},
    {{0, "SIMPLE  ="sv}, &kFits},
};

struct OtherMark {
  Mark mark;
  const char* name;
};

constexpr OtherMark kOthers[] = {
    {{0, "GIF8"sv}, "a GIF"},
    {{0, "DDS "sv}, "a DDS texture"},
    {{0, "8BPS"sv}, "a Photoshop document"},
    {{0, "\x01\xDA"sv}, "an SGI image"},
    {{0, "FOR4"sv}, "a Maya IFF"},
    {{0, "FORM"sv}, "an IFF"},
    {{0, "SDPX"sv}, "a DPX"},
    {{0, "XPDS"sv}, "a DPX"},
    {{0, "\x80\x2A\x5F\xD7"sv}, "a Cineon"},
    {{0, "\x53\x80\xF6\x34"sv}, "a Softimage PIC"},
    {{0, "\0\0\x01\0"sv}, "an icon"},
    {{0, "Ptex"sv}, "a Ptex texture"},
    {{0, " BDV"sv}, "an OpenVDB volume"},
    {{4, "ftyp"sv}, "a HEIF, AVIF or film"},
    {{0, "\0\0\0\x0CJXL "sv}, "a JPEG XL"},
    {{0, "\xFF\x0A"sv}, "a JPEG XL"},
    {{0, "qoif"sv}, "a QOI"},
    {{0, "\xABKTX"sv}, "a KTX texture"},
    {{0, "\x1A\x45\xDF\xA3"sv}, "a film"},
    {{8, "AVI "sv}, "a film"},
    {{0, "%PDF"sv}, "a PDF"},
    {{0, "gimp xcf"sv}, "a GIMP document"},
    {{0, "\x89HDF"sv}, "an HDF5 file"},
    {{0, "PK\x03\x04"sv}, "a ZIP archive"},
    {{0, "\x1F\x8B"sv}, "a gzip archive"},
};

bool has(std::string_view head, const Mark& mark) {
  return head.size() >= mark.at + mark.bytes.size() && head.substr(mark.at, mark.bytes.size()) == mark.bytes;
}

// PBM to PPM, and the floats of PFM.
bool is_pnm(std::string_view head) {
  if (head.size() < 3 || head[0] != 'P') return false;
  const bool is_kind = (head[1] >= '1' && head[1] <= '6') || head[1] == 'f' || head[1] == 'F';
  return is_kind && (std::string_view(" \t\r\n#").find(head[2]) != std::string_view::npos);
}

// TGA has no mark at its begin: its name and a sane header tell it, or the mark of version 2 at its end.
bool is_targa(const std::filesystem::path& path, std::string_view head) {
  constexpr size_t kHeaderBytes = 18;
  constexpr std::string_view kFooter = "TRUEVISION-XFILE."sv;
  if (head.size() < kHeaderBytes) return false;
  const auto byte_at = [&](size_t place) { return int{static_cast<unsigned char>(head[place])}; };
  const int color_map = byte_at(1), kind = byte_at(2), bits = byte_at(16);
  const bool is_kind = (kind >= 1 && kind <= 3) || (kind >= 9 && kind <= 11);
  const bool is_depth = bits == 8 || bits == 15 || bits == 16 || bits == 24 || bits == 32;
  if (!is_kind || !is_depth || color_map > 1) return false;
  if (lower_case_extension(path) == ".tga") return true;
  std::ifstream file(path, std::ios::binary);
  std::string end(kFooter.size(), '\0');
  file.seekg(-static_cast<std::streamoff>(kFooter.size()) - 1, std::ios::end);
  return file.read(end.data(), static_cast<std::streamsize>(end.size())) && end == kFooter;
}

}  // namespace

const ImageFormat& image_format_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(kHeadBytes, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(file.gcount()));
  for (const ReadMark& known : kRead)
    if (has(head, known.mark)) return *known.format;
  if (is_pnm(head)) return kPnm;
  constexpr const char* kExpected =
      "PNG, TIFF, OpenEXR, JPEG, WebP, Radiance HDR, BMP, TGA, PNM, PFM, JPEG 2000 or FITS";
  for (const OtherMark& other : kOthers)
    if (has(head, other.mark))
      throw InputError(
          fmt::format("is {}, which is not read, expected {}: convert it to PNG, TIFF or OpenEXR", other.name,
                      kExpected));
  if (is_targa(path, head)) return kTarga;
  throw InputError(fmt::format("is not an image that can be read, expected {}", kExpected));
}

// Layout: ITU-T T.800, annex A.5.1: SIZ follows the start of the codestream.
ImageClaim jpeg2000_claim(const std::filesystem::path& path) {
  constexpr std::string_view kStart = "\xFF\x4F\xFF\x51"sv;
  std::ifstream file(path, std::ios::binary);
  std::string block(size_t{1} << 20, '\0');
  file.read(block.data(), static_cast<std::streamsize>(block.size()));
  block.resize(static_cast<size_t>(file.gcount()));
  const size_t start = block.find(kStart);
  if (start == std::string::npos) return {};
  ByteReader bytes(path);
  bytes.order = std::endian::big;
  const auto at = [&](size_t offset, int count) {
    return static_cast<int64_t>(bytes.at(start + offset, count));
  };
  return {at(8, 4) - at(16, 4), at(12, 4) - at(20, 4), at(40, 2)};
}

// Layout: openexr.com/en/latest/OpenEXRFileLayout.html: attributes of name, type, size and value; an empty
// name ends a part, and in files of several parts another ends them all.
ExrClaim exr_claim(const std::filesystem::path& path) {
  constexpr uint64_t kSeveralParts = 0x1000;
  constexpr size_t kMostName = 256;
  std::error_code ignored;
  const uint64_t size = std::filesystem::file_size(path, ignored);
  ByteReader bytes(path);
  const bool has_parts = (bytes.at(4, 4) & kSeveralParts) != 0;
  uint64_t at = 8;
  const auto take_name = [&] {
    std::string name;
    for (char c; name.size() < kMostName && (c = static_cast<char>(bytes.at(at++, 1))) != 0;) name += c;
    return name;
  };
  ExrClaim claim;
  for (bool ended = false; at < size;) {
    const std::string name = take_name();
    if (name.empty() && (!has_parts || ended)) return claim;
    ended = name.empty();
    if (ended) continue;
    take_name();  // type
    const uint64_t value_at = at + 4, value_size = bytes.at(at, 4);
    if (value_at > size || value_size > size - value_at) break;
    at = value_at + value_size;
    if (name != "dataWindow") continue;
    const auto edge = [&](uint64_t offset) {
      return int64_t{static_cast<int32_t>(bytes.at(value_at + offset, 4))};
    };
    claim.width = std::max(claim.width, edge(8) - edge(0) + 1);
    claim.height = std::max(claim.height, edge(12) - edge(4) + 1);
  }
  claim.is_whole = false;
  return claim;
}

}  // namespace hemibake
