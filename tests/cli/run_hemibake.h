// Runs the real binary, for tests of the command line.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/grid.h"
#include "io/io_testing.h"
#include "surface/synthetic/synthetic.h"

namespace hemibake {

struct CommandResult {
  int exit_code;
  std::string standard_output;
  std::string standard_error;
};

// line: for /bin/sh. A signal counts as exit code 128 + its number.
CommandResult run_shell(const std::string& line);

// arguments: as typed in a shell after the program's name.
CommandResult run_hemibake(const std::string& arguments);

// A test with its own folder, in which hemibake runs.
class CliTest : public testing::Test {
 protected:
  void write_map(const std::string& name, SyntheticKind kind, int width, int height) const;
  void write_map(const std::string& name, const Grid<float>& heights) const;

  // before: shell commands to run first ("ulimit -f 8; ").
  CommandResult run(const std::string& arguments, const std::string& before = "") const;
  // Runs hemibake on one thread and sends `signal` ("INT") once, when it has worked for 1.5 s of processor
  // time however busy the machine is, or after 60 s.
  CommandResult run_interrupted(const std::string& arguments, const std::string& signal) const;
  // Runs hemibake and expects success.
  CommandResult run_well(const std::string& arguments) const;
  // Returns the object that run_well prints with --json.
  nlohmann::json run_json(const std::string& arguments) const;

  // Expects exit code 2, nothing on standard output, and on standard error the one line "hemibake: LINE" with
  // LINE as `line` says; and that every file in the folder is as it was and no other is there.
  void expect_refusal(const std::string& arguments, const testing::Matcher<std::string>& line,
                      const std::string& before = "") const;

  // Returns every file below the folder, hidden ones too, with size and time.
  std::map<std::string, std::string> listing() const;

  TemporaryFolder folder_;
};

}  // namespace hemibake
