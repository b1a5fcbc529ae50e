// The head of LINKS.h5: where the arrays stand in the file, so that reading it needs no HDF5.
//
// It fills the user block, the bytes before the HDF5 that HDF5 leaves alone:
//   hemibake links 2 BYTES SHA256\n    BYTES: of the head, 16 digits; SHA256: of the rest of it
//   {"bytes": of the file, "gather": MATRIX, "patches": MATRIX or null, "direct": ARRAY, "provenance": {…}}
// and spaces. MATRIX: {"rows", "columns", "indptr": ARRAY, "indices": ARRAY, "weights": ARRAY}. ARRAY:
// {"offset": in the file, "count": of numbers, "sha256": of its bytes}. In files of number 1 patches were
// numbered otherwise.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "io/provenance.h"

namespace hemibake {

struct StoredArray {
  uint64_t offset = 0, count = 0;
  std::string sha256;
};

struct StoredMatrix {
  uint32_t rows = 0, columns = 0;
  StoredArray row_begins, indices, weights;
};

struct LinksLayout {
  uint64_t file_bytes = 0;
  StoredMatrix gather;
  std::optional<StoredMatrix> patches;  // none: gather itself
  StoredArray direct;
  Provenance provenance;
};

// Returns the bytes of a head with room for this provenance: a power of two, as HDF5 wants.
uint64_t links_head_bytes(const Provenance& provenance);

// Returns the head, filled up to `head_bytes`.
std::string links_head(const LinksLayout& layout, uint64_t head_bytes);

// Reads the head. Throws InputError where the file has none, or it is not as written: another hash, arrays
// that do not fit the file or each other.
LinksLayout read_links_layout(const std::filesystem::path& path);

// Throws InputError "PATH: is not a whole links file (FAULT), expected …".
[[noreturn]] void refuse_links(const std::filesystem::path& path, const std::string& fault);

}  // namespace hemibake
