// LINKS.h5: form-factor matrices as compressed sparse rows in HDF5. src/io/README.md describes the file.
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
  std::optional<FormFactorMatrix> patch_form_factors;  // none: final_gather itself, as patches are texels
  std::vector<float> direct;                           // E₀ of every patch, 0..π
  Provenance provenance;
};

// Writes block by block, the same bytes at every run. Throws std::logic_error where sizes do not fit or a
// value is not finite; InputError where the file cannot be written.
// final_gather: texel × patch.
// patches:      patch × patch; null: final_gather itself, stored once under both names.
// direct:       E₀ of every patch, 0..π.
// provenance:   becomes attributes `hemibake:NAME` of the file, with integers of 64 bits.
void write_links(const std::filesystem::path& path, const FormFactorMatrix& final_gather,
                 const FormFactorMatrix* patches, std::span<const float> direct,
                 const Provenance& provenance);

// Reads and packs the rows again, without HDF5 (links_layout.h), in memory bounded by the file's size. Rows
// packed by a bake stay as they are to 10⁻⁴ of their quantum (transport/links/form_factors.h); others are
// rounded with their sum kept. Throws InputError naming the file where it is not a links file of this version
// as it was written: a hash differs, row starts or columns do not ascend, a column is beyond the matrix, or a
// value is not finite or below 0.
LinksFile read_links(const std::filesystem::path& path);

}  // namespace hemibake
