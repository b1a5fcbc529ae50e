// Numbers as files without a decoder of their own store them: raw and NumPy.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "io/height_file.h"

namespace hemibake {

struct SampleType {
  char kind = 'u';  // u, i or f
  int bytes = 1;
  bool is_big_endian = false;
};

// Parses "u8", "i16le", "f32be". Empty where it is none: 8 bits take no byte order, wider types need one.
std::optional<SampleType> parse_sample_type(std::string_view text);

// Returns "16-bit integers", "half floats".
std::string sample_type_name(const SampleType& type);

// Returns the number at `bytes`, which holds type.bytes of them.
double decode_sample(const char* bytes, const SampleType& type);

struct SampleLayout {
  SampleType type;
  int width = 0, height = 0;
  bool is_column_major = false;
};

// Throws InputError naming the file where it and its heights do not fit the memory that there is for them.
void require_read_memory(const std::filesystem::path& path, const SampleLayout& layout);

// Reads one number per texel: unsigned integers over the largest of their type, all others as stored. Throws
// InputError naming the texel where one is infinite.
// bytes: those of all texels. file: gets values, holes, sample type, full scale and its one channel.
void read_samples(const std::filesystem::path& path, std::string_view bytes, const SampleLayout& layout,
                  std::optional<double> no_data, HeightFile& file);

}  // namespace hemibake
