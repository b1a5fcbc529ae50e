// Block Jacobi, the preconditioner of Orthomin: inverts I − W diag(albedo) within small groups of patches
// that see little but each other. Such are nodes round the bottom of a pit, where light stays for hundreds of
// bounces: the blocks of a nearly decomposable chain (Courtois, "Decomposability", 1977).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "transport/links/form_factors.h"

namespace hemibake {

struct BlockJacobi {
  static constexpr uint32_t kMostMembers = 16;

  std::vector<uint32_t> members;       // patches of the groups, one group after another, each ascending
  std::vector<uint32_t> first_member;  // of every group, and the number of members at the end
  std::vector<size_t> first_entry;     // of every group in `inverse`
  std::vector<float> inverse;          // members × members of every group, row by row

  size_t count() const { return first_entry.size(); }
};

// Groups patches and inverts the blocks of the groups. Groups grow along strong connections, that pass on
// more than a quarter of the light, the strongest first, up to two entries of `inverse` per row of the
// matrix. A group that loses nothing gets the inverse 1. Reads the matrix twice. The same bytes at any thread
// count. form_factors: patch × patch. albedo: one per patch, 0..1; empty: 1 everywhere.
BlockJacobi make_block_jacobi(const FormFactorMatrix& form_factors, std::span<const float> albedo);

// Multiplies the values of each group's members by its inverse. values: one per patch.
void apply_block_jacobi(const BlockJacobi& groups, std::vector<double>& values);

}  // namespace hemibake
