// Tables of a model, for spreadsheets, look-up textures and plots.
#pragma once

#include "io/table_io.h"
#include "model/model.h"

namespace hemibake {

// Samples the model at ao = 0, 0.01, … 1. Columns: ao, direct, first_bounce, bounce_ratio, and total_0.0,
// total_0.1, … total_1.0 for the albedo in the name. All values are within 0..1.
Table table_from_model(const BoundedModel& model);
Table table_from_model(const GuardedModel& model);

}  // namespace hemibake
