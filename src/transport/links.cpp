#include "transport/links.h"

#include "core/error.h"
#include "core/parallel.h"

namespace hemibake {

uint64_t Links::count() const {
  uint64_t links = 0;
  for (const LinkBlock& block : blocks) links += block.patches.size();
  return links;
}

size_t Links::memory_bytes() const {
  size_t bytes = 0;
  for (const LinkBlock& block : blocks)
    bytes += block.row_begin.capacity() * sizeof(uint32_t) + block.patches.capacity() * sizeof(uint32_t) +
             block.weights.capacity() * sizeof(float);
  return bytes;
}

Links make_links(uint32_t rows, uint32_t columns) {
  Links links;
  links.rows = rows;
  links.columns = columns;
  links.blocks.resize((rows + Links::kRowsPerBlock - 1) / Links::kRowsPerBlock);
  for (LinkBlock& block : links.blocks) block.row_begin.push_back(0);
  return links;
}

void append_row(LinkBlock& block, std::span<const Link> row) {
  for (const Link& link : row) {
    block.patches.push_back(link.patch);
    block.weights.push_back(link.weight);
  }
  block.row_begin.push_back(static_cast<uint32_t>(block.patches.size()));
}

void gather(const Links& links, std::span<const double> values, std::span<double> out) {
  expect_equal(values.size(), size_t{links.columns}, "values given to gather");
  expect_equal(out.size(), size_t{links.rows}, "results asked of gather");
  parallel_for(links.blocks.size(), 1, [&](size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      const LinkBlock& block = links.blocks[b];
      for (size_t row = 0; row + 1 < block.row_begin.size(); ++row) {
        double sum = 0;
        for (uint32_t k = block.row_begin[row]; k < block.row_begin[row + 1]; ++k)
          sum += static_cast<double>(block.weights[k]) * values[block.patches[k]];
        out[b * Links::kRowsPerBlock + row] = sum;
      }
    }
  });
}

std::vector<double> row_sums(const Links& links) {
  std::vector<double> sums(links.rows);
  gather(links, std::vector<double>(links.columns, 1.0), sums);
  return sums;
}

}  // namespace hemibake
