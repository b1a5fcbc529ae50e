// RAII for HDF5 identifiers, exceptions for its failures. Only for links_file.
#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace hemibake {

// A call to HDF5 that failed, with the innermost reason that the library gives.
class Hdf5Error : public std::runtime_error {
 public:
  Hdf5Error(const std::string& reason, int number) : std::runtime_error(reason), error_number(number) {}
  int error_number;  // errno where the operating system refused, else 0
};

// Throws the library's pending error.
[[noreturn]] void throw_hdf5_error();

// Returns the result of a call; throws Hdf5Error where it is negative, which means failed.
template <class Result>
Result checked(Result result) {
  if (result < 0) throw_hdf5_error();
  return result;
}

// Keeps HDF5 from printing its errors.
class Hdf5Silence {
 public:
  Hdf5Silence();
  ~Hdf5Silence();
  Hdf5Silence(const Hdf5Silence&) = delete;
  Hdf5Silence& operator=(const Hdf5Silence&) = delete;

 private:
  H5E_auto2_t print_ = nullptr;
  void* client_data_ = nullptr;
};

// An open identifier.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  // Throws Hdf5Error where `id` is negative: the call that returned it failed.
  Hdf5Handle(hid_t id, Close closer) : id_(checked(id)), close_(closer) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;

  hid_t id() const { return id_; }
  // Closes; throws Hdf5Error where that fails.
  void close() { checked(close_(std::exchange(id_, -1))); }

 private:
  hid_t id_;
  Close close_;
};

}  // namespace hemibake
