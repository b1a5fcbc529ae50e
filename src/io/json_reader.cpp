#include "io/json_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/printable.h"

namespace hemibake {
namespace {

std::string describe(const nlohmann::ordered_json& json) {
  if (json.is_object()) return "an object";
  if (json.is_array()) return fmt::format("a list of {}", json.size());
  if (json.is_string()) return fmt::format("\"{}\"", excerpt(json.get_ref<const std::string&>()));
  return json.dump();
}

// Returns a whole number in a range, whether it is written as one or as 3.0 or 1e3.
template <class Integer>
std::optional<Integer> whole_from(const nlohmann::ordered_json& json, Integer low, Integer high) {
  std::optional<Integer> value;
  if (json.is_number_unsigned()) {
    const auto stored = json.get<uint64_t>();
    if (std::in_range<Integer>(stored)) value = static_cast<Integer>(stored);
  } else if (json.is_number_integer()) {
    const auto stored = json.get<int64_t>();
    if (std::in_range<Integer>(stored)) value = static_cast<Integer>(stored);
  } else if (json.is_number_float()) {
    const auto stored = json.get<double>();
    constexpr double kLargestExact = 0x1p53;
    if (std::abs(stored) <= kLargestExact && stored == std::floor(stored) &&
        (stored >= 0 || std::numeric_limits<Integer>::is_signed))
      value = static_cast<Integer>(stored);
  }
  return value && *value >= low && *value <= high ? value : std::nullopt;
}

}  // namespace

bool JsonReader::is_null() const { return json_->is_null(); }
bool JsonReader::is_text() const { return json_->is_string(); }
bool JsonReader::is_number() const { return json_->is_number(); }
bool JsonReader::is_whole() const { return json_->is_number_integer(); }
bool JsonReader::is_flag() const { return json_->is_boolean(); }

JsonReader JsonReader::inner(const nlohmann::ordered_json& json, const std::string& name) const {
  JsonReader reader(json, place_ + (is_inner_ ? "/" : ": ") + excerpt(name));
  reader.is_inner_ = true;
  return reader;
}

std::optional<JsonReader> JsonReader::find(const std::string& name) const {
  if (!json_->is_object()) refuse("an object");
  const auto found = json_->find(name);
  return found == json_->end() ? std::nullopt : std::optional(inner(*found, name));
}

JsonReader JsonReader::at(const std::string& name) const {
  if (const auto found = find(name)) return *found;
  throw InputError(fmt::format("{}{}{} is not there, expected it", place_, is_inner_ ? "/" : ": ", name));
}

std::vector<std::pair<std::string, JsonReader>> JsonReader::members() const {
  if (!json_->is_object()) refuse("an object");
  std::vector<std::pair<std::string, JsonReader>> members;
  for (const auto& [name, value] : json_->items()) members.emplace_back(name, inner(value, name));
  return members;
}

std::vector<JsonReader> JsonReader::elements() const {
  if (!json_->is_array()) refuse("a list");
  std::vector<JsonReader> elements;
  for (const auto& value : *json_) elements.push_back(inner(value, std::to_string(elements.size())));
  return elements;
}

double JsonReader::number(double low, double high) const {
  const double value = json_->is_number() ? json_->get<double>() : std::nan("");
  if (value >= low && value <= high) return value;
  if (low <= std::numeric_limits<double>::lowest() && high >= std::numeric_limits<double>::max())
    refuse("a number");
  if (high >= std::numeric_limits<double>::max()) refuse(fmt::format("a number from {}", low));
  refuse(fmt::format("a number from {} to {}", low, high));
}

std::optional<double> JsonReader::number_or_null(double low) const {
  return is_null() ? std::nullopt : std::optional(number(low));
}

int64_t JsonReader::whole_in(int64_t low, int64_t high) const {
  const auto value = whole_from<int64_t>(*json_, low, high);
  if (!value) refuse(fmt::format("a whole number from {} to {}", low, high));
  return *value;
}

uint64_t JsonReader::natural_in(uint64_t low, uint64_t high) const {
  const auto value = whole_from<uint64_t>(*json_, low, high);
  if (!value) refuse(fmt::format("a whole number from {} to {}", low, high));
  return *value;
}

bool JsonReader::flag() const {
  if (!json_->is_boolean()) refuse("true or false");
  return json_->get<bool>();
}

const std::string& JsonReader::text() const {
  if (!json_->is_string()) refuse("a text");
  return json_->get_ref<const std::string&>();
}

void JsonReader::refuse(const std::string& expected) const {
  throw InputError(fmt::format("{} is {}, expected {}", place_, describe(*json_), expected));
}

}  // namespace hemibake
