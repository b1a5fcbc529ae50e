// Maps the benchmarks run on: rough ones and smooth ones.
#pragma once

#include <string>
#include <vector>

#include "support/maps.h"

namespace hemibake {

struct BenchMap {
  std::string name;
  Surface surface;
};

inline std::vector<BenchMap> bench_maps(int side) {
  std::vector<BenchMap> maps;
  maps.push_back({"bricks 0.1 m", synthetic_surface(SyntheticKind::kBricks, side, side, 0.1)});
  maps.push_back({"shapes 0.45 m", synthetic_surface(SyntheticKind::kShapes, side, side, 0.45)});
  return maps;
}

}  // namespace hemibake
