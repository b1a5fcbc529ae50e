#include "core/field.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/printable.h"

namespace hemibake {
namespace {

using Words = std::vector<std::string>;

// Reads a whole text as a number of type T; "+3" and "5." are numbers, "nan" and "1e999" are none.
template <class T>
std::optional<T> number_from(std::string_view text) {
  if constexpr (std::is_floating_point_v<T>)
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  // 010 would be 8 for some.
  if (!std::is_floating_point_v<T> && text.size() > 1 && text.front() == '0') return std::nullopt;
  T value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
}

template <class T>
struct Range {
  T low, high;
  bool above_low = false;  // low itself is out

  std::string type() const {
    return fmt::format("{}:in {}{} - {}]", std::is_floating_point_v<T> ? "FLOAT" : "INT",
                       above_low ? "(" : "[", low, high);
  }
  std::string expectation() const {
    if (above_low) return fmt::format("a number above {}, at most {}", low, high);
    return fmt::format("a {}number from {} to {}", std::is_floating_point_v<T> ? "" : "whole ", low, high);
  }
  T read(const std::string& text) const {
    const std::optional<T> value = number_from<T>(text);
    if (!value || *value < low || *value > high || (above_low && *value == low))
      throw InputError(fmt::format("'{}', expected {}", excerpt(text), expectation()));
    return *value;
  }
};

template <class T, class Variable>
Value ranged(Variable& variable, Range<T> range) {
  Value value;
  value.kind = std::is_floating_point_v<T> ? Value::Kind::kNumber
               : std::is_signed_v<T>       ? Value::Kind::kWhole
                                           : Value::Kind::kUnsigned;
  value.type = range.type();
  value.get = [&variable]() -> std::optional<std::string> {
    if constexpr (std::is_same_v<Variable, std::optional<T>>)
      return variable ? std::optional(fmt::format("{}", *variable)) : std::nullopt;
    else
      return fmt::format("{}", variable);
  };
  value.set = [&variable, range](const Words& words) { variable = range.read(words.at(0)); };
  return value;
}

template <class T>
Value several(std::vector<T>& variable, int count, Range<T> range) {
  Value value;
  value.type = range.type();
  value.fewest = value.most = count;
  value.separated = true;
  value.get = [&variable]() -> std::optional<std::string> {
    if (variable.empty()) return std::nullopt;
    return fmt::format("{}", fmt::join(variable, ","));
  };
  value.set = [&variable, range](const Words& words) {
    std::vector<T> read;
    for (const std::string& word : words) read.push_back(range.read(word));
    variable = std::move(read);
  };
  return value;
}

// Empty text stands for a setting that is not set.
template <class T>
Value kept_text(T& variable) {
  Value value;
  value.type = "TEXT";
  value.get = [&variable]() -> std::optional<std::string> {
    std::string text(variable);
    return text.empty() ? std::nullopt : std::optional(std::move(text));
  };
  value.set = [&variable](const Words& words) { variable = words.at(0); };
  return value;
}

size_t index_of(const std::string& word, const Words& names) {
  const auto found = std::ranges::find(names, word);
  if (found == names.end())
    throw InputError(fmt::format("'{}' is not in {{{}}}", excerpt(word), fmt::join(names, ",")));
  return static_cast<size_t>(found - names.begin());
}

}  // namespace

Value number(double& variable, double low, double high) { return ranged(variable, Range<double>{low, high}); }
Value number(std::optional<double>& variable, double low, double high) {
  return ranged(variable, Range<double>{low, high});
}
Value positive(double& variable, double high) { return ranged(variable, Range<double>{0, high, true}); }
Value positive(std::optional<double>& variable, double high) {
  return ranged(variable, Range<double>{0, high, true});
}
Value whole(int& variable, int low, int high) { return ranged(variable, Range<int>{low, high}); }
Value whole(std::optional<int>& variable, int low, int high) {
  return ranged(variable, Range<int>{low, high});
}
Value whole(uint64_t& variable, uint64_t low, uint64_t high) {
  return ranged(variable, Range<uint64_t>{low, high});
}

Value flag(bool& variable) {
  Value value;
  value.kind = Value::Kind::kFlag;
  value.fewest = value.most = 0;
  value.get = [&variable] { return std::optional<std::string>(variable ? "true" : "false"); };
  value.set = [&variable](const Words& words) {
    variable = words.empty() || index_of(words[0], {"false", "true"}) == 1;
  };
  return value;
}

Value text(std::string& variable) { return kept_text(variable); }
Value file(std::filesystem::path& variable) { return kept_text(variable); }

Value texts(std::vector<std::string>& variable) {
  Value value;
  value.type = "TEXT";
  value.most = -1;
  value.get = [] { return std::optional<std::string>(); };
  value.set = [&variable](const Words& words) { variable = words; };
  return value;
}

Value numbers(std::vector<double>& variable, int count, double low, double high) {
  return several(variable, count, Range<double>{low, high});
}
Value whole_numbers(std::vector<int>& variable, int count, int low, int high) {
  return several(variable, count, Range<int>{low, high});
}

Value choice_of(Words names, std::function<std::optional<size_t>()> get, std::function<void(size_t)> set) {
  Value value;
  value.type = fmt::format("TEXT:{{{}}}", fmt::join(names, ","));
  value.get = [names, get = std::move(get)]() -> std::optional<std::string> {
    const std::optional<size_t> index = get();
    return index ? std::optional(names.at(*index)) : std::nullopt;
  };
  value.set = [names = std::move(names), set = std::move(set)](const Words& words) {
    set(index_of(words.at(0), names));
  };
  return value;
}

Value choices_of(Words names, std::function<std::vector<size_t>()> get,
                 std::function<void(const std::vector<size_t>&)> set) {
  Value value;
  value.type = fmt::format("TEXT:{{{}}}", fmt::join(names, ","));
  value.most = -1;
  value.separated = true;
  value.get = [names, get = std::move(get)]() -> std::optional<std::string> {
    Words chosen;
    for (const size_t index : get()) chosen.push_back(names.at(index));
    return chosen.empty() ? std::nullopt : std::optional(fmt::format("{}", fmt::join(chosen, ",")));
  };
  value.set = [names = std::move(names), set = std::move(set)](const Words& words) {
    std::vector<size_t> indices;
    for (const std::string& word : words) indices.push_back(index_of(word, names));
    set(indices);
  };
  return value;
}

Value choice(std::string& variable, Words names) {
  Value value = kept_text(variable);
  value.type = fmt::format("TEXT:{{{}}}", fmt::join(names, ","));
  value.set = [&variable, names = std::move(names)](const Words& words) {
    variable = names[index_of(words.at(0), names)];
  };
  return value;
}

Value choices(Words& variable, const Words& names) {
  return choices_of(
      names,
      [&variable, names] {
        std::vector<size_t> indices;
        for (const std::string& word : variable) indices.push_back(index_of(word, names));
        return indices;
      },
      [&variable, names](const std::vector<size_t>& indices) {
        variable.clear();
        for (const size_t index : indices) variable.push_back(names[index]);
      });
}

}  // namespace hemibake
