// Vertical slices: exact in elevation on the same triangles as Embree, quantised in azimuth only.
//
// On a height field every direction at one azimuth lies in one vertical half-plane, so one walk over the
// crossings of that plane with the triangle edges serves all elevations (FACTS.md §5; the horizon idea is
// Max, "Horizon mapping", 1988, the exact integral over a slice Jiménez et al., "Practical real-time
// strategies for accurate indirect occlusion", 2016). What stays above the steepest crossing is sky: α and E₀
// come from closed forms. Each crossing steeper than all before it makes the stretch of facet before it
// visible between two elevations. Those stretches are many and most of them tiny, so links come from a sample
// of them: rays as it were, at equal steps of the cosine weight below the horizon, which the closed form
// gives, about eight to a whole slice of a texel and 1.5 to one of a node, well spread over the azimuths.
// All weigh alike, so that rows are stored exactly (transport/links/form_factors.h). Measured with 64
// azimuths, E₁ is off by a sixth more with six hits a slice than with eight on rough noise, by a tenth more
// on shapes at 0.45 m.
//
// A corner of a facet sees the sky along twice as many azimuths as it looks for links along: the few nodes
// next to a texel make most of its first bounce, and their light is what they see of the sky.
// FormFactorMatrix share what is not sky. Where none of them was met, but not all is sky, all azimuths are
// looked along more closely.
//
// Sixteen neighbours along x (aligned to multiples of sixteen) share their azimuths, turned by a hash of
// their place: the same crossings then serve sixteen receivers, and their heights lie side by side in memory.
// Nodes take each azimuth from another low-discrepancy point of the small copy of the facet they look from.
// Starts are not lifted: a row is the limit of Embree's for a lift of zero.
//
// A wrapping map is followed until nothing can rise more than 10⁻⁴ (as a slope) above the horizon found, and
// what is left above it counts as sky. So α and E₀/π are off by at most 10⁻⁴; measured on WallHeight, where a
// sixtieth of the azimuths end so: 1.6·10⁻⁵ in the worst texel, rms 2·10⁻⁷. Azimuths followed for 10⁴ times
// the map's longer side end there, and count in TracerCounts::truncated.
// Below a slope of zero a wrapping map blocks everything; its links stop at a slope of −10⁻³, and the largest
// one gets the rest. Open edges: what leaves the map's rectangle meets nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "surface/surface.h"
#include "tracers/ray_options.h"
#include "tracers/tracer.h"

namespace hemibake {

struct SliceOptions {
  int azimuths = 64;  // per receiver, 1..65536
  double max_distance_m =
      std::numeric_limits<double>::infinity();  // hits beyond, along the ray, are sky, > 0
  PatchKind patch_kind = PatchKind::kFacets;
  TexelLinks texel_links = TexelLinks::kBilinear;
  double lift_texels =
      0;  // starts above the surface, as ray tracers do it: to compare with them; 0 is the truth
  uint64_t seed = 0;
};

// `surface` must outlive the tracer.
std::unique_ptr<Tracer> make_slice_tracer(const Surface& surface, const SliceOptions& options);

// Bytes that tracer will take, about: its heights, its paths, and what its threads collect.
size_t slice_tracer_bytes(const Surface& surface, const SliceOptions& options, bool with_links);

}  // namespace hemibake
