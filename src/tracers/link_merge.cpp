#include "tracers/link_merge.h"

#include <algorithm>
#include <cmath>

namespace hemibake {
namespace {

int settle_index(int i, int n, Edge edge) { return edge == Edge::kWrap ? wrap_index(i, n) : std::clamp(i, 0, n - 1); }

void add_link(const Surface& surface, int x, int y, double weight, std::vector<Link>& links) {
  if (weight <= 0) return;
  const int i = settle_index(x, surface.width(), surface.edge), j = settle_index(y, surface.height(), surface.edge);
  links.push_back({static_cast<uint32_t>(surface.heights_m.index(i, j)), static_cast<float>(weight)});
}

}  // namespace

void add_nearest_link(const Surface& surface, glm::dvec2 position, double weight, std::vector<Link>& links) {
  add_link(surface, static_cast<int>(std::floor(position.x + 0.5)), static_cast<int>(std::floor(position.y + 0.5)),
           weight, links);
}

void add_bilinear_links(const Surface& surface, glm::dvec2 position, double weight, std::vector<Link>& links) {
  const int x = static_cast<int>(std::floor(position.x)), y = static_cast<int>(std::floor(position.y));
  const double fx = position.x - x, fy = position.y - y;
  add_link(surface, x, y, weight * (1 - fx) * (1 - fy), links);
  add_link(surface, x + 1, y, weight * fx * (1 - fy), links);
  add_link(surface, x, y + 1, weight * (1 - fx) * fy, links);
  add_link(surface, x + 1, y + 1, weight * fx * fy, links);
}

void merge_links(Row& row) {
  if (row.links.empty()) {
    row.direct_over_pi = 1;
    return;
  }
  // By weight too where patches are equal: the order of summation is then the same whatever order hits came in.
  std::sort(row.links.begin(), row.links.end(),
            [](const Link& a, const Link& b) { return a.patch != b.patch ? a.patch < b.patch : a.weight < b.weight; });
  size_t merged = 0, largest = 0;
  double total = 0;
  for (size_t i = 0; i < row.links.size();) {
    const uint32_t patch = row.links[i].patch;
    double weight = 0;
    for (; i < row.links.size() && row.links[i].patch == patch; ++i) weight += static_cast<double>(row.links[i].weight);
    row.links[merged] = {patch, static_cast<float>(weight)};
    total += static_cast<double>(row.links[merged].weight);
    if (row.links[merged].weight > row.links[largest].weight) largest = merged;
    ++merged;
  }
  row.links.resize(merged);
  const double missing = 1 - static_cast<double>(static_cast<float>(row.direct_over_pi)) - total;
  row.links[largest].weight = static_cast<float>(static_cast<double>(row.links[largest].weight) + missing);
}

}  // namespace hemibake
