#include "io/hdf5_handle.h"

#include <cstdlib>
#include <string_view>

namespace hemibake {
namespace {

struct Reason {
  std::string text;
  int error_number = 0;
};

// Collects text and errno from an entry of the error stack; HDF5 calls it from the innermost entry outwards.
herr_t collect_reason(unsigned depth, const H5E_error2_t* entry, void* reason_pointer) noexcept {
  Reason& reason = *static_cast<Reason*>(reason_pointer);
  const std::string_view text = entry->desc ? entry->desc : "";
  if (depth == 0) reason.text = text.substr(0, text.find('\n'));
  // HDF5 gives the errno only in words: "file write failed: time = …, errno = 28, error message = …".
  constexpr std::string_view kMark = "errno = ";
  const size_t mark = text.find(kMark);
  if (mark != std::string_view::npos)
    reason.error_number = static_cast<int>(std::strtol(text.data() + mark + kMark.size(), nullptr, 10));
  return 0;
}

}  // namespace

void throw_hdf5_error() {
  Reason reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, collect_reason, &reason);
  H5Eclear2(H5E_DEFAULT);
  throw Hdf5Error(reason.text.empty() ? "HDF5 gives no reason" : reason.text, reason.error_number);
}

Hdf5Silence::Hdf5Silence() {
  // Its clean-up at exit crashes (1.10.8) where a file could not be flushed; every handle here closes itself.
  H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &print_, &client_data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5Silence::~Hdf5Silence() { H5Eset_auto2(H5E_DEFAULT, print_, client_data_); }

}  // namespace hemibake
