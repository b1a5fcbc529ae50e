#include "cli/print/warnings.h"

#include <fmt/format.h>

#include "cli/print/streams.h"

namespace hemibake {

void print_warnings(const std::string& what, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_message(fmt::format("{}: warning: {}", what, warning));
}

}  // namespace hemibake
