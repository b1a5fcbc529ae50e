// How a result was made: an object that every file written carries.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "io/json_reader.h"

struct evp_md_ctx_st;  // of OpenSSL

namespace hemibake {

// A JSON object of names and scalars (string, boolean, integer, finite number), in the order added. Nothing
// in it may depend on the time, the host or the number of threads where the file is to be the same at every
// run.
using Provenance = nlohmann::ordered_json;

// Returns `version`, `command`, `input` (the file's name without its folder) and `input_sha256`. Throws
// InputError where the input cannot be read. command: one line that makes the result again.
Provenance make_provenance(std::string_view command, const std::filesystem::path& input);

// Returns `version` and `command`, for results made from no input.
Provenance make_provenance(std::string_view command);

// Parses a provenance out of a file. Throws InputError "PLACE: …" where it is no JSON object of scalars, or
// an entry that is a text in every file is none. place: for errors: "FILE: attribute hemibake:provenance".
Provenance parse_provenance(std::string_view text, const std::string& place);

// Throws InputError where a value out of a file is no provenance.
void check_read_provenance(const JsonReader& provenance);

// Throws std::logic_error naming an entry that is not as described above, or whose name is empty or
// "provenance", the name that files give the whole.
void check_provenance(const Provenance& provenance);

// The hash of bytes that come piece by piece.
class Sha256 {
 public:
  Sha256();
  void add(const void* bytes, size_t count);
  // Returns 64 hexadecimal digits; to be asked once.
  std::string digits();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

// Returns 64 hexadecimal digits. Throws InputError where the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

// Replaces every byte that is not UTF-8 by U+FFFD: file names may hold any byte, JSON and HDF5 may not.
std::string valid_utf8(std::string_view text);

}  // namespace hemibake
