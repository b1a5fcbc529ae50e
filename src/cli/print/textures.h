// Written textures as text and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "textures/make_textures.h"

namespace hemibake {

// Returns a line for the folder and one per texture, at most 80 columns where names are short.
std::string describe_textures(const std::vector<WrittenTexture>& textures, const TextureSettings& settings,
                              const std::filesystem::path& folder);

// Returns one line for the textures of one of many inputs.
std::string line_of_textures(const std::vector<WrittenTexture>& textures, const std::filesystem::path& input,
                             const std::filesystem::path& folder);

// Returns a line on what a bounce map leaves, with its line breaks, and a second where its truth is
// uncertain; empty for none.
std::string describe_bounce_map(const std::optional<BounceMapLoss>& loss);

// Returns null for none.
nlohmann::ordered_json json_from_bounce_map(const std::optional<BounceMapLoss>& loss);

nlohmann::ordered_json json_from_textures(const std::vector<WrittenTexture>& textures,
                                          const TextureSettings& settings);

}  // namespace hemibake
