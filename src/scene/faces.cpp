#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/bvh.h"
#include "core/edges.h"
#include "core/parallel.h"
#include "core/portable_math.h"
#include "core/walk_bvh.h"
#include "core/weld.h"
#include "scene/convex_polygons.h"
#include "scene/face_cover.h"
#include "scene/plane_pieces.h"
#include "scene/triangle_index.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage {

namespace portable = internal::portable;

using internal::scene::FacePlane;
using internal::scene::PlanePieces;
using internal::scene::Side;
using internal::scene::TriangleCorners;
using internal::scene::TriangleIndex;

namespace {

constexpr double kSteepest = 0.25881904510252074;  // sine of 15 degrees
constexpr double kUpright = 5e-7;                  // half of what a target is taken to be upright by
constexpr double kOffPlane = 5e-4;                 // metres, of the corners of one face
constexpr double kLeastArea = 1;                   // square metres
// Triangles no wider than this may be turned any way by what rounds their corners, metres.
constexpr double kNoDirection = 1e-3;
constexpr double kSameDirection = 0.996;  // cosine of 5 degrees
// What rounding does to coordinates, in parts of the largest: as internal::numerics::kRoundings.
constexpr double kRounding = 8 * 0x1p-53;
constexpr double kNothing = 1e-9;  // metres: as internal::numerics::kOnTarget

Vec3 area_vector_of(const TriangleCorners& c) { return (c[1] - c[0]).cross(c[2] - c[0]) / 2; }

bool is_sliver_triangle(const TriangleCorners& c, double width) {
  const double longest = std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
  return 2 * area_vector_of(c).norm() <= width * longest;
}

/// An object's own triangles, which share the vertices at one position.
struct ObjectMesh {
  std::vector<std::uint32_t> source;  // index in the scene
  std::vector<Triangle> triangles;    // of the scene's vertices
  std::vector<Vec3> area;             // vectors, square metres
};

/// Triangles of one plane that hang together.
struct Group {
  std::vector<std::uint32_t> members;  // of the ObjectMesh, ascending
  Vec3 normal;                         // of the largest; its turn is not the face's yet
};

using Neighbours = std::vector<std::vector<std::uint32_t>>;
using Edge = std::array<Vec3, 2>;

internal::core::Bounds box_about(const Edge& edge, double margin) {
  internal::core::Bounds bounds{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto along = static_cast<Eigen::Index>(axis);
    const auto [low, high] = std::minmax(edge[0][along], edge[1][along]);
    bounds.min[axis] = std::nextafterf(static_cast<float>(low - margin), -INFINITY);
    bounds.max[axis] = std::nextafterf(static_cast<float>(high + margin), INFINITY);
  }
  return bounds;
}

/// Whether two edges have more than a point in common, to `slack` metres.
bool run_together(const Edge& a, const Edge& b, double slack) {
  const double length = (a[1] - a[0]).norm();
  if (!(length > slack)) return false;
  const Vec3 along = (a[1] - a[0]) / length;
  std::array<double, 2> at{};
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 from_start = b[k] - a[0];
    at[k] = from_start.dot(along);
    if ((from_start - at[k] * along).norm() > slack) return false;
  }
  return std::min(std::max(at[0], at[1]), length) - std::max(std::min(at[0], at[1]), 0.0) > slack;
}

/// Triangles that share an edge, or a part of one: an edge may meet two shorter ones.
Neighbours neighbours_of(const ObjectMesh& object, const std::vector<Vec3>& vertices, double slack) {
  Neighbours neighbours(object.triangles.size());
  std::vector<Edge> edges;
  std::vector<std::vector<std::uint32_t>> triangles;  // of each edge
  // Only the object's own vertices, in their order: the scene may have a thousand times as many.
  std::vector<std::uint32_t> own;
  for (const Triangle& t : object.triangles) own.insert(own.end(), t.begin(), t.end());
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  std::vector<Triangle> renumbered = object.triangles;
  for (Triangle& t : renumbered) {
    for (std::uint32_t& vertex : t) {
      vertex = static_cast<std::uint32_t>(std::lower_bound(own.begin(), own.end(), vertex) - own.begin());
    }
  }
  const auto uses = internal::core::edge_uses(renumbered, own.size());
  internal::core::for_each_edge(std::span(uses), [&](std::span<const internal::core::EdgeUse> edge) {
    edges.push_back({vertices[own[edge[0].low]], vertices[own[edge[0].high]]});
    triangles.emplace_back();
    for (const auto& a : edge) {
      triangles.back().push_back(a.triangle);
      for (const auto& b : edge) {
        if (a.triangle != b.triangle) neighbours[a.triangle].push_back(b.triangle);
      }
    }
  });
  std::vector<internal::core::Bounds> boxes;
  for (const Edge& edge : edges) boxes.push_back(box_about(edge, slack));
  std::vector<std::uint32_t> order;
  const internal::core::Bvh bvh = internal::core::build_bvh(boxes, order);
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    const auto meets = [&](const internal::core::BvhNode& node) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (node.bounds.min[axis] > boxes[i].max[axis] || node.bounds.max[axis] < boxes[i].min[axis]) return false;
      }
      return true;
    };
    internal::core::walk_bvh(bvh, meets, [&](std::uint32_t item) {
      const std::uint32_t other = order[item];
      if (other <= i || !run_together(edges[i], edges[other], slack)) return;
      for (const std::uint32_t a : triangles[i]) {
        for (const std::uint32_t b : triangles[other]) {
          if (a == b) continue;
          neighbours[a].push_back(b);
          neighbours[b].push_back(a);
        }
      }
    });
  }
  return neighbours;
}

/// Starts with the largest triangle, and takes in neighbours while they lie in its plane.
std::vector<Group> groups_of(const ObjectMesh& object, const std::vector<Vec3>& vertices, double slack) {
  const std::size_t count = object.triangles.size();
  const Neighbours neighbours = neighbours_of(object, vertices, slack);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](auto a, auto b) { return object.area[a].squaredNorm() > object.area[b].squaredNorm(); });
  std::vector<char> taken(count, 0);
  std::vector<Group> groups;
  for (const std::uint32_t seed : order) {
    if (taken[seed] || object.area[seed].norm() == 0) continue;
    const Vec3 normal = object.area[seed].normalized(), on = vertices[object.triangles[seed][0]];
    const auto fits = [&](std::uint32_t triangle) {
      TriangleCorners corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = vertices[object.triangles[triangle][k]];
      const bool is_in_plane = std::all_of(corners.begin(), corners.end(), [&](const Vec3& corner) {
        return std::abs(normal.dot(corner - on)) <= kOffPlane;
      });
      if (!is_in_plane || is_sliver_triangle(corners, kNoDirection)) return is_in_plane;
      return std::abs(normal.dot(object.area[triangle].normalized())) >= kSameDirection;
    };
    Group group{{seed}, normal};
    taken[seed] = 1;
    for (std::size_t next = 0; next < group.members.size(); ++next) {
      for (const std::uint32_t triangle : neighbours[group.members[next]]) {
        if (taken[triangle] || !fits(triangle)) continue;
        taken[triangle] = 1;
        group.members.push_back(triangle);
      }
    }
    std::sort(group.members.begin(), group.members.end());
    groups.push_back(std::move(group));
  }
  std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.members < b.members; });
  return groups;
}

bool is_of_kind(const Vec3& normal, FaceKind kind) {
  return kind == FaceKind::roof ? normal.z() > kSteepest : std::abs(normal.z()) <= kSteepest;
}

/// Both turns count: which is outside is found out later.
bool may_be_of_kind(const Vec3& normal, FaceKind kind) { return is_of_kind(normal, kind) || is_of_kind(-normal, kind); }

}  // namespace

struct FaceFinder::Data {
  explicit Data(const Scene& of) : scene(of), index(of), weld(internal::core::first_at_position(of.mesh.vertices)) {
    for (std::uint32_t i = 0; i < weld.size(); ++i) weld[i] = weld[weld[i]];
    for (const Vec3& vertex : of.mesh.vertices) largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
    boxes.resize(std::max<std::size_t>(1, of.objects.size()));
    first.assign(boxes.size() + 1, 0);
    for (std::uint32_t i = 0; i < of.mesh.triangles.size(); ++i) {
      for (const Vec3& corner : index.corners(i)) boxes[index.object_of(i)].extend(corner);
      ++first[index.object_of(i) + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    members.resize(of.mesh.triangles.size());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t i = 0; i < members.size(); ++i) members[next[index.object_of(i)]++] = i;
  }

  ObjectMesh mesh_of(std::uint32_t object) const;
  PlanePieces pieces_of(const ObjectMesh& mesh, const Group& group, FacePlane& plane) const;
  std::vector<Face> faces_of(const ObjectMesh& mesh, std::uint32_t object, const Group& group, FaceKind kind) const;
  std::optional<Vec3> outside_of(const ObjectMesh& mesh, std::uint32_t object, const Group& group) const;
  double slack() const { return std::max(kNothing, kRounding * largest); }

  const Scene& scene;
  TriangleIndex index;
  std::vector<std::uint32_t> weld;
  std::vector<Box> boxes;                     // of the objects
  std::vector<std::uint32_t> first, members;  // of object k: members[first[k]] to members[first[k + 1]]
  double largest = 0;
};

ObjectMesh FaceFinder::Data::mesh_of(std::uint32_t object) const {
  ObjectMesh mesh;
  std::vector<std::pair<Triangle, std::uint32_t>> seen;  // corners sorted, to leave out what is there twice
  for (std::uint32_t member = first[object]; member < first[object + 1]; ++member) {
    const std::uint32_t i = members[member];
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) t[k] = weld[scene.mesh.triangles[i][k]];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::sort(t.begin(), t.end());
    seen.emplace_back(t, i);
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
             seen.end());
  for (const auto& entry : seen) mesh.source.push_back(entry.second);
  std::sort(mesh.source.begin(), mesh.source.end());
  for (const std::uint32_t i : mesh.source) {
    Triangle t = scene.mesh.triangles[i];
    for (std::uint32_t& vertex : t) vertex = weld[vertex];
    mesh.triangles.push_back(t);
    mesh.area.push_back(area_vector_of(index.corners(i)));
  }
  return mesh;
}

/// The normal that points outside; nothing for a wall within the object.
std::optional<Vec3> FaceFinder::Data::outside_of(const ObjectMesh& mesh, std::uint32_t object,
                                                 const Group& group) const {
  constexpr std::size_t kMostProbes = 16;
  constexpr double kStep = 1e-2;  // metres
  double outside = 0, inside = 0, wound = 0, sheet = 0;
  const std::size_t stride = (group.members.size() + kMostProbes - 1) / kMostProbes;
  for (std::size_t i = 0; i < group.members.size(); ++i) {
    const std::uint32_t member = group.members[i];
    const double area = mesh.area[member].norm();
    wound += mesh.area[member].dot(group.normal);
    if (i % stride != 0 || area == 0) continue;
    const TriangleCorners c = index.corners(mesh.source[member]);
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3;
    const double step = std::min(kStep, 0.1 * std::sqrt(area)) + kOffPlane;
    const Side front = index.side_of(middle + step * group.normal, object);
    const Side back = index.side_of(middle - step * group.normal, object);
    if (front != back) {
      (front == Side::outside ? outside : inside) += area;
    } else if (front == Side::outside) {
      sheet += area;
    }
  }
  if (outside + inside > 0) return outside >= inside ? group.normal : Vec3(-group.normal);
  if (sheet > 0) return wound >= 0 ? group.normal : Vec3(-group.normal);
  return std::nullopt;
}

/// The triangles of a group in one plane, merged; sets where the plane is. Corners that rounding alone puts beside it
/// stay as they are, others are laid into it.
PlanePieces FaceFinder::Data::pieces_of(const ObjectMesh& mesh, const Group& group, FacePlane& plane) const {
  std::vector<std::uint32_t> used;
  for (const std::uint32_t member : group.members) {
    used.insert(used.end(), mesh.triangles[member].begin(), mesh.triangles[member].end());
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  double lowest = INFINITY;
  for (const std::uint32_t vertex : used) {
    const double height = plane.normal.dot(scene.mesh.vertices[vertex]);
    plane.at = std::max(plane.at, height);
    lowest = std::min(lowest, height);
  }
  const bool is_planar = plane.at - lowest <= slack();
  std::vector<Vec3> vertices;
  for (const std::uint32_t vertex : used) {
    Vec3 at = scene.mesh.vertices[vertex];
    if (!is_planar) at += (plane.at - plane.normal.dot(at)) * plane.normal;
    vertices.push_back(at);
  }
  std::vector<Triangle> triangles;
  for (const std::uint32_t member : group.members) {
    if (is_sliver_triangle(index.corners(mesh.source[member]), slack())) continue;
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      t[k] = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), mesh.triangles[member][k]) -
                                        used.begin());
    }
    triangles.push_back(t);
  }
  SceneStatistics ignored;
  const auto merged = internal::scene::merge_coplanar(
      vertices, triangles, std::vector<std::uint32_t>(triangles.size(), 0), slack(), ignored);
  PlanePieces pieces;
  for (std::size_t i = 0; i < merged.count(); ++i) {
    std::vector<Vec3>& piece = pieces.emplace_back();
    for (std::uint32_t k = merged.first[i]; k < merged.first[i + 1]; ++k) piece.push_back(vertices[merged.vertices[k]]);
    Vec3 turn = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < piece.size(); ++k) turn += (piece[k] - piece[0]).cross(piece[k + 1] - piece[0]);
    if (turn.dot(plane.normal) < 0) std::reverse(piece.begin(), piece.end());
  }
  return pieces;
}

std::vector<Face> FaceFinder::Data::faces_of(const ObjectMesh& mesh, std::uint32_t object, const Group& group,
                                             FaceKind kind) const {
  if (!may_be_of_kind(group.normal, kind)) return {};
  double area = 0;
  for (const std::uint32_t member : group.members) area += mesh.area[member].norm();
  if (area <= kLeastArea) return {};
  const std::optional<Vec3> normal = outside_of(mesh, object, group);
  if (!normal || !is_of_kind(*normal, kind)) return {};

  FacePlane plane{*normal, -INFINITY, kind == FaceKind::facade, {}};
  for (const std::uint32_t member : group.members) plane.triangles.push_back(mesh.source[member]);
  PlanePieces pieces = pieces_of(mesh, group, plane);
  internal::scene::cut_covered(index, boxes, plane, slack(), pieces);
  internal::scene::join_convex(pieces, *normal, slack());
  std::vector<Face> faces;
  for (const PlanePieces& hanging : internal::scene::connected(pieces, 1e3 * slack())) {
    Face face{object, *normal, 0, internal::scene::usable(hanging)};
    for (const std::vector<Vec3>& part : face.parts) face.area_m2 += internal::scene::area_of(part);
    if (face.area_m2 > kLeastArea) faces.push_back(std::move(face));
  }
  return faces;
}

const char* name_of(FaceKind kind) { return kind == FaceKind::roof ? "roof" : "facade"; }

FaceFinder::FaceFinder(const Scene& scene) {
  const auto refuse = [](ErrorCode code, const char* problem) {
    throw Error(code, problem, "scene made in memory", "give each triangle three vertices and an object");
  };
  if (!scene.object_of.empty() && scene.object_of.size() != scene.mesh.triangles.size()) {
    refuse(ErrorCode::array_sizes_differ, "object_of does not have one entry for each triangle");
  }
  for (const Triangle& t : scene.mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= scene.mesh.vertices.size())
      refuse(ErrorCode::index_out_of_range, "a triangle has a vertex that is not there");
  }
  for (const std::uint32_t object : scene.object_of) {
    if (object >= scene.objects.size())
      refuse(ErrorCode::index_out_of_range, "a triangle is of an object that is not there");
  }
  data_ = std::make_unique<const Data>(scene);
}

FaceFinder::~FaceFinder() = default;
FaceFinder::FaceFinder(FaceFinder&&) noexcept = default;
FaceFinder& FaceFinder::operator=(FaceFinder&&) noexcept = default;

namespace {

void check_objects(const Scene& scene, std::span<const std::uint32_t> objects) {
  for (const std::uint32_t object : objects) {
    if (object < std::max<std::size_t>(1, scene.objects.size())) continue;
    throw Error(ErrorCode::index_out_of_range, "there is no object " + std::to_string(object), "scene",
                "count objects from 0");
  }
}

double distance_to(const Face& face, const Vec3& point) {
  double least = INFINITY;
  for (const std::vector<Vec3>& part : face.parts) {
    least = std::min(least, internal::scene::distance_to(part, face.normal, point));
  }
  return least;
}

}  // namespace

std::vector<Face> FaceFinder::faces(std::span<const std::uint32_t> objects, FaceKind kind) const {
  check_objects(data_->scene, objects);
  std::vector<std::vector<Face>> found(objects.size());
  internal::parallel::for_ranges(objects.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ObjectMesh mesh = data_->mesh_of(objects[i]);
      for (const Group& group : groups_of(mesh, data_->scene.mesh.vertices, 1e3 * data_->slack())) {
        std::vector<Face> faces = data_->faces_of(mesh, objects[i], group, kind);
        std::move(faces.begin(), faces.end(), std::back_inserter(found[i]));
      }
    }
  });
  std::vector<Face> result;
  for (std::vector<Face>& faces : found) std::move(faces.begin(), faces.end(), std::back_inserter(result));
  return result;
}

std::optional<Face> FaceFinder::nearest(std::span<const std::uint32_t> objects, FaceKind kind,
                                        const Vec3& point) const {
  check_objects(data_->scene, objects);
  if (!point.allFinite())
    throw Error(ErrorCode::coordinate_not_finite, "the point is not finite", "scene", "give three numbers");
  std::optional<Face> best;
  double least = INFINITY;
  for (const std::uint32_t object : objects) {
    const ObjectMesh mesh = data_->mesh_of(object);
    const std::vector<Group> groups = groups_of(mesh, data_->scene.mesh.vertices, 1e3 * data_->slack());
    // No part of a face is nearer than its triangles, but for what it was raised.
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      double nearest = INFINITY;
      for (const std::uint32_t member : groups[i].members) {
        const TriangleCorners c = data_->index.corners(mesh.source[member]);
        const Vec3 normal = area_vector_of(c).normalized();
        if (normal.allFinite()) {
          nearest = std::min(nearest, internal::scene::distance_to({c[0], c[1], c[2]}, normal, point));
        }
      }
      order.emplace_back(nearest, i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [bound, i] : order) {
      if (bound - 2 * kOffPlane > least) break;
      for (Face& face : data_->faces_of(mesh, object, groups[i], kind)) {
        const double distance = distance_to(face, point);
        if (distance >= least) continue;
        least = distance;
        best = std::move(face);
      }
    }
  }
  return best;
}

std::vector<Face> facing(const std::vector<Face>& faces, double heading_deg) {
  constexpr double kLevel = 1e-3;  // of the normal: no direction in plan
  constexpr double kWithin = 45 * std::numbers::pi / 180;
  const double heading = heading_deg * std::numbers::pi / 180;
  const Eigen::Vector2d wanted(portable::sin(heading), portable::cos(heading));
  std::vector<Face> result;
  for (const Face& face : faces) {
    const Eigen::Vector2d plan = face.normal.head<2>();
    if (plan.norm() <= kLevel) continue;
    if (plan.normalized().dot(wanted) >= portable::cos(kWithin) - 1e-9) result.push_back(face);
  }
  return result;
}

Target target_of(std::span<const Face> faces, std::string name) {
  Target target;
  target.name = std::move(name);
  target.parts.clear();
  Vec3 sum = Vec3::Zero();
  bool is_found_by_default = true;
  for (const Face& face : faces) {
    sum += face.normal;
    is_found_by_default = is_found_by_default && face.normal.z() >= -kUpright;
    target.parts.insert(target.parts.end(), face.parts.begin(), face.parts.end());
  }
  if (target.parts.empty()) {
    throw Error(ErrorCode::nothing_given, "a target is made of one face or more", "target \"" + target.name + "\"",
                "give at least one");
  }
  if (is_found_by_default) return target;
  constexpr double kAlong = 0.1;
  const bool has_one_front = sum.norm() > 0 && std::all_of(faces.begin(), faces.end(), [&](const Face& face) {
                               return face.normal.dot(sum.normalized()) > kAlong;
                             });
  if (has_one_front) {
    target.front = sum.normalized();
  } else {
    target.front_by_order = true;
  }
  return target;
}

}  // namespace vantage
