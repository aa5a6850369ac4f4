// Scene -> PreparedScene: weld, drop what hides nothing, merge coplanar neighbours, index.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/group_side.h"
#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/read_limits.h"
#include "core/weld.h"
#include "scene/convex_polygons.h"
#include "scene/obstacles.h"
#include "scene/prepared_data.h"
#include "scene/scene_check.h"
#include "vantage/error.h"

namespace vantage {
namespace {

// Coordinates about the scene's origin are right to 2^-53 of the largest of them. So much, times a small number, is
// what rounding may have made of three corners on one line: a triangle less wide than this part of the largest
// coordinate may be none. A narrower margin would keep noise; a wider one would lose wires that are really there.
constexpr double kNoWidth = 0x1p-50;
// What rounding may have put between a plane or a line and the vertices that were computed to be on it: 16 times that.
constexpr double kBent = 0x1p-46;
// In a scene that is so large that these are more than a nanometre its coordinates say less than the scene is to.
constexpr double kMostSlack = 1e-9;

double slack_of(double share, const Box& bounds) {
  const double largest = bounds.empty() ? 0 : 0.5 * (bounds.max - bounds.min).maxCoeff();
  return std::min(share * largest, kMostSlack);
}

struct TriangleSize {
  double length;  ///< of the longest side
  double width;   ///< at right angles to it
};

TriangleSize size_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double length = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
  return {length, length > 0 ? (b - a).cross(c - a).norm() / length : 0};
}

/// Whether each triangle has an area, wherever it lies, and the bounds of those that have: neither a vertex that none
/// uses nor a triangle without area, say one with all of its corners at 0 in a file with map coordinates, may move the
/// scene's origin.
struct Extent {
  std::vector<char> has_area;
  Box bounds;
};

Extent extent_of(const Mesh& mesh) {
  constexpr std::size_t kGrain = 1 << 14;
  Extent extent;
  extent.has_area.resize(mesh.triangles.size());
  std::vector<Box> bounds(mesh.triangles.size() / kGrain + 1);
  internal::parallel::for_ranges(bounds.size(), 1, [&](std::size_t part, std::size_t) {
    for (std::size_t i = part * kGrain; i < std::min(mesh.triangles.size(), (part + 1) * kGrain); ++i) {
      const Triangle& t = mesh.triangles[i];
      const TriangleSize size = size_of(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
      extent.has_area[i] = size.width > kNoWidth * size.length;
      if (!extent.has_area[i]) continue;
      for (const std::uint32_t vertex : t) bounds[part].extend(mesh.vertices[vertex]);
    }
  });
  for (const Box& box : bounds) {
    if (box.empty()) continue;
    extent.bounds.extend(box.min);
    extent.bounds.extend(box.max);
  }
  return extent;
}

// Marks each triangle that has the corners of an earlier one. `triangles` may be marked already.
void mark_duplicates(const std::vector<Triangle>& triangles, std::size_t vertices, std::vector<char>& marks,
                     char duplicate) {
  const auto lowest = [&](const Triangle& t) { return std::min({t[0], t[1], t[2]}); };
  std::vector<std::uint32_t> next(vertices + 1, 0);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (!marks[i]) ++next[lowest(triangles[i]) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<std::uint32_t> at_vertex(next.back());
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    if (!marks[i]) at_vertex[next[lowest(triangles[i])]++] = i;
  internal::parallel::for_ranges(vertices, 4096, [&](std::size_t first, std::size_t last) {
    std::vector<std::pair<Triangle, std::uint32_t>> sorted;
    for (std::size_t vertex = first; vertex < last; ++vertex) {
      const std::size_t begin = vertex == 0 ? 0 : next[vertex - 1];
      if (next[vertex] - begin < 2) continue;
      sorted.clear();
      for (std::size_t k = begin; k < next[vertex]; ++k) {
        Triangle t = triangles[at_vertex[k]];
        std::sort(t.begin(), t.end());
        sorted.emplace_back(t, at_vertex[k]);
      }
      std::sort(sorted.begin(), sorted.end());
      for (std::size_t k = 1; k < sorted.size(); ++k)
        if (sorted[k].first == sorted[k - 1].first) marks[sorted[k].second] = duplicate;
    }
  });
}

struct CleanTriangles {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> object_of;
};

// The object of each vertex: of several, that of the last triangle.
std::vector<std::uint32_t> owners_of(const Scene& scene) {
  std::vector<std::uint32_t> owners(scene.mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < scene.object_of.size(); ++i) {
    for (const std::uint32_t vertex : scene.mesh.triangles[i]) owners[vertex] = scene.object_of[i];
  }
  return owners;
}

// Fills in the vertices of `data`; returns each vertex's number there. In a part of a larger scene no vertices of
// different objects become one: else what is made of an object would depend on its neighbours, and they on theirs.
std::vector<std::uint32_t> weld(const Scene& scene, PreparedScene::Data& data) {
  const std::vector<Vec3>& vertices = scene.mesh.vertices;
  std::vector<Vec3> points(vertices.size());
  internal::parallel::for_ranges(points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = (vertices[i] - data.origin).array() + 0.0;  // -0 becomes 0
  });
  std::vector<std::uint32_t> number = scene.whole ? internal::core::first_at_position(points, owners_of(scene))
                                                  : internal::core::first_at_position(points);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (number[i] != i) {
      number[i] = number[number[i]];
      continue;
    }
    number[i] = static_cast<std::uint32_t>(data.vertices.size());
    data.vertices.push_back(points[i]);
  }
  return number;
}

CleanTriangles weld_and_clean(const Scene& scene, const std::vector<char>& has_area, const Box& bounds,
                              PreparedScene::Data& data) {
  SceneStatistics& statistics = data.statistics;
  const std::vector<std::uint32_t> welded = weld(scene, data);
  const double no_width = slack_of(kNoWidth, bounds);
  enum : char { kept, degenerate, duplicate };
  std::vector<Triangle> triangles(scene.mesh.triangles.size());
  std::vector<char> marks(triangles.size());
  internal::parallel::for_ranges(triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Triangle& t = triangles[i];
      for (std::size_t k = 0; k < 3; ++k) t[k] = welded[scene.mesh.triangles[i][k]];
      const auto width = [&] { return size_of(data.vertices[t[0]], data.vertices[t[1]], data.vertices[t[2]]).width; };
      if (!has_area[i] || width() <= no_width) marks[i] = degenerate;
    }
  });
  mark_duplicates(triangles, data.vertices.size(), marks, duplicate);
  CleanTriangles clean;
  clean.triangles.reserve(triangles.size());
  clean.object_of.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    statistics.degenerate_triangles += marks[i] == degenerate;
    statistics.duplicate_triangles += marks[i] == duplicate;
    if (marks[i] != kept) continue;
    clean.triangles.push_back(triangles[i]);
    clean.object_of.push_back(scene.object_of.empty() ? 0 : scene.object_of[i]);
  }
  return clean;
}

internal::core::Bounds bounds_of(const PreparedScene::Data& data, const internal::scene::ConvexPolygons& polygons,
                                 std::size_t i) {
  Box box;
  for (std::uint32_t k = polygons.first[i]; k < polygons.first[i + 1]; ++k)
    box.extend(data.vertices[polygons.vertices[k]]);
  internal::core::Bounds bounds;
  for (int a = 0; a < 3; ++a) {
    bounds.min[a] = std::nextafterf(static_cast<float>(box.min[a]), -INFINITY);
    bounds.max[a] = std::nextafterf(static_cast<float>(box.max[a]), INFINITY);
  }
  return bounds;
}

/// A square in plan, by the middle of the polygon's bounds; of what is larger than a square a group of its own. Which
/// polygons are in a square does not depend on what part of a scene is there, as long as that has all of them.
std::vector<std::uint64_t> groups_of(const std::vector<internal::core::Bounds>& bounds) {
  constexpr auto kSide = static_cast<float>(internal::core::kGroupSide);
  constexpr std::uint64_t kOwn = std::uint64_t{1} << 63;
  std::vector<std::uint64_t> groups(bounds.size());
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const internal::core::Bounds& own = bounds[i];
    if (own.max[0] - own.min[0] > kSide || own.max[1] - own.min[1] > kSide) {
      groups[i] = kOwn + i;
      continue;
    }
    const auto square = [&](int a) {
      constexpr std::int64_t kPositive = 1 << 30;  // squares: more than there are to either side of the origin
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor((own.min[a] + own.max[a]) / 2 / kSide)) +
                                        kPositive);
    };
    groups[i] = square(0) << 31 | square(1);
  }
  return groups;
}

void store_in_leaf_order(PreparedScene::Data& data, const internal::scene::ConvexPolygons& polygons, bool in_groups) {
  std::vector<internal::core::Bounds> bounds(polygons.count());
  internal::parallel::for_ranges(polygons.count(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) bounds[i] = bounds_of(data, polygons, i);
  });
  std::vector<std::uint32_t> order;
  data.bvh = in_groups ? internal::core::build_bvh_of_groups(bounds, groups_of(bounds), order)
                       : internal::core::build_bvh(bounds, order);
  data.first_vertex.reserve(order.size() + 1);
  data.first_vertex.push_back(0);
  data.polygon_vertices.reserve(polygons.vertices.size());
  data.polygon_object.reserve(order.size());
  for (std::uint32_t i : order) {
    data.polygon_vertices.insert(data.polygon_vertices.end(), polygons.vertices.begin() + polygons.first[i],
                                 polygons.vertices.begin() + polygons.first[i + 1]);
    data.first_vertex.push_back(static_cast<std::uint32_t>(data.polygon_vertices.size()));
    data.polygon_object.push_back(polygons.object[i]);
  }
}

void index_incidence(PreparedScene::Data& data) {
  data.first_incident.assign(data.vertices.size() + 1, 0);
  for (std::uint32_t vertex : data.polygon_vertices) ++data.first_incident[vertex + 1];
  std::partial_sum(data.first_incident.begin(), data.first_incident.end(), data.first_incident.begin());
  data.incident.resize(data.polygon_vertices.size());
  std::vector<std::uint32_t> next(data.first_incident.begin(), data.first_incident.end() - 1);
  for (std::uint32_t polygon = 0; polygon < data.polygon_count(); ++polygon)
    for (std::uint32_t vertex : data.corners_of(polygon)) data.incident[next[vertex]++] = polygon;
}

void check_polygon(const PreparedScene::Data& data, std::uint32_t index) {
  if (index < data.polygon_count()) return;
  throw Error(
      ErrorCode::index_out_of_range,
      "there is no polygon " + std::to_string(index) + ": the scene has " + std::to_string(data.polygon_count()),
      "scene", "count polygons from 0");
}

}  // namespace

PreparedScene::PreparedScene(const Scene& scene, const Progress& callback) {
  internal::scene::check_scene(scene);
  auto data = std::make_shared<Data>();
  data->objects = scene.objects;
  if (data->objects.empty()) data->objects.push_back({"scene", "", ObjectKind::other});
  SceneStatistics& statistics = data->statistics;
  statistics.triangles = scene.mesh.triangles.size();
  statistics.vertices = scene.mesh.vertices.size();
  statistics.objects = data->objects.size();
  const Extent extent = extent_of(scene.mesh);
  statistics.bounds = extent.bounds;
  const Box& bounds = scene.whole ? *scene.whole : statistics.bounds;
  if (!bounds.empty()) data->origin = 0.5 * (bounds.min + bounds.max);
  const internal::core::ProgressReporter progress(callback);
  progress.begin("preparing the scene");
  const CleanTriangles clean = weld_and_clean(scene, extent.has_area, bounds, *data);
  statistics.welded_vertices = data->vertices.size();
  progress.report(0.3);
  const auto polygons = internal::scene::merge_coplanar(data->vertices, clean.triangles, clean.object_of,
                                                        slack_of(kBent, bounds), statistics);
  statistics.polygons = polygons.count();
  progress.report(0.7);
  store_in_leaf_order(*data, polygons, scene.whole.has_value());
  index_incidence(*data);
  if (!scene.overhead.empty()) data->overhead = PreparedScene(internal::scene::overhead_alone(scene)).data_;
  progress.finish();
  data_ = std::move(data);
}

const SceneStatistics& PreparedScene::statistics() const { return data_->statistics; }

const std::vector<SceneObject>& PreparedScene::objects() const { return data_->objects; }

std::vector<Vec3> PreparedScene::polygon(std::uint32_t index) const {
  check_polygon(*data_, index);
  std::vector<Vec3> corners;
  for (const std::uint32_t vertex : data_->corners_of(index))
    corners.push_back(data_->vertices[vertex] + data_->origin);
  return corners;
}

std::uint32_t PreparedScene::object_of_polygon(std::uint32_t index) const {
  check_polygon(*data_, index);
  return data_->polygon_object[index];
}

}  // namespace vantage
