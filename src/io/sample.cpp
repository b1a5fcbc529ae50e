#include "io/sample.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "core/memory_limit.h"
#include "io/file_context.h"
#include "io/height_sink.h"

namespace hemibake {
namespace {

// Returns the value of an IEEE 754 binary16 number.
double half_value(uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  double size = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  if (exponent == 31) size = fraction == 0 ? INFINITY : NAN;
  return bits >> 15 ? -size : size;
}

double float_value(uint64_t bits, int bytes) {
  if (bytes == 2) return half_value(static_cast<uint16_t>(bits));
  if (bytes == 4) return static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(bits)));
  return std::bit_cast<double>(bits);
}

}  // namespace

std::optional<SampleType> parse_sample_type(std::string_view text) {
  SampleType type;
  if (text.ends_with("le") || text.ends_with("be")) {
    type.is_big_endian = text.ends_with("be");
    text.remove_suffix(2);
    if (text.ends_with("8")) return std::nullopt;
  } else if (!text.ends_with("8")) {
    return std::nullopt;
  }
  for (const std::string_view known : {"u8", "i8", "u16", "i16", "u32", "i32", "f16", "f32", "f64"}) {
    if (text != known) continue;
    type.kind = known[0];
    type.bytes = known.ends_with("8") ? 1 : known.ends_with("16") ? 2 : known.ends_with("32") ? 4 : 8;
    return type;
  }
  return std::nullopt;
}

std::string sample_type_name(const SampleType& type) {
  if (type.kind == 'f') return type.bytes == 2 ? "half floats" : fmt::format("{}-bit floats", type.bytes * 8);
  return fmt::format("{}{}-bit integers", type.kind == 'i' ? "signed " : "", type.bytes * 8);
}

double decode_sample(const char* bytes, const SampleType& type) {
  uint64_t bits = 0;
  for (int i = 0; i < type.bytes; ++i)
    bits = bits << 8 | static_cast<uint8_t>(bytes[type.is_big_endian ? i : type.bytes - 1 - i]);
  if (type.kind == 'f') return float_value(bits, type.bytes);
  if (type.kind == 'u') return static_cast<double>(bits);
  const int unused = 64 - type.bytes * 8;
  return static_cast<double>(static_cast<int64_t>(bits << unused) >> unused);
}

void require_read_memory(const std::filesystem::path& path, const SampleLayout& layout) {
  const double texels = static_cast<double>(layout.width) * layout.height;
  with_file_context(path, [&] {
    require_map_memory(layout.width, layout.height, texels * (layout.type.bytes + kHeightBytesPerTexel));
  });
}

void read_samples(const std::filesystem::path& path, std::string_view bytes, const SampleLayout& layout,
                  std::optional<double> no_data, HeightFile& file) {
  const SampleType& type = layout.type;
  file.sample_type = sample_type_name(type);
  file.full_scale = type.kind == 'u' ? std::ldexp(1.0, type.bytes * 8) - 1 : 1;
  file.channels = {"Y"};
  file.channel = "Y";
  const auto width = static_cast<size_t>(layout.width), height = static_cast<size_t>(layout.height);
  HeightSink sink(path, layout.width, layout.height, no_data);
  for (size_t i = 0; i < width * height; ++i) {
    const size_t stored_at = layout.is_column_major ? i % width * height + i / width : i;
    const double stored = decode_sample(&bytes[stored_at * static_cast<size_t>(type.bytes)], type);
    sink.put(i, stored, static_cast<float>(stored / file.full_scale));
  }
  sink.finish(file);
}

}  // namespace hemibake
