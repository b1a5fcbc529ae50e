#include "trade/trade_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace hemibake {

std::string Setting::value_text() const {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:#}", *number);
  return fmt::format("{}", std::get<int>(value));
}

std::string RunDescription::id() const {
  std::string id = method;
  for (const Setting& setting : settings) id += "_" + setting.name + "-" + setting.value_text();
  std::ranges::replace_if(
      id, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-' && c != '_'; }, '-');
  return id;
}

std::string RunDescription::settings_text() const {
  std::string text;
  for (const Setting& setting : settings)
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", setting.name, setting.value_text());
  return text;
}

}  // namespace hemibake
