#include "io/provenance.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>

#include "core/context.h"
#include "core/error.h"
#include "core/version.h"
#include "io/json_text.h"

namespace hemibake {
namespace {

constexpr size_t kHashBlockBytes = size_t{1} << 20;

// Entries that are a text in every file that has them.
constexpr std::array<std::string_view, 15> kTexts = {
    "version",      "command",        "input",   "input_sha256",  "input_path",
    "normals_path", "normals_sha256", "geo_crs", "geo_transform", "geo_nodata",
    "texture",      "tracer",         "edge",    "holes",         "normals"};

}  // namespace

Provenance make_provenance(std::string_view command) {
  return {{"version", kVersion}, {"command", valid_utf8(command)}};
}

Provenance make_provenance(std::string_view command, const std::filesystem::path& input) {
  Provenance provenance = make_provenance(command);
  provenance["input"] = valid_utf8(input.filename().string());
  provenance["input_sha256"] = sha256_of_file(input);
  return provenance;
}

Provenance parse_provenance(std::string_view text, const std::string& place) {
  Provenance provenance = parse_json(text, place);
  check_read_provenance({provenance, place});
  return provenance;
}

void check_read_provenance(const JsonReader& provenance) {
  for (const auto& [name, value] : provenance.members()) {
    if (!value.is_text() && !value.is_number() && !value.is_flag())
      value.refuse("a text, a number, or true or false");
    if (std::ranges::find(kTexts, name) != kTexts.end()) value.text();
  }
}

void check_provenance(const Provenance& provenance) {
  if (!provenance.is_object()) throw std::logic_error("provenance is not an object of names and scalars");
  for (const auto& [name, value] : provenance.items()) {
    if (name.empty() || name == "provenance")
      throw std::logic_error(fmt::format("provenance names an entry '{}'", name));
    const bool scalar = value.is_string() || value.is_boolean() || value.is_number();
    if (!scalar || (value.is_number_float() && !std::isfinite(value.get<double>())))
      throw std::logic_error(
          fmt::format("provenance '{}' is {}, expected a finite scalar", name, value.dump()));
  }
}

std::string sha256_of_file(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw InputError(fmt::format("{}: could not read: {}", path.string(), std::strerror(errno)));
  Sha256 hash;
  std::vector<unsigned char> block(kHashBlockBytes);
  while (const size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    throw_if_cancelled();
    hash.add(block.data(), count);
  }
  if (std::ferror(file.get()))
    throw InputError(fmt::format("{}: could not read: {}", path.string(), std::strerror(errno)));
  return hash.digits();
}

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
}

void Sha256::add(const void* bytes, size_t count) { EVP_DigestUpdate(context_.get(), bytes, count); }

std::string Sha256::digits() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  EVP_DigestFinal_ex(context_.get(), digest.data(), &length);
  std::string text;
  for (unsigned i = 0; i < length; ++i) fmt::format_to(std::back_inserter(text), "{:02x}", digest[i]);
  return text;
}

std::string valid_utf8(std::string_view text) {
  const std::string dumped =
      nlohmann::ordered_json(text).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return nlohmann::ordered_json::parse(dumped).get<std::string>();
}

}  // namespace hemibake
