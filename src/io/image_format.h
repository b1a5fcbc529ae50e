// Tells the format of an image by its content, of those that are read: no other reader ever sees a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace hemibake {

struct ImageFormat {
  const char* reader;  // OpenImageIO's name of it: "openexr"
  const char* name;    // "OpenEXR"
  // Most bytes of samples that a byte of the file can stand for; 0: no limit is known.
  double most_expansion;
  // Says what the reader itself holds: bytes for each sample of the whole image; 0: some rows.
  double held_per_sample;
};

// Returns the format of a file. Throws InputError, without the file's name, that says what the file is, where
// that is known and not read, and what is read.
const ImageFormat& image_format_of(const std::filesystem::path& path);

struct ImageClaim {
  int64_t width = 0, height = 0, channels = 0;
};

// Returns the size that a JPEG 2000 names, whose reader decodes it on opening; zeros where it names none.
ImageClaim jpeg2000_claim(const std::filesystem::path& path);

struct ExrClaim {
  int64_t width = 0, height = 0;  // largest of all parts
  bool is_whole = true;           // no attribute is longer than the file
};

// Returns what the headers of an OpenEXR claim, whose reader takes memory for rows and attributes on opening.
ExrClaim exr_claim(const std::filesystem::path& path);

}  // namespace hemibake
