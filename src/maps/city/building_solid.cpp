#include "maps/city/building_solid.h"

#include <algorithm>
#include <utility>

#include "maps/city/drawn_apart.h"
#include "maps/city/grid_rings.h"
#include "maps/city/roof_profile.h"
#include "maps/city/roof_surface.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

constexpr double kNoWall = 1e-6;  // of the height: a lower wall is none, and roof and floor meet

/// Joins a roof, a floor and the walls between them.
class Closing {
 public:
  Closing(const RoofSurface& surface, const BuildingForm& form, double ground_m)
      : surface_(surface), floor_z_(ground_m + form.bottom_m) {
    const double height = form.top_m - form.bottom_m;
    const double wall = height - form.roof_m;
    // Walls that are next to nothing: the roof takes all of the height.
    wall_ = wall > kNoWall * height ? wall : 0;
    stretch_ = form.roof_m > 0 ? (height - wall_) / form.roof_m : 1;
    least_ = kNoWall * height;
  }

  Mesh run() {
    const std::vector<Triangle>& floor = surface_.floor_is_roof ? surface_.roof : surface_.floor;
    place_corners(floor);
    for (const Triangle& t : surface_.roof) {
      if (!is_gone(t)) mesh_.triangles.push_back({roof_[t[0]], roof_[t[1]], roof_[t[2]]});
    }
    for (const Triangle& t : floor) {
      if (!is_gone(t)) mesh_.triangles.push_back({floor_[t[2]], floor_[t[1]], floor_[t[0]]});
    }
    add_walls(floor);
    drop_unused();
    return std::move(mesh_);
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  void place_corners(const std::vector<Triangle>& floor) {
    const std::size_t count = surface_.points.size();
    roof_.resize(count);
    floor_.assign(count, kNone);
    for (std::uint32_t v = 0; v < count; ++v) {
      const Vec2& p = surface_.points[v];
      const double height = wall_ + surface_.heights[v] * stretch_;
      roof_[v] = v;
      mesh_.vertices.emplace_back(p.x(), p.y(), floor_z_ + (height > least_ ? height : 0));
    }
    for (const Triangle& t : floor) {
      for (const std::uint32_t v : t) {
        if (floor_[v] != kNone) continue;
        floor_[v] = v;
        if (mesh_.vertices[v].z() == floor_z_) continue;  // roof and floor meet there
        floor_[v] = static_cast<std::uint32_t>(mesh_.vertices.size());
        mesh_.vertices.emplace_back(surface_.points[v].x(), surface_.points[v].y(), floor_z_);
      }
    }
  }

  /// Whether roof and floor lie on one another there, so that neither is needed.
  bool is_gone(const Triangle& t) const {
    return surface_.floor_is_roof &&
           std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return roof_[v] == floor_[v]; });
  }

  /// Below every side of the floor that has no second triangle, the space lies to its left.
  void add_walls(const std::vector<Triangle>& floor) {
    struct Side {
      std::uint32_t low, high;
      bool forward;
    };
    std::vector<Side> sides;
    sides.reserve(3 * floor.size());
    for (const Triangle& t : floor) {
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t a = t[e], b = t[(e + 1) % 3];
        sides.push_back({std::min(a, b), std::max(a, b), a < b});
      }
    }
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return std::pair(a.low, a.high) < std::pair(b.low, b.high); });
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Side& side = sides[i];
      if (i + 1 < sides.size() && sides[i + 1].low == side.low && sides[i + 1].high == side.high) {
        ++i;
        continue;
      }
      add_wall(side.forward ? side.low : side.high, side.forward ? side.high : side.low);
    }
  }

  void add_wall(std::uint32_t a, std::uint32_t b) {
    if (roof_[b] != floor_[b]) mesh_.triangles.push_back({floor_[a], floor_[b], roof_[b]});
    if (roof_[a] != floor_[a]) mesh_.triangles.push_back({floor_[a], roof_[b], roof_[a]});
  }

  void drop_unused() {
    std::vector<std::uint32_t> renamed(mesh_.vertices.size(), kNone);
    for (const Triangle& t : mesh_.triangles) {
      for (const std::uint32_t v : t) renamed[v] = 0;
    }
    std::uint32_t count = 0;
    for (std::size_t v = 0; v < renamed.size(); ++v) {
      if (renamed[v] == kNone) continue;
      mesh_.vertices[count] = mesh_.vertices[v];
      renamed[v] = count++;
    }
    mesh_.vertices.resize(count);
    for (Triangle& t : mesh_.triangles) {
      for (std::uint32_t& v : t) v = renamed[v];
    }
  }

  const RoofSurface& surface_;
  double floor_z_, wall_ = 0, stretch_ = 1, least_ = 0;
  std::vector<std::uint32_t> roof_, floor_;  // of each corner of the surface: the vertex
  Mesh mesh_;
};

}  // namespace

CitySolid make_solid(const Footprint& footprint, const BuildingForm& form, double ground_m) {
  const bool open = form.roof != RoofShape::flat;
  const RoofFrame frame = open ? roof_frame(footprint, form) : RoofFrame{};
  const BuildingForm whole = settled(form, frame);
  if (!(whole.top_m > whole.bottom_m)) {
    throw Error(ErrorCode::internal_defect, "a building's top is not above its bottom", "building",
                "please report this");
  }
  const Grid grid(footprint);
  std::vector<GridRing> rings{grid.to_grid(footprint.outer)};
  for (const Ring& hole : footprint.holes) rings.push_back(grid.to_grid(hole));
  const RoofSurface surface = roof_surface(footprint, grid, drawn_apart(rings), whole, frame);
  return {Closing(surface, whole, ground_m).run(), surface.repair};
}

}  // namespace vantage::internal::city
