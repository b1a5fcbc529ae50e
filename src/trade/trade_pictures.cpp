#include "trade/trade_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "io/output_file.h"
#include "trade/front.h"
#include "trade/plot.h"
#include "trade/trade_points.h"

namespace hemibake {
namespace {

using nlohmann::ordered_json;

// The group of this label, added where it is new.
PlotGroup& group_of(const std::string& label, Plot& plot) {
  for (PlotGroup& group : plot.groups)
    if (group.label == label) return group;
  plot.groups.push_back({label, {}, {}});
  return plot.groups.back();
}

Plot time_plot(const ordered_json& json, const std::string& plane) {
  Plot plot;
  plot.title = json["planes"][plane].get<std::string>() + ": error against time";
  plot.x_label = "CPU seconds";
  plot.y_label = "rms error";
  plot.front_label = "Pareto front";
  for (const TradePoint& point : trade_points(json["runs"], plane))
    group_of(point.model.empty() ? point.method : point.method + " + " + point.model, plot)
        .points.push_back({point.value.cpu_seconds, point.value.error});
  for (const ordered_json& point : json["fronts"][plane])
    plot.front.push_back({point["cpu_seconds"], point["rmse"]});
  return plot;
}

Plot convergence_plot(const ordered_json& json, const std::string& plane) {
  Plot plot;
  plot.title = json["planes"][plane].get<std::string>() + ": convergence";
  plot.x_label = "rays, azimuths or taps per texel";
  plot.y_label = "rms error";
  for (const ordered_json& series : json["series"]) {
    if (series["plane"] != plane) continue;
    PlotGroup group;
    group.label = series["name"].get<std::string>();
    std::vector<double> x, y;
    for (const ordered_json& point : series["points"]) {
      x.push_back(point[0]);
      y.push_back(point[1]);
      group.points.push_back({x.back(), y.back()});
    }
    const PowerLaw law = fit_power_law(x, y);
    if (law.points > 1) {
      group.label += fmt::format(": slope {:.2f}", law.slope);
      for (const double end : {*std::ranges::min_element(x), *std::ranges::max_element(x)})
        group.line.push_back({end, law.at(end)});
    }
    plot.groups.push_back(std::move(group));
  }
  return plot;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace

ordered_json write_trade_pictures(const std::filesystem::path& folder, const ordered_json& json) {
  ordered_json pictures = ordered_json::array();
  const auto write_plot = [&](const std::string& name, const Plot& plot) {
    write_text(folder / name, svg_of(plot));
    pictures.push_back({{"file", name}, {"title", plot.title}});
  };
  for (const auto& [plane, front] : json["fronts"].items()) {
    write_plot("time-" + plane + ".svg", time_plot(json, plane));
    write_plot("convergence-" + plane + ".svg", convergence_plot(json, plane));
  }
  for (const ordered_json& run : json["runs"]) {
    for (const char* plane : {"ao", "direct", "light.50"}) {
      const std::string name = fmt::format("errors/{}-{}.png", run["id"].get<std::string>(), plane);
      if (!std::filesystem::exists(folder / name)) continue;
      pictures.push_back({{"file", name},
                          {"title", fmt::format("{}: error of {}, blue -0.1 to red +0.1",
                                                run["id"].get<std::string>(), plane)}});
    }
  }
  return pictures;
}

}  // namespace hemibake
