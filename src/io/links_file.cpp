#include "io/links_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/context.h"
#include "core/error.h"
#include "io/hdf5_handle.h"
#include "io/output_file.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProvenanceAttribute = "hemibake:provenance";
// Most rows or columns of a matrix: the facets of the largest map.
constexpr uint64_t kMaxSide = 2 * kMaxTexels;

// ---- Writing

Hdf5Handle make_space(hsize_t size) { return {H5Screate_simple(1, &size, nullptr), H5Sclose}; }

Hdf5Handle make_text_type() {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  checked(H5Tset_size(type.id(), H5T_VARIABLE));
  checked(H5Tset_cset(type.id(), H5T_CSET_UTF8));
  return type;
}

void write_attribute(hid_t owner, const std::string& name, hid_t type, const Hdf5Handle& space,
                     const void* value) {
  Hdf5Handle attribute(H5Acreate2(owner, name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  checked(H5Awrite(attribute.id(), type, value));
  attribute.close();
}

void write_text(hid_t owner, const std::string& name, const std::string& text) {
  const char* bytes = text.c_str();
  write_attribute(owner, name, make_text_type().id(), Hdf5Handle(H5Screate(H5S_SCALAR), H5Sclose), &bytes);
}

template <class Number>
void write_number(hid_t owner, const std::string& name, hid_t type, Number value) {
  write_attribute(owner, name, type, Hdf5Handle(H5Screate(H5S_SCALAR), H5Sclose), &value);
}

void write_provenance(hid_t file, const Provenance& provenance) {
  for (const auto& [name, value] : provenance.items()) {
    const std::string attribute = "hemibake:" + name;
    if (value.is_string()) {
      write_text(file, attribute, valid_utf8(value.get<std::string>()));
    } else if (value.is_boolean()) {
      write_number(file, attribute, H5T_NATIVE_INT64, int64_t{value.get<bool>()});
    } else if (value.is_number_float()) {
      write_number(file, attribute, H5T_NATIVE_DOUBLE, value.get<double>());
    } else if (value.is_number_unsigned()) {
      write_number(file, attribute, H5T_NATIVE_UINT64, value.get<uint64_t>());
    } else {
      write_number(file, attribute, H5T_NATIVE_INT64, value.get<int64_t>());
    }
  }
  write_text(file, kProvenanceAttribute, provenance.dump());
}

// A one-dimensional data set filled from its start, piece by piece.
class Appender {
 public:
  Appender(hid_t group, const char* name, hid_t stored_type, hid_t memory_type, hsize_t size)
      : space_(make_space(size)),
        data_(make(group, name, stored_type, space_.id())),
        memory_type_(memory_type) {}

  void append(const void* values, hsize_t count) {
    if (count == 0) return;
    checked(H5Sselect_hyperslab(space_.id(), H5S_SELECT_SET, &position_, nullptr, &count, nullptr));
    checked(H5Dwrite(data_.id(), memory_type_, make_space(count).id(), space_.id(), H5P_DEFAULT, values));
    position_ += count;
  }
  void close() { data_.close(); }

 private:
  static Hdf5Handle make(hid_t group, const char* name, hid_t type, hid_t space) {
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    checked(H5Pset_obj_track_times(properties.id(), false));  // the same bytes every run
    checked(H5Pset_fill_time(properties.id(), H5D_FILL_TIME_NEVER));
    return {H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties.id(), H5P_DEFAULT), H5Dclose};
  }

  Hdf5Handle space_;
  Hdf5Handle data_;
  hid_t memory_type_;
  hsize_t position_ = 0;
};

void write_matrix(hid_t file, const char* name, const FormFactorMatrix& links) {
  Hdf5Handle group(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  const std::array<uint64_t, 2> shape{links.rows, links.columns};
  write_attribute(group.id(), "shape", H5T_NATIVE_UINT64, make_space(shape.size()), shape.data());
  Appender row_begins(group.id(), "indptr", H5T_STD_U64LE, H5T_NATIVE_UINT64, hsize_t{links.rows} + 1);
  Appender indices(group.id(), "indices", H5T_STD_U32LE, H5T_NATIVE_UINT32, links.count());
  Appender weights(group.id(), "weights", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, links.count());
  uint64_t position = 0;
  row_begins.append(&position, 1);
  std::vector<uint64_t> ends;
  BlockRows rows;
  for (const FormFactorBlock& block : links.blocks) {
    throw_if_cancelled();
    unpack_block(block, rows);
    ends.assign(rows.row_begin.begin() + 1, rows.row_begin.end());
    for (uint64_t& end : ends) end += position;
    position += rows.columns.size();
    row_begins.append(ends.data(), ends.size());
    indices.append(rows.columns.data(), rows.columns.size());
    weights.append(rows.weights.data(), rows.weights.size());
  }
  row_begins.close();
  indices.close();
  weights.close();
  group.close();
}

void check_rows(const FormFactorMatrix& links, const std::string& name) {
  expect_equal(links.blocks.size(), make_form_factors(links.rows, 0).blocks.size(), "blocks of " + name);
  uint64_t rows = 0;
  for (const FormFactorBlock& block : links.blocks) rows += block.rows;
  expect_equal(rows, uint64_t{links.rows}, "rows of " + name);
}

// ---- Reading

// Reports a fault of the contents; becomes an InputError with the file's name in front.
[[noreturn]] void refuse(const std::string& fault) { throw Hdf5Error(fault, 0); }

Provenance read_provenance(hid_t file) {
  if (checked(H5Aexists(file, kProvenanceAttribute)) == 0) refuse("it has no hemibake attributes");
  const Hdf5Handle attribute(H5Aopen(file, kProvenanceAttribute, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (checked(H5Tis_variable_str(type.id())) == 0 || checked(H5Sget_simple_extent_npoints(space.id())) != 1)
    refuse("its hemibake:provenance is not a text");
  char* bytes = nullptr;
  checked(H5Aread(attribute.id(), make_text_type().id(), &bytes));
  Provenance provenance = Provenance::parse(bytes ? bytes : "", nullptr, false);
  H5free_memory(bytes);
  if (!provenance.is_object()) refuse("its hemibake:provenance is not a JSON object");
  return provenance;
}

// Reads a one-dimensional data set from its start, piece by piece.
class Extractor {
 public:
  Extractor(hid_t group, const std::string& name, hid_t stored_type, hid_t memory_type)
      : data_(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose),
        space_(H5Dget_space(data_.id()), H5Sclose),
        memory_type_(memory_type) {
    const Hdf5Handle type(H5Dget_type(data_.id()), H5Tclose);
    if (checked(H5Tequal(type.id(), stored_type)) == 0)
      refuse(name + " has another number type than it should");
    if (H5Sget_simple_extent_ndims(space_.id()) != 1) refuse(name + " is not one-dimensional");
    size_ = static_cast<hsize_t>(checked(H5Sget_simple_extent_npoints(space_.id())));
  }

  hsize_t size() const { return size_; }

  template <class Number>
  void extract(std::vector<Number>& values, hsize_t count) {
    values.resize(count);
    if (count == 0) return;
    checked(H5Sselect_hyperslab(space_.id(), H5S_SELECT_SET, &position_, nullptr, &count, nullptr));
    checked(
        H5Dread(data_.id(), memory_type_, make_space(count).id(), space_.id(), H5P_DEFAULT, values.data()));
    position_ += count;
  }

 private:
  Hdf5Handle data_;
  Hdf5Handle space_;
  hid_t memory_type_;
  hsize_t size_ = 0;
  hsize_t position_ = 0;
};

std::array<uint64_t, 2> read_shape(hid_t group, const std::string& name) {
  const Hdf5Handle attribute(H5Aopen(group, "shape", H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (checked(H5Sget_simple_extent_npoints(space.id())) != 2)
    refuse(name + " has a shape that is not two numbers");
  std::array<uint64_t, 2> shape{};
  checked(H5Aread(attribute.id(), H5T_NATIVE_UINT64, shape.data()));
  if (*std::max_element(shape.begin(), shape.end()) > kMaxSide)
    refuse(fmt::format("{} is {} x {}, expected at most {} a side", name, shape[0], shape[1], kMaxSide));
  return shape;
}

// Place of a block of rows in the matrix that is read.
struct BlockPlace {
  const std::string& name;  // of the matrix
  uint64_t columns, links;  // of the matrix
  uint64_t first_row, first_link;
};

// Sets the row begins, relative to the block, from absolute ends.
void set_row_begins(BlockRows& rows, const std::vector<uint64_t>& ends, const BlockPlace& place) {
  rows.row_begin.assign(1, 0);
  uint64_t previous = place.first_link;
  for (size_t row = 0; row < ends.size(); ++row) {
    if (ends[row] < previous || ends[row] > place.links || ends[row] - previous > place.columns)
      refuse(fmt::format("row {} of {} goes from link {} to {} of {}", place.first_row + row, place.name,
                         previous, ends[row], place.links));
    previous = ends[row];
    if (previous - place.first_link > UINT32_MAX)
      refuse(fmt::format("{} has too many links in a row", place.name));
    rows.row_begin.push_back(static_cast<uint32_t>(previous - place.first_link));
  }
}

void check_block(const BlockRows& rows, uint64_t first_row, const FormFactorMatrix& links,
                 const std::string& name) {
  for (const uint32_t patch : rows.columns)
    if (patch >= links.columns)
      refuse(fmt::format("a link of {} goes to patch {} of {}", name, patch, links.columns));
  for (const float weight : rows.weights)
    if (!(std::isfinite(weight) && weight >= 0)) refuse(fmt::format("a weight of {} is {}", name, weight));
  for (size_t row = 0; row + 1 < rows.row_begin.size(); ++row)
    for (uint32_t k = rows.row_begin[row] + 1; k < rows.row_begin[row + 1]; ++k)
      if (rows.columns[k] <= rows.columns[k - 1])
        refuse(fmt::format("in row {} of {} patch {} follows patch {}", first_row + row, name,
                           rows.columns[k], rows.columns[k - 1]));
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

FormFactorMatrix read_matrix(hid_t file, const std::string& name) {
  const Hdf5Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose);
  const auto [rows, columns] = read_shape(group.id(), name);
  Extractor row_begins(group.id(), "indptr", H5T_STD_U64LE, H5T_NATIVE_UINT64);
  Extractor indices(group.id(), "indices", H5T_STD_U32LE, H5T_NATIVE_UINT32);
  Extractor weights(group.id(), "weights", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT);
  if (row_begins.size() != rows + 1 || indices.size() != weights.size())
    refuse(fmt::format("{} has {} rows, {} row starts, {} indices and {} weights", name, rows,
                       row_begins.size(), indices.size(), weights.size()));
  FormFactorMatrix links = make_form_factors(static_cast<uint32_t>(rows), static_cast<uint32_t>(columns));
  std::vector<uint64_t> ends;
  BlockRows block_rows;
  row_begins.extract(ends, 1);
  uint64_t position = ends[0];
  if (position != 0) refuse(fmt::format("the first row of {} begins at link {}, not at 0", name, position));
  for (size_t b = 0; b < links.blocks.size(); ++b) {
    throw_if_cancelled();
    const uint64_t first_row = b * FormFactorMatrix::kRowsPerBlock;
    row_begins.extract(ends, std::min<uint64_t>(FormFactorMatrix::kRowsPerBlock, rows - first_row));
    set_row_begins(block_rows, ends, {name, columns, indices.size(), first_row, position});
    indices.extract(block_rows.columns, block_rows.row_begin.back());
    weights.extract(block_rows.weights, block_rows.row_begin.back());
    check_block(block_rows, first_row, links, name);
    pack_rows(block_rows, links, b);
    position = ends.back();
  }
  if (position != indices.size())
    refuse(fmt::format("the last row of {} ends at link {} of {}", name, position, indices.size()));
  return links;
}

bool same_object(hid_t file, const char* a, const char* b) {
  H5O_info_t first{}, second{};
  checked(H5Oget_info_by_name2(file, a, &first, H5O_INFO_BASIC, H5P_DEFAULT));
  checked(H5Oget_info_by_name2(file, b, &second, H5O_INFO_BASIC, H5P_DEFAULT));
  return first.addr == second.addr;
}

LinksFile read_links_from(hid_t file) {
  LinksFile result;
  result.provenance = read_provenance(file);
  result.final_gather = read_matrix(file, "gather");
  if (!same_object(file, "gather", "patches")) result.patch_form_factors = read_matrix(file, "patches");
  const FormFactorMatrix& patches =
      result.patch_form_factors ? *result.patch_form_factors : result.final_gather;
  Extractor direct(file, "direct", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT);
  if (patches.rows != result.final_gather.columns || patches.columns != result.final_gather.columns ||
      direct.size() != result.final_gather.columns)
    refuse(fmt::format("gather is {} x {}, patches {} x {}, direct {}: the patches do not agree",
                       result.final_gather.rows, result.final_gather.columns, patches.rows, patches.columns,
                       direct.size()));
  direct.extract(result.direct, direct.size());
  for (size_t i = 0; i < result.direct.size(); ++i)
    if (!std::isfinite(result.direct[i]))
      refuse(fmt::format("direct of patch {} is {}", i, result.direct[i]));
  return result;
}

}  // namespace

void write_links(OutputFile& output, const FormFactorMatrix& final_gather, const FormFactorMatrix* patches,
                 std::span<const float> direct, const Provenance& provenance) {
  check_provenance(provenance);
  const FormFactorMatrix& between_patches = patches ? *patches : final_gather;
  check_rows(final_gather, "gather");
  check_rows(between_patches, "patches");
  expect_equal(between_patches.rows, final_gather.columns, "rows of patches");
  expect_equal(between_patches.columns, final_gather.columns, "columns of patches");
  expect_equal(direct.size(), size_t{final_gather.columns}, "values of direct");
  for (const float value : direct)
    if (!std::isfinite(value)) fail_expectation("E0 of a patch", static_cast<double>(value), 0);
  const fs::path& path = output.path();
  const Hdf5Silence silence;
  try {
    // The file is locked by `output` already.
    Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    checked(H5Pset_file_locking(access.id(), false, true));
    Hdf5Handle file(H5Fcreate(output.temporary_path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()),
                    H5Fclose);
    write_provenance(file.id(), provenance);
    write_matrix(file.id(), "gather", final_gather);
    if (patches) {
      write_matrix(file.id(), "patches", *patches);
    } else {
      checked(H5Lcreate_hard(file.id(), "gather", file.id(), "patches", H5P_DEFAULT, H5P_DEFAULT));
    }
    Appender direct_data(file.id(), "direct", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, direct.size());
    direct_data.append(direct.data(), direct.size());
    direct_data.close();
    file.close();
  } catch (const Hdf5Error& error) {
    if (error.error_number != 0) fail_write(path, error.error_number);
    throw InputError(fmt::format("{}: could not write: {}", path.string(), error.what()));
  }
}

void write_links(const fs::path& path, const FormFactorMatrix& final_gather, const FormFactorMatrix* patches,
                 std::span<const float> direct, const Provenance& provenance) {
  OutputFile file(path);
  write_links(file, final_gather, patches, direct, provenance);
  file.commit();
}

LinksFile read_links(const fs::path& path) {
  std::error_code missing;
  const fs::file_status status = fs::status(path, missing);
  if (!fs::is_regular_file(status))
    throw InputError(fmt::format("{}: {}, expected a links file of `hemibake bake`", path.string(),
                                 fs::exists(status) ? "is not a regular file" : missing.message()));
  const Hdf5Silence silence;
  try {
    const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    return read_links_from(file.id());
  } catch (const Hdf5Error& error) {
    throw InputError(fmt::format("{}: is not a whole links file ({}), expected one of `hemibake bake`",
                                 path.string(), error.what()));
  }
}

}  // namespace hemibake
