// The command line, parsed with CLI11: the only place that knows it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "cli/options/command.h"

namespace hemibake {

struct ParsedCommand {
  CommandSetup setup;
  std::function<bool(const std::string& name)> given;
  bool json = false;
  int threads = 0;
};

// Sets the fields of the command that was called. None: help or version was asked for, and printed. Throws
// InputError for everything that cannot be parsed.
std::optional<ParsedCommand> parse_command_line(int argc, char** argv, std::span<const Command> commands);

}  // namespace hemibake
