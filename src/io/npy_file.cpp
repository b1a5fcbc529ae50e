// Layout: numpy.lib.format, versions 1.0, 2.0 and 3.0.
#include "io/npy_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/printable.h"
#include "io/input_file.h"
#include "io/sample.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::string_view kMagic = "\x93NUMPY"sv;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& fault) {
  throw InputError(fmt::format("{}: {}", path.string(), fault));
}

// Returns what follows 'KEY': in the header, a Python dictionary; empty where it is not there.
std::string_view after_key(std::string_view header, std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const std::string quoted = fmt::format("{0}{1}{0}", quote, key);
    const size_t at = header.find(quoted);
    if (at == std::string_view::npos) continue;
    header.remove_prefix(at + quoted.size());
    const size_t value = header.find_first_not_of(": ");
    return value == std::string_view::npos ? "" : header.substr(value);
  }
  return "";
}

// Returns the type of a descr such as '<u2'; booleans and complex numbers are none.
std::optional<SampleType> parse_descr(std::string_view text) {
  if (text.size() < 5 || (text[0] != '\'' && text[0] != '"') || text[4] != text[0]) return std::nullopt;
  const std::string name = fmt::format("{}{}{}", text[2], (text[3] - '0') * 8,
                                       text[3] == '1'   ? ""
                                       : text[1] == '>' ? "be"
                                                        : "le");
  return parse_sample_type(name);
}

// Returns the numbers of a shape such as (256, 512).
std::vector<uint64_t> parse_shape(std::string_view text) {
  std::vector<uint64_t> shape;
  const size_t end = text.find(')');
  if (!text.starts_with('(') || end == std::string_view::npos) return shape;
  const char* at = text.data() + 1;
  const char* last = text.data() + end;
  while (at < last) {
    uint64_t value = 0;
    const auto [next, error] = std::from_chars(at, last, value);
    const bool is_between = *at == ',' || *at == ' ' || *at == 'L';  // 16L: Python 2
    if (error != std::errc{} && !is_between) return {};
    if (error == std::errc{}) shape.push_back(value);
    at = error == std::errc{} ? next : at + 1;
  }
  return shape;
}

SampleLayout parse_header(const std::filesystem::path& path, std::string_view header) {
  SampleLayout layout;
  const std::string_view descr = after_key(header, "descr");
  const auto type = parse_descr(descr);
  if (!type)
    refuse(path, fmt::format("holds numbers of type {}, expected integers or floats of one array",
                             excerpt(descr.substr(0, descr.find(',')))));
  layout.type = *type;
  layout.is_column_major = after_key(header, "fortran_order").starts_with("True");
  const std::vector<uint64_t> shape = parse_shape(after_key(header, "shape"));
  const std::string_view text = after_key(header, "shape");
  if (shape.size() < 2 || shape.size() > 3 || (shape.size() == 3 && shape[2] != 1))
    refuse(path, fmt::format("is an array of shape {}, expected rows and columns",
                             excerpt(text.substr(0, text.find(')') + 1))));
  if (shape[0] == 0 || shape[1] == 0 || shape[0] > kMaxTexels || shape[1] > kMaxTexels / shape[0])
    refuse(path,
           fmt::format("is an array of {} x {} numbers, expected 1 to {}", shape[0], shape[1], kMaxTexels));
  layout.height = static_cast<int>(shape[0]);
  layout.width = static_cast<int>(shape[1]);
  return layout;
}

}  // namespace

bool is_npy_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic(kMagic.size(), '\0');
  return file.read(magic.data(), static_cast<std::streamsize>(magic.size())) && magic == kMagic;
}

HeightFile read_npy_file(const std::filesystem::path& path, std::optional<double> no_data) {
  const std::string bytes = read_whole_file(path);
  constexpr SampleType kShort{'u', 2, false}, kLong{'u', 4, false};
  const size_t length_at = kMagic.size() + 2;
  const bool is_first = bytes.size() > kMagic.size() && bytes[kMagic.size()] == 1;
  const size_t header_at = length_at + (is_first ? 2 : 4);
  if (bytes.size() < header_at) refuse(path, "is cut short, expected a whole .npy");
  if (bytes[kMagic.size()] < 1 || bytes[kMagic.size()] > 3)
    refuse(path, fmt::format("is of version {} of the format, expected 1 to 3", bytes[kMagic.size()] + 0));
  const auto length = static_cast<size_t>(decode_sample(&bytes[length_at], is_first ? kShort : kLong));
  if (bytes.size() - header_at < length) refuse(path, "is cut short, expected a whole .npy");
  const SampleLayout layout = parse_header(path, std::string_view(bytes).substr(header_at, length));
  const std::string_view values = std::string_view(bytes).substr(header_at + length);
  const size_t expected = static_cast<size_t>(layout.width) * static_cast<size_t>(layout.height) *
                          static_cast<size_t>(layout.type.bytes);
  if (values.size() != expected)
    refuse(path, fmt::format("has {} bytes of numbers, expected {} of {} x {} {}", values.size(), expected,
                             layout.width, layout.height, sample_type_name(layout.type)));
  require_read_memory(path, layout);
  HeightFile file;
  file.format = "NumPy";
  read_samples(path, values, layout, no_data, file);
  return file;
}

}  // namespace hemibake
