// Traces vertical slices: exact in elevation on the same triangles as Embree, quantised in azimuth only.
//
// On a height field every direction at one azimuth lies in one vertical half-plane, so the crossings of that
// plane with the triangle edges serve all elevations (Max, "Horizon mapping", 1988; the exact integral over a
// slice: Jiménez et al., "Practical real-time strategies for accurate indirect occlusion", 2016). Above the
// steepest crossing is sky: α and E₀ come from closed forms. Each crossing steeper than all before it makes
// an interval of the facet before it visible. Form factors come from a sample of these many intervals: hits
// at equal steps of the cosine weight below the horizon, about eight to a whole slice of a texel and 1.5 to
// one of a node. All weigh alike, so that rows are stored exactly (transport/links/form_factors.h).
//
// Nodes that stand at one place share their walks (surface/node_sites.h): the six facets around a texel, the
// two beside an edge. A walk begins at the lowest of their tangent planes; each sees of its horizon what is
// above its own. Starts are exactly there, so a facet beside the start blocks what is behind it by its slope.
//
// Corners of facets see the sky along twice as many azimuths as hits are sampled along, three of the six
// along each. The blocked fraction is distributed over the sampled hits. A receiver without any is traced
// again with denser sampling.
//
// Sixteen neighbours along x (aligned to multiples of sixteen) share their azimuths, rotated by a hash of
// their place: the same crossings serve all of them, and their heights are neighbours in memory.
// Starts are not lifted: a row is the limit of Embree's for a lift of zero.
//
// A wrapping map is followed until no horizon can rise by more than 10⁻⁴ (as a slope), and the rest counts as
// sky: α and E₀/π are off by at most 10⁻⁴. Azimuths followed for 10⁴ times the map's longer side end there,
// and count in TracerCounts::truncated. Below a slope of zero a wrapping map blocks everything; hits end at a
// slope of −10⁻³, and the largest form factor gets the rest. Open edges: beyond the map's rectangle is
// nothing. Ground edges: below a slope of zero everything is blocked, by facets or by the ground beyond the
// map, whose share is spread over the hits; a receiver without hits links to itself.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "surface/surface.h"
#include "tracers/ray_options.h"
#include "tracers/tracer.h"

namespace hemibake {

struct SliceOptions {
  int azimuths = 64;                                                // per receiver, 1..65536
  double max_distance_m = std::numeric_limits<double>::infinity();  // hits beyond, along the ray, are sky, >
                                                                    // 0; none with ground edges
  PatchKind patch_kind = PatchKind::kFacets;
  TexelLinks texel_links = TexelLinks::kBilinear;
  double lift_texels = 0;  // of starts above the surface: 0 is the truth, > 0 compares with ray tracers
  uint64_t seed = 0;
};

// Makes a slice tracer. `surface` must outlive it.
std::unique_ptr<Tracer> make_slice_tracer(const Surface& surface, const SliceOptions& options);

// Estimates the bytes of a slice tracer: its heights, its paths, and the views of its threads.
size_t slice_tracer_bytes(uint32_t texels, const SliceOptions& options, bool with_links);

}  // namespace hemibake
