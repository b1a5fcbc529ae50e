// A command as the program knows it: its options as fields, and what runs once they are set.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/context.h"
#include "core/field.h"

namespace hemibake {

// One call of a command.
struct Invocation {
  const Context& context;
  std::function<bool(const std::string& name)> given;  // whether an option was on the command line
  bool json = false;  // one JSON object on standard output; everything else on standard error

  // Prints the command's result on standard output: `json_result` with --json, else `text`. Throws InputError
  // where that cannot be written.
  void print(const nlohmann::json& json_result, const std::string& text) const;
};

struct CommandSetup {
  std::vector<Field> fields;
  // Returns the exit code (0 done, 1 a check failed). Throws the errors of core/error.h.
  std::function<int(const Invocation&)> run;
  std::string footer;  // of the help
};

// A command is one file in cli/ with one function setup_NAME. The fields refer to options that `run` owns.
struct Command {
  const char* name;
  const char* summary;
  CommandSetup (*setup)();
};

// Declares an option. name: long, or in capitals for a positional.
Field option(std::string name, Value value, std::string help);
Field required(Field field);
Field in_group(Field field, std::string group);
Field shown_as(Field field, std::string placeholder);
// -o, --output.
Field output_option(std::filesystem::path& output, std::string help);
// --bins, the resolution of curves.
Field bins_option(int& bins);

// Appends the fields of `more`.
void append(std::vector<Field>& fields, std::vector<Field> more);

}  // namespace hemibake
