#include "transport/solver/block_jacobi.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/parallel.h"

namespace hemibake {
namespace {

// Measured on WallHeight at 0.1 m: links from a fifth on need a tenth fewer products, of which each is a
// tenth more work.
constexpr float kStrong = 0.25f;
constexpr size_t kEntriesPerRow = 2;
constexpr size_t kGroupsPerTask = 1024;
// What a group loses of its light, at least; the inverse says nothing below.
constexpr double kLeastLoss = 1e-6;
constexpr uint32_t kNoGroup = 0xffffffff;

struct StrongLink {
  float weight;
  uint32_t row, column;
};

bool is_stronger(const StrongLink& a, const StrongLink& b) {
  return std::tuple(-a.weight, a.row, a.column) < std::tuple(-b.weight, b.row, b.column);
}

float passed_on(float weight, uint32_t patch, std::span<const float> albedo) {
  return weight * (albedo.empty() ? 1.0f : albedo[patch]);
}

// The strongest first.
std::vector<StrongLink> strong_connections(const FormFactorMatrix& links, std::span<const float> albedo) {
  std::vector<std::vector<StrongLink>> of_blocks(links.blocks.size());
  parallel_for(links.blocks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b) {
      std::vector<StrongLink>& strong = of_blocks[b];
      visit_rows(links, b,
                 [&](uint32_t row, std::span<const uint32_t> patches, std::span<const float> weights) {
                   for (size_t i = 0; i < patches.size(); ++i) {
                     const float weight = passed_on(weights[i], patches[i], albedo);
                     if (weight > kStrong && patches[i] != row) strong.push_back({weight, row, patches[i]});
                   }
                 });
      std::ranges::sort(strong, is_stronger);
      strong.resize(std::min<size_t>(strong.size(), links.blocks[b].rows));
      strong.shrink_to_fit();
    }
  });
  size_t count = 0;
  for (const std::vector<StrongLink>& strong : of_blocks) count += strong.size();
  std::vector<StrongLink> all;
  all.reserve(count);
  for (std::vector<StrongLink>& strong : of_blocks) {
    all.insert(all.end(), strong.begin(), strong.end());
    strong = std::vector<StrongLink>();
  }
  std::ranges::sort(all, is_stronger);
  return all;
}

// Patches that belong together have one root, the lowest of them.
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

DisjointSets join_strong(const FormFactorMatrix& links, std::span<const float> albedo) {
  DisjointSets unions(links.rows);
  size_t entries = 0;
  for (const StrongLink& link : strong_connections(links, albedo)) {
    const uint32_t a = unions.root(link.row), b = unions.root(link.column);
    if (a == b || unions.size(a) + unions.size(b) > BlockJacobi::kMostMembers) continue;
    const size_t joined = unions.size(a) + unions.size(b);
    const auto entries_of = [](size_t size) { return size > 1 ? size * size : 0; };
    const size_t more = entries_of(joined) - entries_of(unions.size(a)) - entries_of(unions.size(b));
    if (entries + more > kEntriesPerRow * links.rows) continue;
    entries += more;
    unions.join(a, b);
  }
  return unions;
}

// Members and places for the inverses. group: of every patch.
BlockJacobi list_groups(DisjointSets& unions, std::vector<uint32_t>& group) {
  BlockJacobi groups;
  size_t entries = 0;
  uint32_t members = 0;
  for (uint32_t patch = 0; patch < group.size(); ++patch) {
    const uint32_t root = unions.root(patch);
    if (unions.size(root) == 1) continue;
    if (root == patch) {
      group[patch] = static_cast<uint32_t>(groups.count());
      groups.first_member.push_back(members);
      groups.first_entry.push_back(entries);
      members += static_cast<uint32_t>(unions.size(root));
      entries += unions.size(root) * unions.size(root);
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

// W diag(albedo) among the members of each group, where the inverse will be.
void collect_entries(const FormFactorMatrix& links, std::span<const float> albedo,
                     std::span<const uint32_t> group, BlockJacobi& groups) {
  parallel_for(links.blocks.size(), 1, [&](size_t begin, size_t end) {
    for (size_t b = begin; b < end; ++b)
      visit_rows(links, b,
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

// `entries` become (1 − entries)⁻¹, or 1 where that does not exist. Gauss and Jordan, in place; rows that
// pass on at most all light need no pivots.
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

BlockJacobi make_block_jacobi(const FormFactorMatrix& links, std::span<const float> albedo) {
  std::vector<uint32_t> group(links.rows, kNoGroup);
  BlockJacobi groups;
  {
    DisjointSets unions = join_strong(links, albedo);
    groups = list_groups(unions, group);
  }
  collect_entries(links, albedo, group, groups);
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
