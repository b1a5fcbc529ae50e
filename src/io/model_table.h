// Writes a model as a table, for spreadsheets, look-up textures and plots.
#pragma once

#include "io/table_io.h"
#include "model/model.h"

namespace hemibake {

// Returns 101 rows, ao = 0, 0.01, … 1; columns ao, direct, first_bounce, bounce_ratio, and total_0.0,
// total_0.1, … total_1.0 for the albedo in the name. All values are within 0..1 (model/model.h).
Table table_from_model(const ShaderModel& model);

}  // namespace hemibake
