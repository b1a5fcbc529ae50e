// Packs the planes of a bake for a page: whole numbers of one step, compressed, as text.
#pragma once

#include <string>
#include <vector>

#include "transport/baked_planes.h"

namespace hemibake {

struct PackedPlane {
  std::string name;    // `ao`, `irradiance.00`…, `bounce`, `visibility`, as in BAKE.exr
  double step = 0;     // value = code · step
  std::string base64;  // of a zlib stream of width × height low bytes, then as many high bytes, of the codes
};

// Holds every `stride`-th texel of every `stride`-th row: texel (x, y) is (x·stride, y·stride) of the bake.
struct PackedPlanes {
  int width = 0, height = 0;
  int stride = 1;
  std::vector<PackedPlane> planes;
  // Largest differences from the bake that the codes make, over the texels kept.
  double ao_error = 0;                  // of α, and of V where it is packed
  double bounce_error = 0;              // of the bounce map
  double irradiance_error_over_pi = 0;  // of one bounce
  double total_error_over_pi = 0;       // of Σ E_b, which is the largest of Σ ρᵇ E_b for ρ in 0..1
};

// Packs the planes α, E_b and the bounce map that are there, in this order, and V where there is no E₀ to
// tell it. A 16-bit code is replaced by its difference, modulo 2¹⁶, from the median of left, above and left +
// above − above left (Weinberger, Seroussi and Sapiro, "LOCO-I", 1996), outside being 0, and then compressed.
// largest_side: longer side of the kept texels, 1 and up. Throws InputError naming plane and texel for a
// value that is not finite or below 0.
PackedPlanes pack_planes(const Bake& bake, int largest_side);

}  // namespace hemibake
