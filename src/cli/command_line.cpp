#include "cli/command_line.h"

#include <initializer_list>
#include <string_view>

namespace hemibake {
namespace {

bool starts_with_any(std::string_view argument, std::initializer_list<std::string_view> prefixes) {
  for (const std::string_view prefix : prefixes)
    if (argument.starts_with(prefix)) return true;
  return false;
}

// Returns the number of arguments from `argument` on that change no byte of a result.
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

}  // namespace hemibake
