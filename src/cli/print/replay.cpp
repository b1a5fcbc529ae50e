#include "cli/print/replay.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace hemibake {

std::string describe_replay(const Replay& replay) {
  std::string text =
      fmt::format("texel {},{}: height {:.7g} m above the lowest, normal ({:.6f}, {:.6f}, {:.6f})\n",
                  replay.x, replay.y, replay.height_m, replay.normal.x, replay.normal.y, replay.normal.z);
  for (size_t i = 0; i < replay.rays.size(); ++i) {
    const RayRecord& ray = replay.rays[i];
    text += fmt::format("ray {:5} direction ({:9.6f}, {:9.6f}, {:9.6f}) weight {:.6e} ", i, ray.direction.x,
                        ray.direction.y, ray.direction.z, ray.cosine_weight);
    text += ray.hit
                ? fmt::format("hit facet {} at texel ({:.4f}, {:.4f}) after {:.7g} m, tile {}\n", ray.facet,
                              ray.hit_texel.x, ray.hit_texel.y, ray.distance_m, ray.tiles_crossed)
                : "sky\n";
  }
  double sum = 0;
  for (const FormFactor& link : replay.row.links) {
    text += fmt::format("link to patch {:8} weight {:.8f}\n", link.patch, link.weight);
    sum += static_cast<double>(link.weight);
  }
  return text + fmt::format("ao {:.7f}, E0/pi {:.7f}, links {:.7f}, E0/pi + links {:.8f}\n",
                            replay.row.visible_fraction, replay.row.direct_over_pi, sum,
                            replay.row.direct_over_pi + sum);
}

nlohmann::ordered_json json_from_replay(const Replay& replay) {
  const auto vector = [](const auto& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
  nlohmann::ordered_json rays = nlohmann::ordered_json::array(), links = nlohmann::ordered_json::array();
  for (const RayRecord& ray : replay.rays) {
    nlohmann::ordered_json record = {{"direction", vector(ray.direction)},
                                     {"cosine_weight", ray.cosine_weight},
                                     {"uniform_weight", ray.uniform_weight},
                                     {"hit", ray.hit}};
    if (ray.hit) {
      record["facet"] = ray.facet;
      record["hit_texel"] = {ray.hit_texel.x, ray.hit_texel.y};
      record["distance_m"] = ray.distance_m;
      record["tiles_crossed"] = ray.tiles_crossed;
    }
    rays.push_back(std::move(record));
  }
  for (const FormFactor& link : replay.row.links)
    links.push_back({{"patch", link.patch}, {"weight", link.weight}});
  return {{"texel", {replay.x, replay.y}},
          {"height_m", replay.height_m},
          {"normal", vector(replay.normal)},
          {"ao", replay.row.visible_fraction},
          {"direct_over_pi", replay.row.direct_over_pi},
          {"bent_normal", vector(replay.row.bent_normal)},
          {"rays", rays},
          {"links", links}};
}

}  // namespace hemibake
