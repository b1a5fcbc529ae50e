// The command table. A command is one file in cli/ with one function `setup_NAME`: it declares the options on
// the command's CLI11 app and returns what runs once they are parsed.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace hemibake {

// Runs the command; returns the exit code (0 done, 1 a check failed). Throws the errors of core/error.h.
using CommandBody = std::function<int()>;

struct Command {
  const char* name;
  const char* summary;
  CommandBody (*setup)(CLI::App& app);
};

// Parses, runs, reports: the whole program. Exit codes: 0, 1 (a check failed), 2 (input or usage), 130
// (interrupted).
int run_command_line(int argc, char** argv);

}  // namespace hemibake
