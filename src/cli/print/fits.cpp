#include "cli/print/fits.h"

#include <fmt/format.h>

namespace hemibake {

std::string text_from_fits(std::span<const NamedFit> fits) {
  std::string text;
  for (const auto& [name, fit] : fits) {
    text += fmt::format("{:12} {}\n{:12}", name, fit.formula, "");
    for (const FitParameter& parameter : fit.parameters) {
      text += fmt::format(" {} = {:.6g}", parameter.name, parameter.value);
      if (parameter.standard_error) text += fmt::format(" ± {:.2g}", *parameter.standard_error);
      text += ',';
    }
    text += fmt::format(" rms {:.5f}, max {:.5f}, {} points\n", fit.rms, fit.max_error, fit.points);
  }
  return text;
}

}  // namespace hemibake
