// LINKS.h5: form-factor links as compressed sparse rows (DESIGN.md, "Files"). The one place that knows HDF5.
//
// Groups `/gather` (texel × patch) and `/patches` (patch × patch), each `indptr` u64 (rows + 1), `indices`
// u32 (column of every link), `weights` f32, and an attribute `shape` (rows, columns); `/direct` f32, E₀ of
// every patch. In Python: scipy.sparse.csr_matrix((g["weights"], g["indices"], g["indptr"]),
// shape=g.attrs["shape"]).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "io/provenance.h"
#include "transport/links/form_factors.h"

namespace hemibake {

struct LinksFile {
  FormFactorMatrix final_gather;
  std::optional<FormFactorMatrix> patch_form_factors;  // none: patches are texels: the same as final_gather
  std::vector<float> direct;                           // one per patch
  Provenance provenance;
};

// gather: texel × patch. patches: patch × patch; null where that is the same matrix, which is then stored
// once under both names. direct: E₀ of every patch, 0..π. Written block by block; entries of `provenance` are
// attributes `hemibake:NAME` of the file as in io/image_io.h, with integers of 64 bits. The same bytes at
// every run. Throws std::logic_error where sizes do not fit or a value is not finite; InputError where the
// file cannot be written.
void write_links(const std::filesystem::path& path, const FormFactorMatrix& final_gather,
                 const FormFactorMatrix* patches, std::span<const float> direct,
                 const Provenance& provenance);

// The links packed again: rows that were packed before stay as they are to 10⁻⁴ of their quantum
// (transport/links/form_factors.h); few that lost links to it, and others, are rounded, their sum kept.
// Throws InputError naming the file where it is not a whole links file, a row begins before the one before
// it, its columns do not ascend or are beyond the matrix, or a value is not finite or a weight below 0.
LinksFile read_links(const std::filesystem::path& path);

}  // namespace hemibake
