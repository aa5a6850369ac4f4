#include "solid/clean.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "core/crossings.h"
#include "core/edges.h"
#include "core/pieces.h"
#include "core/stars.h"
#include "core/triangle_distance.h"
#include "solid/numerics.h"

namespace vantage::internal::solid {
namespace {

using Corners = std::array<Vec3, 3>;

/// Whether twice the area over the longest side is less than `width`; without roots.
bool is_narrower(const Corners& c, double width) {
  const Vec3 u = c[1] - c[0], v = c[2] - c[0];
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (c[2] - c[1]).squaredNorm()});
  return longest == 0 || u.cross(v).squaredNorm() < width * width * longest;
}

bool names(const Triangle& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

class Cleaner {
 public:
  Cleaner(LabelledMesh& labelled, const Vec3& origin, std::span<const FacetSource> sources,
          const CleaningLimits& limits)
      : labelled_(labelled),
        vertices_(labelled.mesh.vertices),
        triangles_(labelled.mesh.triangles),
        origin_(origin),
        sources_(sources),
        limits_(limits),
        allowance_(limits.allowance_m) {}

  Cleaning run();

 private:
  /// An edge to merge, as it was when it was found.
  struct ShortEdge {
    double length;
    std::uint32_t from, to, from_version, to_version;
    bool operator<(const ShortEdge& other) const {  // the shortest comes first out of a heap
      return std::tie(other.length, other.from, other.to) < std::tie(length, from, to);
    }
  };

  /// A narrow facet whose corner `apex` is near the side between the other two.
  struct Narrow {
    std::uint32_t facet, neighbour;  ///< which shares that side
    std::uint32_t apex, from, to;    ///< the facet's corners, in its turn
    Vec3 foot;                       ///< the point of the side nearest to the apex
  };

  void clean_once();
  bool freeze_crossings(bool with_neighbours);
  void freeze(const std::vector<std::uint32_t>& vertices);
  bool find_suspects();
  void suspect_all_of(std::uint32_t vertex);
  void begin();
  void finish();
  Corners corners(std::uint32_t t) const {
    return {vertices_[triangles_[t][0]], vertices_[triangles_[t][1]], vertices_[triangles_[t][2]]};
  }
  const FacetSource* plane_of(std::uint32_t t) const;
  std::size_t merge_short_edges();
  std::size_t mend_narrow_facets();
  std::optional<Narrow> find_narrow(std::uint32_t t) const;
  bool mend(const Narrow& narrow);
  bool is_frozen(std::uint32_t v) const { return v < frozen_.size() && frozen_[v]; }
  bool can_merge(std::uint32_t u, std::uint32_t v) const;
  bool merge(std::uint32_t u, std::uint32_t v);
  bool merge_somewhere(std::uint32_t u, std::uint32_t v);
  bool merge_at(std::uint32_t u, std::uint32_t v, const Vec3& place);
  std::optional<double> raise_of(std::uint32_t u, std::uint32_t v, const Vec3& place) const;
  std::optional<double> raise_of_facet(std::uint32_t t, std::uint32_t moving, const Vec3& place) const;
  std::optional<Vec3> place_behind(std::uint32_t u, std::uint32_t v) const;

  /// Calls `visit(triangle, moving)` for every triangle that the merged vertex will have; `moving` is its corner that
  /// moves. Stops when that returns false, and returns whether it never did.
  template <typename Visit>
  bool for_each_moving(std::uint32_t u, std::uint32_t v, const Visit& visit) const {
    for (const auto& [moving, other] : {std::pair(u, v), std::pair(v, u)}) {
      for (const std::uint32_t t : stars_->of(moving)) {
        if (!names(triangles_[t], other) && !visit(t, moving)) return false;
      }
    }
    return true;
  }

  LabelledMesh& labelled_;
  std::vector<Vec3>& vertices_;  // relative to origin_ between begin() and finish()
  std::vector<Triangle>& triangles_;
  Vec3 origin_;
  std::span<const FacetSource> sources_;
  CleaningLimits limits_;
  double allowance_;  // of the merge that is tried
  std::optional<core::Stars> stars_;
  std::vector<Vec3> scene_vertices_;    // as they came
  std::vector<char> gone_;              // per triangle
  std::vector<char> suspect_;           // per triangle: it may be narrow; all others are not, nor are their sides short
  std::vector<double> moved_, raised_;  // per vertex: how far anything has moved that is now it, and outward
  std::vector<std::uint32_t> version_;  // per vertex: how often it has moved
  std::vector<std::uint32_t> became_;   // per vertex: the one that it was merged with, or itself
  std::vector<char> frozen_;            // per vertex that came: it must not be merged
  Cleaning result_;
};

/// Those that are narrow, or nearly: coordinates are still rounded in the scene frame.
bool Cleaner::find_suspects() {
  suspect_.resize(triangles_.size());
  bool found = false;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    suspect_[t] = is_narrower(corners(t), 2 * limits_.distance_m);
    found = found || suspect_[t];
  }
  return found;
}

void Cleaner::suspect_all_of(std::uint32_t vertex) {
  for (const std::uint32_t t : stars_->of(vertex)) suspect_[t] = 1;
}

void Cleaner::begin() {
  scene_vertices_ = vertices_;
  for (Vec3& vertex : vertices_) vertex -= origin_;
  stars_.emplace(triangles_, vertices_.size());
  gone_.assign(triangles_.size(), 0);
  moved_.assign(vertices_.size(), 0);
  raised_.assign(vertices_.size(), 0);
  version_.assign(vertices_.size(), 0);
  became_.resize(vertices_.size());
  std::iota(became_.begin(), became_.end(), 0u);
  result_ = {};
}

/// Puts vertices that stayed back bit for bit, and leaves out what is gone.
void Cleaner::finish() {
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    const bool is_as_before = v < scene_vertices_.size() && vertices_[v] == Vec3(scene_vertices_[v] - origin_);
    vertices_[v] = is_as_before ? scene_vertices_[v] : Vec3(vertices_[v] + origin_);
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (gone_[t]) continue;
    triangles_[kept] = triangles_[t];
    labelled_.labels[kept++] = labelled_.labels[t];
  }
  triangles_.resize(kept);
  labelled_.labels.resize(kept);
  core::drop_unused_vertices(labelled_.mesh);
}

/// The plane that a facet must stay in, if there is one.
const FacetSource* Cleaner::plane_of(std::uint32_t t) const {
  if (sources_.empty()) return nullptr;
  const FacetSource& source = sources_[labelled_.labels[t]];
  return source.axis ? &source : nullptr;
}

/// Whether the mesh stays closed with two triangles to an edge: the two vertices may have no common neighbours but the
/// corners across from their edge.
bool Cleaner::can_merge(std::uint32_t u, std::uint32_t v) const {
  if (is_frozen(u) || is_frozen(v)) return false;
  std::vector<std::uint32_t> of_u, of_v, common;
  std::size_t shared = 0;
  for (const std::uint32_t t : stars_->of(u)) {
    of_u.insert(of_u.end(), triangles_[t].begin(), triangles_[t].end());
    shared += names(triangles_[t], v);
  }
  for (const std::uint32_t t : stars_->of(v)) of_v.insert(of_v.end(), triangles_[t].begin(), triangles_[t].end());
  for (std::vector<std::uint32_t>* list : {&of_u, &of_v}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  std::set_intersection(of_u.begin(), of_u.end(), of_v.begin(), of_v.end(), std::back_inserter(common));
  return shared == 2 && common.size() == 4;  // u, v and the two corners
}

/// How far outside of the solid, by the facet, it would come to lie if its corner `moving` went to `place`; nothing
/// when that is too far, when it would turn over or when it would leave a plane that it must stay in. The facet sweeps
/// a tetrahedron; where the place lies behind the facet that is taken from the solid, else it is added, and no point of
/// it is farther outside than the place.
std::optional<double> Cleaner::raise_of_facet(std::uint32_t t, std::uint32_t moving, const Vec3& place) const {
  const FacetSource* const plane = plane_of(t);
  if (plane && place[*plane->axis] != plane->at - origin_[*plane->axis]) return std::nullopt;
  const Corners old = corners(t);
  const Vec3 normal = (old[1] - old[0]).cross(old[2] - old[0]);
  const double length = normal.norm();
  double raise = length > 0 ? std::max(normal.dot(place - old[0]) / length, 0.0) : limits_.distance_m;
  if (raise > allowance_) raise = std::sqrt(core::squared_distance_to_triangle(place, old[0], old[1], old[2]));
  if (raise > allowance_) return std::nullopt;
  if (is_narrower(old, numerics::kTurnable * limits_.distance_m)) return raise;  // too narrow to have a direction
  Corners turned = old;
  for (std::size_t i = 0; i < 3; ++i) {
    if (triangles_[t][i] == moving) turned[i] = place;
  }
  if ((turned[1] - turned[0]).cross(turned[2] - turned[0]).dot(normal) <= 0) return std::nullopt;
  return raise;
}

double merged_anyway_m(const CleaningLimits& limits) {
  return std::min(numerics::kMergeAnyway * limits.distance_m, numerics::kMostRaises * limits.allowance_m);
}

double most_added_m(const CleaningLimits& limits) {
  return numerics::kMostRaises * limits.allowance_m + merged_anyway_m(limits);
}

/// The same of all facets of two vertices that would be merged, with what was raised before.
std::optional<double> Cleaner::raise_of(std::uint32_t u, std::uint32_t v, const Vec3& place) const {
  const double move = std::max(moved_[u] + (place - vertices_[u]).norm(), moved_[v] + (place - vertices_[v]).norm());
  if (move > numerics::kFarthestMove * limits_.distance_m) return std::nullopt;
  double raise = 0;
  const bool fits = for_each_moving(u, v, [&](std::uint32_t t, std::uint32_t moving) {
    const std::optional<double> of_facet = raise_of_facet(t, moving, place);
    if (of_facet) raise = std::max(raise, *of_facet);
    return of_facet.has_value();
  });
  raise += std::max(raised_[u], raised_[v]);
  if (!fits || raise > most_added_m(limits_)) return std::nullopt;
  return raise;
}

/// A point near the middle of two vertices that lies behind all their facets: from the middle, step by step, behind the
/// facet that it lies farthest in front of. There need not be one.
std::optional<Vec3> Cleaner::place_behind(std::uint32_t u, std::uint32_t v) const {
  struct Plane {
    Vec3 normal;
    double at;
    const FacetSource* kept;
  };
  std::vector<Plane> planes;
  for_each_moving(u, v, [&](std::uint32_t t, std::uint32_t) {
    const Corners c = corners(t);
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    const bool has_direction = !is_narrower(c, numerics::kTurnable * limits_.distance_m);
    if (has_direction) planes.push_back({normal, normal.dot(c[0]), plane_of(t)});
    return true;
  });
  constexpr int kSteps = 200;
  Vec3 place = (vertices_[u] + vertices_[v]) / 2;
  for (int step = 0; step < kSteps; ++step) {
    double farthest = 0;
    const Plane* front = nullptr;
    for (const Plane& plane : planes) {
      const double height = plane.normal.dot(place) - plane.at;
      if (!plane.kept && height > farthest) {
        farthest = height;
        front = &plane;
      }
      if (plane.kept) place[*plane.kept->axis] = plane.kept->at - origin_[*plane.kept->axis];
    }
    if (farthest <= limits_.allowance_m / 2) return place;
    place -=
        front->normal * (1.2 * farthest + 0.1 * limits_.allowance_m);  // a little too far: it comes to an end sooner
  }
  return std::nullopt;
}

/// Vertices that all but coincide are merged even where that adds something: as much as they are apart.
bool Cleaner::merge(std::uint32_t u, std::uint32_t v) {
  if (!can_merge(u, v)) return false;
  if (merge_somewhere(u, v)) return true;
  const double length = (vertices_[v] - vertices_[u]).norm();
  if (length > merged_anyway_m(limits_)) return false;
  allowance_ = std::max(length, limits_.allowance_m);
  const bool is_merged = merge_somewhere(u, v);
  allowance_ = limits_.allowance_m;
  return is_merged;
}

bool Cleaner::merge_somewhere(std::uint32_t u, std::uint32_t v) {
  if (merge_at(u, v, vertices_[v]) || merge_at(u, v, vertices_[u])) return true;
  const std::optional<Vec3> behind = place_behind(u, v);
  return behind && merge_at(u, v, *behind);
}

/// u goes, v stays.
bool Cleaner::merge_at(std::uint32_t u, std::uint32_t v, const Vec3& place) {
  const std::optional<double> raise = raise_of(u, v, place);
  if (!raise) return false;
  moved_[v] = std::max(moved_[u] + (place - vertices_[u]).norm(), moved_[v] + (place - vertices_[v]).norm());
  raised_[v] = *raise;
  result_.moved_m = std::max(result_.moved_m, moved_[v]);
  if (vertices_[v] != place) ++version_[v];
  vertices_[v] = place;
  became_[u] = v;
  const std::span<const std::uint32_t> built = stars_->of(u);
  const std::vector<std::uint32_t> star(built.begin(), built.end());
  for (const std::uint32_t t : star) {
    if (names(triangles_[t], v)) {
      gone_[t] = 1;
      for (const std::uint32_t corner : triangles_[t]) stars_->remove(corner, t);
    } else {
      std::replace(triangles_[t].begin(), triangles_[t].end(), u, v);
      stars_->add(v, t);
    }
  }
  stars_->clear(u);
  suspect_all_of(v);
  ++result_.merged;
  return true;
}

/// Merges ends of edges, the shortest first, until no edge is left that can be merged. Returns how many were; tells of
/// those that were not.
std::size_t Cleaner::merge_short_edges() {
  std::priority_queue<ShortEdge> waiting;
  const auto add = [&](std::uint32_t from, std::uint32_t to) {
    const double length = (vertices_[to] - vertices_[from]).norm();
    if (length < limits_.distance_m) waiting.push({length, from, to, version_[from], version_[to]});
  };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (gone_[t] || !suspect_[t]) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = triangles_[t][i], to = triangles_[t][(i + 1) % 3];
      if (from < to) add(from, to);  // the triangle on the other side has it the other way round
    }
  }
  std::size_t merged = 0;
  result_.left = 0;
  while (!waiting.empty()) {
    const ShortEdge edge = waiting.top();
    waiting.pop();
    if (version_[edge.from] != edge.from_version || version_[edge.to] != edge.to_version) continue;
    if (stars_->of(edge.from).empty() || stars_->of(edge.to).empty()) continue;
    if (!merge(edge.from, edge.to)) {
      ++result_.left;
      continue;
    }
    ++merged;
    for (const std::uint32_t t : stars_->of(edge.to)) {
      for (const std::uint32_t other : triangles_[t]) {
        if (other != edge.to) add(edge.to, other);
      }
    }
  }
  return merged;
}

std::optional<Cleaner::Narrow> Cleaner::find_narrow(std::uint32_t t) const {
  const Corners c = corners(t);
  if (!is_narrower(c, limits_.distance_m)) return std::nullopt;
  std::size_t longest = 0;  // the side from corner `longest` to the next
  for (std::size_t i = 1; i < 3; ++i) {
    if ((c[(i + 1) % 3] - c[i]).squaredNorm() > (c[(longest + 1) % 3] - c[longest]).squaredNorm()) longest = i;
  }
  const Vec3 &from = c[longest], &to = c[(longest + 1) % 3], &apex = c[(longest + 2) % 3];
  const double along = (to - from).dot(apex - from) / (to - from).squaredNorm();
  Narrow narrow{t,
                t,
                triangles_[t][(longest + 2) % 3],
                triangles_[t][longest],
                triangles_[t][(longest + 1) % 3],
                from + along * (to - from)};
  // Near an end it is that edge which is short.
  if ((narrow.foot - from).norm() < limits_.distance_m || (narrow.foot - to).norm() < limits_.distance_m) {
    return std::nullopt;
  }
  for (const std::uint32_t other : stars_->of(narrow.from)) {
    if (other != t && names(triangles_[other], narrow.to)) narrow.neighbour = other;
  }
  if (narrow.neighbour == t || names(triangles_[narrow.neighbour], narrow.apex)) return std::nullopt;
  return narrow;
}

/// Splits the side at the foot, and merges that with the apex; undoes the split when they do not merge.
bool Cleaner::mend(const Narrow& narrow) {
  const auto& [facet, neighbour, apex, from, to, foot] = narrow;
  const Triangle old_facet = triangles_[facet], old_neighbour = triangles_[neighbour];
  const auto middle = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back(foot);
  gone_.resize(triangles_.size() + 2, 0);
  suspect_.resize(triangles_.size() + 2, 1);
  moved_.push_back(0);
  raised_.push_back(0);
  version_.push_back(0);
  became_.push_back(middle);
  stars_->add_vertex();
  std::array<std::uint32_t, 2> added{};
  std::size_t count = 0;
  for (const std::uint32_t t :
       {facet, neighbour}) {  // `t` keeps the part at `from`, a new triangle has the one at `to`
    Triangle part = triangles_[t];
    std::replace(part.begin(), part.end(), from, middle);
    std::replace(triangles_[t].begin(), triangles_[t].end(), to, middle);
    added[count++] = static_cast<std::uint32_t>(triangles_.size());
    triangles_.push_back(part);
    labelled_.labels.push_back(labelled_.labels[t]);
    stars_->remove(to, t);
    stars_->add(middle, t);
    for (const std::uint32_t v : part) stars_->add(v, added[count - 1]);
  }
  if (merge(middle, apex)) return true;
  for (const std::uint32_t t : added) {
    for (const std::uint32_t v : triangles_[t]) stars_->remove(v, t);
  }
  for (const auto& [t, old] : {std::pair(facet, old_facet), std::pair(neighbour, old_neighbour)}) {
    triangles_[t] = old;
    stars_->add(to, t);
  }
  triangles_.resize(triangles_.size() - 2);
  labelled_.labels.resize(triangles_.size());
  gone_.resize(triangles_.size());
  suspect_.resize(triangles_.size());
  vertices_.pop_back();
  moved_.pop_back();
  raised_.pop_back();
  version_.pop_back();
  became_.pop_back();
  stars_->clear(middle);
  stars_->remove_vertex();
  return false;
}

std::size_t Cleaner::mend_narrow_facets() {
  std::size_t mended = 0;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (gone_[t] || !suspect_[t]) continue;
    const std::optional<Narrow> narrow = find_narrow(t);
    if (narrow && mend(*narrow)) ++mended;
  }
  return mended;
}

void Cleaner::clean_once() {
  begin();
  constexpr int kRounds = 6;  // after three nothing changes any more, as a rule
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t merged = merge_short_edges();
    if (mend_narrow_facets() == 0 && merged == 0) break;
  }
}

/// Freezes all that was merged to become one of `vertices`, which are sorted.
void Cleaner::freeze(const std::vector<std::uint32_t>& vertices) {
  for (std::uint32_t v = 0; v < frozen_.size(); ++v) {
    std::uint32_t now = v;
    while (became_[now] != now) now = became_[now];
    if (std::binary_search(vertices.begin(), vertices.end(), now)) frozen_[v] = 1;
  }
}

/// Where the solid is thinner than vertices move, a facet that goes inward may come out on the other side. Freezes the
/// vertices that had moved of facets that pass through each other now, and of facets beside these. False where there
/// are none.
bool Cleaner::freeze_crossings(bool with_neighbours) {
  if (result_.merged == 0 || !limits_.is_checked) return false;
  Mesh mesh{vertices_, {}};
  std::vector<std::uint32_t> changed;
  const auto has_moved = [&](std::uint32_t v) { return moved_[v] > 0; };
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (gone_[t]) continue;
    const Triangle& triangle = triangles_[t];
    if (std::any_of(triangle.begin(), triangle.end(), has_moved)) {
      changed.push_back(static_cast<std::uint32_t>(mesh.triangles.size()));
    }
    mesh.triangles.push_back(triangle);
  }
  std::vector<std::uint32_t> met;
  for (const auto& [a, b] : core::find_crossings(mesh, changed, most_added_m(limits_))) {
    for (const std::uint32_t t : {a, b}) {
      std::copy_if(mesh.triangles[t].begin(), mesh.triangles[t].end(), std::back_inserter(met), has_moved);
    }
  }
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  const std::size_t count = met.size();
  for (std::size_t i = 0; i < count && with_neighbours; ++i) {
    for (const std::uint32_t t : stars_->of(met[i])) {
      std::copy_if(triangles_[t].begin(), triangles_[t].end(), std::back_inserter(met), has_moved);
    }
  }
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  freeze(met);
  return !met.empty();
}

Cleaning Cleaner::run() {
  if (!find_suspects()) return {};
  const LabelledMesh as_it_came = labelled_;
  const std::vector<char> suspect = suspect_;
  frozen_.assign(vertices_.size(), 0);
  constexpr int kAttempts = 12;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    clean_once();
    if (!freeze_crossings(attempt > 0)) {  // the first time they are many
      finish();
      if (result_.merged > 0) core::drop_slivers(labelled_, 0);  // a thin piece may have been turned inside out
      return result_;
    }
    labelled_ = as_it_came;
    suspect_ = suspect;
  }
  return {};
}

}  // namespace

CleaningLimits cleaning_limits(double tolerance_m, double allowance_m, const Box& scene_bounds) {
  const double largest = std::max(scene_bounds.min.cwiseAbs().maxCoeff(), scene_bounds.max.cwiseAbs().maxCoeff());
  const double diagonal = (scene_bounds.max - scene_bounds.min).norm();
  const double wanted = std::min(numerics::kCleanPart * tolerance_m, numerics::kCleanLargest * diagonal);
  const double resolved = std::max(allowance_m, std::numeric_limits<double>::epsilon() * largest);
  return {std::max(wanted, numerics::kCleanEpsilons * resolved), allowance_m};
}

Cleaning clean_inward(LabelledMesh& labelled, const Vec3& origin, std::span<const FacetSource> sources,
                      const CleaningLimits& limits) {
  return Cleaner(labelled, origin, sources, limits).run();
}

}  // namespace vantage::internal::solid
