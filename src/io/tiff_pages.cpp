// Layout: TIFF Revision 6.0, Adobe 1992, section 2; BigTIFF:
// libtiff.gitlab.io/libtiff/specification/bigtiff.html.
// WebP: developers.google.com/speed/webp/docs/riff_container.
#include "io/tiff_pages.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "io/sample.h"

namespace hemibake {
namespace {

constexpr uint64_t kSubfileTypeTag = 254, kOldSubfileTypeTag = 255, kNoDataTag = 42113, kOrientationTag = 274;
constexpr size_t kMaxPages = 65536, kMaxEntries = 4096, kMaxTextBytes = 64;

// Integers of a file in its byte order; failed() after one that is not there.
class TiffBytes {
 public:
  TiffBytes(const std::filesystem::path& path, uint64_t begin)
      : file_(path, std::ios::binary), begin_(begin) {
    const std::string mark = text(0, 2);
    big_endian_ = mark == "MM";
    if (!big_endian_ && mark != "II") failed_ = true;
  }

  bool failed() const { return failed_; }

  std::string text(uint64_t offset, size_t bytes) {
    std::string found(bytes, '\0');
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(begin_ + offset));
    file_.read(found.data(), static_cast<std::streamsize>(bytes));
    if (file_.gcount() != static_cast<std::streamsize>(bytes)) failed_ = true;
    return found;
  }

  uint64_t integer(uint64_t offset, size_t bytes) {
    std::string found = text(offset, bytes);
    if (!big_endian_) std::ranges::reverse(found);
    uint64_t value = 0;
    for (const char byte : found) value = value << 8 | static_cast<uint8_t>(byte);
    return value;
  }

 private:
  std::ifstream file_;
  uint64_t begin_;
  bool big_endian_ = false, failed_ = false;
};

struct Widths {
  size_t count, entry, offset;  // bytes of a directory's entry count, of an entry, of an offset
};

void read_entry(TiffBytes& file, uint64_t at, const Widths& widths, TiffPage& page) {
  const uint64_t tag = file.integer(at, 2), type = file.integer(at + 2, 2);
  const uint64_t value_at = at + 4 + widths.offset;
  if (tag == kSubfileTypeTag) {
    const uint64_t bits = file.integer(value_at, type == 3 ? 2 : 4);
    page.is_reduced = (bits & 1) != 0;
    page.is_mask = (bits & 4) != 0;
  } else if (tag == kOldSubfileTypeTag) {
    page.is_reduced = file.integer(value_at, 2) == 2;
  } else if (tag == kOrientationTag) {
    page.orientation = static_cast<int>(file.integer(value_at, 2));
  } else if (tag == kNoDataTag) {
    const auto bytes = std::min<size_t>(kMaxTextBytes, file.integer(at + 4, widths.offset));
    const std::string text =
        file.text(bytes <= widths.offset ? value_at : file.integer(value_at, widths.offset), bytes);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str()) page.no_data = value;
  }
}

}  // namespace

std::vector<TiffPage> tiff_pages(const std::filesystem::path& path, uint64_t begin) {
  TiffBytes file(path, begin);
  if (file.failed()) return {};
  const uint64_t version = file.integer(2, 2);
  if (version != 42 && version != 43) return {};
  const Widths widths = version == 42 ? Widths{2, 12, 4} : Widths{8, 20, 8};
  std::vector<TiffPage> pages;
  std::vector<uint64_t> seen;
  uint64_t at = file.integer(version == 42 ? 4 : 8, widths.offset);
  while (at != 0 && !file.failed() && pages.size() < kMaxPages) {
    if (std::ranges::find(seen, at) != seen.end()) return {};
    seen.push_back(at);
    const uint64_t entries = file.integer(at, widths.count);
    if (entries > kMaxEntries) return {};
    TiffPage page;
    for (uint64_t i = 0; i < entries; ++i)
      read_entry(file, at + widths.count + i * widths.entry, widths, page);
    pages.push_back(page);
    at = file.integer(at + widths.count + entries * widths.entry, widths.offset);
  }
  return file.failed() ? std::vector<TiffPage>() : pages;
}

int webp_orientation(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  char head[12];
  if (!file.read(head, sizeof(head)) || std::string_view(head, 4) != "RIFF" ||
      std::string_view(head + 8, 4) != "WEBP")
    return 1;
  uint64_t at = sizeof(head);
  constexpr SampleType kLong{'u', 4, false};
  for (char chunk[8]; file.seekg(static_cast<std::streamoff>(at)) && file.read(chunk, sizeof(chunk));) {
    const auto size = static_cast<uint64_t>(decode_sample(chunk + 4, kLong));
    at += sizeof(chunk);
    if (std::string_view(chunk, 4) == "EXIF") {
      char mark[6];
      const bool has_mark =
          file.read(mark, sizeof(mark)) && std::string_view(mark, 6) == std::string_view("Exif\0\0", 6);
      const std::vector<TiffPage> pages = tiff_pages(path, at + (has_mark ? sizeof(mark) : 0));
      return pages.empty() ? 1 : pages[0].orientation;
    }
    at += size + size % 2;
  }
  return 1;
}

}  // namespace hemibake
