#include "cli/print/referee.h"

#include <fmt/format.h>

namespace hemibake {
namespace {

const char* name_of(RefereeVerdict verdict) {
  switch (verdict) {
    case RefereeVerdict::kWithin:
      return "ok";
    case RefereeVerdict::kOutside:
      return "FAILED";
    case RefereeVerdict::kUndecided:
      return "open";
  }
  return "";
}

std::string line_of(const RefereeRow& row) {
  return fmt::format(
      "{:7} {:26} {:.2f}..{:.2f} {:7} {:10.6f} {:10.6f} {:+10.6f} ±{:9.6f} {:10.6f} {:10.6f}\n",
      name_of(row.verdict), row.quantity + "/pi", row.ao_low, row.ao_high, row.texels, row.bake_mean,
      row.referee_mean, row.bias, row.half_width, row.rms_difference, row.tolerance);
}

nlohmann::ordered_json rows_of(const std::vector<RefereeRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const RefereeRow& row : rows)
    list.push_back({{"quantity", row.quantity},
                    {"ao_low", row.ao_low},
                    {"ao_high", row.ao_high},
                    {"texels", row.texels},
                    {"bake_mean", row.bake_mean},
                    {"referee_mean", row.referee_mean},
                    {"bias", row.bias},
                    {"half_width", row.half_width},
                    {"rms_difference", row.rms_difference},
                    {"tolerance", row.tolerance},
                    {"verdict", name_of(row.verdict)}});
  return list;
}

}  // namespace

std::string table_from_referee(const RefereeCheck& check) {
  std::string text = fmt::format("referee: {} texels, {} paths each, {:.1f} M rays\n", check.texels,
                                 check.paths_per_texel, 1e-6 * static_cast<double>(check.rays));
  text += fmt::format("{:7} {:26} {:10} {:>7} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "", "quantity",
                      "ao", "texels", "bake", "referee", "bias", "interval", "rms", "tolerance");
  for (const RefereeRow& row : check.means) text += line_of(row);
  for (const RefereeRow& row : check.bins) text += line_of(row);
  return text;
}

nlohmann::ordered_json json_from_referee(const RefereeCheck& check) {
  return {{"passed", has_passed(check)},
          {"texels", check.texels},
          {"paths_per_texel", check.paths_per_texel},
          {"rays", check.rays},
          {"lost_rays", check.truncated_rays},
          {"means", rows_of(check.means)},
          {"bins", rows_of(check.bins)}};
}

}  // namespace hemibake
