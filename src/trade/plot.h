// Plots on two logarithmic axes as SVG, for a browser and for a report to take in.
#pragma once

#include <string>
#include <vector>

namespace hemibake {

struct PlotPoint {
  double x, y;  // above 0; others are not drawn
};

struct PlotGroup {
  std::string label;
  std::vector<PlotPoint> points;
  std::vector<PlotPoint> line;  // drawn through, thin: a fit; empty: none
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotGroup> groups;  // each with its own colour and mark
  std::vector<PlotPoint> front;   // drawn through as steps and ringed; empty: none
  std::string front_label;
};

// A plot without points says so.
std::string svg_of(const Plot& plot);

}  // namespace hemibake
