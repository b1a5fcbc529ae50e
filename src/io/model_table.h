// Writes a model as a table, for spreadsheets, look-up textures and plots.
#pragma once

#include "io/table_io.h"
#include "model/model.h"

namespace hemibake {

// Returns the model over its inputs in equal steps and over the albedos 0, 0.1, … 1.
//
// First the inputs: `ao` or `visibility` (101 rows, 0 to 1), or two of them, `visibility,ao`,
// `visibility,normal_z` or `visibility,bounce` (51 × 51 rows, the second one runs faster). Then `direct`
// (albedo 0), `first_bounce` and `bounce_ratio` (at albedo 1; only of models that tell bounces apart: not of
// the bounce map and the cubic of Jimenez), and total_0.0, total_0.1, … total_1.0 for the albedo in the name.
// All values are within 0..1 (model/model.h).
Table table_from_model(const AnyModel& model);

}  // namespace hemibake
