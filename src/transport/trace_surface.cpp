#include "transport/trace_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/parallel.h"
#include "core/progress.h"

namespace hemibake {
namespace {

// Without form factors texels are traced in tiles: the surface around a tile stays in the cache. Tiles are as
// high as leaves every thread enough to do.
constexpr uint32_t kTileWidth = 128, kHighestTile = 128, kLowestTile = 16, kTilesPerThread = 4;

// Blocks of patches traced together: the same node of many facets sees along the same paths.
constexpr uint32_t kMostBlocksTogether = 32, kFewestPieces = 32;

void check_row(uint32_t index, const Row& row) {
  // Up to 2: the march with published weights in a narrow cone.
  if (!(row.direct_over_pi >= 0 && row.direct_over_pi <= 2))
    throw std::logic_error(fmt::format("row {}: E0/pi is {}, expected 0..2", index, row.direct_over_pi));
}

TracerCounts sum(const std::vector<TracerCounts>& counts) {
  TracerCounts total;
  for (const TracerCounts& c : counts) {
    total.rays += c.rays;
    total.truncated += c.truncated;
  }
  return total;
}

// Traces the rows of all texels or patches, and packs them into a matrix where there is one.
// together: blocks traced at once, whose rows the tracer may share work among. trace_rows(first, rows,
// counts): traces rows from `first` on. store(index, row): keeps the other results of a row.
template <class TraceRows, class Store>
TracerCounts trace_blocks(uint32_t row_count, uint32_t together, FormFactorMatrix* form_factors,
                          Progress& progress, const TraceRows& trace_rows, const Store& store) {
  const uint32_t rows_together = together * FormFactorMatrix::kRowsPerBlock;
  const size_t pieces = (size_t{row_count} + rows_together - 1) / rows_together;
  std::vector<TracerCounts> counts(pieces);
  parallel_for(pieces, 1, [&](size_t first_piece, size_t last_piece) {
    std::vector<Row> rows(std::min(rows_together, row_count));
    for (size_t piece = first_piece; piece < last_piece; ++piece) {
      const uint32_t begin = static_cast<uint32_t>(piece) * rows_together;
      const std::span<Row> piece_rows(rows.data(), std::min(rows_together, row_count - begin));
      trace_rows(begin, piece_rows, counts[piece]);
      for (uint32_t i = 0; i < piece_rows.size(); ++i) {
        check_row(begin + i, piece_rows[i]);
        store(begin + i, piece_rows[i]);
        if (!form_factors) continue;
        const size_t block = (begin + i) / FormFactorMatrix::kRowsPerBlock;
        append_row(form_factors->blocks[block], piece_rows[i].links);
        if ((begin + i + 1) % FormFactorMatrix::kRowsPerBlock == 0 || begin + i + 1 == row_count)
          finish_block(*form_factors, block);
      }
      progress.advance(piece_rows.size());
    }
  });
  return sum(counts);
}

// Returns the blocks of patches to trace at once: as many as leave every thread enough to do.
uint32_t blocks_together(uint32_t patch_count) {
  return std::clamp(patch_count / FormFactorMatrix::kRowsPerBlock / kFewestPieces, 1u, kMostBlocksTogether);
}

uint32_t height_of_tiles(uint32_t columns, uint32_t height) {
  const uint32_t wanted = kTilesPerThread * static_cast<uint32_t>(thread_count());
  uint32_t tile_height = kHighestTile;
  while (tile_height > kLowestTile && columns * ((height + tile_height - 1) / tile_height) < wanted)
    tile_height /= 2;
  return tile_height;
}

// Traces every texel tile by tile. store(texel, row): keeps the results of a row.
template <class Store>
TracerCounts trace_tiles(const Tracer& tracer, Progress& progress, const Store& store) {
  const uint32_t width = static_cast<uint32_t>(tracer.surface().width());
  const uint32_t height = static_cast<uint32_t>(tracer.surface().height());
  const uint32_t columns = (width + kTileWidth - 1) / kTileWidth;
  const uint32_t tile_height = height_of_tiles(columns, height);
  const uint32_t rows_of_tiles = (height + tile_height - 1) / tile_height;
  std::vector<TracerCounts> counts(size_t{columns} * rows_of_tiles);
  parallel_for(counts.size(), 1, [&](size_t first, size_t last) {
    std::vector<Row> rows(kTileWidth * tile_height);
    for (size_t t = first; t < last; ++t) {
      TexelTile tile{static_cast<uint32_t>(t % columns) * kTileWidth,
                     static_cast<uint32_t>(t / columns) * tile_height, kTileWidth, tile_height};
      tile.width = std::min(tile.width, width - tile.x);
      tile.height = std::min(tile.height, height - tile.y);
      tracer.trace_tile(tile, {rows.data(), size_t{tile.width} * tile.height}, counts[t]);
      for (uint32_t j = 0; j < tile.height; ++j)
        for (uint32_t i = 0; i < tile.width; ++i) {
          const uint32_t texel = (tile.y + j) * width + tile.x + i;
          const Row& row = rows[size_t{j} * tile.width + i];
          check_row(texel, row);
          store(texel, row);
        }
      progress.advance(size_t{tile.width} * tile.height);
    }
  });
  return sum(counts);
}

}  // namespace

LightTransport trace_surface(const Tracer& tracer, KeptLinks kept, const std::shared_ptr<SpillFile>& spill) {
  const int width = tracer.surface().width(), height = tracer.surface().height();
  LightTransport transport;
  transport.visible_fraction = Grid<float>(width, height);
  transport.direct_over_pi = Grid<float>(width, height);
  transport.bent_normals = Grid<glm::vec3>(width, height);
  const uint32_t texels = static_cast<uint32_t>(transport.visible_fraction.size());
  const bool trace_patches = kept != KeptLinks::kNone && tracer.patch_set().kind == PatchKind::kFacets;

  const uint32_t patch_count = tracer.patch_set().count;
  Progress progress("tracing", uint64_t{texels} + (trace_patches ? patch_count : 0), "receiver");

  const auto store_texel = [&](uint32_t texel, const Row& row) {
    transport.visible_fraction[texel] = static_cast<float>(row.visible_fraction);
    transport.direct_over_pi[texel] = static_cast<float>(row.direct_over_pi);
    transport.bent_normals[texel] = glm::vec3(row.bent_normal);
  };
  if (kept == KeptLinks::kNone) {
    transport.counts = trace_tiles(tracer, progress, store_texel);
    return transport;
  }
  transport.final_gather = make_form_factors(texels, patch_count, spill);
  transport.counts = trace_blocks(
      texels, 1, &transport.final_gather, progress,
      [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
        tracer.trace_texels(first, true, rows, counts);
      },
      store_texel);
  if (!trace_patches) return transport;

  transport.patch_direct_over_pi.resize(patch_count);
  const auto store_patch = [&](uint32_t patch, const Row& row) {
    transport.patch_direct_over_pi[patch] = static_cast<float>(row.direct_over_pi);
  };
  const bool links_patches = kept == KeptLinks::kAll;
  if (links_patches) transport.patch_form_factors = make_form_factors(patch_count, patch_count, spill);
  const TracerCounts of_patches = trace_blocks(
      patch_count, blocks_together(patch_count), links_patches ? &transport.patch_form_factors : nullptr,
      progress,
      [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
        tracer.trace_patches(first, links_patches, rows, counts);
      },
      store_patch);
  transport.counts.rays += of_patches.rays;
  transport.counts.truncated += of_patches.truncated;
  return transport;
}

}  // namespace hemibake
