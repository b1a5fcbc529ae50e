#include "io/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <unordered_set>
#include <vector>

#include "core/error.h"
#include "core/printable.h"

namespace hemibake {
namespace {

using Json = nlohmann::ordered_json;
// The base appends in constant time; ordered_map itself searches all names before.
using Members = std::vector<std::pair<const std::string, Json>>;

// Builds the document from what the parser meets; a function that returns false stops it.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Json document;
  std::string fault;    // empty: none
  size_t position = 0;  // bytes up to the fault, where the parser knows
  bool at_position = false;

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return refuse("binary data, expected text"); }

  bool start_object(size_t) override {
    names_.emplace_back();
    return open(Json::object());
  }
  bool key(string_t& name) override {
    if (!names_.back().insert(name).second)
      return refuse(
          fmt::format("the name '{}' is there twice in an object, expected it once", excerpt(name)));
    name_ = std::move(name);
    return true;
  }
  bool end_object() override {
    names_.pop_back();
    return close();
  }
  bool start_array(size_t) override { return open(Json::array()); }
  bool end_array() override { return close(); }

  bool parse_error(size_t byte, const std::string& token, const nlohmann::detail::exception&) override {
    position = byte;
    at_position = true;
    return refuse(
        fmt::format("'{}' does not go on as JSON, expected a whole document of it", excerpt(token)));
  }

 private:
  bool refuse(std::string why) {
    fault = std::move(why);
    return false;
  }

  // Puts a value where the document goes on; null where there are too many.
  Json* put(Json value) {
    if (++values_ > kMaxJsonValues) return nullptr;
    if (open_.empty()) return &(document = std::move(value));
    Json& parent = *open_.back();
    if (parent.is_array()) return &parent.get_ref<Json::array_t&>().emplace_back(std::move(value));
    Members& members = parent.get_ref<Json::object_t&>();
    return &members.emplace_back(std::move(name_), std::move(value)).second;
  }
  bool add(Json value) {
    return put(std::move(value)) != nullptr ||
           refuse(fmt::format("more than {} values, expected fewer", kMaxJsonValues));
  }
  bool open(Json value) {
    if (open_.size() >= kMaxJsonDepth)
      return refuse(fmt::format("nests deeper than {}, expected less", kMaxJsonDepth));
    Json* place = put(std::move(value));
    if (!place) return refuse(fmt::format("more than {} values, expected fewer", kMaxJsonValues));
    open_.push_back(place);
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::vector<Json*> open_;  // from the document inwards; only the last still grows
  std::vector<std::unordered_set<std::string>> names_;
  std::string name_;
  size_t values_ = 0;
};

std::string line_and_column(std::string_view text, size_t position) {
  const std::string_view before = text.substr(0, position > 0 ? position - 1 : 0);
  const size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", 1 + std::ranges::count(before, '\n'),
                     before.size() - line_begin + 1);
}

}  // namespace

nlohmann::ordered_json parse_json(std::string_view text, const std::string& place) {
  if (text.size() > kMaxJsonBytes)
    throw InputError(fmt::format("{}: {} MiB of JSON, expected at most {}", place, text.size() >> 20,
                                 kMaxJsonBytes >> 20));
  Builder builder;
  if (Json::sax_parse(text.begin(), text.end(), &builder)) return std::move(builder.document);
  if (!builder.at_position) throw InputError(fmt::format("{}: {}", place, builder.fault));
  throw InputError(fmt::format("{}: {}: {}", place, line_and_column(text, builder.position), builder.fault));
}

}  // namespace hemibake
