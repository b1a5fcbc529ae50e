#include "io/model_table.h"

#include <fmt/format.h>

namespace hemibake {
namespace {

constexpr int kSteps = 100;
constexpr int kStepsOfPairs = 50;
constexpr int kAlbedoSteps = 10;

double step(int i, int steps) { return static_cast<double>(i) / steps; }

// Adds the names of the columns: inputs, what `bounces` holds, totals.
Table head(std::vector<std::string> inputs, bool bounces) {
  Table table;
  table.columns = std::move(inputs);
  table.columns.emplace_back("direct");
  if (bounces) table.columns.insert(table.columns.end(), {"first_bounce", "bounce_ratio"});
  for (int r = 0; r <= kAlbedoSteps; ++r)
    table.columns.push_back(fmt::format("total_{:.1f}", step(r, kAlbedoSteps)));
  return table;
}

// Adds a row. first: inputs, and the bounces that the model tells apart. total: of an albedo.
template <class Total>
void add_row(Table& table, std::vector<double> first, Total total) {
  auto& row = table.rows.emplace_back(first.begin(), first.end());
  for (int r = 0; r <= kAlbedoSteps; ++r) row.emplace_back(total(step(r, kAlbedoSteps)));
}

// Adds 51 × 51 rows. row(x, y): adds one.
template <class Row>
void add_square(Row row) {
  for (int i = 0; i <= kStepsOfPairs; ++i)
    for (int j = 0; j <= kStepsOfPairs; ++j) row(step(i, kStepsOfPairs), step(j, kStepsOfPairs));
}

template <class Model>
Table table_of(const Model& model) {  // of α
  Table table = head({"ao"}, true);
  for (int i = 0; i <= kSteps; ++i) {
    const double ao = step(i, kSteps);
    add_row(table, {ao, model.direct(ao), model.first_bounce(ao), model.bounce_ratio(ao)},
            [&](double albedo) { return model.total(ao, albedo); });
  }
  return table;
}

Table table_of(const VisibilityModel& model) {
  Table table = head({"visibility"}, true);
  for (int i = 0; i <= kSteps; ++i) {
    const double v = step(i, kSteps), escape = model.escape(v);
    add_row(table, {v, v, (1 - v) * escape, 1 - escape},
            [&](double albedo) { return model.total(v, albedo); });
  }
  return table;
}

// Makes the table of a model of V and a second input, `second`. escape(visibility, second): g.
template <class Model, class Escape>
Table table_of_pairs(const char* second, const Model& model, Escape escape) {
  Table table = head({"visibility", second}, true);
  add_square([&](double v, double x) {
    const double g = escape(v, x);
    add_row(table, {v, x, v, (1 - v) * g, 1 - g}, [&](double albedo) { return model.total(v, x, albedo); });
  });
  return table;
}

Table table_of(const VisibilityAoModel& model) {
  return table_of_pairs("ao", model, [&](double, double ao) { return model.escape(ao); });
}

Table table_of(const MeanEscapeModel& model) {
  return table_of_pairs("ao", model, [&](double, double ao) { return model.escape(ao); });
}

Table table_of(const VisibilityNormalModel& model) {
  return table_of_pairs("normal_z", model, [&](double v, double z) { return model.escape(v, z); });
}

Table table_of(const BounceMapModel& model) {
  Table table = head({"visibility", "bounce"}, false);
  add_square([&](double v, double bounce) {
    add_row(table, {v, bounce, v}, [&](double albedo) { return model.total(v, bounce, albedo); });
  });
  return table;
}

Table table_of(const JimenezModel& model) {
  Table table = head({"visibility"}, false);
  for (int i = 0; i <= kSteps; ++i) {
    const double v = step(i, kSteps);
    add_row(table, {v, model.total(v, 0.0)}, [&](double albedo) { return model.total(v, albedo); });
  }
  return table;
}

}  // namespace

Table table_from_model(const AnyModel& model) {
  return std::visit([](const auto& m) { return table_of(m); }, model);
}

}  // namespace hemibake
