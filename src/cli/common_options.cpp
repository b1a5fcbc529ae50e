#include "cli/common_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "core/parallel.h"

namespace hemibake {

void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_flag("--json", options.json,
               "print one JSON object on standard output, everything else on standard error");
  app.add_option("--threads", options.threads, "threads to use, 0 = all")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

void apply_common_options(const CommonOptions& options) { set_thread_count(options.threads); }

void print_result(const CommonOptions& options, const nlohmann::json& json, const std::string& text) {
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}", text);
  }
}

}  // namespace hemibake
