#include "io/model_table.h"

#include <fmt/format.h>

namespace hemibake {
namespace {

constexpr int kAoSteps = 100;
constexpr int kAlbedoSteps = 10;

template <class Model>
Table sample(const Model& model) {
  Table table;
  table.columns = {"ao", "direct", "first_bounce", "bounce_ratio"};
  for (int r = 0; r <= kAlbedoSteps; ++r) {
    table.columns.push_back(fmt::format("total_{:.1f}", static_cast<double>(r) / kAlbedoSteps));
  }
  for (int i = 0; i <= kAoSteps; ++i) {
    const double ao = static_cast<double>(i) / kAoSteps;
    auto& row = table.rows.emplace_back();
    row = {ao, model.direct(ao), model.first_bounce(ao), model.bounce_ratio(ao)};
    for (int r = 0; r <= kAlbedoSteps; ++r)
      row.emplace_back(model.total(ao, static_cast<double>(r) / kAlbedoSteps));
  }
  return table;
}

}  // namespace

Table table_from_model(const ShaderModel& model) {
  return std::visit([](const auto& m) { return sample(m); }, model);
}

}  // namespace hemibake
