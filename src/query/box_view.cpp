#include "query/box_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>

#include "exact/segment_cover.h"

namespace vantage::internal::query {
namespace {

using Eigen::Vector2d;

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// A surface of more polygons is not looked for: each costs as much as a few voxels.
constexpr std::size_t kMostTogether = 32;

/// So many of the polygons that hide the centre of a piece are tried.
constexpr int kMostTries = 4;

/// The target is halved so often, to find that several surfaces hide it together.
constexpr int kHalvings = 4;

/// Sines of smaller angles are rounding.
constexpr double kAngle = 1e-12;

double turn_from(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The directions of points of the plane, as seen from the origin: they span an angle of less than pi, or too much.
class Wedge {
 public:
  void add(const Vector2d& q) {
    if (is_empty_) {
      right_ = left_ = q;
      is_empty_ = false;
      return;
    }
    if (turn_from(right_, q) < 0) right_ = q;
    if (turn_from(left_, q) > 0) left_ = q;
  }
  /// All points should be in front of the line through the origin that is square to this.
  Vector2d middle() const { return right_.normalized() + left_.normalized(); }

 private:
  bool is_empty_ = true;
  Vector2d right_ = Vector2d::Zero(), left_ = Vector2d::Zero();
};

std::array<Vec3, 8> corners_of(const SightBox& box) {
  std::array<Vec3, 8> corners;
  for (int k = 0; k < 8; ++k) {
    const Vec3 sign((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1);
    corners[k] = box.centre + sign.cwiseProduct(box.half);
  }
  return corners;
}

}  // namespace

BoxView::BoxView(const Side& side, const BlockerIndex& index, bool is_point)
    : origin_(side.frame.origin),
      up_(side.frame.normal),
      slack_(side.target.slack),
      reach_(side.target.radius),
      is_point_(is_point) {
  const TargetFrame& frame = side.frame;
  pieces_.emplace_back();
  for (const auto& t : side.target.vertices) {
    pieces_[0].corners.emplace_back(frame.axis_u * t.x() + frame.axis_v * t.y());
  }
  halve(0, 0);
  for (std::uint32_t i = 0; i < index.blocker_count(); ++i) {
    const BlockerIndex::Blocker& from = index.blocker(i);
    Blocker blocker{};
    blocker.first_plane = static_cast<std::uint32_t>(planes_.size());
    blocker.plane_count = from.plane_count;
    blocker.polygon = from.polygon;
    blockers_.push_back(blocker);
    for (const core::Plane& g : index.planes_of(from)) {
      planes_.emplace_back(frame.axis_u * g.x() + frame.axis_v * g.y() + frame.normal * g.z());
    }
  }
  add_corners(side);
  find_neighbours(side);
}

// Square to the piece's longest extent, through its centre.
void BoxView::halve(std::uint32_t piece, int depth) {
  const std::vector<Vec3> corners = pieces_[piece].corners;
  Vec3 sum = Vec3::Zero(), longest = Vec3::Zero();
  for (const Vec3& a : corners) {
    sum += a;
    for (const Vec3& b : corners) {
      if ((b - a).squaredNorm() > longest.squaredNorm()) longest = b - a;
    }
  }
  const Vec3 centre = sum / static_cast<double>(corners.size());
  pieces_[piece].centre = centre;
  if (depth == kHalvings || is_point_) return;
  const auto halves = static_cast<std::uint32_t>(pieces_.size());
  pieces_[piece].halves = halves;
  pieces_.resize(pieces_.size() + 2);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[i + 1 == corners.size() ? 0 : i + 1];
    const double at_a = longest.dot(a - centre), at_b = longest.dot(b - centre);
    if (at_a <= 0) pieces_[halves].corners.push_back(a);
    if (at_a >= 0) pieces_[halves + 1].corners.push_back(a);
    if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0)) {
      const Vec3 cut = a + at_a / (at_a - at_b) * (b - a);
      pieces_[halves].corners.push_back(cut);
      pieces_[halves + 1].corners.push_back(cut);
    }
  }
  halve(halves, depth + 1);
  halve(halves + 1, depth + 1);
}

void BoxView::add_corners(const Side& side) {
  const Vec3 centre = origin_ - side.scene.origin;
  for (Blocker& blocker : blockers_) {
    blocker.first_corner = static_cast<std::uint32_t>(corners_.size());
    for (const std::uint32_t vertex : side.scene.corners_of(blocker.polygon)) {
      corners_.push_back({side.scene.vertices[vertex] - centre, kNone});
      reach_ = std::max(reach_, corners_.back().place.norm());
    }
    blocker.corner_count = static_cast<std::uint32_t>(corners_.size()) - blocker.first_corner;
    const Corner* const c = &corners_[blocker.first_corner];
    Vec3 area = Vec3::Zero();
    for (std::uint32_t i = 1; i + 1 < blocker.corner_count; ++i) {
      area += (c[i].place - c[0].place).cross(c[i + 1].place - c[0].place);
    }
    if (!(area.norm() > 0)) continue;
    blocker.normal = area.normalized();
    double low = std::numeric_limits<double>::infinity(), high = -low, own_low = low, own_high = -low;
    for (const Vec3& t : pieces_[0].corners) {
      low = std::min(low, blocker.normal.dot(t));
      high = std::max(high, blocker.normal.dot(t));
    }
    for (std::uint32_t i = 0; i < blocker.corner_count; ++i) {
      own_low = std::min(own_low, blocker.normal.dot(c[i].place));
      own_high = std::max(own_high, blocker.normal.dot(c[i].place));
    }
    if (high <= own_low + slack_) {
      blocker.height = own_high;
      blocker.is_beside = true;
    } else if (low >= own_high - slack_) {
      blocker.normal = -blocker.normal;
      blocker.height = -own_low;
      blocker.is_beside = true;
    }
  }
}

// Blockers that share both ends of an edge. Of three and more none is the neighbour: a surface may end there.
void BoxView::find_neighbours(const Side& side) {
  using Edge = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;  // ends, corner, blocker
  std::vector<Edge> edges;
  edges.reserve(corners_.size());
  for (std::uint32_t b = 0; b < blockers_.size(); ++b) {
    const std::span<const std::uint32_t> ends = side.scene.corners_of(blockers_[b].polygon);
    for (std::uint32_t i = 0; i < ends.size(); ++i) {
      const std::uint32_t from = ends[i], to = ends[i + 1 == ends.size() ? 0 : i + 1];
      edges.emplace_back(std::min(from, to), std::max(from, to), blockers_[b].first_corner + i, b);
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    const auto ends = [&](std::size_t at) { return std::pair(std::get<0>(edges[at]), std::get<1>(edges[at])); };
    while (end < edges.size() && ends(end) == ends(i)) ++end;
    if (end == i + 2 && std::get<3>(edges[i]) != std::get<3>(edges[i + 1])) {
      corners_[std::get<2>(edges[i])].neighbour = std::get<3>(edges[i + 1]);
      corners_[std::get<2>(edges[i + 1])].neighbour = std::get<3>(edges[i]);
    }
    i = end;
  }
}

BoxView::Place BoxView::place_of(const SightBox& box) const {
  const double height = up_.dot(box.centre), half = up_.cwiseAbs().dot(box.half);
  if (height + half < -slack_) return Place::behind;
  return height - half > slack_ ? Place::in_front : Place::across;
}

bool BoxView::separates(const Blocker& blocker, const SightBox& box) const {
  return blocker.is_beside &&
         blocker.normal.dot(box.centre) - blocker.normal.cwiseAbs().dot(box.half) > blocker.height + 4 * slack_;
}

/// Whether no line of sight from the box to the piece meets the edge, or comes near to it.
bool BoxView::is_clear(const Vec3& a, const Vec3& b, const Piece& piece, const SightBox& box) const {
  const double room = 4 * slack_ + kAngle * reach_;
  if (up_.dot(a) < -room && up_.dot(b) < -room) return true;  // below the target
  const double length = (b - a).norm();
  if (!(length > room)) return false;
  const Vec3 along = (b - a) / length;
  const double middle = along.dot(box.centre - a), half = along.cwiseAbs().dot(box.half);
  double least = middle - half, most = middle + half;
  for (const Vec3& t : piece.corners) {
    least = std::min(least, along.dot(t - a));
    most = std::max(most, along.dot(t - a));
  }
  if (most < -room || least > length + room) return true;  // beyond one of its ends
  // Seen along the edge, the edge is the origin: a line through it must have all lines of sight on one side.
  const Vec3 u = along.unitOrthogonal(), v = along.cross(u);
  thread_local std::vector<Vector2d> points;
  points.clear();
  Wedge wedge;
  const auto add = [&](const Vec3& x) {
    points.emplace_back(u.dot(x - a), v.dot(x - a));
    wedge.add(points.back());
  };
  for (const Vec3& t : piece.corners) add(t);
  for (const Vec3& corner : corners_of(box)) add(corner);
  const Vector2d across = wedge.middle();
  const double norm = across.norm();
  if (!(norm > kAngle)) return false;
  return std::all_of(points.begin(), points.end(), [&](const Vector2d& q) { return across.dot(q) > room * norm; });
}

/// Whether the line goes through a polygon whose plane lies between its ends.
BoxView::Crossing BoxView::crosses(const Blocker& blocker, const Vec3& from, const Vec3& to) const {
  const Vec3 line = to - from;
  const Corner* const c = &corners_[blocker.first_corner];
  bool left = false, right = false;
  for (std::uint32_t i = 0; i < blocker.corner_count; ++i) {
    const Vec3 a = c[i].place - from, edge = c[i + 1 == blocker.corner_count ? 0 : i + 1].place - c[i].place;
    const double turn = a.cross(edge).dot(line);
    if (std::abs(turn) <= kAngle * a.norm() * edge.norm() * line.norm()) return Crossing::unsure;
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return left && right ? Crossing::no : Crossing::yes;
}

// A surface that starts with one polygon, and goes on beyond each edge that a line of sight may meet. If it has no
// other edges there, moving the ends of a line of sight cannot change by an odd number how often the line goes through
// it.
bool BoxView::surface_hides(std::uint32_t first, const Piece& piece, const SightBox& box) const {
  std::array<std::uint32_t, kMostTogether> surface;
  std::size_t count = 1;
  surface[0] = first;
  for (std::size_t done = 0; done < count; ++done) {
    const Blocker& blocker = blockers_[surface[done]];
    for (std::uint32_t i = 0; i < blocker.corner_count; ++i) {
      const Corner& from = corners_[blocker.first_corner + i];
      const std::uint32_t neighbour = from.neighbour;
      const std::span<const std::uint32_t> so_far(surface.data(), count);
      if (std::find(so_far.begin(), so_far.end(), neighbour) != so_far.end()) continue;
      const Corner& to = corners_[blocker.first_corner + (i + 1 == blocker.corner_count ? 0 : i + 1)];
      if (is_clear(from.place, to.place, piece, box)) continue;
      if (neighbour == kNone || count == kMostTogether || !separates(blockers_[neighbour], box)) return false;
      surface[count++] = neighbour;
    }
  }
  std::size_t crossings = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Crossing crossing = crosses(blockers_[surface[i]], piece.centre, box.centre);
    if (crossing == Crossing::unsure) return false;
    crossings += crossing == Crossing::yes ? 1 : 0;
  }
  return crossings % 2 == 1;
}

/// A point as a target is hidden where PointQuery says so: well behind all planes of one blocker.
bool BoxView::hides_point(const Blocker& blocker, const SightBox& box) const {
  const double farthest = (box.centre.cwiseAbs() + box.half).norm();
  for (std::uint32_t p = blocker.first_plane; p < blocker.first_plane + blocker.plane_count; ++p) {
    const Vec3& plane = planes_[p];
    const double least = plane.dot(box.centre) - plane.cwiseAbs().dot(box.half);
    if (!(least > 1 + 2 * exact::tie_margin(std::sqrt(3.0) * plane.norm(), farthest))) return false;
  }
  return true;
}

bool BoxView::hides_all(std::span<const std::uint32_t> blockers, const SightBox& box) const {
  if (is_point_) {
    return std::any_of(blockers.begin(), blockers.end(),
                       [&](std::uint32_t b) { return hides_point(blockers_[b], box); });
  }
  thread_local std::vector<std::uint32_t> between;
  between.clear();
  std::copy_if(blockers.begin(), blockers.end(), std::back_inserter(between),
               [&](std::uint32_t b) { return separates(blockers_[b], box); });
  return hides_piece(between, pieces_[0], box);
}

// By one surface, or each half by others.
bool BoxView::hides_piece(std::span<const std::uint32_t> between, const Piece& piece, const SightBox& box) const {
  int tries = 0;
  for (const std::uint32_t b : between) {
    if (crosses(blockers_[b], piece.centre, box.centre) != Crossing::yes) continue;
    if (surface_hides(b, piece, box)) return true;
    if (++tries == kMostTries) break;
  }
  if (tries == 0 || piece.halves == 0) return false;
  return hides_piece(between, pieces_[piece.halves], box) && hides_piece(between, pieces_[piece.halves + 1], box);
}

}  // namespace vantage::internal::query
