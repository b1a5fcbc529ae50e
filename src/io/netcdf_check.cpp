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

constexpr uint64_t kTypeBytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};  // by number
constexpr uint64_t kStreaming = 0xffffffff;  // records of a file that was not closed

// Walks a header as the file format specification of netCDF (Unidata) lists it. The library sets memory aside
// for what dimensions say, whatever length a variable claims: both are looked at.
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

  // Returns where the last byte of header and variables would be; 0: the header is none.
  uint64_t end_of_variables() {
    position_ = 4;
    records_ = take(count_bytes_);
    std::vector<uint64_t> lengths;
    for (uint64_t i = 0, count = take_list(); i < count; ++i) {
      skip_name();
      lengths.push_back(take(count_bytes_));
    }
    skip_attributes();
    uint64_t end = 0;
    for (uint64_t i = 0, count = take_list(); i < count; ++i) end = std::max(end, end_of_variable(lengths));
    return is_whole_ && end > 0 ? std::max(end, position_) : 0;
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

  void skip_padded(uint64_t bytes) {
    position_ += (std::min(bytes, kMost) + kPadding - 1) / kPadding * kPadding;
    if (position_ > kMost) is_whole_ = false;
  }
  void skip_name() { skip_padded(take(count_bytes_)); }

  void skip_attributes() {
    for (uint64_t i = 0, count = take_list(); i < count; ++i) {
      skip_name();
      const uint64_t bytes = take_type();
      if (!is_whole_) return;
      skip_padded(times(take(count_bytes_), bytes));
    }
  }

  uint64_t end_of_variable(const std::vector<uint64_t>& lengths) {
    skip_name();
    const uint64_t dimensions = take(count_bytes_);
    if (dimensions > lengths.size()) is_whole_ = false;
    bool has_records = false;
    uint64_t values = 1;
    for (uint64_t d = 0; is_whole_ && d < dimensions; ++d) {
      const uint64_t index = take(count_bytes_);
      if (index >= lengths.size()) is_whole_ = false;
      if (!is_whole_) return 0;
      has_records = has_records || lengths[index] == 0;
      if (lengths[index] > 0) values = times(values, lengths[index]);
    }
    skip_attributes();
    const uint64_t type_bytes = take_type();
    const uint64_t claimed = take(count_bytes_), begin = take(offset_bytes_);
    if (begin > kMost) is_whole_ = false;
    const uint64_t bytes = times(values, type_bytes);
    if (has_records) return records_ == kStreaming ? 0 : begin + times(bytes, records_);
    return begin + std::max(bytes, claimed - std::min(claimed, kPadding - 1));
  }

  // Returns the bytes of a value of the type that comes.
  uint64_t take_type() {
    const uint64_t type = take(4);
    if (type >= std::size(kTypeBytes)) is_whole_ = false;
    return is_whole_ ? kTypeBytes[type] : 0;
  }

  // Returns a product, or the most that a file can have.
  static uint64_t times(uint64_t a, uint64_t b) { return b > 0 && a > kMost / b ? kMost : a * b; }

  static constexpr uint64_t kMost = uint64_t{1} << 60;
  ByteReader file_;
  bool is_classic_ = false, is_whole_ = true;
  int count_bytes_ = 4, offset_bytes_ = 4;
  uint64_t position_ = 0, records_ = 0;
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
