#include "io/links_layout.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/json_text.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kMark = "hemibake links 2 ";
constexpr std::string_view kHdf5Mark = "\x89HDF\r\n\x1a\n";
constexpr size_t kSizeDigits = 16, kHashDigits = 64;
constexpr size_t kFirstLineBytes = kMark.size() + kSizeDigits + 1 + kHashDigits + 1;
constexpr uint64_t kLeastHeadBytes = 512;     // of HDF5
constexpr uint64_t kBytesOfLayout = 1 << 11;  // more than seven arrays of largest numbers take
constexpr uint64_t kMostHeadBytes = 2 * kMaxJsonBytes;
// Most rows or columns of a matrix: the facets of the largest map.
constexpr uint32_t kMaxSide = 2 * kMaxTexels;

std::string sha256_of(std::string_view text) {
  Sha256 hash;
  hash.add(text.data(), text.size());
  return hash.digits();
}

Json json_from(const StoredArray& array) {
  return {{"offset", array.offset}, {"count", array.count}, {"sha256", array.sha256}};
}

Json json_from(const StoredMatrix& matrix) {
  return {{"rows", matrix.rows},
          {"columns", matrix.columns},
          {"indptr", json_from(matrix.row_begins)},
          {"indices", json_from(matrix.indices)},
          {"weights", json_from(matrix.weights)}};
}

// bytes: of a number. end: of the file.
StoredArray array_from(const JsonReader& json, uint64_t bytes, uint64_t end) {
  StoredArray array;
  array.offset = json.at("offset").whole<uint64_t>(0, end);
  array.count = json.at("count").whole<uint64_t>(0, (end - array.offset) / bytes);
  array.sha256 = json.at("sha256").text();
  return array;
}

StoredMatrix matrix_from(const JsonReader& json, uint64_t end) {
  StoredMatrix matrix;
  matrix.rows = json.at("rows").whole<uint32_t>(0, kMaxSide);
  matrix.columns = json.at("columns").whole<uint32_t>(0, kMaxSide);
  matrix.row_begins = array_from(json.at("indptr"), sizeof(uint64_t), end);
  matrix.indices = array_from(json.at("indices"), sizeof(uint32_t), end);
  matrix.weights = array_from(json.at("weights"), sizeof(float), end);
  if (matrix.row_begins.count != uint64_t{matrix.rows} + 1 || matrix.indices.count != matrix.weights.count)
    throw InputError(fmt::format("{} has {} rows, {} row starts, {} indices and {} weights, expected as many",
                                 json.place(), matrix.rows, matrix.row_begins.count, matrix.indices.count,
                                 matrix.weights.count));
  return matrix;
}

LinksLayout layout_from(const JsonReader& json, uint64_t end) {
  LinksLayout layout;
  layout.file_bytes = json.at("bytes").whole<uint64_t>(end, end);
  layout.gather = matrix_from(json.at("gather"), end);
  if (const JsonReader patches = json.at("patches"); !patches.is_null())
    layout.patches = matrix_from(patches, end);
  layout.direct = array_from(json.at("direct"), sizeof(float), end);
  const StoredMatrix& patches = layout.patches ? *layout.patches : layout.gather;
  if (patches.rows != layout.gather.columns || patches.columns != patches.rows ||
      layout.direct.count != patches.rows)
    throw InputError(fmt::format(
        "{}: gather is {} x {}, patches {} x {}, direct {}: the patches do not agree", json.place(),
        layout.gather.rows, layout.gather.columns, patches.rows, patches.columns, layout.direct.count));
  return layout;
}

// Returns the head without its first line, whose hash it has.
std::string read_head(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line(kFirstLineBytes, '\0');
  if (!file.read(line.data(), static_cast<std::streamsize>(line.size())) || !line.starts_with(kMark)) {
    if (line.starts_with(kHdf5Mark))
      throw SettingError(
          "is HDF5 of another program or an older version, expected the links of a bake of this one: bake "
          "again with {links}",
          path.string());
    refuse_links(path, "it does not begin as one");
  }
  uint64_t bytes = 0;
  const char* digits = line.data() + kMark.size();
  const auto [end, error] = std::from_chars(digits, digits + kSizeDigits, bytes);
  if (error != std::errc() || end != digits + kSizeDigits || bytes < kLeastHeadBytes ||
      bytes > kMostHeadBytes)
    refuse_links(path, "its head has no size");
  std::string rest(bytes - kFirstLineBytes, '\0');
  if (!file.read(rest.data(), static_cast<std::streamsize>(rest.size())))
    refuse_links(path, "it ends within its head");
  if (line != fmt::format("{}{:016} {}\n", kMark, bytes, sha256_of(rest)))
    refuse_links(path, "its head was changed");
  return rest;
}

}  // namespace

uint64_t links_head_bytes(const Provenance& provenance) {
  return std::bit_ceil(
      std::max(kLeastHeadBytes, kFirstLineBytes + kBytesOfLayout + provenance.dump().size()));
}

std::string links_head(const LinksLayout& layout, uint64_t head_bytes) {
  const Json json = {{"bytes", layout.file_bytes},
                     {"gather", json_from(layout.gather)},
                     {"patches", layout.patches ? json_from(*layout.patches) : Json()},
                     {"direct", json_from(layout.direct)},
                     {"provenance", layout.provenance}};
  std::string rest = json.dump();
  if (rest.size() + kFirstLineBytes > head_bytes)
    throw std::logic_error("the head of a links file has no room");
  rest.resize(head_bytes - kFirstLineBytes, ' ');
  return fmt::format("{}{:016} {}\n{}", kMark, head_bytes, sha256_of(rest), rest);
}

LinksLayout read_links_layout(const fs::path& path) {
  std::error_code error;
  const uint64_t bytes = fs::file_size(path, error);
  if (error) refuse_links(path, error.message());
  const std::string head = read_head(path);
  try {
    const Json json = parse_json(head, "its head");
    LinksLayout layout = layout_from({json, "its head"}, bytes);
    check_read_provenance(JsonReader(json, "its head").at("provenance"));
    layout.provenance = json["provenance"];
    return layout;
  } catch (const InputError& fault) {
    refuse_links(path, fault.what());
  }
}

void refuse_links(const fs::path& path, const std::string& fault) {
  throw InputError(fmt::format("{}: is not a whole links file ({}), expected one of `hemibake bake`",
                               path.string(), fault));
}

}  // namespace hemibake
