#include "trade/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hemibake {
namespace {

constexpr double kWidth = 920, kHeight = 560;
constexpr double kLeft = 78, kRight = 640, kTop = 44, kBottom = 500;

// Okabe and Ito's colours, which the colour-blind tell apart, and marks for when they repeat.
constexpr std::array<const char*, 8> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#e69f00", "#56b4e9", "#000000", "#8c6d1f"};
constexpr size_t kMarks = 3;

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

bool drawable(const PlotPoint& point) { return point.x > 0 && point.y > 0; }

// Whole decades around what is drawn.
struct Axis {
  int first = 0, last = 1;
  double low_pixel, high_pixel;

  void take(double value, bool& any) {
    const double decade = std::log10(value);
    const int below = static_cast<int>(std::floor(decade)), above = static_cast<int>(std::ceil(decade));
    first = any ? std::min(first, below) : below;
    last = any ? std::max(last, above) : above;
    any = true;
  }
  double pixel(double value) const {
    return low_pixel + (std::log10(value) - first) / (last - first) * (high_pixel - low_pixel);
  }
};

struct Canvas {
  Axis x{0, 1, kLeft, kRight}, y{0, 1, kBottom, kTop};
  std::string svg;

  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    svg += fmt::format(format, std::forward<Arguments>(arguments)...);
  }

  void text(double at_x, double at_y, const std::string& words, const char* anchor, int size = 13) {
    add("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-size=\"{}\">{}</text>\n", at_x, at_y, anchor,
        size, escaped(words));
  }

  void line(double x0, double y0, double x1, double y1, const char* color) {
    add("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", x0, y0, x1, y1,
        color);
  }

  void polyline(const std::vector<PlotPoint>& points, const char* color, double width, const char* dashes) {
    add("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\" points=\"", color,
        width, dashes);
    for (const PlotPoint& point : points)
      if (drawable(point)) add("{:.1f},{:.1f} ", x.pixel(point.x), y.pixel(point.y));
    svg += "\"/>\n";
  }

  void mark(double at_x, double at_y, size_t group) {
    const char* color = kColors[group % kColors.size()];
    switch (group / kColors.size() % kMarks) {
      case 0:
        add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"{}\"/>\n", at_x, at_y, color);
        break;
      case 1:
        add("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\" fill=\"{}\"/>\n", at_x - 4, at_y - 4,
            color);
        break;
      default:
        add("<path d=\"M{:.1f} {:.1f}l5 9h-10z\" fill=\"{}\"/>\n", at_x, at_y - 5, color);
    }
  }

  void draw_axes(const Plot& plot) {
    for (int decade = x.first; decade <= x.last; ++decade) {
      const double at = x.pixel(std::pow(10.0, decade));
      line(at, kTop, at, kBottom, "#ddd");
      text(at, kBottom + 18, fmt::format("{:g}", std::pow(10.0, decade)), "middle");
    }
    for (int decade = y.first; decade <= y.last; ++decade) {
      const double at = y.pixel(std::pow(10.0, decade));
      line(kLeft, at, kRight, at, "#ddd");
      text(kLeft - 8, at + 4, fmt::format("{:g}", std::pow(10.0, decade)), "end");
    }
    add("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#555\"/>\n", kLeft, kTop,
        kRight - kLeft, kBottom - kTop);
    text((kLeft + kRight) / 2, kTop - 16, plot.title, "middle", 16);
    text((kLeft + kRight) / 2, kBottom + 42, plot.x_label, "middle");
    add("<text transform=\"translate(20 {:.1f}) rotate(-90)\" text-anchor=\"middle\" "
        "font-size=\"13\">{}</text>\n",
        (kTop + kBottom) / 2, escaped(plot.y_label));
  }

  void draw_front(const std::vector<PlotPoint>& front) {
    // Between two of them the cheaper one is the best there is: steps.
    std::vector<PlotPoint> steps;
    for (const PlotPoint& point : front) {
      if (!steps.empty()) steps.push_back({point.x, steps.back().y});
      steps.push_back(point);
    }
    polyline(steps, "#999", 1.5, "none");
    for (const PlotPoint& point : front)
      if (drawable(point))
        add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"8\" fill=\"none\" stroke=\"#999\" "
            "stroke-width=\"1.5\"/>\n",
            x.pixel(point.x), y.pixel(point.y));
  }
};

}  // namespace

std::string svg_of(const Plot& plot) {
  Canvas canvas;
  bool any_x = false, any_y = false;
  for (const PlotGroup& group : plot.groups)
    for (const PlotPoint& point : group.points)
      if (drawable(point)) {
        canvas.x.take(point.x, any_x);
        canvas.y.take(point.y, any_y);
      }
  for (Axis* axis : {&canvas.x, &canvas.y})
    if (axis->last == axis->first) ++axis->last;

  canvas.add(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"sans-serif\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      kWidth, kHeight);
  canvas.draw_axes(plot);
  if (!any_x) canvas.text((kLeft + kRight) / 2, (kTop + kBottom) / 2, "nothing to show", "middle");
  if (!plot.front.empty()) canvas.draw_front(plot.front);
  double legend_y = kTop + 8;
  for (size_t g = 0; g < plot.groups.size(); ++g) {
    const PlotGroup& group = plot.groups[g];
    if (!group.line.empty()) canvas.polyline(group.line, kColors[g % kColors.size()], 1, "5 3");
    for (const PlotPoint& point : group.points)
      if (drawable(point)) canvas.mark(canvas.x.pixel(point.x), canvas.y.pixel(point.y), g);
    canvas.mark(kRight + 20, legend_y, g);
    canvas.text(kRight + 32, legend_y + 4, group.label, "start");
    legend_y += 21;
  }
  if (!plot.front.empty()) {
    canvas.add(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"7\" fill=\"none\" stroke=\"#999\" stroke-width=\"1.5\"/>\n",
        kRight + 20, legend_y);
    canvas.text(kRight + 32, legend_y + 4, plot.front_label, "start");
  }
  return canvas.svg + "</svg>\n";
}

}  // namespace hemibake
