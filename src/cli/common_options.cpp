#include "cli/common_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "cli/validators.h"
#include "core/error.h"
#include "core/parallel.h"

namespace hemibake {
namespace {

constexpr uint64_t kMaxThreads = 1024;
constexpr uint64_t kMaxBins = 65536;

}  // namespace

void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_flag("--json", options.json,
               "print one JSON object on standard output, everything else on standard error");
  app.add_option("--threads", options.threads, "threads to use, 0 = all")
      ->check(whole_number_in(0, kMaxThreads))
      ->capture_default_str();
}

CLI::Option* add_bins_option(CLI::App& app, int& bins) {
  return app.add_option("--bins", bins, "bins of equal width on the AO axis 0..1")
      ->check(whole_number_in(1, kMaxBins))
      ->capture_default_str();
}

void apply_common_options(const CommonOptions& options) { set_thread_count(options.threads); }

void print_result(const CommonOptions& options, const nlohmann::json& json, const std::string& text) {
  const std::string result = options.json ? json.dump(2) + "\n" : text;
  if (std::fwrite(result.data(), 1, result.size(), stdout) != result.size() || std::fflush(stdout) != 0)
    throw InputError(fmt::format("standard output: could not write: {}", std::strerror(errno)));
}

}  // namespace hemibake
