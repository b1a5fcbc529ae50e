#include "io/provenance.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include "core/context.h"
#include "core/error.h"

namespace hemibake {
namespace {

constexpr size_t kHashBlockBytes = size_t{1} << 20;

bool starts_with_any(std::string_view argument, std::initializer_list<std::string_view> prefixes) {
  for (const std::string_view prefix : prefixes)
    if (argument.starts_with(prefix)) return true;
  return false;
}

// How many arguments from `argument` on change no byte of a result.
int arguments_left_out(std::string_view argument) {
  if (argument == "--threads" || argument == "--output" || argument == "-o") return 2;
  if (argument == "--json" || starts_with_any(argument, {"--threads=", "--output="})) return 1;
  return argument.starts_with("-o") ? 1 : 0;
}

std::string shell_quoted(const std::string& argument) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) return argument;
  std::string quoted = "'";
  for (const char c : argument) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted.append("'");
}

}  // namespace

Provenance make_provenance(std::string_view command) {
  return {{"version", HEMIBAKE_VERSION}, {"command", valid_utf8(command)}};
}

Provenance make_provenance(std::string_view command, const std::filesystem::path& input) {
  Provenance provenance = make_provenance(command);
  provenance["input"] = valid_utf8(input.filename().string());
  provenance["input_sha256"] = sha256_of_file(input);
  return provenance;
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

std::vector<std::string> process_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

std::string command_line(const std::vector<std::string>& arguments) {
  std::string line = "hemibake";
  for (size_t i = 1; i < arguments.size(); ++i) {
    if (const int left_out = arguments_left_out(arguments[i])) {
      i += static_cast<size_t>(left_out) - 1;
    } else {
      line.append(" ").append(shell_quoted(arguments[i]));
    }
  }
  return line;
}

std::string sha256_of_file(const std::filesystem::path& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw InputError(fmt::format("{}: could not read: {}", path.string(), std::strerror(errno)));
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  std::vector<unsigned char> block(kHashBlockBytes);
  while (const size_t count = std::fread(block.data(), 1, block.size(), file.get())) {
    throw_if_cancelled();
    EVP_DigestUpdate(context.get(), block.data(), count);
  }
  if (std::ferror(file.get()))
    throw InputError(fmt::format("{}: could not read: {}", path.string(), std::strerror(errno)));
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  EVP_DigestFinal_ex(context.get(), digest.data(), &length);
  std::string text;
  for (unsigned i = 0; i < length; ++i) fmt::format_to(std::back_inserter(text), "{:02x}", digest[i]);
  return text;
}

std::string valid_utf8(std::string_view text) {
  const std::string dumped =
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return nlohmann::json::parse(dumped).get<std::string>();
}

}  // namespace hemibake
