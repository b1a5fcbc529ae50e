// One run of the trade study: a method at one setting, and the planes it makes of a surface.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "surface/surface.h"
#include "trade/run_planes.h"

namespace hemibake {

struct Setting {
  std::string name;
  std::variant<int, double, std::string> value;

  std::string value_text() const;  // a double keeps its point: "1.0"
};

struct RunDescription {
  std::string method;  // "embree", "slice", "disk", …: a row of the closing table
  std::vector<Setting> settings;
  std::string series;         // runs that differ in `abscissa` only; empty: of no series
  std::string abscissa_name;  // the setting a series varies
  double abscissa = 0;
  bool representative = false;  // the one good setting of its method

  void add_setting(const std::string& name, const std::variant<int, double, std::string>& value) {
    settings.push_back({name, value});
  }
  // Names the run and its files: "embree_rays-64_directions-uniform".
  std::string id() const;
  // "rays=64 directions=uniform".
  std::string settings_text() const;
};

struct TradeRun : RunDescription {
  bool keeps_planes = false;  // written out with their error maps; those of representative runs are too
  // direct: the true E₀ (0..π), for methods that take it as given. Throws Cancelled.
  std::function<RunPlanes(const Surface& surface, const Grid<float>& direct)> perform;
};

}  // namespace hemibake
