#include "io/raw_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "io/input_file.h"
#include "io/sample.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

// Parses a whole positive number at the start of `text` and removes it; 0 where there is none.
int take_number(std::string_view& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || value < 1) return 0;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return value;
}

SampleLayout parse_layout(const std::filesystem::path& path, const std::string& text) {
  SampleLayout layout;
  std::string_view rest = text;
  layout.width = take_number(rest);
  const bool has_x = rest.starts_with('x');
  if (has_x) rest.remove_prefix(1);
  layout.height = take_number(rest);
  const auto type = rest.starts_with(':') ? parse_sample_type(rest.substr(1)) : std::optional<SampleType>();
  if (layout.width == 0 || !has_x || layout.height == 0 || !type)
    throw InputError(
        fmt::format("{}: --raw is '{}', expected WIDTHxHEIGHT:TYPE as 512x512:u16le, TYPE one of "
                    "u8, i8, and u16, i16, u32, i32, f16, f32, f64 with le or be",
                    path.string(), text));
  layout.type = *type;
  if (static_cast<uint64_t>(layout.width) * static_cast<uint64_t>(layout.height) > kMaxTexels)
    throw InputError(fmt::format("{}: --raw claims {} x {} texels, expected at most {}", path.string(),
                                 layout.width, layout.height, kMaxTexels));
  return layout;
}

std::vector<std::string> likely_types(const std::string& extension) {
  if (extension == ".r8") return {"u8"};
  if (extension == ".r16") return {"u16le"};
  if (extension == ".r32" || extension == ".f32") return {"f32le"};
  return {"u8", "u16le", "f32le"};
}

}  // namespace

bool is_raw_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const char* known : {".raw", ".r8", ".r16", ".r32", ".f32", ".bin"})
    if (extension == known) return true;
  return false;
}

std::string raw_suggestion(const std::filesystem::path& path) {
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error) return "";
  std::vector<std::string> squares;
  for (const std::string& type : likely_types(lower_extension(path))) {
    const auto bytes = static_cast<uint64_t>(parse_sample_type(type)->bytes);
    const auto side = static_cast<uint64_t>(std::llround(std::sqrt(static_cast<double>(size / bytes))));
    if (side > 0 && side * side * bytes == size) squares.push_back(fmt::format("{0}x{0}:{1}", side, type));
  }
  if (squares.empty())
    return fmt::format("it has {} bytes, which no square of {} texels fills", size,
                       fmt::join(likely_types(lower_extension(path)), ", "));
  return fmt::format("it has {} bytes, as --raw {} has", size, fmt::join(squares, " or "));
}

HeightFile read_raw_file(const std::filesystem::path& path, const std::string& layout_text,
                         std::optional<double> no_data) {
  const SampleLayout layout = parse_layout(path, layout_text);
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(path, error);
  const uint64_t expected = static_cast<uint64_t>(layout.width) * static_cast<uint64_t>(layout.height) *
                            static_cast<uint64_t>(layout.type.bytes);
  if (!error && size != expected)
    throw InputError(fmt::format("{}: has {} bytes, expected {} of --raw {}; {}", path.string(), size,
                                 expected, layout_text, raw_suggestion(path)));
  require_read_memory(path, layout);
  HeightFile file;
  file.format = "raw";
  read_samples(path, read_whole_file(path), layout, no_data, file);
  return file;
}

}  // namespace hemibake
