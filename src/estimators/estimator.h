// Lists the estimators of AO: one signature, one table. None of them traces a ray.
#pragma once

#include <span>
#include <string_view>

#include "estimators/alchemy.h"
#include "estimators/disk.h"
#include "estimators/disk_robust.h"
#include "estimators/estimate.h"
#include "estimators/horizon.h"

namespace hemibake {

// Options of all estimators; each reads its own.
struct EstimatorOptions {
  DiskOptions disk;
  DiskRobustOptions disk_robust;
  AlchemyOptions alchemy;
  HorizonOptions horizon;
};

struct Estimator {
  const char* name;
  const char* description;  // one line
  // Estimates AO. The same bytes at any thread count. Throws Cancelled.
  Estimate (*estimate)(const Surface& surface, const EstimatorOptions& options);
};

std::span<const Estimator> estimators();

// Returns the estimator of a name, or nullptr.
const Estimator* find_estimator(std::string_view name);

}  // namespace hemibake
