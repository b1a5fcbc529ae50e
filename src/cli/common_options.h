// Options that every command has, and how a command speaks.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace hemibake {

struct CommonOptions {
  bool json = false;  // one JSON object on standard output; everything else on standard error
  int threads = 0;    // 0: all hardware threads
};

// Adds --json and --threads to `app`.
void add_common_options(CLI::App& app, CommonOptions& options);

// Adds --bins, the resolution of curves.
CLI::Option* add_bins_option(CLI::App& app, int& bins);

// To be called first when the command runs: sets the thread count.
void apply_common_options(const CommonOptions& options);

// The command's result on standard output: `json` with --json, else `text`. Throws InputError where that
// cannot be written.
void print_result(const CommonOptions& options, const nlohmann::json& json, const std::string& text);

}  // namespace hemibake
