#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/common_options.h"

namespace hemibake {
CommandBody setup_synth(CLI::App& app) {
  auto options = std::make_shared<CommonOptions>();
  add_common_options(app, *options);
  return [options] { apply_common_options(*options); return 0; };
}
}  // namespace hemibake
