#include "solid/clearance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/edges.h"
#include "core/grown_polygon.h"
#include "core/triangle_tree.h"
#include "core/weld.h"
#include "solid/convex_body.h"
#include "solid/convex_hull.h"
#include "solid/grown_hull.h"
#include "solid/obstacle_shape.h"
#include "solid/surface_turn.h"
#include "vantage/error.h"

namespace vantage::internal::solid {
namespace {

bool meet(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

Box grown(Box box, double by) {
  box.min.array() -= by;
  box.max.array() += by;
  return box;
}

Box box_of(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  return box;
}

/// Preparing a scene drops triangles that hide nothing: those no wider than rounding, of their longest side or of the
/// scene. As obstacles they count. `size`: of the largest coordinate.
bool is_thin(const std::array<Vec3, 3>& corners, double size) {
  constexpr double kThinnest = 1e-6;     // of the longest side
  constexpr double kSmallest = 0x1p-46;  // 16 times what preparing drops, of half of the scene's extent
  const Vec3 u = corners[1] - corners[0], v = corners[2] - corners[0], w = corners[2] - corners[1];
  const double longest = std::sqrt(std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm()}));
  return !(u.cross(v).norm() > std::max(kThinnest * longest, kSmallest * size) * longest);
}

/// Polygons that share corners, by their numbers.
std::vector<std::vector<std::uint32_t>> components_of(const std::vector<Polygon>& polygons) {
  Mesh corners;
  std::vector<std::uint32_t> polygon_of;
  for (std::uint32_t i = 0; i < polygons.size(); ++i) {
    corners.vertices.insert(corners.vertices.end(), polygons[i].begin(), polygons[i].end());
    polygon_of.resize(corners.vertices.size(), i);
  }
  const std::vector<std::uint32_t> first = core::first_at_position(corners.vertices);
  core::DisjointSets sets(polygons.size());
  for (std::size_t v = 0; v < first.size(); ++v) sets.join(polygon_of[v], polygon_of[first[v]]);
  std::vector<std::vector<std::uint32_t>> members(polygons.size());
  for (std::uint32_t i = 0; i < polygons.size(); ++i) members[sets.find(i)].push_back(i);
  std::erase_if(members, [](const auto& component) { return component.empty(); });
  return members;
}

/// Neighbours are united first: what lies inside of them is gone before the rest is looked at.
Solid unite_neighbours(std::span<Solid> solids, const core::ProgressReporter& progress, core::ProgressCounter& done) {
  constexpr std::size_t kFew = 8;  // for one boolean
  if (solids.size() <= kFew) {
    const std::size_t count = solids.size();
    Solid all = unite(solids, progress.part(0, 0));
    done.add(count);
    return all;
  }
  const auto centre = [](const Solid& solid) -> Vec3 { return solid.bounds().min + solid.bounds().max; };
  Box centres;
  for (const Solid& solid : solids) centres.extend(centre(solid));
  Eigen::Index axis = 0;
  (centres.max - centres.min).maxCoeff(&axis);
  const std::size_t half = solids.size() / 2;
  // Sorted all the way: in which order std::nth_element leaves the halves is each standard library's own choice.
  std::stable_sort(solids.begin(), solids.end(),
                   [&](const Solid& a, const Solid& b) { return centre(a)[axis] < centre(b)[axis]; });
  // One after the other: Manifold numbers what it makes, and its results depend on these numbers.
  const Solid low = unite_neighbours(solids.first(half), progress, done);
  const Solid high = unite_neighbours(solids.subspan(half), progress, done);
  return unite(low, high, progress.part(0, 0));
}

/// The part of a convex polygon with a coordinate of at least `at` (`side` 1), or at most (`side` -1).
Polygon part_beyond(const Polygon& polygon, Eigen::Index axis, double at, int side) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double height_a = side * (a[axis] - at), height_b = side * (b[axis] - at);
    if (height_a >= 0) part.push_back(a);
    if ((height_a < 0) == (height_b < 0)) continue;
    Vec3& crossing = part.emplace_back(a + height_a / (height_a - height_b) * (b - a));
    crossing[axis] = at;
  }
  return part;
}

/// Convex polygons about an origin, and how far rounding may have moved their corners.
struct NearObstacles {
  std::vector<Polygon> polygons;
  std::vector<bool> has_normal;  // not of thin ones
  double rounding_m = 0;
};

/// Booleans round to a part of the largest coordinate: of a triangle far larger than the volume only what is near takes
/// part. `near`: about the triangle's origin.
void trim(Polygon& triangle, const Box& near, NearObstacles& obstacles) {
  constexpr double kFarLarger = 64;
  constexpr double kRoundings = 16 * std::numeric_limits<double>::epsilon();  // of six cuts one after the other
  const double size = (near.max - near.min).norm();
  const Box box = box_of(triangle);
  const double farthest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if ((box.max - box.min).maxCoeff() <= kFarLarger * size) return;
  const Box trimmed = grown(near, size);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    triangle = part_beyond(triangle, axis, trimmed.min[axis], 1);
    triangle = part_beyond(triangle, axis, trimmed.max[axis], -1);
  }
  obstacles.rounding_m = std::max(obstacles.rounding_m, kRoundings * farthest);
}

/// Those that hold the triangles which reach into `near`, a box about `origin`.
NearObstacles obstacles_near(const Mesh& obstacles, const Box& near, const Vec3& origin,
                             const core::ProgressReporter& progress) {
  NearObstacles result;
  std::vector<std::array<Vec3, 3>> triangles;
  double size = 0;
  for (std::size_t t = 0; t < obstacles.triangles.size(); ++t) {
    progress.tick();
    if (!meet(core::triangle_box(obstacles, t), {near.min + origin, near.max + origin})) continue;
    Polygon polygon;
    for (const std::uint32_t v : obstacles.triangles[t]) polygon.push_back(obstacles.vertices[v] - origin);
    trim(polygon, near, result);
    for (const Vec3& corner : polygon) size = std::max(size, corner.cwiseAbs().maxCoeff());
    for (std::size_t k = 2; k < polygon.size(); ++k) triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
  }
  Scene scene;
  scene.objects.emplace_back();
  for (const std::array<Vec3, 3>& corners : triangles) {
    if (is_thin(corners, size)) {
      result.polygons.emplace_back(corners.begin(), corners.end());
      result.has_normal.push_back(false);
      continue;
    }
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    scene.mesh.vertices.insert(scene.mesh.vertices.end(), corners.begin(), corners.end());
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
    scene.object_of.push_back(0);
  }
  if (scene.mesh.empty()) return result;
  const Progress ask = [&](std::string_view, double) {
    progress.check();
    return true;
  };
  const PreparedScene prepared(scene, progress.is_followed() ? ask : Progress());
  for (std::uint32_t i = 0; i < prepared.statistics().polygons; ++i) result.polygons.push_back(prepared.polygon(i));
  result.has_normal.resize(result.polygons.size(), true);
  return result;
}

/// What becomes one solid.
struct ToGrow {
  /// A patch is the hull of some polygons of a surface.
  enum class Shape { polygon, prism, hull, patch };

  Shape shape;
  std::vector<Vec3> points;  ///< of a polygon its corners in order
  double aside = 1;          ///< of a prism: see grow_across, in parts of the radius

  /// About so many facets will be grown, and go through the booleans: of a polygon an octagon's for each ring, and one
  /// more for each corner; of a prism six for each corner, of a hull about twelve. Patches cover most of each other:
  /// less than half of that is left for the rounds that follow.
  double facets() const {
    constexpr double kOfRings = 8, kOfTurn = 5, kOfPrism = 6, kOfHull = 12, kOfPatch = 5;
    const auto count = static_cast<double>(points.size());
    switch (shape) {
      case Shape::polygon:
        return kOfRings * (count + kOfTurn);
      case Shape::prism:
        return kOfPrism * count;
      case Shape::hull:
        return kOfHull * count;
      case Shape::patch:
        return kOfPatch * count;
    }
    return 0;
  }
};

/// Makes of the polygons of one component what must grow.
class ComponentGrower {
 public:
  using ReachesVolume = std::function<bool(const Polygon&)>;

  /// `aside`: how far aside of each polygon that lies which is nearest to it, in parts of the radius. `volume`: its
  /// vertices. `centre`: where it begins; none where it may begin anywhere.
  ComponentGrower(const std::vector<Polygon>& polygons, const std::vector<double>& aside,
                  const std::vector<Vec3>& volume, const std::optional<Vec3>& centre, double radius,
                  ReachesVolume reaches_volume)
      : polygons_(polygons),
        aside_(aside),
        volume_(volume),
        centre_(centre),
        radius_(radius),
        reaches_volume_(std::move(reaches_volume)) {}

  void add(const std::vector<std::uint32_t>& members, std::vector<ToGrow>& to_grow) const;

 private:
  bool add_hull(const std::vector<std::uint32_t>& members, ToGrow::Shape shape, std::vector<ToGrow>& to_grow) const;
  void add_polygon(std::uint32_t i, std::vector<ToGrow>& to_grow) const;
  void add_patches(std::span<std::uint32_t> members, std::vector<ToGrow>& to_grow) const;
  bool begins_in_hull(const std::vector<Vec3>& points) const;
  bool begins_in_solid(const std::vector<std::uint32_t>& members) const;

  const std::vector<Polygon>& polygons_;
  const std::vector<double>& aside_;
  const std::vector<Vec3>& volume_;
  std::optional<Vec3> centre_;
  double radius_;
  ReachesVolume reaches_volume_;
};

constexpr double kBeside = 1e-6;  // of the size: on a wall, but for rounding

/// Whether the volume begins inside of the points' hull. Where it begins on a facet, on a wall, that is so unless all
/// of it lies before the facet.
bool ComponentGrower::begins_in_hull(const std::vector<Vec3>& points) const {
  const Box box = box_of(points);
  const double slack = kBeside * (box.max - box.min).norm();
  const Box near = grown(box, slack);
  if ((centre_->array() < near.min.array()).any() || (centre_->array() > near.max.array()).any()) return false;
  const Mesh hull = convex_hull(points);
  return std::none_of(hull.triangles.begin(), hull.triangles.end(), [&](const Triangle& t) {
    const Vec3& a = hull.vertices[t[0]];
    const Vec3 normal = sure_normal(a, hull.vertices[t[1]], hull.vertices[t[2]]).normalized();
    const double height = normal.dot(*centre_ - a);
    if (height > slack) return true;
    return height >= -slack && std::all_of(volume_.begin(), volume_.end(),
                                           [&](const Vec3& vertex) { return normal.dot(vertex - a) >= -slack; });
  });
}

/// Whether the volume begins inside of what closed members bound. Where it begins on them, that is so where a place on
/// the way to one of its vertices is: nothing stands in that way.
bool ComponentGrower::begins_in_solid(const std::vector<std::uint32_t>& members) const {
  constexpr std::size_t kEnough = 500;  // of the vertices
  Mesh surface;
  for (const std::uint32_t i : members) {
    const auto first = static_cast<std::uint32_t>(surface.vertices.size());
    const Polygon& polygon = polygons_[i];
    surface.vertices.insert(surface.vertices.end(), polygon.begin(), polygon.end());
    for (std::uint32_t k = 2; k < polygon.size(); ++k) surface.triangles.push_back({first, first + k - 1, first + k});
  }
  const core::TriangleTree tree(surface);
  const Box box = box_of(surface.vertices);
  const double slack = kBeside * (box.max - box.min).norm();
  const auto is_inside = [&](const Vec3& point) {
    return tree.winding_number(point) != 0 && tree.distance(point) > slack;
  };
  if (tree.distance(*centre_) > slack) return is_inside(*centre_);
  for (std::size_t v = 0; v < volume_.size(); v += 1 + volume_.size() / kEnough) {
    if (is_inside((*centre_ + volume_[v]) / 2)) return true;
  }
  return false;
}

/// What is inside of a closed solid no volume reaches that does not begin there; and what lies in a gap that is
/// narrower than the clearance no vehicle does.
void ComponentGrower::add(const std::vector<std::uint32_t>& members, std::vector<ToGrow>& to_grow) const {
  std::vector<std::uint32_t> near;
  for (const std::uint32_t i : members) {
    if (reaches_volume_(polygons_[i])) near.push_back(i);
  }
  if (near.empty()) return;
  if (!centre_) {
    for (const std::uint32_t i : near) add_polygon(i, to_grow);
    return;
  }
  if (add_hull(members, ToGrow::Shape::hull, to_grow)) return;
  Columns found = columns_of(polygons_, members);
  if (!found.columns.empty() && !begins_in_solid(members)) {
    for (std::vector<Vec3>& column : found.columns) {
      if (reaches_volume_(column)) to_grow.push_back({ToGrow::Shape::hull, std::move(column)});
    }
    near = std::move(found.others);
    std::erase_if(near, [&](std::uint32_t i) { return !reaches_volume_(polygons_[i]); });
  }
  add_patches(near, to_grow);
}

/// False where their hull may not stand for the members.
bool ComponentGrower::add_hull(const std::vector<std::uint32_t>& members, ToGrow::Shape shape,
                               std::vector<ToGrow>& to_grow) const {
  if (!is_nearly_convex(polygons_, members, radius_)) return false;
  std::vector<Vec3> corners = corners_of(polygons_, members);
  if (begins_in_hull(corners)) return false;
  to_grow.push_back({shape, std::move(corners)});
  return true;
}

/// By itself.
void ComponentGrower::add_polygon(std::uint32_t i, std::vector<ToGrow>& to_grow) const {
  const bool is_prism = aside_[i] <= core::kMostAside;
  to_grow.push_back({is_prism ? ToGrow::Shape::prism : ToGrow::Shape::polygon, polygons_[i], aside_[i]});
}

/// Of a surface that is not nearly convex as a whole: of each half, along the longest side, its hull or its halves.
void ComponentGrower::add_patches(std::span<std::uint32_t> members, std::vector<ToGrow>& to_grow) const {
  if (members.empty()) return;
  if (members.size() == 1) return add_polygon(members[0], to_grow);
  const auto centre = [&](std::uint32_t i) -> Vec3 {
    const Box box = box_of(polygons_[i]);
    return box.min + box.max;
  };
  Box centres;
  for (const std::uint32_t i : members) centres.extend(centre(i));
  Eigen::Index axis = 0;
  (centres.max - centres.min).maxCoeff(&axis);
  std::stable_sort(members.begin(), members.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return centre(a)[axis] < centre(b)[axis]; });
  const std::size_t half = members.size() / 2;
  for (const std::span<std::uint32_t> part : {members.first(half), members.subspan(half)}) {
    if (!add_hull({part.begin(), part.end()}, ToGrow::Shape::patch, to_grow)) add_patches(part, to_grow);
  }
}

Solid grown_solid(const ToGrow& what, double radius, std::uint32_t label) {
  Mesh mesh;
  switch (what.shape) {
    case ToGrow::Shape::polygon:
      mesh = core::grow_polygon(what.points, radius);
      break;
    case ToGrow::Shape::prism:
      mesh = core::grow_across(what.points, radius, what.aside * radius);
      break;
    case ToGrow::Shape::hull:
    case ToGrow::Shape::patch:
      mesh = grow_hull(what.points, radius);
      break;
  }
  if (mesh.empty()) throw Error(ErrorCode::internal_defect, "an obstacle did not grow", "clearance", "");
  std::vector<std::uint32_t> labels(mesh.triangles.size(), label);
  return Solid({std::move(mesh), std::move(labels)}, "clearance");
}

/// About as much work as unite_neighbours() will count. It unites solids in pairs, the results in pairs, and so on:
/// log2(solids) rounds, and all facets go into each. Where solids overlap the union has facets more, for which it is
/// multiplied by 1.4. Of the grown triangles of a city's surface the work was 1.7 (of 1,800 triangles) and 1.4 (of
/// 10,000) times facets * log2(solids). Solids that cover each other lose facets in each round: then it is far less.
double work_to_unite(double facets, std::size_t solids) {
  constexpr double kMoreInEachRound = 1.4;
  return solids > 1 ? kMoreInEachRound * facets * std::log2(static_cast<double>(solids)) : 0;
}

}  // namespace

Solid make_clearance(const Clearance& clearance, const Mesh& volume, const std::optional<Vec3>& from,
                     const Vec3& origin, std::uint32_t label, const core::ProgressReporter& progress) {
  const Box bounds = bounding_box(volume);
  const double reach = (1 + core::kMostGrownTooFar) * clearance.distance_m;
  // Merging moves what is in one plane but for rounding by as much, a few roundings of the largest coordinate; and
  // hulls and booleans round to 1e-12 of that about the origin.
  constexpr double kMerging = 1e-14, kBooleans = 4e-12;
  const double largest = std::max(bounds.min.cwiseAbs().maxCoeff(), bounds.max.cwiseAbs().maxCoeff()) + reach;
  const NearObstacles near = obstacles_near(*clearance.obstacles, grown(bounds, reach), origin, progress);
  const std::vector<Polygon>& polygons = near.polygons;
  const double radius =
      clearance.distance_m + kBooleans * largest + kMerging * origin.cwiseAbs().maxCoeff() + near.rounding_m;
  progress.report(0.1);
  const core::TriangleTree tree(volume);
  std::optional<Vec3> centre;
  if (from) centre = *from - origin;
  const auto reaches_volume = [&](const Polygon& polygon) {
    progress.tick();
    const Box box = grown(box_of(polygon), reach);
    if (!meet(box, bounds)) return false;
    const bool is_near = tree.any_near(box, [](std::uint32_t) { return true; });
    return is_near || tree.winding_number(polygon[0]) != 0;
  };
  // Beside a surface that turns little each polygon needs to grow aside by a part of the radius only.
  constexpr double kRounding = 1e-4;  // neighbours overlap by this
  std::vector<double> aside = sines_of_turns(polygons, near.has_normal);
  for (double& sine : aside) sine += kRounding;
  const ComponentGrower grower(polygons, aside, volume.vertices, centre, radius, reaches_volume);
  std::vector<ToGrow> to_grow;
  for (const std::vector<std::uint32_t>& component : components_of(polygons)) grower.add(component, to_grow);
  progress.report(0.2);
  double facets = 0;
  for (const ToGrow& one : to_grow) facets += one.facets();
  progress.expect(work_to_unite(facets, to_grow.size()));
  std::vector<Solid> solids;
  const core::ProgressReporter growing = progress.part(0.2, 0.4), uniting = progress.part(0.4, 1);
  for (const ToGrow& one : to_grow) {
    growing.report(solids.size(), to_grow.size());
    solids.push_back(grown_solid(one, radius, label));
  }
  core::ProgressCounter done(uniting, solids.size());
  return unite_neighbours(std::span(solids), uniting, done);
}

}  // namespace vantage::internal::solid
