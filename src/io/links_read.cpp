#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/context.h"
#include "core/error.h"
#include "io/links_file.h"
#include "io/links_layout.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "arrays are read as they are stored");

class LinksSource {
 public:
  explicit LinksSource(const fs::path& path)
      : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
    if (!file_) throw InputError(fmt::format("{}: could not read: {}", path.string(), std::strerror(errno)));
  }

  [[noreturn]] void refuse(const std::string& fault) const { refuse_links(path_, fault); }

  void read(uint64_t offset, void* values, size_t bytes) const {
    auto* next = static_cast<char*>(values);
    while (bytes > 0) {
      const ssize_t count = pread(fileno(file_.get()), next, bytes, static_cast<off_t>(offset));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) refuse(count < 0 ? std::strerror(errno) : "it ends within an array");
      next += count;
      offset += static_cast<uint64_t>(count);
      bytes -= static_cast<size_t>(count);
    }
  }

 private:
  fs::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

// Reads an array from its start, piece by piece.
class Extractor {
 public:
  Extractor(const LinksSource& source, const StoredArray& array, std::string name)
      : source_(source), array_(array), name_(std::move(name)) {}

  template <class Number>
  void extract(std::vector<Number>& values, uint64_t count) {
    values.resize(count);
    source_.read(array_.offset + position_ * sizeof(Number), values.data(), count * sizeof(Number));
    hash_.add(values.data(), count * sizeof(Number));
    position_ += count;
  }
  // Throws InputError where what was read is not what was written.
  void check_hash() {
    if (hash_.digits() != array_.sha256) source_.refuse(name_ + " was changed");
  }

 private:
  const LinksSource& source_;
  const StoredArray& array_;
  std::string name_;
  Sha256 hash_;
  uint64_t position_ = 0;
};

// Place of a block of rows in the matrix that is read.
struct BlockPlace {
  const std::string& name;  // of the matrix
  uint64_t columns, links;  // of the matrix
  uint64_t first_row, first_link;
};

// Sets the row begins, relative to the block, from absolute ends.
void set_row_begins(const LinksSource& source, BlockRows& rows, const std::vector<uint64_t>& ends,
                    const BlockPlace& place) {
  rows.row_begin.assign(1, 0);
  uint64_t previous = place.first_link;
  for (size_t row = 0; row < ends.size(); ++row) {
    if (ends[row] < previous || ends[row] > place.links || ends[row] - previous > place.columns)
      source.refuse(fmt::format("row {} of {} goes from link {} to {} of {}", place.first_row + row,
                                place.name, previous, ends[row], place.links));
    previous = ends[row];
    if (previous - place.first_link > UINT32_MAX)
      source.refuse(fmt::format("{} has too many links in a row", place.name));
    rows.row_begin.push_back(static_cast<uint32_t>(previous - place.first_link));
  }
}

void check_block(const LinksSource& source, const BlockRows& rows, const BlockPlace& place) {
  for (const uint32_t patch : rows.columns)
    if (patch >= place.columns)
      source.refuse(fmt::format("a link of {} goes to patch {} of {}", place.name, patch, place.columns));
  for (const float weight : rows.weights)
    if (!(std::isfinite(weight) && weight >= 0))
      source.refuse(fmt::format("a weight of {} is {}", place.name, weight));
  for (size_t row = 0; row + 1 < rows.row_begin.size(); ++row)
    for (uint32_t k = rows.row_begin[row] + 1; k < rows.row_begin[row + 1]; ++k)
      if (rows.columns[k] <= rows.columns[k - 1])
        source.refuse(fmt::format("in row {} of {} patch {} follows patch {}", place.first_row + row,
                                  place.name, rows.columns[k], rows.columns[k - 1]));
}

void pack_rows(const BlockRows& rows, FormFactorMatrix& links, size_t index) {
  std::vector<FormFactor> row;
  for (size_t i = 0; i + 1 < rows.row_begin.size(); ++i) {
    row.clear();
    for (uint32_t k = rows.row_begin[i]; k < rows.row_begin[i + 1]; ++k)
      row.push_back({rows.columns[k], rows.weights[k]});
    append_row(links.blocks[index], row);
  }
  finish_block(links, index);
}

FormFactorMatrix read_matrix(const LinksSource& source, const StoredMatrix& stored, const std::string& name) {
  Extractor row_begins(source, stored.row_begins, name + "/indptr");
  Extractor indices(source, stored.indices, name + "/indices");
  Extractor weights(source, stored.weights, name + "/weights");
  const uint64_t count = stored.indices.count;
  FormFactorMatrix links = make_form_factors(stored.rows, stored.columns);
  std::vector<uint64_t> ends;
  BlockRows rows;
  row_begins.extract(ends, 1);
  uint64_t position = ends[0];
  if (position != 0)
    source.refuse(fmt::format("the first row of {} begins at link {}, not at 0", name, position));
  for (size_t b = 0; b < links.blocks.size(); ++b) {
    throw_if_cancelled();
    const uint64_t first_row = b * FormFactorMatrix::kRowsPerBlock;
    const BlockPlace place{name, stored.columns, count, first_row, position};
    row_begins.extract(ends, std::min<uint64_t>(FormFactorMatrix::kRowsPerBlock, stored.rows - first_row));
    set_row_begins(source, rows, ends, place);
    indices.extract(rows.columns, rows.row_begin.back());
    weights.extract(rows.weights, rows.row_begin.back());
    check_block(source, rows, place);
    pack_rows(rows, links, b);
    position = ends.back();
  }
  if (position != count)
    source.refuse(fmt::format("the last row of {} ends at link {} of {}", name, position, count));
  for (Extractor* array : {&row_begins, &indices, &weights}) array->check_hash();
  return links;
}

}  // namespace

LinksFile read_links(const fs::path& path) {
  std::error_code missing;
  const fs::file_status status = fs::status(path, missing);
  if (!fs::is_regular_file(status))
    throw InputError(fmt::format("{}: {}, expected a links file of `hemibake bake`", path.string(),
                                 fs::exists(status) ? "is not a regular file" : missing.message()));
  LinksLayout layout = read_links_layout(path);
  const LinksSource source(path);
  LinksFile result;
  result.final_gather = read_matrix(source, layout.gather, "gather");
  if (layout.patches) result.patch_form_factors = read_matrix(source, *layout.patches, "patches");
  Extractor direct(source, layout.direct, "direct");
  direct.extract(result.direct, layout.direct.count);
  for (size_t i = 0; i < result.direct.size(); ++i)
    if (!(std::isfinite(result.direct[i]) && result.direct[i] >= 0))
      source.refuse(fmt::format("direct of patch {} is {}", i, result.direct[i]));
  direct.check_hash();
  result.provenance = std::move(layout.provenance);
  return result;
}

}  // namespace hemibake
