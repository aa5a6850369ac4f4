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
  /// To the border, in plan; negative outside.
  double inside_in_plan(const Vec3& point) const {
    bool is_inside = true;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      is_inside = is_inside && turn_in_plan_of(a, b, point) >= 0;
      least = std::min(least, distance_in_plan_to(point, a, b));
    }
    return is_inside ? least : -least;
  }
  double outside_in_plan(const Vec3& point) const { return std::max(0.0, -inside_in_plan(point)); }
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
    visit_near(box_of(facet), tolerance, [&](std::uint32_t index) { near.push_back(index); });
    for (const std::uint32_t index : near) {
      const GroundPiece& piece = pieces_[index];
      const std::vector<HalfSpace> column = piece.column(volume_.unsure_m());
      const ConvexPolygon over = part_within(facet, column);
      if (over.empty()) continue;
      if (!keeps_over(index, over, near, tolerance)) see_corners(over, finding);
      if (piece.thinness >= kCovering) take_away(column, bare);
    }
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

  /// Beside a step of the ground what breaks the limit over one piece may be all but over the next one, where it keeps
  /// it. Of what was found only the worst place remains that is not so near to one that keeps the limit; the facets
  /// stay open.
  void confirm(std::vector<FacetFinding>& findings) const {
    std::vector<std::size_t> broken;
    for (std::size_t f = 0; f < findings.size(); ++f) {
      if (findings[f].broken.by_m > volume_.least_m()) broken.push_back(f);
    }
    std::stable_sort(broken.begin(), broken.end(),
                     [&](std::size_t a, std::size_t b) { return findings[a].broken.by_m > findings[b].broken.by_m; });
    bool is_found = false;
    for (const std::size_t f : broken) {
      Broken& one = findings[f].broken;
      one.by_m = is_found ? -std::numeric_limits<double>::infinity() : to_kept_m(one.at, one.by_m);
      is_found = is_found || one.by_m > volume_.tolerance_of(volume_.facets()[f]);
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

  static void take_away(const std::vector<HalfSpace>& column, std::vector<ConvexPolygon>& polygons) {
    std::vector<ConvexPolygon> left;
    for (const ConvexPolygon& one : polygons) subtract(one, column, left);
    polygons = std::move(left);
  }

  bool keeps(const GroundPiece& piece, const ConvexPolygon& polygon, double tolerance) const {
    return std::all_of(polygon.begin(), polygon.end(),
                       [&](const Vec3& corner) { return too_far_by(piece, corner) <= tolerance; });
  }

  /// Whether a part of a facet that is over a piece, or all but over it, keeps the limit. Nearer to the piece's border
  /// than the tolerance, it may do so for what lies beside it: the other side of a step.
  bool keeps_over(std::uint32_t index, const ConvexPolygon& over, const std::vector<std::uint32_t>& near,
                  double tolerance) const {
    const GroundPiece& piece = pieces_[index];
    if (keeps(piece, over, tolerance)) return true;
    const std::vector<HalfSpace> inner = piece.column(-tolerance);
    if (!keeps(piece, part_within(over, inner), tolerance)) return false;
    std::vector<ConvexPolygon> border = {over};
    take_away(inner, border);
    for (const std::uint32_t other : near) {
      if (other == index || pieces_[other].thinness < kCovering) continue;
      const std::vector<HalfSpace> column = pieces_[other].column(tolerance);
      std::vector<ConvexPolygon> left;
      for (const ConvexPolygon& one : border) {
        const ConvexPolygon part = part_within(one, column);
        if (part.empty() || !keeps(pieces_[other], part, tolerance)) {
          left.push_back(one);
        } else {
          subtract(one, column, left);
        }
      }
      border = std::move(left);
    }
    return border.empty();
  }

  /// Corners may lie just beside the piece that they are over, and the limit may be broken next to one only.
  void see_corners(const ConvexPolygon& over, FacetFinding& finding) const {
    finding.is_open = true;
    const Vec3 middle = middle_of(over);
    for (const double inwards : {1e-3, 1e-5, 1e-7}) {
      for (const Vec3& corner : over) see(corner + inwards * (middle - corner), finding);
    }
  }

  /// How far a place is at least from any in the volume's box that keeps the limit: a place over one of the pieces, as
  /// high as that piece asks for, and over no piece that asks for another height. `most_m`: it is not farther.
  double to_kept_m(const Vec3& point, double most_m) const {
    Box here;
    here.extend(point);
    double to_any = most_m, out_of_one = -std::numeric_limits<double>::infinity();
    for (double reach = volume_.tolerance_m();; reach *= 4) {
      visit_near(here, std::min(reach, to_any), [&](std::uint32_t index) {
        const double inside = pieces_[index].inside_in_plan(point), by = too_far_by(pieces_[index], point);
        to_any = std::min(to_any, std::max(-inside, by));
        out_of_one = std::max(out_of_one, std::min(inside, by));
      });
      if (to_any <= reach) return std::max(to_any, out_of_one);
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
  auto findings = volume.look_at_facets(
      [&](const LimitedVolume::Corners& corners, FacetFinding& finding) { sheet.look(corners, finding); }, progress);
  sheet.confirm(findings);
  return volume.judged(name, findings, "every facet is over ground and between the heights, triangle by triangle",
                       "the height above the ground");
}

}  // namespace vantage::internal::prove
