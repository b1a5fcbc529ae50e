#include "transport/solver/block_jacobi.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/parallel.h"

namespace hemibake {
namespace {

constexpr float kStrong = 0.25f;  // least share of light that a strong connection passes on
constexpr size_t kEntriesPerRow = 2;
constexpr size_t kGroupsPerTask = 1024;
// Least share of its light that a group loses: below, its inverse is rounding.
constexpr double kLeastLoss = 1e-6;
constexpr uint32_t kNoGroup = 0xffffffff;

struct Connection {
  float weight;
  uint32_t row, column;
};

bool is_stronger(const Connection& a, const Connection& b) {
  return std::tuple(-a.weight, a.row, a.column) < std::tuple(-b.weight, b.row, b.column);
}

float passed_on(float weight, uint32_t patch, std::span<const float> albedo) {
  return weight * (albedo.empty() ? 1.0f : albedo[patch]);
}

// Returns the strong connections, the strongest first.
std::vector<Connection> strong_connections(const FormFactorMatrix& form_factors,
                                           std::span<const float> albedo) {
  std::vector<std::vector<Connection>> of_blocks(form_factors.blocks.size());
  parallel_for(form_factors.blocks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b) {
      std::vector<Connection>& strong = of_blocks[b];
      visit_rows(form_factors, b,
                 [&](uint32_t row, std::span<const uint32_t> patches, std::span<const float> weights) {
                   for (size_t i = 0; i < patches.size(); ++i) {
                     const float weight = passed_on(weights[i], patches[i], albedo);
                     if (weight > kStrong && patches[i] != row) strong.push_back({weight, row, patches[i]});
                   }
                 });
      std::ranges::sort(strong, is_stronger);
      strong.resize(std::min<size_t>(strong.size(), form_factors.blocks[b].rows));
      strong.shrink_to_fit();
    }
  });
  size_t count = 0;
  for (const std::vector<Connection>& strong : of_blocks) count += strong.size();
  std::vector<Connection> all;
  all.reserve(count);
  for (std::vector<Connection>& strong : of_blocks) {
    all.insert(all.end(), strong.begin(), strong.end());
    strong = std::vector<Connection>();
  }
  std::ranges::sort(all, is_stronger);
  return all;
}

// Disjoint sets of patches, each named by its root, the lowest of them.
class DisjointSets {
 public:
  explicit DisjointSets(uint32_t patches) : parent_(patches), size_(patches, 1) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  uint32_t root(uint32_t patch) {
    while (parent_[patch] != patch) patch = parent_[patch] = parent_[parent_[patch]];
    return patch;
  }
  size_t size(uint32_t root) const { return size_[root]; }
  void join(uint32_t root_a, uint32_t root_b) {
    const auto [low, high] = std::minmax(root_a, root_b);
    parent_[high] = low;
    size_[low] = static_cast<uint8_t>(size_[low] + size_[high]);
  }

 private:
  std::vector<uint32_t> parent_;
  std::vector<uint8_t> size_;  // of roots
};

// Joins patches along strong connections.
DisjointSets join_strong(const FormFactorMatrix& form_factors, std::span<const float> albedo) {
  DisjointSets sets(form_factors.rows);
  size_t entries = 0;
  for (const Connection& connection : strong_connections(form_factors, albedo)) {
    const uint32_t a = sets.root(connection.row), b = sets.root(connection.column);
    if (a == b || sets.size(a) + sets.size(b) > BlockJacobi::kMostMembers) continue;
    const size_t joined = sets.size(a) + sets.size(b);
    const auto entries_of = [](size_t size) { return size > 1 ? size * size : 0; };
    const size_t more = entries_of(joined) - entries_of(sets.size(a)) - entries_of(sets.size(b));
    if (entries + more > kEntriesPerRow * form_factors.rows) continue;
    entries += more;
    sets.join(a, b);
  }
  return sets;
}

// Lists the members of the sets of two or more and makes room for their inverses. group: set for every patch.
BlockJacobi list_groups(DisjointSets& sets, std::vector<uint32_t>& group) {
  BlockJacobi groups;
  size_t entries = 0;
  uint32_t members = 0;
  for (uint32_t patch = 0; patch < group.size(); ++patch) {
    const uint32_t root = sets.root(patch);
    if (sets.size(root) == 1) continue;
    if (root == patch) {
      group[patch] = static_cast<uint32_t>(groups.count());
      groups.first_member.push_back(members);
      groups.first_entry.push_back(entries);
      members += static_cast<uint32_t>(sets.size(root));
      entries += sets.size(root) * sets.size(root);
    } else {
      group[patch] = group[root];
    }
  }
  groups.first_member.push_back(members);
  groups.members.resize(members);
  groups.inverse.assign(entries, 0);
  std::vector<uint32_t> next(groups.first_member);
  for (uint32_t patch = 0; patch < group.size(); ++patch)
    if (group[patch] != kNoGroup) groups.members[next[group[patch]]++] = patch;
  return groups;
}

std::span<const uint32_t> members_of(const BlockJacobi& groups, size_t group) {
  return std::span(groups.members)
      .subspan(groups.first_member[group], groups.first_member[group + 1] - groups.first_member[group]);
}

// Writes W diag(albedo) among the members of each group to where the inverse will be.
void collect_entries(const FormFactorMatrix& form_factors, std::span<const float> albedo,
                     std::span<const uint32_t> group, BlockJacobi& groups) {
  parallel_for(form_factors.blocks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b)
      visit_rows(form_factors, b,
                 [&](uint32_t row, std::span<const uint32_t> patches, std::span<const float> weights) {
                   if (group[row] == kNoGroup) return;
                   const std::span<const uint32_t> members = members_of(groups, group[row]);
                   const auto place = [&](uint32_t patch) {
                     return static_cast<size_t>(std::ranges::lower_bound(members, patch) - members.begin());
                   };
                   float* const of_row =
                       groups.inverse.data() + groups.first_entry[group[row]] + place(row) * members.size();
                   for (size_t i = 0; i < patches.size(); ++i)
                     if (group[patches[i]] == group[row])
                       of_row[place(patches[i])] = passed_on(weights[i], patches[i], albedo);
                 });
  });
}

// Replaces a matrix A by (1 − A)⁻¹, or by 1 if that does not exist: Gauss-Jordan elimination in place. Rows
// that pass on at most all light need no pivoting. entries: A, row by row, size × size.
void invert(std::span<float> entries, size_t size) {
  std::array<double, BlockJacobi::kMostMembers * BlockJacobi::kMostMembers> a;
  for (size_t i = 0; i < size * size; ++i) a[i] = -static_cast<double>(entries[i]);
  for (size_t i = 0; i < size; ++i) a[i * size + i] += 1;
  for (size_t k = 0; k < size; ++k) {
    const double pivot = a[k * size + k];
    if (!(pivot > kLeastLoss)) {
      for (size_t i = 0; i < size * size; ++i) entries[i] = i % (size + 1) == 0;
      return;
    }
    a[k * size + k] = 1;
    for (size_t j = 0; j < size; ++j) a[k * size + j] /= pivot;
    for (size_t i = 0; i < size; ++i) {
      const double factor = a[i * size + k];
      if (i == k || factor == 0) continue;
      a[i * size + k] = 0;
      for (size_t j = 0; j < size; ++j) a[i * size + j] -= factor * a[k * size + j];
    }
  }
  for (size_t i = 0; i < size * size; ++i) entries[i] = static_cast<float>(a[i]);
}

}  // namespace

BlockJacobi make_block_jacobi(const FormFactorMatrix& form_factors, std::span<const float> albedo) {
  std::vector<uint32_t> group(form_factors.rows, kNoGroup);
  BlockJacobi groups;
  {
    DisjointSets sets = join_strong(form_factors, albedo);
    groups = list_groups(sets, group);
  }
  collect_entries(form_factors, albedo, group, groups);
  parallel_for(groups.count(), kGroupsPerTask, [&](size_t begin, size_t end) {
    for (size_t g = begin; g < end; ++g) {
      const size_t size = members_of(groups, g).size();
      invert(std::span(groups.inverse).subspan(groups.first_entry[g], size * size), size);
    }
  });
  return groups;
}

void apply_block_jacobi(const BlockJacobi& groups, std::vector<double>& values) {
  parallel_for(groups.count(), kGroupsPerTask, [&](size_t begin, size_t end) {
    std::array<double, BlockJacobi::kMostMembers> before;
    for (size_t g = begin; g < end; ++g) {
      const std::span<const uint32_t> members = members_of(groups, g);
      const float* entry = groups.inverse.data() + groups.first_entry[g];
      for (size_t i = 0; i < members.size(); ++i) before[i] = values[members[i]];
      for (const uint32_t member : members) {
        double sum = 0;
        for (size_t j = 0; j < members.size(); ++j) sum += static_cast<double>(*entry++) * before[j];
        values[member] = sum;
      }
    }
  });
}

}  // namespace hemibake
