// Settings described once: the options of the command line, the help, what a file records of how it was made
// and what is read back of it are all made from the same fields.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hemibake {

// The place a setting is kept, as text. Made by the functions below; refers to the variable it was made for.
struct Value {
  enum class Kind { kFlag, kNumber, kWhole, kUnsigned, kText };
  Kind kind = Kind::kText;
  std::string type;          // of the text, for people: "FLOAT:in [0 - 180]", "TEXT:{wrap,open}"
  int fewest = 1, most = 1;  // words it takes; most −1: any number
  bool separated = false;    // words may be joined by commas
  std::function<std::optional<std::string>()> get;  // the text that sets the same again; none: is not set
  // Throws InputError ("'x', expected a number from 0 to 1") and changes nothing where a word is no value.
  std::function<void(const std::vector<std::string>&)> set;
};

struct Field {
  std::string name;         // of the option: "max-distance"; a positional is in capitals: "MAP"
  std::string short_name;   // one letter, or none
  std::string key;          // in a record; empty: is not recorded
  std::string key_prefix;   // of the recorded text
  std::string group;        // of the help
  std::string help;         // with unit and default where these are not in `value`
  std::string placeholder;  // of the value in the help; empty: its type
  bool required = false;
  bool may_be_missing = false;  // in a record of an older version: the variable then keeps its value
  Value value;
  std::function<bool()> recorded = [] {
    return true;
  };  // whether it has a meaning with the settings as they are
};

// A finite number in [low, high].
Value number(double& variable, double low, double high);
Value number(std::optional<double>& variable, double low, double high);
// A number in (0, high].
Value positive(double& variable, double high);
Value positive(std::optional<double>& variable, double high);
// A whole number in [low, high], in decimal digits and nothing else.
Value whole(int& variable, int low, int high);
Value whole(std::optional<int>& variable, int low, int high);
Value whole(uint64_t& variable, uint64_t low, uint64_t high = std::numeric_limits<uint64_t>::max());
Value flag(bool& variable);
Value text(std::string& variable);
Value file(std::filesystem::path& variable);
Value texts(std::vector<std::string>& variable);  // one or more
// Exactly `count` numbers in [low, high], which commas may separate.
Value numbers(std::vector<double>& variable, int count, double low, double high);
Value whole_numbers(std::vector<int>& variable, int count, int low, int high);

// Takes one of `names`, by its index.
Value choice_of(std::vector<std::string> names, std::function<std::optional<size_t>()> get,
                std::function<void(size_t)> set);
// Several of `names`, which commas may separate, in the order given.
Value choices_of(std::vector<std::string> names, std::function<std::vector<size_t>()> get,
                 std::function<void(const std::vector<size_t>&)> set);

Value choice(std::string& variable, std::vector<std::string> names);
Value choices(std::vector<std::string>& variable, const std::vector<std::string>& names);

// An enumeration whose enumerators are 0, 1, … in the order of `names`.
template <class Enum>
Value choice(Enum& variable, std::vector<std::string> names) {
  return choice_of(
      std::move(names), [&variable] { return static_cast<size_t>(variable); },
      [&variable](size_t index) { variable = static_cast<Enum>(index); });
}
template <class Enum>
Value choice(std::optional<Enum>& variable, std::vector<std::string> names) {
  return choice_of(
      std::move(names),
      [&variable] { return variable ? std::optional(static_cast<size_t>(*variable)) : std::nullopt; },
      [&variable](size_t index) { variable = static_cast<Enum>(index); });
}
template <class Enum>
Value choices(std::vector<Enum>& variable, std::vector<std::string> names) {
  return choices_of(
      std::move(names),
      [&variable] {
        std::vector<size_t> indices;
        for (const Enum value : variable) indices.push_back(static_cast<size_t>(value));
        return indices;
      },
      [&variable](const std::vector<size_t>& indices) {
        variable.clear();
        for (const size_t index : indices) variable.push_back(static_cast<Enum>(index));
      });
}

}  // namespace hemibake
