// Plans the memory and the work of a bake before it starts.
#pragma once

#include <cstdint>

#include "core/memory_limit.h"
#include "surface/patches.h"
#include "surface/surface.h"
#include "tracers/tracer.h"

namespace hemibake {

struct BakePlan {
  uint64_t rays = 0;             // of all receivers
  uint64_t links = 0;            // stored, expected
  size_t surface_bytes = 0;      // heights, normals and the tracer's scene
  size_t link_bytes = 0;         // expected and four standard errors more
  size_t plane_bytes = 0;        // results, and light under way
  double trace_cpu_seconds = 0;  // from the pilot
  double bounce_cpu_seconds = 0;

  // The program with its libraries, before it has read anything (measured; most of it OpenImageIO's).
  static constexpr size_t kProgramBytes = size_t{150} << 20;

  bool spills = false;  // links go to a file instead of memory

  size_t memory_bytes() const {
    return kProgramBytes + surface_bytes + (spills ? 0 : link_bytes) + plane_bytes;
  }
};

struct PlanOptions {
  PatchKind patch_kind = PatchKind::kFacets;
  bool with_links = true;
  int bounces = 20;
  bool converges = false;
  size_t scene_bytes = 0;  // of the tracer
  int kept_planes = 0;     // results kept beside what tracing and links take
};

// Plans without tracing: all but links and seconds.
// texels, patches: of the surface.
BakePlan plan_planes(size_t texels, size_t patches, const PlanOptions& options);
BakePlan plan_planes(const Surface& surface, const PlanOptions& options);

// Adds links and seconds from a pilot of a thousand texels and as many patches, in groups spread over the
// map.
BakePlan plan_bake(const Surface& surface, const Tracer& tracer, const PlanOptions& options);

}  // namespace hemibake
