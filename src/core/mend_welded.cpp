#include "core/mend_welded.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "core/edges.h"
#include "core/pieces.h"
#include "core/stars.h"
#include "core/weld.h"

namespace vantage::internal::core {
namespace {

inline bool is_flat(const Triangle& t, const std::vector<Vec3>& vertices, double flat) {
  const Vec3 &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
  const Vec3 to_b = b - a, to_c = c - a, normal = to_b.cross(to_c);
  if (flat == 0) return normal.isZero(0);
  const double longest = std::max({to_b.squaredNorm(), (c - b).squaredNorm(), to_c.squaredNorm()});
  return normal.squaredNorm() <= flat * flat * longest;
}

class Mender {
 public:
  Mender(LabelledMesh& labelled, double flat)
      : labelled_(labelled),
        vertices_(labelled.mesh.vertices),
        triangles_(labelled.mesh.triangles),
        flat_(flat),
        owner_sets_(labelled.mesh.vertices.size()) {}

  bool run();
  // A facet with two corners in one place is flat too. So a mesh without flaws is told without sorting its vertices.
  bool has_flaws() const { return has_narrow_facets(labelled_.mesh, flat_); }

 private:
  struct Waiting {
    double length;  // of its longest side
    std::uint32_t triangle;
    bool operator<(const Waiting& other) const {  // the longest comes first out of a heap
      return std::tie(length, other.triangle) < std::tie(other.length, triangle);
    }
  };

  bool is_collapsed(const Triangle& t) const { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }
  bool is_flat(const Triangle& t) const { return core::is_flat(t, vertices_, flat_); }
  void weld(const std::vector<std::uint32_t>& first);
  void cancel_facing();
  void remove(std::uint32_t t);
  bool cancel(std::uint32_t t);
  std::size_t longest_side(std::uint32_t t) const;
  double side_length(std::uint32_t t, std::size_t side) const {
    return (vertices_[triangles_[t][(side + 1) % 3]] - vertices_[triangles_[t][side]]).norm();
  }
  std::optional<std::uint32_t> across(std::uint32_t t, std::size_t side) const;
  void take_in(std::uint32_t t);
  void turn_sides();
  void finish();

  LabelledMesh& labelled_;
  std::vector<Vec3>& vertices_;
  std::vector<Triangle>& triangles_;
  double flat_;
  // Per corner of each triangle the vertex that it was before welding: surfaces that only touch stay apart by it.
  std::vector<Triangle> owners_;
  DisjointSets owner_sets_;  // of such vertices that have become one
  std::optional<Stars> stars_;
  std::vector<char> gone_;
  std::priority_queue<Waiting> flat_facets_;
};

void Mender::remove(std::uint32_t t) {
  gone_[t] = 1;
  for (const std::uint32_t v : triangles_[t]) stars_->remove(v, t);
}

/// One vertex for each place; facets with two corners in one place go. `first`: per vertex the first one in its place.
void Mender::weld(const std::vector<std::uint32_t>& first) {
  owners_ = triangles_;
  for (Triangle& t : triangles_) t = {first[t[0]], first[t[1]], first[t[2]]};
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (is_collapsed(triangles_[t])) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (triangles_[t][i] == triangles_[t][next]) owner_sets_.join(owners_[t][i], owners_[t][next]);
      }
      continue;
    }
    triangles_[kept] = triangles_[t];
    owners_[kept] = owners_[t];
    labelled_.labels[kept++] = labelled_.labels[t];
  }
  triangles_.resize(kept);
  owners_.resize(kept);
  labelled_.labels.resize(kept);
  stars_.emplace(triangles_, vertices_.size());
  gone_.assign(kept, 0);
}

void Mender::cancel_facing() {
  for (const std::uint32_t t : facing_facets(triangles_)) remove(t);
}

/// Removes a facet together with one on the same corners that faces it, where there is one.
bool Mender::cancel(std::uint32_t t) {
  const auto& [a, b, c] = triangles_[t];
  for (const std::uint32_t other : stars_->of(a)) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Triangle& o = triangles_[other];
      if (o[i] != a || o[(i + 1) % 3] != c || o[(i + 2) % 3] != b) continue;
      remove(t);
      remove(other);
      return true;
    }
  }
  return false;
}

/// The side from that corner to the next.
std::size_t Mender::longest_side(std::uint32_t t) const {
  std::size_t longest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (side_length(t, i) > side_length(t, longest)) longest = i;
  }
  return longest;
}

/// A facet that runs a side in the other direction; of several one that is not flat.
std::optional<std::uint32_t> Mender::across(std::uint32_t t, std::size_t side) const {
  const std::uint32_t from = triangles_[t][side], to = triangles_[t][(side + 1) % 3];
  std::optional<std::uint32_t> found;
  for (const std::uint32_t other : stars_->of(from)) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (triangles_[other][i] != to || triangles_[other][(i + 1) % 3] != from) continue;
      if (!found || (is_flat(triangles_[*found]) && !is_flat(triangles_[other]))) found = other;
    }
  }
  return found;
}

/// A facet that is new, or is looked at for the first time.
void Mender::take_in(std::uint32_t t) {
  if (gone_[t] || cancel(t) || !is_flat(triangles_[t])) return;
  flat_facets_.push({side_length(t, longest_side(t)), t});
}

/// The flat facet with the longest side of all gives its third corner, b, to the facet across: (c, a, b) and (a, c, x)
/// become (a, b, x) and (b, c, x). On one line b and x lie between a and c, so the side b x that comes is shorter than
/// the side a c that goes, and an end is reached. Narrow facets that are not quite flat may turn in circles: so many
/// turns for each of them are far more than others need.
void Mender::turn_sides() {
  const std::size_t turns = flat_ == 0 ? 16 * triangles_.size() : 64 * flat_facets_.size();
  std::size_t left = 64 + std::min(turns, 16 * triangles_.size());
  while (!flat_facets_.empty() && left-- > 0) {
    const std::uint32_t t = flat_facets_.top().triangle;
    const double length = flat_facets_.top().length;
    flat_facets_.pop();
    if (gone_[t] || !is_flat(triangles_[t])) continue;
    const std::size_t side = longest_side(t);
    if (side_length(t, side) != length) continue;  // it has changed and waits again
    const std::optional<std::uint32_t> other = across(t, side);
    if (!other) continue;  // of an open mesh
    const std::uint32_t c = triangles_[t][side], a = triangles_[t][(side + 1) % 3], b = triangles_[t][(side + 2) % 3];
    const Triangle of_t = owners_[t], of_other = owners_[*other];
    const std::uint32_t of_c = of_t[side], of_a = of_t[(side + 1) % 3], of_b = of_t[(side + 2) % 3];
    std::uint32_t x = 0, of_x = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t v = triangles_[*other][i];
      if (v == a || v == c) {
        owner_sets_.join(of_other[i], v == a ? of_a : of_c);
      } else {
        x = v;
        of_x = of_other[i];
      }
    }
    remove(t);
    remove(*other);
    if (x == b) continue;  // they faced each other
    gone_[t] = gone_[*other] = 0;
    triangles_[t] = {a, b, x};
    triangles_[*other] = {b, c, x};
    owners_[t] = {of_a, of_b, of_x};
    owners_[*other] = {of_b, of_c, of_x};
    labelled_.labels[t] = labelled_.labels[*other];
    for (const std::uint32_t made : {t, *other}) {
      for (const std::uint32_t v : triangles_[made]) stars_->add(v, made);
    }
    take_in(t);
    take_in(*other);
  }
}

/// Leaves out what is gone and gives each fan of facets a vertex of its own.
void Mender::finish() {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (gone_[t]) continue;
    triangles_[kept] = triangles_[t];
    for (std::size_t i = 0; i < 3; ++i) owners_[kept][i] = owner_sets_.find(owners_[t][i]);
    labelled_.labels[kept++] = labelled_.labels[t];
  }
  triangles_.resize(kept);
  owners_.resize(kept);
  labelled_.labels.resize(kept);
  split_where_pieces_touch(labelled_.mesh, owners_);
  drop_unused_vertices(labelled_.mesh);
}

bool Mender::run() {
  if (!has_flaws()) return false;
  const std::vector<std::uint32_t> first = first_at_position(vertices_);
  weld(first);
  cancel_facing();
  std::vector<char> is_welded(vertices_.size(), 0);
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (first[v] != v) is_welded[first[v]] = 1;
  }
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    if (is_welded[a] || is_welded[b] || is_welded[c] || is_flat(triangles_[t])) take_in(t);
  }
  turn_sides();
  finish();
  return true;
}

}  // namespace

bool mend_welded(LabelledMesh& labelled, double flat_m) { return Mender(labelled, flat_m).run(); }

void take_out_facing_facets(LabelledMesh& labelled) {
  std::vector<Triangle>& triangles = labelled.mesh.triangles;
  const std::vector<std::uint32_t> facing = facing_facets(triangles);
  if (facing.empty()) return;
  std::vector<char> gone(triangles.size(), 0);
  for (const std::uint32_t t : facing) gone[t] = 1;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (gone[t]) continue;
    triangles[kept] = triangles[t];
    labelled.labels[kept++] = labelled.labels[t];
  }
  triangles.resize(kept);
  labelled.labels.resize(kept);
  drop_unused_vertices(labelled.mesh);
}

bool split_shared_edges(LabelledMesh& labelled) {
  const SplitEdges split = split_shared_edges(labelled.mesh);
  for (const std::uint32_t whole : split.part_of) {
    const std::uint32_t label = labelled.labels[whole];
    labelled.labels.push_back(label);
  }
  return split.is_done;
}

double split_on_grid(LabelledMesh& labelled, const std::function<Vec3(const Vec3&)>& place) {
  constexpr int kRounds = 4;
  double moved = 0;
  take_out_facing_facets(labelled);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Vec3>& vertices = labelled.mesh.vertices;
    const std::size_t before = vertices.size();
    split_shared_edges(labelled);
    double farthest = 0;
    for (std::size_t v = before; v < vertices.size(); ++v) {
      const Vec3 at = place(vertices[v]);
      farthest = std::max(farthest, (at - vertices[v]).norm());
      vertices[v] = at;
    }
    moved += farthest;
    if (vertices.size() == before || !mend_welded(labelled, 0)) break;
  }
  return moved;
}

std::optional<double> mend_for_doubles(LabelledMesh& labelled) {
  const double flat = flat_width(labelled.mesh);
  if (!Mender(labelled, flat).has_flaws()) return std::nullopt;
  LabelledMesh mended = labelled;
  mend_welded(mended, flat);
  if (!Mender(mended, flat).has_flaws()) {
    constexpr double kLeast = 0.25;  // halves are half as wide, and few are halved again
    if (split_shared_edges(mended) && !Mender(mended, kLeast * flat).has_flaws()) {
      labelled = std::move(mended);
      return flat;
    }
  }
  // A grid as coarse as that: what is flat on it is so exactly, and turning sides comes to an end.
  double moved = 0;
  for (Vec3& vertex : labelled.mesh.vertices) {
    const Vec3 place = (vertex / flat).array().round() * flat;
    moved = std::max(moved, (place - vertex).norm());
    vertex = place;
  }
  mend_welded(labelled, 0);
  return moved + split_on_grid(labelled, [](const Vec3& middle) { return middle; });
}

bool has_narrow_facets(const Mesh& mesh, double flat_m) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return is_flat(t, mesh.vertices, flat_m); });
}

double flat_width(const Mesh& mesh) {
  constexpr double kSteps = 4;
  if (mesh.empty()) return 0;
  double largest = 0;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      for (const double coordinate : mesh.vertices[v]) largest = std::max(largest, std::abs(coordinate));
    }
  }
  int exponent = 0;
  std::frexp(largest, &exponent);  // largest < 2^exponent
  return kSteps * std::ldexp(1.0, exponent - std::numeric_limits<double>::digits);
}

}  // namespace vantage::internal::core
