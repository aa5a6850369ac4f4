// Scene -> PreparedScene: weld, drop what hides nothing, merge coplanar neighbours, index.
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <unordered_set>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/read_limits.h"
#include "scene/convex_polygons.h"
#include "scene/prepared_data.h"
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

std::uint64_t mix(std::uint64_t x) {  // splitmix64's finalizer
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

// Maps each vertex to the first one at exactly the same place. Open addressing: half a million vertices are usual.
class Welder {
 public:
  explicit Welder(std::size_t count) : mask_(std::bit_ceil(2 * count + 1) - 1), slots_(mask_ + 1, kFree) {}

  std::uint32_t add(const Vec3& point) {
    const Vec3 p = point.array() + 0.0;  // -0 becomes 0
    std::uint64_t hash = 0;
    for (int a = 0; a < 3; ++a) hash = mix(hash + 0x9e3779b97f4a7c15ull + std::bit_cast<std::uint64_t>(p[a]));
    for (std::size_t slot = hash & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot] == kFree) {
        slots_[slot] = static_cast<std::uint32_t>(points.size());
        points.push_back(p);
        return slots_[slot];
      }
      if (points[slots_[slot]] == p) return slots_[slot];
    }
  }

  std::vector<Vec3> points;

 private:
  static constexpr std::uint32_t kFree = ~0u;
  std::size_t mask_;
  std::vector<std::uint32_t> slots_;
};

struct TriangleSize {
  double length;  ///< of the longest side
  double width;   ///< at right angles to it
};

TriangleSize size_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double length = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
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
  Extent extent;
  extent.has_area.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const TriangleSize size = size_of(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    extent.has_area.push_back(size.width > kNoWidth * size.length);
    if (!extent.has_area.back()) continue;
    for (const std::uint32_t vertex : t) extent.bounds.extend(mesh.vertices[vertex]);
  }
  return extent;
}

struct TriangleHash {
  std::size_t operator()(const Triangle& t) const { return mix(mix(mix(t[0] + 0x9e3779b97f4a7c15ull) + t[1]) + t[2]); }
};

struct CleanTriangles {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> object_of;
};

CleanTriangles weld_and_clean(const Scene& scene, const std::vector<char>& has_area, PreparedScene::Data& data) {
  SceneStatistics& statistics = data.statistics;
  Welder welder(scene.mesh.vertices.size());
  std::vector<std::uint32_t> welded;
  welded.reserve(scene.mesh.vertices.size());
  for (const Vec3& v : scene.mesh.vertices) welded.push_back(welder.add(v - data.origin));
  data.vertices = std::move(welder.points);

  CleanTriangles clean;
  const double no_width = slack_of(kNoWidth, statistics.bounds);
  std::unordered_set<Triangle, TriangleHash> seen;
  seen.reserve(scene.mesh.triangles.size());
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    Triangle t = scene.mesh.triangles[i];
    for (std::uint32_t& corner : t) corner = welded[corner];
    if (!has_area[i] || size_of(data.vertices[t[0]], data.vertices[t[1]], data.vertices[t[2]]).width <= no_width) {
      ++statistics.degenerate_triangles;
      continue;
    }
    Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    if (!seen.insert(sorted).second) {
      ++statistics.duplicate_triangles;
      continue;
    }
    clean.triangles.push_back(t);
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

void store_in_leaf_order(PreparedScene::Data& data, const internal::scene::ConvexPolygons& polygons) {
  std::vector<internal::core::Bounds> bounds(polygons.count());
  internal::parallel::for_ranges(polygons.count(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) bounds[i] = bounds_of(data, polygons, i);
  });
  std::vector<std::uint32_t> order;
  data.bvh = internal::core::build_bvh(bounds, order);
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

void check(const Scene& scene) {
  const auto refuse = [](ErrorCode code, std::string problem,
                         const char* fix = "give each triangle three vertices and an object") {
    throw Error(code, std::move(problem), "scene made in memory", fix);
  };
  const std::size_t objects = std::max<std::size_t>(1, scene.objects.size());
  if (!scene.object_of.empty() && scene.object_of.size() != scene.mesh.triangles.size())
    refuse(ErrorCode::array_sizes_differ, "object_of has " + std::to_string(scene.object_of.size()) + " entries for " +
                                              std::to_string(scene.mesh.triangles.size()) + " triangles");
  for (std::uint32_t object : scene.object_of)
    if (object >= objects)
      refuse(ErrorCode::index_out_of_range, "object index " + std::to_string(object) + " is out of range");
  for (const Triangle& t : scene.mesh.triangles)
    for (std::uint32_t corner : t)
      if (corner >= scene.mesh.vertices.size())
        refuse(ErrorCode::index_out_of_range, "vertex index " + std::to_string(corner) + " is out of range");
  for (std::size_t i = 0; i < scene.mesh.vertices.size(); ++i) {
    const Vec3& v = scene.mesh.vertices[i];
    if (!v.allFinite())
      refuse(ErrorCode::coordinate_not_finite, "vertex " + std::to_string(i) + " is not finite", "give three numbers");
    if (v.cwiseAbs().maxCoeff() > internal::core::kMaxCoordinate)
      refuse(ErrorCode::coordinate_too_large,
             "vertex " + std::to_string(i) + " is more than " +
                 std::to_string(static_cast<long>(internal::core::kMaxCoordinate / 1000)) + " km from the origin",
             "give coordinates in metres");
  }
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
  check(scene);
  auto data = std::make_shared<Data>();
  data->objects = scene.objects;
  if (data->objects.empty()) data->objects.push_back({"scene", "", ObjectKind::other});
  SceneStatistics& statistics = data->statistics;
  statistics.triangles = scene.mesh.triangles.size();
  statistics.vertices = scene.mesh.vertices.size();
  statistics.objects = data->objects.size();
  const Extent extent = extent_of(scene.mesh);
  statistics.bounds = extent.bounds;
  if (!statistics.bounds.empty()) data->origin = 0.5 * (statistics.bounds.min + statistics.bounds.max);
  const internal::core::ProgressReporter progress(callback);
  progress.begin("preparing the scene");
  const CleanTriangles clean = weld_and_clean(scene, extent.has_area, *data);
  statistics.welded_vertices = data->vertices.size();
  progress.report(0.3);
  const auto polygons = internal::scene::merge_coplanar(data->vertices, clean.triangles, clean.object_of,
                                                        slack_of(kBent, statistics.bounds), statistics);
  statistics.polygons = polygons.count();
  progress.report(0.7);
  store_in_leaf_order(*data, polygons);
  index_incidence(*data);
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
