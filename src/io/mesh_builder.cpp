#include "io/mesh_builder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/input.h"
#include "core/format.h"
#include "core/text.h"
#include "io/object_text.h"
#include "io/triangulate_polygon.h"

namespace vantage::internal::io {

std::string clean_name(std::string_view name) {
  const std::string clean = printable(name);
  const std::size_t first = clean.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return clean.substr(first, clean.find_last_not_of(' ') - first + 1);
}

std::uint32_t MeshBuilder::add_object(std::string_view name) {
  object_ = static_cast<std::uint32_t>(mesh_.objects.size());
  mesh_.objects.push_back(object_named(clean_name(name)));
  return object_;
}

void MeshBuilder::rename_object(std::uint32_t object, std::string_view name) {
  mesh_.objects[object] = object_named(clean_name(name));
}

void MeshBuilder::identify_object(std::uint32_t object, const SceneObject& identity) {
  mesh_.objects[object] = {clean_name(identity.name), clean_name(identity.source_id), identity.kind};
}

void MeshBuilder::end_face() {
  if (object_ == kNone) add_object("");
  if (corners_.size() < 3) {
    ++mesh_.dropped_faces;
  } else if (corners_.size() > limits_.corners) {
    fail(ErrorCode::mesh_too_large, place_,
         "a face has " + std::to_string(corners_.size()) + " corners; at most " + std::to_string(limits_.corners) +
             " can be read",
         "triangulate the mesh on export");
  } else if (highest_ < mesh_.vertices.size()) {
    add_face();
  } else {
    late_faces_.push_back({late_corners_.size(), late_corners_.size() + corners_.size(), place_, object_});
    late_corners_.insert(late_corners_.end(), corners_.begin(), corners_.end());
  }
  highest_ = 0;
}

void MeshBuilder::add_face() {
  if (corners_.size() == 3) {
    add_triangle({corners_[0], corners_[1], corners_[2]});
    return;
  }
  polygon_.clear();
  for (const std::uint32_t corner : corners_) polygon_.push_back(mesh_.vertices[corner]);
  ears_.clear();
  const double farthest = off_plane();
  if (farthest > 0 && corners_.size() == 4 && limits_.both_diagonals) {
    add_triangle({corners_[0], corners_[1], corners_[2]});
    add_triangle({corners_[0], corners_[2], corners_[3]});
    add_triangle({corners_[0], corners_[1], corners_[3]});
    add_triangle({corners_[1], corners_[2], corners_[3]});
    ++doubled_;
    return;
  }
  if (farthest > 0) {
    Uneven& uneven = uneven_[object_];
    for (const Vec3& corner : polygon_) uneven.box.extend(corner);
    uneven.farthest = std::max(uneven.farthest, farthest);
    ++uneven.faces;
  }
  triangulate_polygon(polygon_, ears_);
  for (const Triangle& ear : ears_) add_triangle({corners_[ear[0]], corners_[ear[1]], corners_[ear[2]]});
}

/// How far a corner of polygon_ lies off its plane at most; 0 where it is flat.
double MeshBuilder::off_plane() const {
  constexpr double kFlatM = 0.01;  // what val3dity (H. Ledoux, 2018) allows by default for a surface to count as flat
  constexpr double kShare = 1e-3, kSingle = 0x1p-22;
  const Vec3& origin = polygon_[0];
  const auto farthest_from = [&](const auto& distance) {
    return *std::max_element(polygon_.begin(), polygon_.end(),
                             [&](const Vec3& a, const Vec3& b) { return distance(a) < distance(b); });
  };
  Vec3 normal = Vec3::Zero(), middle = Vec3::Zero();
  Box box;
  double largest = 0;
  for (std::size_t i = 0; i < polygon_.size(); ++i) {
    const Vec3 a = polygon_[i] - origin, b = polygon_[(i + 1) % polygon_.size()] - origin;
    normal += a.cross(b);
    middle += a / static_cast<double>(polygon_.size());
    box.extend(a);
    largest = std::max(largest, polygon_[i].cwiseAbs().maxCoeff());
  }
  if (!(normal.norm() > 0)) {  // its halves cancel out: the plane of what lies farthest out
    const Vec3 along = farthest_from([&](const Vec3& p) { return (p - origin).norm(); }) - origin;
    normal = along.cross(farthest_from([&](const Vec3& p) { return along.cross(p - origin).norm(); }) - origin);
    if (!(normal.norm() > 0)) return 0;
  }
  normal.normalize();
  double farthest = 0;
  for (const Vec3& corner : polygon_) farthest = std::max(farthest, std::abs(normal.dot(corner - origin - middle)));
  const double allowed = std::min(kFlatM / limits_.unit_m, kShare * (box.max - box.min).norm());
  return farthest > std::max(allowed, kSingle * largest) ? farthest : 0;
}

void MeshBuilder::add_late_faces() {
  for (const LateFace& face : late_faces_) {
    corners_.assign(late_corners_.begin() + static_cast<std::ptrdiff_t>(face.begin),
                    late_corners_.begin() + static_cast<std::ptrdiff_t>(face.end));
    for (const std::uint32_t corner : corners_) {
      if (corner >= mesh_.vertices.size()) fail_out_of_range(corner, face.place);
    }
    object_ = face.object;
    add_face();
  }
}

/// Returns what has become of their numbers.
std::vector<std::uint32_t> MeshBuilder::keep_used_objects() {
  std::vector<std::uint32_t> new_index(mesh_.objects.size(), kNone);
  for (const std::uint32_t object : mesh_.object_of) new_index[object] = 0;
  std::vector<SceneObject> used;
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] == kNone) continue;
    new_index[i] = static_cast<std::uint32_t>(used.size());
    const std::string number = std::to_string(used.size());
    used.push_back(std::move(mesh_.objects[i]));
    if (display_name(used.back()).empty()) used.back().name = "object " + number;
  }
  mesh_.objects = std::move(used);
  for (std::uint32_t& object : mesh_.object_of) object = new_index[object];
  return new_index;
}

void MeshBuilder::tell_uneven(const std::vector<std::uint32_t>& new_index) {
  for (const auto& [object, uneven] : uneven_) {
    LedgerEntry entry;
    entry.object = mesh_.objects[new_index[object]];
    entry.what = core::count_text(uneven.faces, "face that is not flat", "faces that are not flat");
    entry.reason = core::format("a corner lies {:.3g} m off the plane: cut into triangles, which may be so much off",
                                uneven.farthest * limits_.unit_m);
    entry.box = uneven.box;
    mesh_.ledger.push_back({std::move(entry), {}});
  }
}

RawMesh MeshBuilder::finish(const std::vector<std::uint32_t>& joined) {
  add_late_faces();
  if (!joined.empty()) {
    for (std::uint32_t& object : mesh_.object_of) object = joined[object];
    std::map<std::uint32_t, Uneven> uneven;
    for (const auto& [object, part] : std::exchange(uneven_, {})) {
      Uneven& whole = uneven[joined[object]];
      whole.box.extend(part.box);
      whole.farthest = std::max(whole.farthest, part.farthest);
      whole.faces += part.faces;
    }
    uneven_ = std::move(uneven);
  }
  if (mesh_.triangles.empty()) {
    source_.fail(ErrorCode::mesh_empty,
                 "the file holds no triangles (" + std::to_string(mesh_.vertices.size()) + " vertices, " +
                     std::to_string(mesh_.dropped_faces) + " faces with fewer than 3 corners)",
                 "export a surface mesh with faces");
  }
  tell_uneven(keep_used_objects());
  if (doubled_ > 0) {
    mesh_.notes.push_back(core::count_text(doubled_, "quadrilateral is not flat: it has become",
                                           "quadrilaterals are not flat: each has become") +
                          " the triangles of both its diagonals");
  }
  return std::move(mesh_);
}

void MeshBuilder::fail(ErrorCode code, std::uint64_t place, std::string problem, std::string fix) const {
  if (unit_ == PlaceUnit::line) source_.fail_at_line(code, place, std::move(problem), std::move(fix));
  source_.fail_at_byte(code, place, std::move(problem), std::move(fix));
}

void MeshBuilder::fail_not_finite(const Vec3& vertex, std::uint64_t place) const {
  const int axis = std::isfinite(vertex.x()) ? (std::isfinite(vertex.y()) ? 2 : 1) : 0;
  fail(ErrorCode::coordinate_not_finite, place,
       std::string("the ") + "xyz"[axis] + " coordinate of vertex " +
           std::to_string(mesh_.vertices.size() + first_index_) + " is not finite",
       "correct the coordinate or remove the vertex and its faces");
}

void MeshBuilder::fail_too_many(std::uint64_t place) const {
  fail(ErrorCode::mesh_too_large, place, "the mesh has more than " + std::to_string(kMaxVertices) + " vertices",
       "cut the mesh to the part that is needed");
}

void MeshBuilder::fail_out_of_range(std::uint64_t vertex, std::uint64_t place) const {
  // `vertex` may be the highest 64-bit number: the sum wraps where the file's own number did.
  const std::uint64_t number = vertex + first_index_;
  fail(ErrorCode::mesh_syntax, place,
       "a face refers to vertex " + std::to_string(number) + ", but the file has only " +
           std::to_string(mesh_.vertices.size()) + (first_index_ == 0 ? " (counted from 0)" : ""),
       "export the mesh again; it is cut off or garbled");
}

}  // namespace vantage::internal::io
