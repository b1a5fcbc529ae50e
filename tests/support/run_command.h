// Runs a program the way a user does: what it prints and how it ends.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace hemibake {

struct CommandOutcome {
  int exit_code = -1;  // -1: ended by a signal
  std::string out;
  std::string err;
};

// command: a line for /bin/sh. folder: an existing one for the standard error's file.
inline CommandOutcome run_command(const std::string& command, const std::filesystem::path& folder) {
  const std::filesystem::path err = folder / "stderr.txt";
  CommandOutcome outcome;
  FILE* pipe = popen(("(" + command + ") 2>'" + err.string() + "'").c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> buffer;
  for (size_t got; (got = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.out.append(buffer.data(), got);
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::ifstream file(err, std::ios::binary);
  outcome.err.assign(std::istreambuf_iterator<char>(file), {});
  return outcome;
}

inline CommandOutcome run_hemibake(const std::string& arguments, const std::filesystem::path& folder) {
  return run_command("'" HEMIBAKE_BINARY "' " + arguments, folder);
}

}  // namespace hemibake
