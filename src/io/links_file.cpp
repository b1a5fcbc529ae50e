#include "io/links_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/context.h"
#include "core/error.h"
#include "io/hdf5_handle.h"
#include "io/links_layout.h"
#include "io/output_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProvenanceAttribute = "hemibake:provenance";

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
    hash_.add(values, count * H5Tget_size(memory_type_));
    position_ += count;
  }
  // Returns where it stands in the file.
  StoredArray close() {
    const haddr_t offset = position_ > 0 ? H5Dget_offset(data_.id()) : 0;
    if (offset == HADDR_UNDEF) throw_hdf5_error();
    data_.close();
    return {offset, position_, hash_.digits()};
  }

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
  Sha256 hash_;
};

StoredMatrix write_matrix(hid_t file, const char* name, const FormFactorMatrix& links) {
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
  const StoredMatrix stored{links.rows, links.columns, row_begins.close(), indices.close(), weights.close()};
  group.close();
  return stored;
}

Hdf5Handle create_file(const fs::path& path, uint64_t head_bytes) {
  const Hdf5Handle properties(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  checked(H5Pset_userblock(properties.id(), head_bytes));
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  checked(H5Pset_file_locking(access.id(), false, true));  // the OutputFile holds a lock
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, properties.id(), access.id()), H5Fclose};
}

void check_rows(const FormFactorMatrix& links, const std::string& name) {
  expect_equal(links.blocks.size(), make_form_factors(links.rows, 0).blocks.size(), "blocks of " + name);
  uint64_t rows = 0;
  for (const FormFactorBlock& block : links.blocks) rows += block.rows;
  expect_equal(rows, uint64_t{links.rows}, "rows of " + name);
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
  const uint64_t head_bytes = links_head_bytes(provenance);
  LinksLayout layout;
  layout.provenance = provenance;
  try {
    Hdf5Handle file = create_file(output.temporary_path(), head_bytes);
    write_provenance(file.id(), provenance);
    layout.gather = write_matrix(file.id(), "gather", final_gather);
    if (patches) {
      layout.patches = write_matrix(file.id(), "patches", *patches);
    } else {
      checked(H5Lcreate_hard(file.id(), "gather", file.id(), "patches", H5P_DEFAULT, H5P_DEFAULT));
    }
    Appender direct_data(file.id(), "direct", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, direct.size());
    direct_data.append(direct.data(), direct.size());
    layout.direct = direct_data.close();
    file.close();
  } catch (const Hdf5Error& error) {
    if (error.error_number != 0) fail_write(path, error.error_number);
    throw InputError(
        fmt::format("{}: could not be made a file of HDF5, expected free memory and disk", path.string()));
  }
  std::error_code error;
  layout.file_bytes = fs::file_size(output.temporary_path(), error);
  if (error) fail_write(path, error.value());
  output.write(links_head(layout, head_bytes));  // from offset 0: over the user block
}

void write_links(const fs::path& path, const FormFactorMatrix& final_gather, const FormFactorMatrix* patches,
                 std::span<const float> direct, const Provenance& provenance) {
  OutputFile file(path);
  write_links(file, final_gather, patches, direct, provenance);
  file.commit();
}

}  // namespace hemibake
