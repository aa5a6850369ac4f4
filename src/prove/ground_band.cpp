// A position that is too low stays so straight down to a facet, one that is too high straight up, and one without
// ground below it both ways. So facets decide; and over one triangle of the ground the height is linear on a facet: the
// corners of what overlaps in plan decide.
//
// A part of a facet that breaks the limit may do so by the tolerance sideways, too: where all of it, moved across the
// side of a triangle, keeps the limit over whatever is there. What is between two facets, straight above each other and
// each moved its own way, keeps it with one of them where the heights that both grounds allow overlap.
#include "prove/ground_band.h"

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

/// For triangles in plan: the least part of the squared longest side that twice the area is. Thinner ones are vertical;
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

double size_of(const ConvexPolygon& polygon) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    twice += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  return 0.5 * twice.norm();
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
  /// What lies straight above and below, with sides moved out; and cut square to each corner, so that beyond a sharp
  /// one nothing of it is farther from the piece than twice that.
  std::vector<HalfSpace> column(double grown) const {
    std::array<Vec3, 3> outward;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      outward[k] = unit(Vec3(b.y() - a.y(), a.x() - b.x(), 0));
    }
    std::vector<HalfSpace> sides;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 across = (outward[k] + outward[(k + 2) % 3]).normalized();
      sides.push_back({outward[k], outward[k].dot(corners[k]) + grown});
      sides.push_back({across, across.dot(corners[k]) + grown});
    }
    return sides;
  }
};

class GroundSheet {
 public:
  GroundSheet(const LimitedVolume& volume, const AboveGround& limit)
      : volume_(volume),
        limit_(limit),
        room_m_(volume.tolerance_m() + 0.1 * (volume.box().max - volume.box().min).norm()) {
    const Mesh& surface = *limit.ground.surface;
    const Vec3 by = Vec3::Constant(room_m_);
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
      piece.normal = unit(b - a).cross(unit(c - a)).normalized();  // products of short sides underflow
      flat.push_back(Piece::triangle(piece.corners, static_cast<std::uint32_t>(pieces_.size())));
      for (Vec3& corner : flat.back().corners) corner.z() = 0;
      pieces_.push_back(piece);
    }
    tree_ = make_tree(std::move(flat));
  }

  void look(const LimitedVolume::Corners& corners, FacetFinding& finding) const {
    const double tolerance = volume_.tolerance_of(corners);
    const ConvexPolygon facet(corners.begin(), corners.end());
    std::vector<ConvexPolygon> bare = {facet};  // not covered by any piece so far
    visit_near(box_of(facet), volume_.unsure_m(), [&](std::uint32_t index) {
      const GroundPiece& piece = pieces_[index];
      const std::vector<HalfSpace> column = piece.column(volume_.unsure_m());
      const ConvexPolygon over = part_within(facet, column);
      if (over.empty()) return;
      if (!keeps_over(piece, over, tolerance)) see_corners(over, finding);
      if (piece.thinness >= kCovering) take_away(column, bare);
    });
    for (const ConvexPolygon& one : bare) {
      const auto shifts = [&](const ConvexPolygon& part) { return shifts_onto_ground(part, tolerance); };
      if (keeps_beside(one, shifts, tolerance)) continue;
      finding.is_open = true;
      see(middle_of(one), finding);
    }
  }

  /// Beside a step of the ground what breaks the limit over one piece may be all but over the next one, where it keeps
  /// it. Of what was found only the worst place remains that is surely not so near to one that keeps the limit; the
  /// facets stay open.
  void confirm(std::vector<FacetFinding>& findings) const {
    std::vector<std::size_t> broken;
    for (std::size_t f = 0; f < findings.size(); ++f) {
      if (findings[f].broken.by_m > 0) broken.push_back(f);
    }
    std::stable_sort(broken.begin(), broken.end(),
                     [&](std::size_t a, std::size_t b) { return findings[a].broken.by_m > findings[b].broken.by_m; });
    bool is_found = false;
    for (const std::size_t f : broken) {
      Broken& one = findings[f].broken;
      one.by_m = is_found ? -std::numeric_limits<double>::infinity() : to_kept_m(one.at);
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

  /// Whether a part of a facet that is over a piece, or all but over it, keeps the limit there or beside the piece.
  bool keeps_over(const GroundPiece& piece, const ConvexPolygon& over, double tolerance) const {
    if (keeps(piece, over, tolerance)) return true;
    std::vector<ConvexPolygon> broken;
    add_broken(piece, over, tolerance, broken);
    return std::all_of(broken.begin(), broken.end(), [&](const ConvexPolygon& part) {
      return keeps_beside(
          part, [&](const ConvexPolygon& one) { return shifts_off(piece, one, tolerance); }, tolerance);
    });
  }

  /// The parts of a polygon that are too low or too high over a piece by more than `allowed`.
  void add_broken(const GroundPiece& piece, const ConvexPolygon& over, double allowed,
                  std::vector<ConvexPolygon>& broken) const {
    const double level = piece.normal.dot(piece.corners[0]);
    const auto add = [&](const HalfSpace& side) {
      ConvexPolygon part = part_within(over, {side});
      if (!part.empty()) broken.push_back(std::move(part));
    };
    if (std::isfinite(limit_.min_m)) add({piece.normal, level + limit_.min_m * piece.normal.z() - allowed});
    if (std::isfinite(limit_.max_m)) add({-piece.normal, -(level + limit_.max_m * piece.normal.z() + allowed)});
  }

  /// Whether each place of a polygon keeps the limit where a shift moves it. `shifts_of(part)`: to be tried, shorter
  /// than the tolerance; what no shift serves as a whole is tried in parts. "No" where these are many.
  template <typename ShiftsOf>
  bool keeps_beside(const ConvexPolygon& polygon, const ShiftsOf& shifts_of, double tolerance) const {
    constexpr std::size_t kMostParts = 200;
    std::vector<ConvexPolygon> waiting = {polygon};
    for (std::size_t tried = 0; !waiting.empty(); ++tried) {
      if (tried == kMostParts) return false;
      const ConvexPolygon part = waiting.back();
      waiting.pop_back();
      // Heights may differ along it by more than the limit allows.
      const bool goes_on = do_heights_overlap(part, tolerance)
                               ? add_what_shifts_leave(part, shifts_of(part), tolerance, waiting)
                               : add_halves(part, tolerance, waiting);
      if (!goes_on) return false;
    }
    return true;
  }

  /// Cut across its longer extent in plan. False where that is no longer than what is looked at beside it.
  static bool add_halves(const ConvexPolygon& polygon, double tolerance, std::vector<ConvexPolygon>& waiting) {
    const Box box = box_of(polygon);
    const Vec3 extent = box.max - box.min, middle = (box.min + box.max) / 2;
    const Vec3 along = extent.x() > extent.y() ? Vec3::UnitX() : Vec3::UnitY();
    if (!(along.dot(extent) > 4 * tolerance)) return false;
    CutPolygon halves = cut(polygon, {along, along.dot(middle)});
    if (halves.inside.empty() || halves.outside.empty()) return false;
    waiting.push_back(std::move(halves.inside));
    waiting.push_back(std::move(halves.outside));
    return true;
  }

  /// Adds what is left of a part by the shift that leaves least. False where no shift serves any of it.
  bool add_what_shifts_leave(const ConvexPolygon& part, const std::vector<Vec3>& shifts, double tolerance,
                             std::vector<ConvexPolygon>& waiting) const {
    const double whole = size_of(part);
    double least = whole;
    std::vector<ConvexPolygon> best;
    for (const Vec3& shift : shifts) {
      std::vector<ConvexPolygon> left;
      add_broken_at(part, shift, tolerance - shift.norm(), left);
      if (left.empty()) return true;
      double size = 0;
      for (const ConvexPolygon& one : left) size += size_of(one);
      if (size >= least) continue;
      least = size;
      best = std::move(left);
    }
    waiting.insert(waiting.end(), best.begin(), best.end());
    return least < whole;
  }

  /// The parts of a polygon that, moved by a shift, are not over ground, or break the limit over some piece of it by
  /// more than `allowed`; where they are without it.
  void add_broken_at(const ConvexPolygon& polygon, const Vec3& shift, double allowed,
                     std::vector<ConvexPolygon>& left) const {
    ConvexPolygon moved = polygon;
    for (Vec3& corner : moved) corner += shift;
    std::vector<ConvexPolygon> broken, bare = {moved};
    visit_near(box_of(moved), beside_m(), [&](std::uint32_t index) {
      const GroundPiece& piece = pieces_[index];
      const std::vector<HalfSpace> column = piece.column(beside_m());
      const ConvexPolygon over = part_within(moved, column);
      if (over.empty()) return;
      if (!keeps(piece, over, allowed)) add_broken(piece, over, allowed, broken);
      if (piece.thinness >= kCovering) take_away(column, bare);
    });
    broken.insert(broken.end(), bare.begin(), bare.end());
    for (ConvexPolygon& one : broken) {
      for (Vec3& corner : one) corner -= shift;
      left.push_back(std::move(one));
    }
  }

  /// Horizontal moves, shorter than the tolerance. Each takes all of a polygon across a side of the piece that it is
  /// over, or of another piece that some of it is over.
  std::vector<Vec3> shifts_off(const GroundPiece& piece, const ConvexPolygon& polygon, double tolerance) const {
    std::vector<Vec3> shifts;
    add_shifts_off(piece, polygon, tolerance, shifts);
    visit_near(box_of(polygon), volume_.unsure_m(), [&](std::uint32_t index) {
      const GroundPiece& other = pieces_[index];
      if (&other == &piece || part_within(polygon, other.column(volume_.unsure_m())).empty()) return;
      add_shifts_off(other, polygon, tolerance, shifts);
    });
    // Where several pieces meet, off two of them at once; of many pieces the first ones alone.
    constexpr std::size_t kMostAtOnce = 12;
    const std::size_t singles = std::min(shifts.size(), kMostAtOnce);
    for (std::size_t i = 0; i < singles; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (const Vec3 both = shifts[i] + shifts[j]; both.norm() < tolerance) shifts.push_back(both);
      }
    }
    return shifts;
  }

  void add_shifts_off(const GroundPiece& piece, const ConvexPolygon& polygon, double tolerance,
                      std::vector<Vec3>& shifts) const {
    for (const HalfSpace& side : piece.column(0)) {
      double inside = 0;
      for (const Vec3& corner : polygon) inside = std::max(inside, -side.over(corner));
      add_shift(side.normal, inside, tolerance, shifts);
    }
  }

  /// Horizontal moves of a polygon beside the ground that take it across a side of a piece nearby, onto that piece.
  std::vector<Vec3> shifts_onto_ground(const ConvexPolygon& polygon, double tolerance) const {
    std::vector<Vec3> shifts;
    visit_near(box_of(polygon), tolerance, [&](std::uint32_t index) {
      if (pieces_[index].thinness < kCovering) return;
      for (const HalfSpace& side : pieces_[index].column(0)) {
        double outside = 0;
        for (const Vec3& corner : polygon) outside = std::max(outside, side.over(corner));
        if (outside > 0) add_shift(-side.normal, outside, tolerance, shifts);
      }
    });
    return shifts;
  }

  /// What is farther than this beside a piece is surely not over it: four roundings. All that is unsure, four times
  /// that, may be as much as the tolerance.
  double beside_m() const { return 0.25 * volume_.unsure_m(); }

  void add_shift(const Vec3& direction, double length, double tolerance, std::vector<Vec3>& shifts) const {
    constexpr std::size_t kMostShifts = 48;
    const double longer = length + 2 * beside_m();
    if (longer < tolerance && shifts.size() < kMostShifts) shifts.push_back(longer * direction);
  }

  /// Whether any two pieces of ground within the tolerance of a polygon, in plan, allow some height in common.
  bool do_heights_overlap(const ConvexPolygon& polygon, double tolerance) const {
    if (!std::isfinite(limit_.min_m) || !std::isfinite(limit_.max_m)) return true;
    const Box box = box_of(polygon);
    const std::vector<HalfSpace> around = {{Vec3::UnitX(), box.max.x() + tolerance},
                                           {-Vec3::UnitX(), tolerance - box.min.x()},
                                           {Vec3::UnitY(), box.max.y() + tolerance},
                                           {-Vec3::UnitY(), tolerance - box.min.y()}};
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    visit_near(box, tolerance, [&](std::uint32_t index) {
      const auto& corners = pieces_[index].corners;
      for (const Vec3& corner : part_within({corners.begin(), corners.end()}, around)) {
        lowest = std::min(lowest, corner.z());
        highest = std::max(highest, corner.z());
      }
    });
    return highest + limit_.min_m <= lowest + limit_.max_m;
  }

  /// Corners may lie just beside the piece that they are over, and the limit may be broken next to one only.
  void see_corners(const ConvexPolygon& over, FacetFinding& finding) const {
    finding.is_open = true;
    const Vec3 middle = middle_of(over);
    see(middle, finding);
    for (const double inwards : {1e-1, 1e-3, 1e-5, 1e-7}) {
      for (const Vec3& corner : over) see(corner + inwards * (middle - corner), finding);
    }
  }

  /// How far a place is at least from any that keeps the limit: a place over one of the pieces, as high as that piece
  /// asks for, and over no piece that asks for another height.
  double to_kept_m(const Vec3& point) const {
    const double by = broken_by(point);
    double to_any = std::min(std::max(by, most_broken_by(point)), to_other_ground_m(point));
    Box here;
    here.extend(point);
    for (double reach = volume_.tolerance_m();; reach *= 4) {
      visit_near(here, std::min(reach, to_any), [&](std::uint32_t index) {
        to_any = std::min(to_any, std::max(pieces_[index].outside_in_plan(point), too_far_by(pieces_[index], point)));
      });
      if (to_any <= reach) return std::max(to_any, by);
    }
  }

  double too_far_by(const GroundPiece& piece, const Vec3& point) const {
    double by = -std::numeric_limits<double>::infinity();
    if (std::isfinite(limit_.min_m)) by = std::max(by, -piece.above(point, limit_.min_m));
    if (std::isfinite(limit_.max_m)) by = std::max(by, piece.above(point, limit_.max_m));
    return by;
  }

  void see(const Vec3& point, FacetFinding& finding) const { finding.broken.see(broken_by(point), point); }

  /// Calls visit(piece) for those that a place is over.
  template <typename Visit>
  void visit_under(const Vec3& point, const Visit& visit) const {
    Box here;
    here.extend(point);
    visit_near(here, 0, [&](std::uint32_t index) {
      if (pieces_[index].inside_in_plan(point) >= 0) visit(pieces_[index]);
    });
  }

  /// How far a place is at least from one that keeps the limit: over one piece, until it is beside it.
  double broken_by(const Vec3& point) const {
    bool is_over_ground = false;
    double by = -std::numeric_limits<double>::infinity();
    visit_under(point, [&](const GroundPiece& piece) {
      is_over_ground = true;
      by = std::max(by, std::min(piece.inside_in_plan(point), too_far_by(piece, point)));
    });
    return is_over_ground ? by : beside_ground_by(point);
  }

  /// By how much it breaks the limit straight up or down.
  double most_broken_by(const Vec3& point) const {
    double by = -std::numeric_limits<double>::infinity();
    visit_under(point, [&](const GroundPiece& piece) { by = std::max(by, too_far_by(piece, point)); });
    return by;
  }

  /// Ground that was left out is farther away in plan.
  double to_other_ground_m(const Vec3& point) const {
    const Box& box = volume_.box();
    return room_m_ + std::min({point.x() - box.min.x(), box.max.x() - point.x(), point.y() - box.min.y(),
                               box.max.y() - point.y()});
  }

  /// Metres in plan to the nearest ground, at least.
  double beside_ground_by(const Vec3& point) const {
    double nearest = to_other_ground_m(point);
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
  double room_m_;  ///< ground that is farther than this from the volume's box, in plan, is left out
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
