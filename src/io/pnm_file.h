// Reads PGM and PPM of any largest value, exactly: OpenImageIO rounds those below 255 down.
#pragma once

#include <string>

#include "io/channel_reader.h"

namespace hemibake {

// A PGM or PPM, P2, P3, P5 or P6, with its values over the largest that its header names.
class PnmReader : public ChannelReader {
 public:
  // Reads the file. Throws InputError where the header is broken, the file cut short or a value too large.
  explicit PnmReader(const std::filesystem::path& path);

  void read(int begin, int end, const BlockVisitor& visit) override;

 private:
  std::string bytes_;
  size_t at_ = 0;  // of what is read next
  int max_value_ = 0;
  bool is_text_ = false;

  int read_number();
  int read_sample();
};

// Returns whether a file starts as one of these formats does.
bool is_pnm_file(const std::filesystem::path& path);

}  // namespace hemibake
