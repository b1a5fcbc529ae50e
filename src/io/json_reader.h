// Typed values out of a JSON document; what is wrong with one is an error that says where it stands.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hemibake {

// A value and its place, "FILE: F0/parameters/k". Refers to the document, which must outlive it. Every
// function throws InputError "PLACE is \"x\", expected a number" where the value is another.
class JsonReader {
 public:
  // place: of the document: "FILE", or "FILE: attribute NAME" for a single value.
  JsonReader(const nlohmann::ordered_json& json, std::string place)
      : json_(&json), place_(std::move(place)) {}

  bool is_null() const;
  bool is_text() const;
  bool is_number() const;
  bool is_whole() const;
  bool is_flag() const;

  // An object's member; of another name: an error, or none.
  JsonReader at(const std::string& name) const;
  std::optional<JsonReader> find(const std::string& name) const;
  std::vector<std::pair<std::string, JsonReader>> members() const;
  std::vector<JsonReader> elements() const;

  double number(double low = std::numeric_limits<double>::lowest(),
                double high = std::numeric_limits<double>::max()) const;
  std::optional<double> number_or_null(double low = std::numeric_limits<double>::lowest()) const;
  // A whole number that the type holds.
  template <class Integer>
  Integer whole(Integer low = 0, Integer high = std::numeric_limits<Integer>::max()) const {
    if constexpr (std::numeric_limits<Integer>::is_signed)
      return static_cast<Integer>(whole_in(low, high));
    else
      return static_cast<Integer>(natural_in(low, high));
  }
  bool flag() const;
  const std::string& text() const;

  // Throws "PLACE is …, expected WHAT".
  [[noreturn]] void refuse(const std::string& expected) const;
  const std::string& place() const { return place_; }

 private:
  JsonReader inner(const nlohmann::ordered_json& json, const std::string& name) const;
  int64_t whole_in(int64_t low, int64_t high) const;
  uint64_t natural_in(uint64_t low, uint64_t high) const;

  const nlohmann::ordered_json* json_;
  std::string place_;
  bool is_inner_ = false;
};

}  // namespace hemibake
