// What packing does to the links: bytes of each, both matrices together, and what it changes in the light of
// all bounces, against the same rows unpacked (weights as floats, products in double).
//
//   hemibake_bench_coding [MAP…]     bricks, shapes: both by default; noise; wall, the published height map
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bench/named_maps.h"
#include "core/parallel.h"
#include "transport/links/form_factors.h"

namespace hemibake {
namespace {

constexpr int kBounces = 20;

struct Rows {
  std::vector<size_t> begin{0};
  std::vector<FormFactor> links;
};

void multiply(const Rows& rows, const std::vector<double>& values, std::vector<double>& out) {
  out.resize(rows.begin.size() - 1);
  parallel_for(out.size(), 4096, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      double sum = 0;
      for (size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k)
        sum += static_cast<double>(rows.links[k].weight) * values[rows.links[k].patch];
      out[i] = sum;
    }
  });
}

FormFactorMatrix pack(const Rows& rows, uint32_t columns) {
  FormFactorMatrix links = make_form_factors(static_cast<uint32_t>(rows.begin.size() - 1), columns);
  parallel_for(links.blocks.size(), 1, [&](size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      const size_t end = std::min<size_t>(links.rows, (b + 1) * FormFactorMatrix::kRowsPerBlock);
      for (size_t i = b * FormFactorMatrix::kRowsPerBlock; i < end; ++i)
        append_row(links.blocks[b],
                   std::span(rows.links).subspan(rows.begin[i], rows.begin[i + 1] - rows.begin[i]));
      finish_block(links, b);
    }
  });
  return links;
}

// Largest |packed / given − 1| of the sums of rows.
double row_sum_error(const Rows& rows, const FormFactorMatrix& links) {
  const std::vector<double> sums = row_sums(links);
  double worst = 0;
  for (size_t i = 0; i < sums.size(); ++i) {
    double sum = 0;
    for (size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k)
      sum += static_cast<double>(rows.links[k].weight);
    if (sum > 0) worst = std::max(worst, std::abs(sums[i] / sum - 1));
  }
  return worst;
}

// All that the tracer sees.
struct Scene {
  Rows final_gather, patch_form_factors;
  std::vector<double> direct;  // of the patches
};

template <class Trace>
void trace_rows(uint32_t count, const Trace& trace, Rows& rows, std::vector<double>* direct) {
  constexpr uint32_t kBatch = 1024;
  std::vector<std::vector<Row> > batches((count + kBatch - 1) / kBatch);
  parallel_for(batches.size(), 1, [&](size_t first, size_t last) {
    TracerCounts counts;
    for (size_t b = first; b < last; ++b) {
      const auto begin = static_cast<uint32_t>(b) * kBatch;
      batches[b].resize(std::min(kBatch, count - begin));
      trace(begin, batches[b], counts);
      for (Row& row : batches[b]) row.links.shrink_to_fit();
    }
  });
  for (std::vector<Row>& batch : batches) {
    for (const Row& row : batch) {
      rows.links.insert(rows.links.end(), row.links.begin(), row.links.end());
      rows.begin.push_back(rows.links.size());
      if (direct) direct->push_back(static_cast<double>(static_cast<float>(row.direct_over_pi)));
    }
    batch = std::vector<Row>();
  }
}

Scene trace_scene(const Tracer& tracer, uint32_t texels) {
  Scene scene;
  trace_rows(
      texels,
      [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
        tracer.trace_texels(first, true, rows, counts);
      },
      scene.final_gather, nullptr);
  trace_rows(
      tracer.patch_set().count,
      [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
        tracer.trace_patches(first, true, rows, counts);
      },
      scene.patch_form_factors, &scene.direct);
  return scene;
}

// All bounced light of the texels at an albedo, over π, of either kind of rows.
template <class Patches, class Gather>
std::vector<double> bounced(const Scene& scene, double albedo, const Patches& patches,
                            const Gather& gather_in) {
  std::vector<double> light = scene.direct, sum = light, next, texels;
  for (int b = 1; b < kBounces; ++b) {
    patches(light, next);
    for (size_t i = 0; i < light.size(); ++i) sum[i] += light[i] = albedo * next[i];
  }
  gather_in(sum, texels);
  for (double& value : texels) value *= albedo;
  return texels;
}

double rms_of_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

void run(const std::string& map, const std::string& tracer_name) {
  const Surface surface = bench_map(map);
  const auto tracer = bench_tracer(surface, tracer_name);
  const Scene scene = trace_scene(*tracer, surface.texel_count());
  const FormFactorMatrix gather_links = pack(scene.final_gather, tracer->patch_set().count),
                         patch_links = pack(scene.patch_form_factors, tracer->patch_set().count);
  const auto bytes = static_cast<double>(gather_links.stored_bytes() + patch_links.stored_bytes());
  const auto links = static_cast<double>(gather_links.count() + patch_links.count());
  const auto given =
      static_cast<double>(scene.final_gather.links.size() + scene.patch_form_factors.links.size());
  const auto each = [](const FormFactorMatrix& matrix) {
    return static_cast<double>(matrix.stored_bytes()) / static_cast<double>(matrix.count());
  };
  fmt::print("{:8} {:8} {:8.1f} {:8.2f} % {:8.3f} {:8.3f} {:8.3f} {:10.1e}", map, tracer_name, 1e-6 * links,
             100 * (1 - links / given), bytes / links, each(gather_links), each(patch_links),
             std::max(row_sum_error(scene.final_gather, gather_links),
                      row_sum_error(scene.patch_form_factors, patch_links)));
  const auto through_rows = [](const Rows& rows) {
    return [&](const std::vector<double>& values, std::vector<double>& out) { multiply(rows, values, out); };
  };
  const auto through_links = [](const FormFactorMatrix& matrix) {
    return [&](const std::vector<double>& values, std::vector<double>& out) {
      out.resize(matrix.rows);
      multiply(matrix, values, out);
    };
  };
  for (const double albedo : {0.5, 0.9, 1.0})
    fmt::print(
        " {:9.1e}",
        rms_of_difference(
            bounced(scene, albedo, through_rows(scene.patch_form_factors), through_rows(scene.final_gather)),
            bounced(scene, albedo, through_links(patch_links), through_links(gather_links))));
  fmt::print("\n");
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  std::vector<std::string> maps(argv + 1, argv + argc);
  if (maps.empty()) maps = {"bricks", "shapes"};
  fmt::print("{:8} {:8} {:>8} {:>10} {:>8} {:>8} {:>8} {:>10} {:>9} {:>9} {:>9}\n", "map", "tracer",
             "M links", "lost", "B/link", "gather", "patches", "row sums", "rho 0.5", "rho 0.9", "rho 1");
  for (const std::string& map : maps)
    for (const std::string tracer : {"embree", "slice"}) hemibake::run(map, tracer);
}
