// Forms of g, the chance that light which leaves a texel leaves for the sky, and their fits.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/escape_truth.h"

namespace hemibake {

// What a form may use of a texel: V, α, n.z and its map's m = (⟨V⟩ − ⟨V²⟩)/(1 − ⟨V⟩).
struct TexelInput {
  double visibility, escape, normal_z, map_escape;
};

// A form of E/π of all bounces.
struct Form {
  std::string inputs, formula;
  std::vector<double> constants;  // start of the fit; empty: none
  std::function<double(const TexelInput&, double albedo, const double* constants)> total;
};

// Returns the forms of the table, those without constants too.
std::vector<Form> forms();

// Returns m of a map.
double map_escape(const MapTruth& map);

// Root mean square errors of a form on one map, one for each model albedo.
using AlbedoErrors = std::array<double, kModelAlbedos>;
AlbedoErrors errors_of(const Form& form, std::span<const double> constants, const MapTruth& map);
double mean_of(const AlbedoErrors& errors);

// Returns the constants with the least mean rms error over maps and albedos (Gauss-Newton with damping, every
// map and albedo weighted by the reciprocal of its error), from about a thousand texels a map.
std::vector<double> fit(const Form& form, std::span<const MapTruth* const> maps);

}  // namespace hemibake
