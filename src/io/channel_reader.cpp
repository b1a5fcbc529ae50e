#include "io/channel_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include "core/error.h"
#include "core/memory_limit.h"
#include "core/printable.h"
#include "io/file_context.h"

namespace hemibake {
namespace {

bool alike(const std::string& a, const std::string& b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::optional<int> parse_index(const std::string& text, int count) {
  int index = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size() || index < 0 || index >= count)
    return std::nullopt;
  return index;
}

}  // namespace

void ChannelReader::require_bytes_per_texel(double bytes) const {
  const double texels = static_cast<double>(facts_.width) * facts_.height;
  with_file_context(path_, [&] { require_map_memory(width(), height(), texels * bytes); });
}

void ChannelReader::refuse(const std::string& fault) const {
  constexpr size_t kMostText = 2000;  // channels may have any names, and there may be thousands
  throw InputError(fmt::format("{}: {}", path_.string(), excerpt(fault, kMostText)));
}

std::optional<int> find_channel(const std::vector<std::string>& channels, const std::string& name) {
  const auto exact = std::ranges::find(channels, name);
  if (exact != channels.end()) return static_cast<int>(exact - channels.begin());
  const auto matches = [&](const std::string& channel) { return alike(channel, name); };
  if (std::ranges::count_if(channels, matches) != 1) return std::nullopt;
  return static_cast<int>(std::ranges::find_if(channels, matches) - channels.begin());
}

std::optional<int> choose_channel(const ChannelFacts& facts, const std::string& wanted) {
  const auto count = static_cast<int>(facts.channels.size());
  if (!wanted.empty()) {
    const std::optional<int> named = find_channel(facts.channels, wanted);
    return named ? named : parse_index(wanted, count);
  }
  if (count == 1) return 0;
  if (count == 2 && facts.alpha) return 1 - *facts.alpha;
  const std::optional<int> green = find_channel(facts.channels, "G");
  return green ? green : find_channel(facts.channels, "Y");
}

void refuse_value(const ChannelReader& reader, const std::string& channel, size_t texel, float value) {
  const auto width = static_cast<size_t>(reader.width());
  reader.refuse(fmt::format("channel {} is {} at texel {},{}, expected a finite number", channel, value,
                            texel % width, texel / width));
}

void refuse_channel(const ChannelReader& reader, const std::string& wanted) {
  reader.refuse(fmt::format("has {}, expected the name or index of one of its channels: {}",
                            wanted.empty() ? "no channel G" : fmt::format("no channel '{}'", wanted),
                            fmt::join(reader.facts().channels, ", ")));
}

}  // namespace hemibake
