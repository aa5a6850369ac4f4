#include "prove/maximal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "core/parallel.h"
#include "prove/distance.h"
#include "prove/flat_polygons.h"
#include "prove/orientation.h"
#include "prove/shadow.h"
#include "prove/winding.h"

namespace vantage::internal::prove {
namespace {

constexpr double kUnitRounding = 1.2e-16;
constexpr std::size_t kChunk = 256;     // facets that one thread takes at a time
constexpr std::size_t kKinds = 8;       // of witnesses
constexpr int kMostHalvings = 64;       // of a facet and its pieces, in all
constexpr int kFewHalvings = 12;        // where these leave nearly all of it
constexpr std::size_t kMostRecent = 4;  // polygons that are tried before others are looked for

using FacetPiece = std::array<Vec3, 3>;

/// On a facet that is moved out, and on the facet as it is.
struct FacetPlace {
  Vec3 at = Vec3::Zero(), stored = Vec3::Zero();

  FacetPlace towards(const FacetPlace& other, double part) const {
    return {at + part * (other.at - at), stored + part * (other.stored - stored)};
  }
};

double area_of(const FacetPiece& p) { return (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2; }

std::vector<std::uint32_t> numbers_of(const SceneTree& obstacles) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(obstacles.pieces.size());
  for (const Piece& piece : obstacles.pieces) {
    if (piece.count > 0) numbers.push_back(piece.of);
  }
  return numbers;
}

/// To what is rounded in the facet itself: nothing in front of the target is beyond it.
bool lies_in_target_plane(const Triangle& triangle, const std::vector<Vec3>& vertices, const Beyond& beyond) {
  const View& view = beyond.view;
  if (view.all_sides) return false;
  double largest = 0;
  for (const std::uint32_t v : triangle) largest = std::max(largest, vertices[v].cwiseAbs().maxCoeff());
  const double margin = std::max(view.margin_m, 16 * kUnitRounding * largest) + beyond.rounding_m;
  return std::all_of(triangle.begin(), triangle.end(),
                     [&](std::uint32_t v) { return std::abs(view.normal.dot(vertices[v])) <= margin; });
}

/// Looks at facets one after another, and remembers what it found for those beside them.
class FacetJudge {
 public:
  struct Shared {
    const Beyond& beyond;
    ShadowTarget target;
    FlatPolygons polygons;
    const std::vector<Vec3>& vertices;  ///< as they are
    const std::vector<Vec3>& outer;     ///< moved out
    const std::vector<Triangle>& triangles;
    double farthest_m = 0, largest = 0;
  };
  explicit FacetJudge(const Shared& shared) : shared_(shared) {}

  FacetWitness judge(std::uint32_t facet);
  /// Whether a limit was the witness of a facet that faces away from the target, and may end farther out.
  bool may_return() const { return may_return_; }

 private:
  /// A corner of a piece, and what is known of it.
  struct Corner {
    Vec3 at = Vec3::Zero();      ///< moved out
    Vec3 stored = Vec3::Zero();  ///< as it is
    bool is_asked = false;
    std::vector<std::uint32_t> candidates = {};  ///< triangles of the scene that hide something from it
    std::vector<std::pair<const FlatPolygon*, Hit>> hits = {};
  };
  using Corners = std::array<std::uint32_t, 3>;  ///< of corners_

  std::uint32_t add(const FacetPlace& place) {
    corners_.push_back({place.at, place.stored});
    return static_cast<std::uint32_t>(corners_.size() - 1);
  }
  FacetPiece piece_of(const Corners& c) const { return {corners_[c[0]].at, corners_[c[1]].at, corners_[c[2]].at}; }
  bool is_edge_on(const FacetPiece& piece) const;
  bool is_covered(const Corners& piece, bool is_whole);
  std::array<Corners, 2> halves(const Corners& piece);
  void look_at(const Corners& facet);
  void cover(WitnessKind kind, double area, std::uint32_t limit = 0);
  std::vector<std::array<FacetPlace, 3>> above_floor(const std::array<FacetPlace, 3>& facet) const;
  bool is_out_of_range(const FacetPiece& piece) const;
  std::optional<std::uint32_t> broken_limit(const Corners& piece) const;
  std::optional<Hit> hit(std::uint32_t corner, const FlatPolygon& polygon);
  const std::vector<std::uint32_t>& candidates(std::uint32_t corner);
  bool hidden_by(const Corners& piece, const FlatPolygon& polygon);
  bool is_hidden(const Corners& piece);
  bool has_witness(std::uint32_t corner);
  FacetWitness summary() const;

  const Shared& shared_;
  std::vector<Corner> corners_;
  std::vector<const FlatPolygon*> recent_;
  std::array<double, kKinds> covered_{};
  std::uint32_t limit_ = 0;
  Vec3 outward_ = Vec3::Zero();
  bool is_far_ = false, may_return_ = false;
};

void FacetJudge::cover(WitnessKind kind, double area, std::uint32_t limit) {
  covered_[static_cast<std::size_t>(kind)] += area;
  if (kind != WitnessKind::navigation && kind != WitnessKind::sensor) return;
  limit_ = limit;
  if (is_far_ && !shared_.beyond.limits.limits[limit].begins_once) may_return_ = true;
}

bool FacetJudge::is_edge_on(const FacetPiece& piece) const {
  double largest = 0;
  for (const Vec3& corner : piece) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  if (!(largest > 0)) return true;
  // In parts of the largest coordinate: else the squares of very small ones would be zero.
  const Vec3 normal = ((piece[1] - piece[0]) / largest).cross((piece[2] - piece[0]) / largest);
  const double length = normal.norm();
  return !(length > 0) || std::abs(normal.dot(piece[0] / largest)) <= 16 * kUnitRounding * length;
}

/// What lies so low that no line of sight is told from the target's plane is left out.
std::vector<std::array<FacetPlace, 3>> FacetJudge::above_floor(const std::array<FacetPlace, 3>& facet) const {
  const View& view = shared_.beyond.view;
  if (view.all_sides) return {facet};
  const double floor = shared_.beyond.grow * distance_from(Vec3::Zero(), {facet[0].at, facet[1].at, facet[2].at});
  std::vector<FacetPlace> left;
  for (std::size_t k = 0; k < 3; ++k) {
    const FacetPlace &a = facet[k], &b = facet[(k + 1) % 3];
    const double at_a = view.normal.dot(a.at) - floor, at_b = view.normal.dot(b.at) - floor;
    if (at_a >= 0) left.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) left.push_back(a.towards(b, at_a / (at_a - at_b)));
  }
  std::vector<std::array<FacetPlace, 3>> pieces;
  for (std::size_t k = 2; k < left.size(); ++k) pieces.push_back({left[0], left[k - 1], left[k]});
  return pieces;
}

/// For all of the piece: a corner of the target is farther than the range, and so is it from all that lies beyond, as
/// it is not that far from the origin.
bool FacetJudge::is_out_of_range(const FacetPiece& piece) const {
  const double least = shared_.beyond.range_m - shared_.beyond.tolerance_m + 16 * kUnitRounding * shared_.largest;
  if (!std::isfinite(least)) return false;
  const auto is_far = [&](const Vec3& corner) {
    const auto far = [&](const Vec3& at) { return (at - corner).squaredNorm() >= least * least; };
    return far(piece[0]) && far(piece[1]) && far(piece[2]) && corner.norm() < least &&
           distance_from(corner, piece) >= least;
  };
  return std::any_of(shared_.beyond.view.whole.begin(), shared_.beyond.view.whole.end(), is_far);
}

std::optional<std::uint32_t> FacetJudge::broken_limit(const Corners& piece) const {
  const auto& limits = shared_.beyond.limits.limits;
  if (limits.empty()) return std::nullopt;
  MovedPiece moved{{}, outward_};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& at = corners_[piece[k]].stored;
    moved.corners[k] = at + (shared_.beyond.grow * at.norm() + shared_.beyond.rounding_m) * outward_;
  }
  for (std::uint32_t i = 0; i < limits.size(); ++i) {
    if (limits[i].breaks(moved)) return i;
  }
  return std::nullopt;
}

/// Those that are found are kept.
std::optional<Hit> FacetJudge::hit(std::uint32_t corner, const FlatPolygon& polygon) {
  auto& known = corners_[corner].hits;
  for (const auto& [of, found] : known) {
    if (of == &polygon) return found;
  }
  std::optional<Hit> found = find_hit(corners_[corner].at, polygon, shared_.target);
  if (found) known.emplace_back(&polygon, *found);
  return found;
}

const std::vector<std::uint32_t>& FacetJudge::candidates(std::uint32_t index) {
  Corner& corner = corners_[index];
  if (corner.is_asked) return corner.candidates;
  corner.is_asked = true;
  collect_hiding(corner.at, shared_.target, shared_.beyond.obstacles, corner.candidates);
  std::erase_if(corner.candidates, [&](std::uint32_t triangle) {
    const FlatPolygon* const only = shared_.polygons.only(triangle);
    return !only || !find_hit(corner.at, *only, shared_.target);
  });
  return corner.candidates;
}

bool FacetJudge::hidden_by(const Corners& piece, const FlatPolygon& polygon) {
  std::array<Hit, 3> hits;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = hit(piece[k], polygon);
    if (!found) return false;
    hits[k] = *found;
  }
  const std::array<Vec3, 3> at = {corners_[piece[0]].at, corners_[piece[1]].at, corners_[piece[2]].at};
  return hides(polygon, shared_.target, hits, shared_.farthest_m, shared_.largest) ||
         hides_finely(polygon, shared_.target, at, hits, shared_.farthest_m, shared_.largest);
}

bool FacetJudge::is_hidden(const Corners& piece) {
  const auto remember = [&](const FlatPolygon* polygon) {
    const auto at = std::find(recent_.begin(), recent_.end(), polygon);
    if (at != recent_.end()) recent_.erase(at);
    recent_.insert(recent_.begin(), polygon);
    if (recent_.size() > kMostRecent) recent_.pop_back();
  };
  for (const FlatPolygon* polygon : recent_) {
    if (!hidden_by(piece, *polygon)) continue;
    remember(polygon);
    return true;
  }
  std::vector<const FlatPolygon*> tried;
  for (const std::uint32_t corner : piece) {
    for (const std::uint32_t triangle : candidates(corner)) {
      for (const FlatPolygon* polygon : {shared_.polygons.around(triangle), shared_.polygons.only(triangle)}) {
        if (!polygon || std::find(tried.begin(), tried.end(), polygon) != tried.end()) continue;
        tried.push_back(polygon);
        if (!hidden_by(piece, *polygon)) continue;
        remember(polygon);
        return true;
      }
    }
  }
  return false;
}

/// By itself: else no piece of a facet has one that holds it.
bool FacetJudge::has_witness(std::uint32_t corner) {
  const Vec3 at = corners_[corner].at;
  const Corners point = {corner, corner, corner};
  return (is_far_ && (is_out_of_range({at, at, at}) || is_hidden(point))) || broken_limit(point);
}

/// What a whole piece has as a witness, if anything; its area is counted then.
bool FacetJudge::is_covered(const Corners& corners, bool is_whole) {
  const FacetPiece piece = piece_of(corners);
  const double area = std::max(area_of(piece), std::numeric_limits<double>::min());
  if (!(area_of(piece) > 0) && is_edge_on(piece)) return true;
  if (const auto limit = broken_limit(corners)) {
    cover(shared_.beyond.limits.limits[*limit].kind, area, *limit);
  } else if (is_far_ && is_out_of_range(piece)) {
    cover(WitnessKind::range, area);
  } else if (is_far_ && is_hidden(corners)) {
    cover(is_whole ? WitnessKind::hidden : WitnessKind::hidden_in_pieces, area);
  } else {
    return false;
  }
  return true;
}

/// Across the longest side.
std::array<FacetJudge::Corners, 2> FacetJudge::halves(const Corners& piece) {
  std::size_t longest = 0;
  double most = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = (corners_[piece[k]].at - corners_[piece[(k + 1) % 3]].at).squaredNorm();
    if (length <= most) continue;
    most = length;
    longest = k;
  }
  const std::uint32_t a = piece[longest], b = piece[(longest + 1) % 3], c = piece[(longest + 2) % 3];
  const FacetPlace from{corners_[a].at, corners_[a].stored}, to{corners_[b].at, corners_[b].stored};
  const std::uint32_t middle = add(from.towards(to, 0.5));
  return {{{a, middle, c}, {middle, b, c}}};
}

/// Halved where it has no witness, the largest piece first.
void FacetJudge::look_at(const Corners& facet) {
  if (is_covered(facet, true)) return;
  struct Open {
    double area;
    Corners corners;
    bool operator<(const Open& other) const {
      return area < other.area || (area == other.area && corners < other.corners);
    }
  };
  const double whole = area_of(piece_of(facet));
  double left = whole;
  std::priority_queue<Open> open;
  open.push({whole, facet});
  for (int halved = 0; !open.empty(); ++halved) {
    const Open piece = open.top();
    open.pop();
    const bool goes_on = halved < (left > 0.9 * whole ? kFewHalvings : kMostHalvings);
    const auto has = [&](std::uint32_t corner) { return has_witness(corner); };
    if (!goes_on || std::none_of(piece.corners.begin(), piece.corners.end(), has)) {
      cover(WitnessKind::none, std::max(piece.area, std::numeric_limits<double>::min()));
      continue;
    }
    for (const Corners& half : halves(piece.corners)) {
      const double area = area_of(piece_of(half));
      if (is_covered(half, false)) {
        left -= area;
      } else {
        open.push({area, half});
      }
    }
  }
}

FacetWitness FacetJudge::judge(std::uint32_t facet) {
  const Triangle& t = shared_.triangles[facet];
  if (lies_in_target_plane(t, shared_.vertices, shared_.beyond)) {
    return {WitnessKind::target_plane, 0, 0};
  }
  const auto& outer = shared_.outer;
  const FacetPiece stored = {shared_.vertices[t[0]], shared_.vertices[t[1]], shared_.vertices[t[2]]};
  outward_ = (stored[1] - stored[0]).cross(stored[2] - stored[0]).normalized();
  is_far_ = orientation(outer[t[0]], outer[t[1]], outer[t[2]], Vec3::Zero()) > 0;
  covered_.fill(0);
  corners_.clear();
  const FacetPiece moved = {outer[t[0]], outer[t[1]], outer[t[2]]};
  if (is_far_ && shared_.beyond.limits.limits.empty() && is_out_of_range(moved)) return {WitnessKind::range, 0, 0};
  const std::array<FacetPlace, 3> facet_places = {
      {{moved[0], stored[0]}, {moved[1], stored[1]}, {moved[2], stored[2]}}};
  if (is_edge_on(moved)) {
    const Corners all = {add(facet_places[0]), add(facet_places[1]), add(facet_places[2])};
    const auto limit = broken_limit(all);
    if (!limit) return {WitnessKind::edge_on, 0, 0};
    return {shared_.beyond.limits.limits[*limit].kind, *limit, 0};  // lines from the target do not pass through it
  }
  const auto pieces = above_floor(facet_places);
  if (pieces.empty()) return {WitnessKind::target_plane, 0, 0};
  for (const auto& piece : pieces) look_at({add(piece[0]), add(piece[1]), add(piece[2])});
  return summary();
}

FacetWitness FacetJudge::summary() const {
  double all = 0;
  for (const double area : covered_) all += area;
  const auto most = std::max_element(covered_.begin() + 1, covered_.end());
  if (!(*most > 0)) return {};
  const auto kind = static_cast<WitnessKind>(most - covered_.begin());
  const bool is_limit = kind == WitnessKind::navigation || kind == WitnessKind::sensor;
  const double open = covered_[0] > 0 ? std::max(covered_[0] / all, std::numeric_limits<double>::min()) : 0;
  return {kind, is_limit ? limit_ : 0, open};
}

/// Nothing where it is too near to tell.
std::optional<int> turns_about(const Vec3& point, const std::vector<Vec3>& vertices,
                               const std::vector<Triangle>& triangles) {
  Box box;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) box.extend(vertices[v]);
  }
  Winding winding(point, box);
  for (const auto& [i, j, k] : triangles) winding.add({vertices[i], vertices[j], vertices[k]});
  return winding.turns(0);
}

}  // namespace

std::vector<Vec3> grown(const std::vector<Vec3>& vertices, const Beyond& beyond) {
  std::vector<Vec3> outer;
  outer.reserve(vertices.size());
  for (const Vec3& at : vertices) {
    const double length = at.norm();
    outer.push_back(length > 0 ? Vec3(at * (1 + beyond.grow + beyond.rounding_m / length)) : at);
  }
  return outer;
}

Witnesses find_witnesses(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                         const Beyond& beyond, const core::ProgressReporter& progress) {
  const std::vector<Vec3> outer = grown(vertices, beyond);
  FacetJudge::Shared shared{.beyond = beyond,
                            .target = shadow_target(beyond.view, beyond.point_radius_m),
                            .polygons = FlatPolygons(beyond.scene, beyond.view.origin, numbers_of(beyond.obstacles)),
                            .vertices = vertices,
                            .outer = outer,
                            .triangles = triangles};
  for (const Vec3& at : outer) {
    shared.farthest_m = std::max(shared.farthest_m, at.norm());
    shared.largest = std::max(shared.largest, at.cwiseAbs().maxCoeff());
  }
  for (const Piece& piece : beyond.obstacles.pieces) {
    if (piece.count == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& at = beyond.scene.mesh.vertices[beyond.scene.mesh.triangles[piece.of][k]];
      shared.largest = std::max(shared.largest, (at - beyond.view.origin).cwiseAbs().maxCoeff());
    }
  }
  shared.largest = std::max(shared.largest, shared.target.radius_m);
  const std::size_t chunks = (triangles.size() + kChunk - 1) / kChunk;
  Witnesses found;
  found.facets.resize(triangles.size());
  std::vector<unsigned char> may_return(chunks, 0);
  core::ProgressCounter done(progress, chunks);
  parallel::for_ranges(chunks, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      FacetJudge judge(shared);
      const std::size_t last = std::min(triangles.size(), (chunk + 1) * kChunk);
      for (std::size_t facet = chunk * kChunk; facet < last; ++facet) {
        found.facets[facet] = judge.judge(static_cast<std::uint32_t>(facet));
      }
      may_return[chunk] = judge.may_return() ? 1 : 0;
      done.add(1);
    }
  });
  found.may_return = std::find(may_return.begin(), may_return.end(), 1) != may_return.end();
  return found;
}

std::vector<MaximalCondition> whole_conditions(const std::vector<Vec3>& vertices,
                                               const std::vector<Triangle>& triangles, const Witnesses& witnesses,
                                               const Beyond& beyond) {
  double nearest = std::numeric_limits<double>::infinity(), highest = 0, reach = 0, farthest = 0;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) reach = std::max(reach, vertices[v].norm());
  }
  for (const Triangle& t : triangles) {
    if (lies_in_target_plane(t, vertices, beyond)) {
      for (const std::uint32_t v : t) {
        highest = std::max(highest, std::abs(beyond.view.normal.dot(vertices[v])));
      }
    } else {
      nearest = std::min(nearest, distance_from(Vec3::Zero(), {vertices[t[0]], vertices[t[1]], vertices[t[2]]}));
    }
  }
  for (const Vec3& corner : beyond.view.whole) farthest = std::max(farthest, corner.norm());
  // Half as far as the first facet: above what is left out, or all round.
  const double step = std::isfinite(nearest) ? nearest / 2 : 0;
  const Vec3 just_before = beyond.view.all_sides ? Vec3(Vec3::Zero()) : Vec3(step * beyond.view.normal);
  const bool is_clear = beyond.view.all_sides || highest <= beyond.grow * step;
  const bool is_round =
      step > 64 * kUnitRounding * reach && is_clear && turns_about(just_before, vertices, triangles) == 1;
  std::vector<MaximalCondition> conditions;
  conditions.push_back({"all that is close to the target's centre, in front, is inside", is_round});
  conditions.push_back(
      {"the target's centre is within range of its corners", farthest <= beyond.range_m - beyond.tolerance_m});
  conditions.push_back(
      {"what is beyond a limit stays beyond it, on the lines from the target's centre", !witnesses.may_return});
  return conditions;
}

}  // namespace vantage::internal::prove
