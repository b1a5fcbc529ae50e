#include "io/netcdf_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "io/byte_reader.h"

namespace hemibake {
namespace {

constexpr uint64_t kClassicMark = 0x434446;  // "CDF"
constexpr uint64_t kMostItems = 1 << 16;     // of a list; more is no header
constexpr uint64_t kPadding = 4;

// Walks a header as the file format specification of netCDF (Unidata) lists it.
class ClassicHeader {
 public:
  explicit ClassicHeader(const std::filesystem::path& path) : file_(path) {
    file_.order = std::endian::big;
    const uint64_t version = file_.at(3, 1);
    is_classic_ = file_.at(0, 3) == kClassicMark && (version == 1 || version == 2 || version == 5);
    count_bytes_ = version == 5 ? 8 : 4;
    offset_bytes_ = version == 1 ? 4 : 8;
  }

  bool is_classic() const { return is_classic_; }

  // Returns where the last byte of the variables without records would be; 0: the header is none.
  uint64_t end_of_variables() {
    position_ = 4;
    take(count_bytes_);  // records
    std::vector<uint64_t> lengths;
    for (uint64_t i = 0, count = take_list(); i < count; ++i) {
      skip_name();
      lengths.push_back(take(count_bytes_));
    }
    skip_attributes();
    uint64_t end = 0;
    for (uint64_t i = 0, count = take_list(); i < count; ++i) end = std::max(end, end_of_variable(lengths));
    return is_whole_ ? end : 0;
  }

 private:
  uint64_t take(int bytes) {
    const uint64_t value = file_.at(position_, bytes);
    position_ += static_cast<uint64_t>(bytes);
    return value;
  }

  // Returns the length of a list.
  uint64_t take_list() {
    take(4);  // its kind
    const uint64_t count = take(count_bytes_);
    if (count > kMostItems) is_whole_ = false;
    return is_whole_ ? count : 0;
  }

  void skip_padded(uint64_t bytes) { position_ += (bytes + kPadding - 1) / kPadding * kPadding; }
  void skip_name() { skip_padded(take(count_bytes_)); }

  void skip_attributes() {
    constexpr uint64_t kBytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};  // of the types by number
    for (uint64_t i = 0, count = take_list(); i < count; ++i) {
      skip_name();
      const uint64_t type = take(4);
      if (type >= std::size(kBytes)) is_whole_ = false;
      if (!is_whole_) return;
      skip_padded(take(count_bytes_) * kBytes[type]);
    }
  }

  uint64_t end_of_variable(const std::vector<uint64_t>& lengths) {
    skip_name();
    const uint64_t dimensions = take(count_bytes_);
    if (dimensions > lengths.size()) is_whole_ = false;
    bool has_records = false;
    for (uint64_t d = 0; is_whole_ && d < dimensions; ++d) {
      const uint64_t index = take(count_bytes_);
      has_records = has_records || index >= lengths.size() || lengths[index] == 0;
    }
    skip_attributes();
    take(4);  // type
    const uint64_t size = take(count_bytes_);
    const uint64_t begin = take(offset_bytes_);
    return has_records ? 0 : begin + size - std::min(size, kPadding - 1);
  }

  ByteReader file_;
  bool is_classic_ = false, is_whole_ = true;
  int count_bytes_ = 4, offset_bytes_ = 4;
  uint64_t position_ = 0;
};

}  // namespace

std::string netcdf_error(const std::filesystem::path& path) {
  ClassicHeader header(path);
  if (!header.is_classic()) return "";
  const uint64_t end = header.end_of_variables();
  std::error_code gone;
  const uint64_t size = std::filesystem::file_size(path, gone);
  if (gone) return "could not read: " + gone.message();
  if (end > 0 && end <= size) return "";
  if (end == 0) return "holds no whole variable, expected a whole file of netCDF";
  return fmt::format("is cut short: has {} bytes, expected {}", size, end);
}

}  // namespace hemibake
