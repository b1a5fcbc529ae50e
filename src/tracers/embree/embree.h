// Traces rays against the triangles of the surface with Embree: the reference tracer.
//
// A wrapping map is followed tile by tile for any distance: the scene holds one tile (small maps repeated up
// to 64 texels) and a margin, and a ray that leaves it goes on in the next copy. A ray below the highest
// texel is followed for a horizontal distance of 10⁵ height ranges (at most 10⁶ tiles), then it counts as sky
// and in TracerCounts::truncated. Only rays within 10⁻⁵ rad of the horizon can get that far below the top, so
// α and E₀/π are off by at most 10⁻⁵; with more than 10 tile lengths of height range the bound is range /
// (10⁶ tiles). Open edges: rays that leave the map's rectangle meet nothing.
// Ground edges: those that leave it downwards meet ground, whose share is spread over the hits; a receiver
// without hits links to itself.
//
// Holes of the surface: no ray meets a facet at one, and rays below the surface see sky. Texels in holes and
// nodes of such facets are not traced; their rows are those of open ground, and no row links to them.
//
// Starts are lifted vertically: along the normal they may end inside the solid.
// Nodes start each ray at another point of a small copy of their facet.
#pragma once

#include <memory>

#include "surface/surface.h"
#include "tracers/ray_options.h"
#include "tracers/tracer.h"

namespace hemibake {

// Builds the scene. `surface` must outlive the tracer. Throws std::runtime_error where Embree fails (out of
// memory).
std::unique_ptr<Tracer> make_embree_tracer(const Surface& surface, const RayOptions& options);

// Estimates the bytes that the scene of this surface takes.
size_t embree_scene_bytes(uint32_t facets);

}  // namespace hemibake
