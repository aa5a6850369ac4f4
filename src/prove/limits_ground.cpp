// A position that is too low stays so straight down to a facet, one that is too high straight up, and one without
// ground below it both ways. So facets decide; and over one triangle of the ground the height is linear on a facet: the
// corners of what overlaps in plan decide.
#include "prove/limits_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "prove/convex_polygon.h"
#include "prove/scene_tree.h"
#include "prove/tree_search.h"

namespace vantage::internal::prove {
namespace {

/// Of triangles in plan: the least part of the squared longest side that twice the area is. Thinner ones are vertical;
/// those that are thinner than the second one cover nothing, as their corners would move far with their sides.
constexpr double kVertical = 1e-13, kCovering = 1e-6;

double turn_in_plan_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

double distance_in_plan_to(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Eigen::Vector2d p = point.head<2>(), a = from.head<2>(), along = to.head<2>() - a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

struct GroundPiece {
  std::array<Vec3, 3> corners;  ///< counter-clockwise in plan
  Vec3 normal;                  ///< upward, unit length
  double thinness = 0;

  /// Square to it, metres above what is `height` over it.
  double above(const Vec3& point, double height) const { return normal.dot(point - corners[0]) - height * normal.z(); }
  double outside_in_plan(const Vec3& point) const {
    bool is_inside = true;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      is_inside = is_inside && turn_in_plan_of(a, b, point) >= 0;
      least = std::min(least, distance_in_plan_to(point, a, b));
    }
    return is_inside ? 0 : least;
  }
  /// What lies straight above and below, with sides moved out.
  std::vector<HalfSpace> column(double grown) const {
    std::vector<HalfSpace> sides;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      const Vec3 outward = Vec3(b.y() - a.y(), a.x() - b.x(), 0).normalized();
      sides.push_back({outward, outward.dot(a) + grown});
    }
    return sides;
  }
};

class GroundSheet {
 public:
  GroundSheet(const LimitedVolume& volume, const AboveGround& limit) : volume_(volume), limit_(limit) {
    const Mesh& surface = *limit.ground.surface;
    const Vec3 by = Vec3::Constant(volume.tolerance_m());
    const Box near{volume.box().min - by, volume.box().max + by};
    std::vector<Piece> flat;
    for (const Triangle& t : surface.triangles) {
      GroundPiece piece;
      Box box;
      for (std::size_t k = 0; k < 3; ++k) {
        piece.corners[k] = surface.vertices[t[k]] - volume.origin();
        box.extend(piece.corners[k]);
      }
      if (is_beside(box, near)) continue;
      auto& [a, b, c] = piece.corners;
      if (turn_in_plan_of(a, b, c) < 0) std::swap(b, c);
      const double longest =
          std::max({(b - a).head<2>().squaredNorm(), (c - b).head<2>().squaredNorm(), (a - c).head<2>().squaredNorm()});
      piece.thinness = turn_in_plan_of(a, b, c) / longest;
      if (!(piece.thinness > kVertical)) continue;
      piece.normal = (b - a).cross(c - a).normalized();
      flat.push_back(Piece::triangle(piece.corners, static_cast<std::uint32_t>(pieces_.size())));
      for (Vec3& corner : flat.back().corners) corner.z() = 0;
      pieces_.push_back(piece);
    }
    tree_ = make_tree(std::move(flat));
  }

  void look(const LimitedVolume::Corners& corners, FacetFinding& finding) const {
    const double tolerance = volume_.tolerance_of(corners);
    std::vector<ConvexPolygon> bare = {{corners.begin(), corners.end()}};  // not covered by any piece so far
    const ConvexPolygon facet = bare.front();
    std::vector<std::uint32_t> near;
    visit_near(box_of(facet), tolerance, [&](std::uint32_t index) {
      near.push_back(index);
      const GroundPiece& piece = pieces_[index];
      const std::vector<HalfSpace> column = piece.column(volume_.unsure_m());
      const ConvexPolygon over = part_within(facet, column);
      if (over.empty()) return;
      look_over(piece, over, tolerance, finding);
      if (piece.thinness < kCovering) return;
      std::vector<ConvexPolygon> left;
      for (const ConvexPolygon& one : bare) subtract(one, column, left);
      bare = std::move(left);
    });
    for (const ConvexPolygon& one : bare) {
      const bool is_beside_one = std::any_of(near.begin(), near.end(), [&](std::uint32_t index) {
        return std::all_of(one.begin(), one.end(),
                           [&](const Vec3& corner) { return pieces_[index].outside_in_plan(corner) <= tolerance; });
      });
      if (is_beside_one) continue;
      finding.is_open = true;
      see(middle_of(one), finding);
    }
  }

 private:
  static bool is_beside(const Box& a, const Box& b) {
    return a.min.x() > b.max.x() || b.min.x() > a.max.x() || a.min.y() > b.max.y() || b.min.y() > a.max.y();
  }

  template <typename Visit>
  void visit_near(const Box& box, double by, const Visit& visit) const {
    const Box near{{box.min.x() - by, box.min.y() - by, 0}, {box.max.x() + by, box.max.y() + by, 0}};
    search_tree(
        tree_, [&](const Box& node) { return is_beside(node, near); },
        [&](std::uint32_t i) { visit(tree_.pieces[i].of); });
  }

  void look_over(const GroundPiece& piece, const ConvexPolygon& over, double tolerance, FacetFinding& finding) const {
    bool is_kept = true;
    for (const Vec3& corner : over) is_kept = is_kept && too_far_by(piece, corner) <= tolerance;
    if (is_kept) return;
    finding.is_open = true;
    // Corners may lie just beside the piece, and the limit may be broken next to one only.
    const Vec3 middle = middle_of(over);
    for (const double inwards : {1e-3, 1e-5, 1e-7}) {
      for (const Vec3& corner : over) see(corner + inwards * (middle - corner), finding);
    }
  }

  double too_far_by(const GroundPiece& piece, const Vec3& point) const {
    double by = -std::numeric_limits<double>::infinity();
    if (std::isfinite(limit_.min_m)) by = std::max(by, -piece.above(point, limit_.min_m));
    if (std::isfinite(limit_.max_m)) by = std::max(by, piece.above(point, limit_.max_m));
    return by;
  }

  /// By how much a place breaks the limit, by its definition.
  void see(const Vec3& point, FacetFinding& finding) const {
    Box here;
    here.extend(point);
    bool is_over_ground = false;
    visit_near(here, 0, [&](std::uint32_t index) {
      if (pieces_[index].outside_in_plan(point) > 0) return;
      is_over_ground = true;
      finding.broken.see(too_far_by(pieces_[index], point), point);
    });
    if (!is_over_ground) finding.broken.see(beside_ground_by(point), point);
  }

  /// Metres in plan to the nearest ground, at least.
  double beside_ground_by(const Vec3& point) const {
    const Box& box = volume_.box();
    // Ground that was left out lies farther away than this.
    double nearest = volume_.tolerance_m() + std::min({point.x() - box.min.x(), box.max.x() - point.x(),
                                                       point.y() - box.min.y(), box.max.y() - point.y()});
    Box here;
    here.extend(point);
    for (double reach = volume_.tolerance_m();; reach *= 4) {
      visit_near(here, std::min(reach, nearest),
                 [&](std::uint32_t index) { nearest = std::min(nearest, pieces_[index].outside_in_plan(point)); });
      if (nearest <= reach) break;
    }
    return nearest;
  }

  const LimitedVolume& volume_;
  const AboveGround& limit_;
  std::vector<GroundPiece> pieces_;
  SceneTree tree_;
};

}  // namespace

ClaimProof prove_above_ground(const std::string& name, const LimitedVolume& volume, const AboveGround& limit,
                              const core::ProgressReporter& progress) {
  if (!limit.ground.surface) {
    const double ground = limit.ground.plane_z_m;
    return volume.judged_at_vertices(
        name,
        [&](const Vec3& vertex) {
          const double z = vertex.z() + volume.origin().z();
          return std::max(ground + limit.min_m - z, z - (ground + limit.max_m));
        },
        [&](const Vec3& vertex) { return volume.rounded_at(vertex); });
  }
  const GroundSheet sheet(volume, limit);
  const auto findings = volume.look_at_facets(
      [&](const LimitedVolume::Corners& corners, FacetFinding& finding) { sheet.look(corners, finding); }, progress);
  return volume.judged(name, findings, "every facet is over ground and between the heights, triangle by triangle",
                       "the height above the ground");
}

}  // namespace vantage::internal::prove
