#include "trade/trade_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "core/constants.h"
#include "transport/series.h"

namespace hemibake {

std::string TradeRun::id() const {
  std::string id = method;
  for (const auto& [name, value] : settings.items())
    id += "_" + name + "-" + (value.is_string() ? value.get<std::string>() : value.dump());
  std::ranges::replace_if(
      id, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-' && c != '_'; }, '-');
  return id;
}

const std::vector<NamedPlane>& named_planes() {
  static const std::vector<NamedPlane> planes = [] {
    std::vector<NamedPlane> all{{"ao", &RunPlanes::uniform, 0},
                                {"direct", &RunPlanes::cosine, 0},
                                {"first", &RunPlanes::first_bounce, 0}};
    for (size_t a = 0; a < kJudgedAlbedos.size(); ++a)
      all.push_back({fmt::format("light.{:02.0f}", 100 * kJudgedAlbedos[a]), nullptr, a});
    return all;
  }();
  return planes;
}

void add_bounces(const std::vector<Grid<float>>& irradiance, RunPlanes& planes) {
  if (irradiance.size() < 2) return;
  const size_t texels = irradiance[0].size();
  planes.first_bounce = irradiance[1];
  for (float& value : planes.first_bounce.values) value /= static_cast<float>(kPi);
  for (size_t a = 0; a < kJudgedAlbedos.size(); ++a) {
    planes.all_bounces[a] = Grid<float>(irradiance[0].width, irradiance[0].height);
    for (size_t i = 0; i < texels; ++i)
      planes.all_bounces[a][i] = static_cast<float>(sum_bounces(irradiance, i, kJudgedAlbedos[a]) / kPi);
  }
}

}  // namespace hemibake
