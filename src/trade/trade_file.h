// The results of a study as files.
//
// trade.json:
//   provenance      how it was made (io/provenance.h): version, command, input, input_sha256, map options
//   effort          "quick", "normal", "full"
//   albedos         [0.2, 0.5, 0.8, 0.95]
//   planes          {name: description}: "ao" α, "direct" E₀/π, "first" E₁/π at albedo 1, "light.20" …
//                   "light.95" E/π over all bounces at that albedo. Every error is of one of them, 0..1
//   reference       trade/reference.h, ReferenceFacts: "mean", "error", "best_run_error" {plane: number},
//                   "referee" [{quantity, reference, referee, bias, half_width, texels}], "models"
//                   (constants fitted to this map), "models_on_true_ao" {model: {plane: ERROR}}; and
//                   "precision": {plane: {"error", "best_error", "best_run", "share", "reached"}}, the best
//                   of all runs; "share" = error / best_error is to be at most 0.2
//   models          {name: description} of the irradiance models
//   runs            [RUN], in the order of the sweep
//   fronts          {plane: [{"id", "model", "cpu_seconds", "rmse"}]}: the Pareto fronts of "ao", "direct",
//                   "light.50", cheapest first; model is "" where the run has bounces of its own
//   series          [{"name", "abscissa", "plane", "slope", "slope_error", "points": [[x, rmse], …]}]
//   files           {"trade.csv": SHA-256}
//   pictures        [{"file", "title"}], PNG error maps in the folder of trade.json
// RUN:
//   id, method, settings {name: number or string}, series, abscissa, abscissa_value, representative (bool)
//   cpu_seconds, wall_seconds, repeats, memory_bytes (trade/scored_run.h, RunCost), work
//   known           share of the texels the method has an answer for; errors are over them
//   error           {plane: ERROR}, the planes the run has
//   curve           {"E0": {"bias", "rms", "max", "bins"}, "E1": …}, over π (trade/scored_run.h)
//   models          {model: {plane: ERROR}} of the "light.NN" planes: that model on the run's AO
// ERROR: {"rmse", "bias", "max", "p99"} of run − reference over the texels; max and p99 of its size.
//
// trade.csv: a line per run, and one per run and model: method, settings ("rays=64 directions=uniform"),
// model (empty: the run itself), representative, cpu_seconds, wall_seconds, memory_bytes, known, then
// PLANE_rmse, PLANE_bias, PLANE_max, PLANE_p99 for every plane, then curve_E0_bias … curve_E1_max. Method
// "truth": models on the reference's own AO. Cells that do not apply are empty.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "io/output_file.h"
#include "io/provenance.h"
#include "trade/study.h"
#include "trade/sweep.h"

namespace hemibake {

const char* effort_name(Effort effort);

// folder: of the study, for the list of its pictures.
nlohmann::ordered_json json_from_study(const Study& study, Effort effort, const Provenance& provenance,
                                       const std::filesystem::path& folder);

void write_trade_csv(OutputFile& file, const Study& study);

}  // namespace hemibake
