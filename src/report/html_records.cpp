#include "report/html_records.h"

namespace hemibake {
namespace {

// Checks a member that may be missing: check(member).
template <class Check>
void check_if_there(const JsonReader& json, const char* name, Check check) {
  if (const auto member = json.find(name)) check(*member);
}

// Checks an ERROR of a run, trade/trade_file.h.
void check_error(const JsonReader& error) {
  error.at("rmse").number();
  error.at("bias").number();
}

void check_errors(const JsonReader& by_plane) {
  for (const auto& [plane, error] : by_plane.members()) check_error(error);
}

void check_settings(const JsonReader& settings) {
  if (settings.is_null()) return;  // as older versions write none
  for (const auto& [name, value] : settings.members())
    if (!value.is_text()) value.number();
}

void check_trade_run(const JsonReader& run) {
  run.at("method").text();
  check_settings(run.at("settings"));
  run.at("representative").flag();
  run.at("cpu_seconds").number();
  run.at("memory_bytes").number();
  check_errors(run.at("error"));
  check_if_there(run, "models", [](const JsonReader& models) {
    for (const auto& [name, errors] : models.members()) check_errors(errors);
  });
}

void check_series(const JsonReader& series) {
  series.at("name").text();
  series.at("plane").text();
  series.at("slope").number_or_null();
  for (const JsonReader& point : series.at("points").elements()) {
    const auto place = point.elements();
    if (place.size() != 2) point.refuse("two numbers");
    for (const JsonReader& coordinate : place) coordinate.number();
  }
}

void check_front(const JsonReader& front) {
  for (const JsonReader& point : front.elements()) {
    point.at("cpu_seconds").number();
    point.at("rmse").number();
  }
}

}  // namespace

void check_checks_record(const JsonReader& json) {
  for (const JsonReader& check : json.at("checks").elements()) {
    check.at("quantity").text();
    check.at("value").number_or_null();
    check.at("expected").number_or_null();
    check.at("tolerance").number_or_null();
    check.at("passed").flag();
    check.at("detail").text();
  }
}

void check_run_record(const JsonReader& json) {
  for (const char* name : {"seconds", "cpu_seconds"})
    check_if_there(json, name, [](const JsonReader& seconds) { seconds.number(); });
}

void check_trade_record(const JsonReader& json) {
  check_if_there(json, "effort", [](const JsonReader& effort) { effort.text(); });
  for (const JsonReader& run : json.at("runs").elements()) check_trade_run(run);
  check_if_there(json, "series", [](const JsonReader& list) {
    for (const JsonReader& series : list.elements()) check_series(series);
  });
  check_if_there(json, "fronts", [](const JsonReader& fronts) {
    for (const auto& [plane, front] : fronts.members()) check_front(front);
  });
}

void check_pictures_record(const JsonReader& json) {
  for (const JsonReader& picture : json.at("pictures").elements())
    for (const JsonReader& name : picture.at("files").elements()) name.text();
}

}  // namespace hemibake
