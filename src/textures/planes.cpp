#include "textures/planes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "textures/light.h"

namespace hemibake {
namespace {

// Mean distance from the bounds of V that rays too few for either leave; planes of two maps are beyond.
constexpr double kMeanOutOfBounds = 0.02;

struct Needs {
  bool visibility = false, ao = false, bounces = false, bounce_plane = false, bent = false, normal = false;
};

Needs needs_of(const TextureSettings& textures) {
  Needs needs;
  for (const TextureKind wanted : textures.kinds) {
    const bool packed = wanted == TextureKind::kOrm || wanted == TextureKind::kMask;
    const TextureKind kind = packed ? textures.occlusion : wanted;
    const bool bounce = kind == TextureKind::kBounce || kind == TextureKind::kBounceMap;
    const bool bent = kind == TextureKind::kBent;
    const bool irradiance = kind == TextureKind::kIrradiance;
    const bool with_normal = bent && textures.bent_length == BentLength::kVisibility;
    needs.bent |= bent;
    needs.bounce_plane |= bounce;
    needs.bounces |= irradiance && std::ranges::max(textures.albedo) > 0;
    needs.normal |= kind == TextureKind::kNormal || with_normal;
    needs.ao |= kind == TextureKind::kAo || (bent && textures.bent_length == BentLength::kAo);
    needs.visibility |= kind == TextureKind::kVisibility || bounce || irradiance || with_normal;
  }
  return needs;
}

template <class T>
void expect_plane(const Bake& bake, const Grid<T>& plane, const char* channel) {
  if (plane.empty())
    throw InputError(fmt::format("has no channel {}, expected it for the textures asked for", channel));
  if (plane.width != bake.width || plane.height != bake.height)
    throw InputError(fmt::format("channel {} has {} x {} texels, expected the {} x {} of the bake", channel,
                                 plane.width, plane.height, bake.width, bake.height));
}

void expect_light(const Bake& bake, const Needs& needs) {
  if (needs.visibility && bake.visibility.empty()) {
    if (bake.irradiance.empty())
      throw InputError(
          "has neither channel visibility nor irradiance.00, expected one of them for the textures asked "
          "for");
    expect_plane(bake, bake.irradiance[0], "irradiance.00");
  } else if (needs.visibility) {
    expect_plane(bake, bake.visibility, "visibility");
  }
  const bool has_bounce_plane = !bake.bounce.empty();
  if ((needs.bounce_plane || needs.bounces) && has_bounce_plane) expect_plane(bake, bake.bounce, "bounce");
  const bool sums_bounces = needs.bounces || (needs.bounce_plane && !has_bounce_plane);
  if (sums_bounces && bake.irradiance.size() < 2)
    throw InputError("has no bounces, expected channel irradiance.01 for the textures asked for");
  if (!sums_bounces && !needs.bounce_plane) return;
  for (const Grid<float>& plane : bake.irradiance) expect_plane(bake, plane, "irradiance");
}

void expect_one_surface(const Bake& bake) {
  double outside = 0;
  for (size_t i = 0; i < bake.visible_fraction.size(); ++i) {
    const double ao = static_cast<double>(bake.visible_fraction[i]), visibility = visibility_at(bake, i);
    outside += std::max({0.0, ao * ao - visibility, visibility - ao * (2 - ao)});
  }
  const double mean = outside / static_cast<double>(bake.visible_fraction.size());
  if (!(mean <= kMeanOutOfBounds))
    throw InputError(
        fmt::format("channels ao and visibility are not of one bake: V is outside a^2..a(2-a) "
                    "by {:.3f} on average, expected at most {}",
                    mean, kMeanOutOfBounds));
}

}  // namespace

void bake_only_what_textures_need(const TextureSettings& textures, BakeSettings& bake) {
  const Needs needs = needs_of(textures);
  bake.outputs.clear();
  if (needs.visibility || needs.ao) bake.outputs.push_back(BakeOutput::kAo);  // comes with V
  if (needs.bounces || needs.bounce_plane) bake.outputs.push_back(BakeOutput::kIrradiance);
  if (needs.bent) bake.outputs.push_back(BakeOutput::kBent);
  if (needs.normal) bake.outputs.push_back(BakeOutput::kNormal);
  if (!needs.bounce_plane) bake.bounce_albedo.reset();
}

void check_planes(const Bake& bake, const TextureSettings& textures) {
  const Needs needs = needs_of(textures);
  expect_light(bake, needs);
  if (needs.ao) expect_plane(bake, bake.visible_fraction, "ao");
  if (needs.bent) expect_plane(bake, bake.bent_normals, "bent");
  if (needs.normal) expect_plane(bake, bake.normals, "normal");
  if (needs.ao && needs.visibility) expect_one_surface(bake);
}

}  // namespace hemibake
