#include "cli/options/command.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace hemibake {
namespace {

constexpr int kMaxBins = 65536;

}  // namespace

void Invocation::print(const nlohmann::json& json_result, const std::string& text) const {
  const std::string result =
      json ? json_result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n" : text;
  if (std::fwrite(result.data(), 1, result.size(), stdout) != result.size() || std::fflush(stdout) != 0)
    throw InputError(fmt::format("standard output: could not write: {}", std::strerror(errno)));
}

Field option(std::string name, Value value, std::string help) {
  Field field;
  field.name = std::move(name);
  field.value = std::move(value);
  field.help = std::move(help);
  return field;
}

Field required(Field field) {
  field.required = true;
  return field;
}

Field in_group(Field field, std::string group) {
  field.group = std::move(group);
  return field;
}

Field shown_as(Field field, std::string placeholder) {
  field.placeholder = std::move(placeholder);
  return field;
}

Field output_option(std::filesystem::path& output, std::string help) {
  Field field = option("output", file(output), std::move(help));
  field.short_name = "o";
  return field;
}

Field bins_option(int& bins) {
  return option("bins", whole(bins, 1, kMaxBins), "bins of equal width on the AO axis 0..1");
}

void append(std::vector<Field>& fields, std::vector<Field> more) {
  fields.insert(fields.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace hemibake
