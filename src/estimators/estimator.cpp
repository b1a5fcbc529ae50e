#include "estimators/estimator.h"

#include <array>

namespace hemibake {
namespace {

constexpr std::array<Estimator, 4> kEstimators{{
    {"disk", "shadows between disks at the vertices, over a tree (Bunnell 2005)",
     [](const Surface& surface, const EstimatorOptions& options) {
       return estimate_disk(surface, options.disk);
     }},
    {"disk-robust", "disks on the facets, exact polygons in the last pass (Hoberock & Jia 2007)",
     [](const Surface& surface, const EstimatorOptions& options) {
       return estimate_disk_robust(surface, options.disk_robust);
     }},
    {"alchemy", "screen-space obscurance from a spiral of taps, blurred (McGuire et al. 2011)",
     [](const Surface& surface, const EstimatorOptions& options) {
       return estimate_alchemy(surface, options.alchemy);
     }},
    {"horizon", "highest of a few height samples in a few azimuths (Bavoil 2008, GTAO 2016)",
     [](const Surface& surface, const EstimatorOptions& options) {
       return estimate_horizon(surface, options.horizon);
     }},
}};

}  // namespace

std::span<const Estimator> estimators() { return kEstimators; }

const Estimator* find_estimator(std::string_view name) {
  for (const Estimator& estimator : kEstimators)
    if (name == estimator.name) return &estimator;
  return nullptr;
}

}  // namespace hemibake
