#include "reference/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace hemibake {

SurfacePoint texel_center(const Surface& surface, size_t texel) {
  const auto width = static_cast<size_t>(surface.width());
  return {{static_cast<double>(texel % width), static_cast<double>(texel / width),
           static_cast<double>(surface.heights_m[texel]) / surface.texel_size_m},
          glm::dvec3(surface.normals[texel])};
}

// Holds a ray with its height in metres, to compare with the map as stored. x, y move back by whole tiles.
struct HeightFieldRayCaster::Ray {
  double x, y, z_m;
  double dx, dy, dz_m;
  double inverse_dx, inverse_dy;
  double end;             // leaves the relief: above its top, or surely below the ground (height 0)
  bool is_below = false;  // the surface: it came through a hole

  double x_at(double t) const { return x + t * dx; }
  double y_at(double t) const { return y + t * dy; }
  double z_at(double t) const { return z_m + t * dz_m; }
};

HeightFieldRayCaster::HeightFieldRayCaster(const Surface& surface)
    : surface_(surface),
      cells_x_(surface.edge == Edge::kWrap ? surface.width() : surface.width() - 1),
      cells_y_(surface.edge == Edge::kWrap ? surface.height() : surface.height() - 1),
      range_m_(height_range_m(surface)),
      truncation_texels_(1e5 * std::max(1.0, range_m_ / surface.texel_size_m)) {
  build_max_mips();
}

void HeightFieldRayCaster::build_max_mips() {
  // A level per factor of 4: finer steps cost more tests than they skip.
  Grid<float> finer(cells_x_, cells_y_);
  for (int y = 0; y < cells_y_; ++y)
    for (int x = 0; x < cells_x_; ++x)
      finer(x, y) =
          std::max({height_m(x, y), height_m(x + 1, y), height_m(x, y + 1), height_m(x + 1, y + 1)});
  while (finer.width > 1 || finer.height > 1) {
    Grid<float> coarser((finer.width + 3) / 4, (finer.height + 3) / 4, 0);
    for (int y = 0; y < finer.height; ++y)
      for (int x = 0; x < finer.width; ++x)
        coarser(x / 4, y / 4) = std::max(coarser(x / 4, y / 4), finer(x, y));
    max_mips_m_.push_back(coarser);
    finer = std::move(coarser);
  }
}

// Returns the height at x, y up to one beyond the last texel.
float HeightFieldRayCaster::height_m(int x, int y) const {
  return surface_.heights_m(x == surface_.width() ? 0 : x, y == surface_.height() ? 0 : y);
}

HeightFieldRayCaster::Triangle HeightFieldRayCaster::triangle_of(const Cell& cell, bool far_half) const {
  const double along_x = height_m(cell.x + 1, cell.y), along_y = height_m(cell.x, cell.y + 1);
  if (!far_half) {
    const double corner = height_m(cell.x, cell.y);
    return {1.0 * cell.x, 1.0 * cell.y, corner, along_x - corner, along_y - corner};
  }
  const double corner = height_m(cell.x + 1, cell.y + 1);
  return {cell.x + 1.0, cell.y + 1.0, corner, corner - along_y, corner - along_x};
}

SurfacePoint HeightFieldRayCaster::point_on(const Triangle& triangle, double x, double y) const {
  const double texel = surface_.texel_size_m;
  return {{x, y, triangle.height_m(x, y) / texel},
          glm::normalize(glm::dvec3(-triangle.slope_x_m / texel, -triangle.slope_y_m / texel, 1))};
}

uint32_t HeightFieldRayCaster::facet_count() const {
  return 2 * static_cast<uint32_t>(cells_x_) * static_cast<uint32_t>(cells_y_);
}

double HeightFieldRayCaster::start_lift(double wanted_texels) const {
  const double range = range_m_ / surface_.texel_size_m;
  return std::max(wanted_texels * std::min(1.0, range), 0x1p-44 * range);
}

SurfacePoint HeightFieldRayCaster::point_on_facet(uint32_t facet, double u, double v) const {
  const uint32_t cell = facet / 2, columns = static_cast<uint32_t>(cells_x_);
  const bool far_half = facet % 2 == 1;
  const Triangle triangle =
      triangle_of({static_cast<int>(cell % columns), static_cast<int>(cell / columns), 0}, far_half);
  const double leg = far_half ? -1 : 1;
  return point_on(triangle, triangle.corner_x + leg * u, triangle.corner_y + leg * v);
}

HeightFieldRayCaster::Block HeightFieldRayCaster::block_at(const Cell& cell) const {
  if (cell.level == 0) {
    const float max_m = std::max({height_m(cell.x, cell.y), height_m(cell.x + 1, cell.y),
                                  height_m(cell.x, cell.y + 1), height_m(cell.x + 1, cell.y + 1)});
    return {cell.x, cell.x + 1, cell.y, cell.y + 1, max_m};
  }
  const int shift = 2 * cell.level;
  const int block_x = cell.x >> shift, block_y = cell.y >> shift;
  return {block_x << shift, std::min((block_x + 1) << shift, cells_x_), block_y << shift,
          std::min((block_y + 1) << shift, cells_y_),
          max_mips_m_[static_cast<size_t>(cell.level - 1)](block_x, block_y)};
}

// Returns whether a triangle is no surface: a corner of it is a hole.
bool HeightFieldRayCaster::is_open(const Cell& cell, bool far_half) const {
  if (surface_.holes.empty()) return false;
  const auto is_hole = [&](int x, int y) {
    return surface_.is_hole(x == surface_.width() ? 0 : x, y == surface_.height() ? 0 : y);
  };
  return is_hole(cell.x + 1, cell.y) || is_hole(cell.x, cell.y + 1) ||
         (far_half ? is_hole(cell.x + 1, cell.y + 1) : is_hole(cell.x, cell.y));
}

// Returns where a ray ends inside a triangle, if it does.
std::optional<RayOutcome> HeightFieldRayCaster::meet_triangle(Ray& ray, const Cell& cell, bool far_half,
                                                              double enter, double leave,
                                                              SurfacePoint& hit) const {
  const Triangle triangle = triangle_of(cell, far_half);
  const double below = triangle.height_m(ray.x_at(leave), ray.y_at(leave)) - ray.z_at(leave);
  if (is_open(cell, far_half)) {
    ray.is_below = below > 0;
    return std::nullopt;
  }
  if (ray.is_below) return below > 0 ? std::nullopt : std::optional(RayOutcome::kBelow);
  if (below <= 0) return std::nullopt;
  // Rounding may put the entry below the plane too: it counts as on it.
  const double above = std::max(0.0, ray.z_at(enter) - triangle.height_m(ray.x_at(enter), ray.y_at(enter)));
  const double t = enter + (leave - enter) * above / (above + below);
  hit = point_on(triangle, ray.x_at(t), ray.y_at(t));
  return RayOutcome::kHit;
}

std::optional<RayOutcome> HeightFieldRayCaster::meet_cell(Ray& ray, const Cell& cell, double enter,
                                                          double leave, SurfacePoint& hit) const {
  // The diagonal is where the shares along both legs add up to 1.
  const double diagonal = cell.x + cell.y + 1.0;
  const double enter_side = ray.x_at(enter) + ray.y_at(enter) - diagonal;
  const double leave_side = ray.x_at(leave) + ray.y_at(leave) - diagonal;
  if ((enter_side < 0) == (leave_side < 0))
    return meet_triangle(ray, cell, enter_side >= 0, enter, leave, hit);
  const double cross = enter + (leave - enter) * enter_side / (enter_side - leave_side);
  const auto first = meet_triangle(ray, cell, enter_side >= 0, enter, cross, hit);
  return first ? first : meet_triangle(ray, cell, leave_side >= 0, cross, leave, hit);
}

HeightFieldRayCaster::Ray HeightFieldRayCaster::make_ray(const glm::dvec3& start,
                                                         const glm::dvec3& direction) const {
  const double texel = surface_.texel_size_m;
  Ray ray{start.x, start.y, start.z * texel, direction.x, direction.y, direction.z * texel, 0, 0, 0, false};
  // Finite, so that on the very edge of a block (0 texels to go) the product is 0.
  constexpr double kNever = 1e300;
  ray.inverse_dx = ray.dx == 0 ? kNever : 1 / ray.dx;
  ray.inverse_dy = ray.dy == 0 ? kNever : 1 / ray.dy;
  const double below_ground = texel + 1e-6 * range_m_;
  ray.end = ray.dz_m >= 0 ? (range_m_ - ray.z_m) / ray.dz_m : (ray.z_m + below_ground) / -ray.dz_m;
  return ray;
}

// Moves to the cell across the side of `block` at t, and cell and ray by whole tiles back into the map.
// Returns false beyond an open edge. along_x: across a side in x.
inline bool HeightFieldRayCaster::enter_next(const Block& block, bool along_x, double t, Ray& ray,
                                             Cell& cell) const {
  // Cells advance by whole numbers: rounding of t cannot stop the ray.
  if (along_x) {
    cell.x = ray.dx >= 0 ? block.end_x : block.begin_x - 1;
    if (cell.level > 0)
      cell.y = std::clamp(static_cast<int>(std::floor(ray.y_at(t))), block.begin_y, block.end_y - 1);
  } else {
    cell.y = ray.dy >= 0 ? block.end_y : block.begin_y - 1;
    if (cell.level > 0)
      cell.x = std::clamp(static_cast<int>(std::floor(ray.x_at(t))), block.begin_x, block.end_x - 1);
  }
  const int tiles_x = cell.x < 0 ? -1 : cell.x == cells_x_ ? 1 : 0;
  const int tiles_y = cell.y < 0 ? -1 : cell.y == cells_y_ ? 1 : 0;
  if (tiles_x != 0 || tiles_y != 0) {
    if (surface_.edge != Edge::kWrap) return false;
    cell.x -= tiles_x * cells_x_;
    cell.y -= tiles_y * cells_y_;
    ray.x -= tiles_x * cells_x_;
    ray.y -= tiles_y * cells_y_;
  }
  // The block around this one was tried on the way down: coarser only where the ray has entered another.
  const int shift = 2 * (cell.level + 1);
  const bool entered = block.begin_x >> shift != cell.x >> shift || block.begin_y >> shift != cell.y >> shift;
  if (entered && cell.level < static_cast<int>(max_mips_m_.size())) ++cell.level;
  return true;
}

RayOutcome HeightFieldRayCaster::cast(const glm::dvec3& start, const glm::dvec3& direction,
                                      SurfacePoint& hit) const {
  Ray ray = make_ray(start, direction);
  if (ray.dz_m >= 0 && ray.z_m >= range_m_) return RayOutcome::kEscaped;
  const double truncation = truncation_texels_ / std::hypot(ray.dx, ray.dy);
  Cell cell{std::clamp(static_cast<int>(std::floor(ray.x)), 0, cells_x_ - 1),
            std::clamp(static_cast<int>(std::floor(ray.y)), 0, cells_y_ - 1), 0};
  for (double t = 0; t <= truncation;) {
    const Block block = block_at(cell);
    const double leave_x = ((ray.dx >= 0 ? block.end_x : block.begin_x) - ray.x) * ray.inverse_dx;
    const double leave_y = ((ray.dy >= 0 ? block.end_y : block.begin_y) - ray.y) * ray.inverse_dy;
    const double leave = std::max(t, std::min({leave_x, leave_y, ray.end}));
    const bool clear = std::min(ray.z_at(t), ray.z_at(leave)) > static_cast<double>(block.max_m);
    if (!clear && cell.level > 0) {
      --cell.level;
      continue;
    }
    if (clear) ray.is_below = false;
    const std::optional<RayOutcome> end = clear ? std::nullopt : meet_cell(ray, cell, t, leave, hit);
    if (end == RayOutcome::kHit) {
      hit.position.x = std::clamp(hit.position.x, 1.0 * cell.x, cell.x + 1.0);
      hit.position.y = std::clamp(hit.position.y, 1.0 * cell.y, cell.y + 1.0);
    }
    if (end) return *end;
    const RayOutcome beyond = ray.is_below                                     ? RayOutcome::kBelow
                              : surface_.edge == Edge::kGround && ray.dz_m < 0 ? RayOutcome::kGround
                                                                               : RayOutcome::kEscaped;
    if (leave >= ray.end) return beyond;
    t = leave;
    if (!enter_next(block, leave_x <= leave_y, t, ray, cell)) return beyond;
  }
  return RayOutcome::kTruncated;
}

}  // namespace hemibake
