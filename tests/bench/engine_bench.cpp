// What an engine gains by the formulas it can be given: rms error over the texels of E/π at five albedos,
// mean over four maps, of what it multiplies the ambient light by. AO of a bake, and of a horizon shader (8
// and 1 slices of 8 samples a side).
//
//   hemibake_bench_engine [SIDE]     (96)
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "estimators/horizon.h"
#include "model/model.h"
#include "support/maps.h"
#include "textures/bounce_map.h"
#include "tracers/slice/slice.h"
#include "transport/albedo_light.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

constexpr std::array kAlbedos = kBounceMapAlbedos;
constexpr size_t kBounceAlbedoIndex = 3;
constexpr double kBounceAlbedo = kAlbedos[kBounceAlbedoIndex];

// Holds V, α and the bounce map of a texel, as a shader has them.
struct Texel {
  double visibility, ao, mapped_visibility, bounce;
};

struct Formula {
  std::string name;
  std::function<double(const Texel&, double albedo)> total;
};

std::vector<Formula> formulas() {
  return {
      {"AO alone (E = V)", [](const Texel& t, double) { return t.visibility; }},
      {"the cubic", [](const Texel& t, double rho) { return JimenezModel{}.total(t.visibility, rho); }},
      {"visibility, g = V",
       [](const Texel& t, double rho) { return VisibilityModel{}.total(t.visibility, rho); }},
      {"visibility-ao, g = ao",
       [](const Texel& t, double rho) { return VisibilityAoModel{}.total(t.visibility, t.ao, rho); }},
      {"bounce-map, 8 bits",
       [](const Texel& t, double rho) {
         return BounceMapModel{kBounceAlbedo}.total(t.mapped_visibility, t.bounce, rho);
       }},
  };
}

struct Truth {
  LightTransport transport;
  std::array<std::vector<double>, kAlbedos.size()> light;  // E/π
  BounceMap bounce_map;                                    // in 8 bits, as `textures` writes it
};

// Returns the bounce map of the light, which the truth has already.
BounceMap bounce_map_of(const Truth& truth) {
  const Grid<float>& direct = truth.transport.direct_over_pi;
  return choose_bounce_map(direct.width, direct.height, 255, kBounceAlbedo, [&](size_t texel) {
    MappedLight mapped{static_cast<double>(direct[texel]), truth.light[kBounceAlbedoIndex][texel], {}};
    for (size_t a = 0; a < kAlbedos.size(); ++a) mapped.irradiance[a] = truth.light[a][texel];
    return mapped;
  });
}

Truth trace(const Surface& surface) {
  SliceOptions slices;
  slices.azimuths = 64;
  Truth truth{trace_surface(*make_slice_tracer(surface, slices), KeptLinks::kAll), {}, {}};
  for (size_t a = 0; a < kAlbedos.size(); ++a) {
    const std::vector<float> albedo(truth.transport.patch_direct_over_pi.size(),
                                    static_cast<float>(kAlbedos[a]));
    truth.light[a] = bounce_with_albedo(truth.transport, albedo, {}).texel_light;
  }
  truth.bounce_map = bounce_map_of(truth);
  return truth;
}

using Errors = std::array<double, kAlbedos.size()>;

Errors errors_of(const Formula& formula, const Truth& truth, const Grid<float>& visibility,
                 const Grid<float>& ao) {
  Errors errors{};
  for (size_t a = 0; a < kAlbedos.size(); ++a) {
    double sum = 0;
    for (size_t i = 0; i < ao.size(); ++i) {
      const Texel texel{static_cast<double>(visibility[i]), static_cast<double>(ao[i]),
                        static_cast<double>(truth.bounce_map.visibility[i]),
                        static_cast<double>(truth.bounce_map.bounce[i])};
      const double error = formula.total(texel, kAlbedos[a]) - truth.light[a][i];
      sum += error * error;
    }
    errors[a] = std::sqrt(sum / static_cast<double>(ao.size()));
  }
  return errors;
}

void print_table(const std::string& source, const std::vector<Errors>& sums, size_t maps) {
  const std::vector<Formula> list = formulas();
  for (size_t f = 0; f < sums.size(); ++f) {
    fmt::print("| {} | {} |", source, list[f].name);
    for (const double sum : sums[f]) fmt::print(" {:.4f} |", sum / static_cast<double>(maps));
    fmt::print("\n");
  }
}

void run(int side) {
  const std::vector<Surface> surfaces = {synthetic_surface(SyntheticKind::kBricks, side, side, 0.1),
                                         synthetic_surface(SyntheticKind::kShapes, side, side, 0.45),
                                         synthetic_surface(SyntheticKind::kConcrete, side, side, 0.05),
                                         synthetic_surface(SyntheticKind::kNoise, side, side, 0.1)};
  const std::vector<Formula> list = formulas();
  std::vector<Errors> baked(list.size(), Errors{});
  // A shader has no baked second texture: all but the last formula.
  std::vector<Errors> eight(list.size() - 1, Errors{}), one = eight;
  const auto add = [](Errors& sum, const Errors& errors) {
    for (size_t a = 0; a < sum.size(); ++a) sum[a] += errors[a];
  };
  for (const Surface& surface : surfaces) {
    const Truth truth = trace(surface);
    HorizonOptions options;
    options.azimuths = 16;
    const Estimate fine = estimate_horizon(surface, options);
    options.azimuths = 2;
    const Estimate coarse = estimate_horizon(surface, options);
    for (size_t f = 0; f < list.size(); ++f) {
      add(baked[f],
          errors_of(list[f], truth, truth.transport.direct_over_pi, truth.transport.visible_fraction));
      if (f >= eight.size()) continue;
      add(eight[f], errors_of(list[f], truth, fine.ao, fine.other_ao));
      add(one[f], errors_of(list[f], truth, coarse.ao, coarse.other_ao));
    }
  }
  fmt::print("| AO | formula | .2 | .5 | .8 | .9 | .95 |\n| --- | --- | --- | --- | --- | --- | --- |\n");
  print_table("baked", baked, surfaces.size());
  print_table("8 slices", eight, surfaces.size());
  print_table("1 slice", one, surfaces.size());
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  hemibake::run(argc > 1 ? std::atoi(argv[1]) : 96);
  return 0;
}
