// Small groups of patches that see little but each other: nodes round the bottom of a pit, where light stays
// for hundreds of bounces. Inside a group it is followed to the end at once, by the inverse of I − W
// diag(albedo) among its members: block Jacobi with the blocks of a nearly decomposable chain (Courtois,
// "Decomposability", 1977), the preconditioner of Orthomin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "transport/links/form_factors.h"

namespace hemibake {

struct BlockJacobi {
  static constexpr uint32_t kMostMembers = 16;

  std::vector<uint32_t> members;       // of the groups, one after another, each ascending
  std::vector<uint32_t> first_member;  // of every group; their number at the end
  std::vector<size_t> first_entry;     // of every group
  std::vector<float> inverse;          // members × members of every group, row by row

  size_t count() const { return first_entry.size(); }
};

// Groups grow along links that pass on more than a quarter of the light, the strongest first, and take at
// most two entries of `inverse` for each row of the links. A group that loses nothing has the inverse 1.
// Reads the links twice. links: patch × patch. albedo: one per patch, 0..1; empty: 1 everywhere. The same
// bytes at any thread count.
BlockJacobi make_block_jacobi(const FormFactorMatrix& links, std::span<const float> albedo);

// values of a group's members: its inverse times them; of other patches they stay.
void apply_block_jacobi(const BlockJacobi& groups, std::vector<double>& values);

}  // namespace hemibake
