#include "cli/print/study.h"

#include <fmt/format.h>

#include "trade/analysis.h"

namespace hemibake {
namespace {

constexpr size_t kMiddleAlbedo = 1;  // 0.5

std::string cell(const ErrorStatistics& error) {
  return fmt::format("{:.4f} ({:+.4f})", error.rmse, error.bias);
}

std::string cell(const std::optional<ErrorStatistics>& error) { return error ? cell(*error) : ""; }

std::string model_lines(const char* method, const std::vector<LightModelErrors>& models) {
  std::string text;
  for (const LightModelErrors& model : models)
    text += fmt::format("{:17} {:32} {:8} {:8} {:16} {:16} {:>16}\n", method, "  with " + model.model, "", "",
                        "", "", cell(model.error[kMiddleAlbedo]));
  return text;
}

}  // namespace

std::string text_of_study(const Study& study) {
  std::string text = fmt::format("{:17} {:32} {:>8} {:>8} {:>16} {:>16} {:>16}\n", "method", "settings",
                                 "cpu-s", "MiB", "ao rmse (bias)", "E0/pi", "E/pi, albedo 0.5");
  for (const ScoredRun& run : study.runs) {
    if (!run.representative) continue;
    text += fmt::format("{:17} {:32} {:8.3f} {:8.1f} {:>16} {:>16} {:>16}\n", run.method, run.settings_text(),
                        run.cost.cpu_seconds, static_cast<double>(run.cost.memory_bytes) / (1 << 20),
                        cell(run.error[kAoPlane]), cell(run.error[kDirectPlane]),
                        cell(run.error[kLightPlanes + kMiddleAlbedo]));
    text += model_lines("", run.models);
  }
  text += model_lines("true ao", study.reference.models_on_true_ao);
  const auto precision = precision_of(study.reference.error, study.runs);
  for (size_t p = 0; p < kPlaneCount; ++p)
    text += fmt::format("reference {:8} off by {:.2g} rms, best run by {:.2g}{}\n", named_planes()[p].name,
                        precision[p].error, precision[p].best_run ? precision[p].best_error : 0.0,
                        precision[p].reached ? "" : ": more than a fifth of it");
  return text;
}

}  // namespace hemibake
