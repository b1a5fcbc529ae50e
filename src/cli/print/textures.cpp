#include "cli/print/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace hemibake {
namespace {

const char* normal_y_name(const TextureSettings& settings) {
  return *settings.normal_y == NormalY::kUp ? "up" : "down";
}

constexpr double kTruthUncertain = 5e-4;

nlohmann::ordered_json json_from_stored(const StoredLoss& stored) {
  nlohmann::ordered_json rms = nlohmann::ordered_json::array(), percentile = rms, largest = rms;
  for (const MapError& error : stored.by_albedo) {
    rms.push_back(error.rms);
    percentile.push_back(error.percentile);
    largest.push_back(error.largest);
  }
  return {{"bits", stored.bits},           {"box", stored.box}, {"mean_rms", stored.mean_rms()}, {"rms", rms},
          {"percentile_99_9", percentile}, {"largest", largest}};
}

std::string describe_values(const WrittenTexture& texture) {
  if (texture.channels.size() == 1) {
    const ChannelRange& range = texture.channels[0];
    return fmt::format("mean {:.4f}, {:.4f} to {:.4f}", range.mean, range.low, range.high);
  }
  if (texture.kind == TextureKind::kHorizon) return fmt::format("{} azimuths", texture.channels.size());
  std::string text = "mean";
  for (const ChannelRange& range : texture.channels)
    text += fmt::format(" {} {:.3f}", range.channel, range.mean);
  return text;
}

}  // namespace

std::string describe_textures(const std::vector<WrittenTexture>& textures, const TextureSettings& settings,
                              const std::filesystem::path& folder) {
  const TextureFormatInfo& format = texture_format_info(settings.coding.format);
  std::string text =
      fmt::format("{}: {} textures, {} bits a channel{}{}, linear, green {}\n", folder.string(),
                  textures.size(), format.bits, format.is_float ? " (float)" : "",
                  settings.coding.dither ? " (dithered)" : "", normal_y_name(settings));
  size_t widest = 0;
  for (const WrittenTexture& texture : textures)
    widest = std::max(widest, texture.path.filename().string().size());
  for (const WrittenTexture& texture : textures)
    text += fmt::format("  {:{}}  {:10}  {}\n", texture.path.filename().string(), widest,
                        texture_name(texture.kind), describe_values(texture));
  for (const WrittenTexture& texture : textures) text += describe_bounce_map(texture.bounce_map);
  return text;
}

std::string describe_bounce_map(const std::optional<BounceMapLoss>& loss) {
  if (!loss) return "";
  const StoredLoss& bytes = *loss->find(8, 1);
  std::string text = fmt::format("bounce map: off by {:.4f} rms at 8 bits ({:.3f} at most), {:.4f} at 16",
                                 bytes.mean_rms(), bytes.largest(), loss->find(16, 1)->mean_rms());
  if (const StoredLoss* filtered = loss->find(8, 4))
    text += fmt::format(", {:.4f} in 4 x 4 means", filtered->mean_rms());
  text += fmt::format("; albedos {:g} to {:g}\n", kBounceMapAlbedos.front(), kBounceMapAlbedos.back());
  if (loss->truth_rms > kTruthUncertain)
    text += fmt::format("            judged by light that the stored bounces tell to {:.4f} rms\n",
                        loss->truth_rms);
  return text;
}

nlohmann::ordered_json json_from_bounce_map(const std::optional<BounceMapLoss>& loss) {
  if (!loss) return nullptr;
  nlohmann::ordered_json json = {{"bounce_albedo", loss->bounce_albedo},
                                 {"truth_rms", loss->truth_rms},
                                 {"albedos", kBounceMapAlbedos},
                                 {"stored", nlohmann::ordered_json::array()}};
  for (const StoredLoss& stored : loss->stored) json["stored"].push_back(json_from_stored(stored));
  return json;
}

std::string line_of_textures(const std::vector<WrittenTexture>& textures, const std::filesystem::path& input,
                             const std::filesystem::path& folder) {
  std::string text = fmt::format("{} -> {}:", input.string(), folder.string());
  for (const WrittenTexture& texture : textures)
    text += fmt::format(" {} {:.4f}", texture_name(texture.kind), texture.channels[0].mean);
  return text;
}

nlohmann::ordered_json json_from_textures(const std::vector<WrittenTexture>& textures,
                                          const TextureSettings& settings) {
  const TextureFormatInfo& format = texture_format_info(settings.coding.format);
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const WrittenTexture& texture : textures) {
    nlohmann::ordered_json channels = nlohmann::ordered_json::array(), low = channels, mean = channels,
                           high = channels;
    for (const ChannelRange& range : texture.channels) {
      channels.push_back(range.channel);
      low.push_back(range.low);
      mean.push_back(range.mean);
      high.push_back(range.high);
    }
    const bool vectors = texture.kind == TextureKind::kBent || texture.kind == TextureKind::kNormal;
    list.push_back({{"path", texture.path.string()},
                    {"texture", texture_name(texture.kind)},
                    {"holds", texture.holds},
                    {"channels", channels},
                    {"bits", format.bits},
                    {"low", low},
                    {"mean", mean},
                    {"high", high},
                    {"normal_y", vectors ? nlohmann::ordered_json(normal_y_name(settings)) : nullptr}});
    if (texture.bounce_map) list.back()["bounce_map"] = json_from_bounce_map(texture.bounce_map);
  }
  return list;
}

}  // namespace hemibake
