#include "core/solid_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "core/edges.h"
#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/text.h"
#include "core/triangle_contact.h"
#include "core/triangle_tree.h"
#include "core/weld.h"
#include "vantage/error.h"

namespace vantage::internal::core {
namespace {

/// Parts of a mesh that meet less deeply than this times the diagonal of its bounding box count as touching.
/// Single-precision files round each coordinate by 6e-8 of its size, so two walls drawn flush may cross by 2 * sqrt(3)
/// times that, and by a few times more where a narrow triangle is tilted.
constexpr double kTouching = 1e-6;

/// A crossing is looked at again with this part of the touching distance: well above the rounding of coordinates (1e-16
/// of the diagonal), and so little that what is nearer counts as touching anyway.
constexpr double kClosely = 1e-3;

/// How far off a facet, in units of the touching distance, winding numbers are taken: outside the zone in which
/// surfaces count as touching, and still close to the facet.
constexpr double kSampleOffset = 10;

/// A mesh under examination: welded, about the origin.
class Examination {
 public:
  Examination(const Mesh& mesh, std::string name) : local_(mesh), name_(std::move(name)) {
    const Box box = bounding_box(mesh);
    centre_ = (box.min + box.max) / 2;
    distance_ = kTouching * (box.max - box.min).norm();
    for (Vec3& vertex : local_.vertices) vertex -= centre_;
  }

  void check_edges() const;
  void check_volume() const;
  bool check_contacts(const TriangleTree& tree, const ProgressReporter& progress, double folds);
  void check_windings(const TriangleTree& tree, const ProgressReporter& progress) const;

  const Mesh& local() const { return local_; }

 private:
  std::string place(const Vec3& local_point) const { return name_ + ", " + point_text(local_point + centre_); }
  std::array<Vec3, 3> corners(std::size_t t) const {
    const Triangle& triangle = local_.triangles[t];
    return {local_.vertices[triangle[0]], local_.vertices[triangle[1]], local_.vertices[triangle[2]]};
  }
  Vec3 middle(std::size_t t) const {
    const std::array<Vec3, 3> c = corners(t);
    return (c[0] + c[1] + c[2]) / 3;
  }
  int shared_corners(std::size_t a, std::size_t b) const;
  std::size_t first_crossing(std::size_t t, const TriangleTree& tree, const ProgressReporter& progress);
  std::vector<std::size_t> samples() const;

  Mesh local_;
  std::string name_;
  Vec3 centre_;
  double distance_ = 0;         // up to which a contact counts as touching
  std::vector<char> touching_;  // per triangle: meets one that is not its neighbour
};

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

void Examination::check_edges() const {
  std::size_t single = 0, crowded = 0, turned = 0;
  EdgeUse first{};
  for_each_edge(edge_uses(local_.triangles, local_.vertices.size()), [&](std::span<const EdgeUse> edge) {
    const auto forward = std::count_if(edge.begin(), edge.end(), [](const EdgeUse& use) { return use.forward; });
    if (2 * static_cast<std::size_t>(forward) == edge.size()) return;
    if (single + crowded + turned == 0) first = edge[0];
    if (edge.size() == 1) ++single;
    if (edge.size() > 1) ++(edge.size() % 2 == 1 ? crowded : turned);
  });
  if (single + crowded + turned == 0) return;
  const std::string where = name_ + ", first at the edge from " + point_text(local_.vertices[first.low] + centre_) +
                            " to " + point_text(local_.vertices[first.high] + centre_);
  if (single > 0) {
    throw Error(ErrorCode::mesh_not_closed,
                "the mesh is open: " + count_text(single, "edge has", "edges have") + " only one triangle", where,
                "close its holes, so that every edge has two triangles");
  }
  if (crowded > 0) {
    throw Error(
        ErrorCode::mesh_not_closed,
        "the mesh is not closed: " + count_text(crowded, "edge has", "edges have") + " an odd number of triangles",
        where, "remove inner and doubled faces, so that every edge has two triangles");
  }
  throw Error(ErrorCode::mesh_not_oriented,
              "the triangles turn different ways: at " + count_text(turned, "edge", "edges") + " neighbours disagree",
              where, "make all triangles face outward");
}

void Examination::check_volume() const {
  const double volume = enclosed_volume(local_);
  if (volume > surface_area(local_) * distance_) return;
  if (volume >= -surface_area(local_) * distance_) {
    throw Error(ErrorCode::mesh_without_inside, "the mesh encloses no space", name_,
                "give a closed mesh with an inside");
  }
  throw Error(ErrorCode::mesh_inside_out, "the mesh is inside out: its triangles face inward", name_,
              "flip its triangles (reverse their corners)");
}

int Examination::shared_corners(std::size_t a, std::size_t b) const {
  int shared = 0;
  for (const std::uint32_t v : local_.triangles[a]) {
    shared += static_cast<int>(std::count(local_.triangles[b].begin(), local_.triangles[b].end(), v));
  }
  return shared;
}

/// The first triangle that passes through `t`; notes whether `t` touches any at all.
std::size_t Examination::first_crossing(std::size_t t, const TriangleTree& tree, const ProgressReporter& progress) {
  std::size_t first = kNone;
  tree.for_each_near(triangle_box(local_, t), distance_, [&](std::size_t other) {
    progress.tick();
    if (other == t) return;
    const int shared = shared_corners(t, other);
    const Contact contact = contact_of(corners(t), corners(other), shared, distance_);
    // If two triangles pass each other by within the distance, all but parallel, corners are taken to lie in the
    // other's plane, and the rest seems to cross. What truly crosses does so when looked at closely, too.
    const bool is_apart = contact == Contact::crossing &&
                          contact_of(corners(t), corners(other), shared, kClosely * distance_) != Contact::crossing;
    if (contact == Contact::touching || is_apart) touching_[t] = 1;
    if (contact == Contact::crossing && !is_apart) first = std::min(first, other);
  });
  return first;
}

/// Whether no triangle passes through another. Some may, where they are few.
bool Examination::check_contacts(const TriangleTree& tree, const ProgressReporter& progress, double folds) {
  const std::size_t count = local_.triangles.size();
  constexpr std::size_t kGrain = 256;
  touching_.assign(count, 0);
  std::vector<std::size_t> crossing(count, kNone);
  ProgressCounter counter(progress, count);
  parallel::for_ranges(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) crossing[t] = first_crossing(t, tree, progress);
    counter.add(end - begin);
  });
  const auto crosses = [](std::size_t other) { return other != kNone; };
  const auto first = std::find_if(crossing.begin(), crossing.end(), crosses);
  if (first == crossing.end()) return true;
  double folded = 0, whole = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::array<Vec3, 3> c = corners(k);
    const double area = (c[1] - c[0]).cross(c[2] - c[0]).norm();
    whole += area;
    if (crosses(crossing[k])) folded += area;
  }
  if (folded <= folds * whole) return false;
  const auto t = static_cast<std::size_t>(first - crossing.begin());
  const auto triangles = std::count_if(crossing.begin(), crossing.end(), crosses);
  throw Error(ErrorCode::mesh_intersects_itself,
              "the mesh intersects itself: " +
                  count_text(static_cast<std::size_t>(triangles), "triangle passes", "triangles pass") +
                  " through others",
              name_ + ", first the triangles at " + point_text(middle(t) + centre_) + " and " +
                  point_text(middle(*first) + centre_),
              "unite its overlapping parts into one solid");
}

/// Triangles from which the winding number is known everywhere, when none passes through another: the largest of each
/// patch that is bounded by crowded edges, and those that touch others.
std::vector<std::size_t> Examination::samples() const {
  const std::size_t count = local_.triangles.size();
  DisjointSets patches(count);
  for_each_edge(edge_uses(local_.triangles, local_.vertices.size()), [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 2) patches.join(edge[0].triangle, edge[1].triangle);
  });
  const auto area = [&](std::size_t t) {
    const std::array<Vec3, 3> c = corners(t);
    return (c[1] - c[0]).cross(c[2] - c[0]).norm();
  };
  std::vector<std::size_t> largest(count, kNone), result;
  for (std::uint32_t t = 0; t < count; ++t) {
    std::size_t& best = largest[patches.find(t)];
    if (best == kNone || area(t) > area(best)) best = t;
  }
  for (std::size_t t = 0; t < count; ++t) {
    if (touching_[t] || largest[patches.find(static_cast<std::uint32_t>(t))] == t) result.push_back(t);
  }
  return result;
}

void Examination::check_windings(const TriangleTree& tree, const ProgressReporter& progress) const {
  const double offset = kSampleOffset * distance_;
  std::size_t done = 0;
  const std::vector<std::size_t> chosen = samples();
  for (const std::size_t t : chosen) {
    progress.report(done++, chosen.size());
    const std::array<Vec3, 3> c = corners(t);
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const double longest = std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
    if (normal.norm() < 4 * offset * longest) continue;  // too narrow: the sample could lie beyond its neighbours
    for (const double side : {offset, -offset}) {
      const Vec3 point = middle(t) + normal.normalized() * side;
      const int winding = tree.winding_number(point);
      if (winding > 1) {
        throw Error(ErrorCode::mesh_intersects_itself,
                    "parts of the mesh overlap: there is space that lies inside two of them", place(point),
                    "unite its parts into one solid");
      }
      if (winding < 0) {
        throw Error(ErrorCode::mesh_inside_out, "a part of the mesh is inside out: its triangles face inward",
                    place(point), "flip that part's triangles, or put it inside another part if it is a hole");
      }
    }
  }
}

}  // namespace

Mesh checked_solid(const Mesh& mesh, const std::string& name, const ProgressReporter& progress, double folds) {
  if (mesh.empty()) throw Error(ErrorCode::mesh_empty, "the mesh has no triangles", name, "give a closed mesh");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite, "a coordinate is not finite",
                  name + ", vertex " + std::to_string(v), "give numbers");
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto beyond = [&](std::uint32_t v) { return v >= mesh.vertices.size(); };
    if (std::any_of(mesh.triangles[t].begin(), mesh.triangles[t].end(), beyond)) {
      throw Error(ErrorCode::index_out_of_range, "a vertex index is out of range",
                  name + ", triangle " + std::to_string(t), "mend the mesh");
    }
  }
  Mesh result = welded(mesh);
  Examination examination(result, name);
  examination.check_edges();
  examination.check_volume();
  const TriangleTree tree(examination.local());
  // Within a fold space is inside twice, or inside out: all that is known then is that the whole is not.
  if (examination.check_contacts(tree, progress.part(0, 0.7), folds)) {
    examination.check_windings(tree, progress.part(0.7, 1));
  }
  return result;
}

}  // namespace vantage::internal::core
