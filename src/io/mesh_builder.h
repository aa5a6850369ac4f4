// Collects what the readers find in a file: vertices, faces of any number of corners, objects.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/mesh_file.h"
#include "io/mesh_source.h"
#include "vantage/error.h"
#include "vantage/export.h"

namespace vantage::internal::io {

/// Room for more values: it grows as a vector does, but asks `progress` while millions move.
template <class T>
void make_room(std::vector<T>& values, std::size_t more, const core::ProgressReporter& progress) {
  if (more <= values.capacity() - values.size()) return;
  std::vector<T> grown;
  grown.reserve(std::max(2 * values.capacity(), values.size() + more));
  for (const T& value : values) {
    progress.tick();
    grown.push_back(value);
  }
  values = std::move(grown);
}

/// Makes a RawMesh. Places are lines or bytes of the file, for messages.
class MeshBuilder {
 public:
  enum class PlaceUnit { line, byte };

  /// `first_index` is the number that the file format gives to the first vertex.
  MeshBuilder(const MeshSource& source, MeshFormat format, PlaceUnit unit, const core::ReadLimits& limits,
              std::uint32_t first_index = 0)
      : source_(source), unit_(unit), limits_(limits), first_index_(first_index) {
    mesh_.format = format;
  }

  /// Room for what a file announces. The caller has checked the numbers against the file's size.
  void reserve(std::size_t vertices, std::size_t triangles) {
    mesh_.vertices.reserve(vertices);
    mesh_.triangles.reserve(triangles);
    mesh_.object_of.reserve(triangles);
  }

  /// Room for what comes next, where a small file repeats much.
  void make_room(std::size_t vertices, std::size_t triangles, const core::ProgressReporter& progress) {
    io::make_room(mesh_.vertices, vertices, progress);
    io::make_room(mesh_.triangles, triangles, progress);
    io::make_room(mesh_.object_of, triangles, progress);
  }

  const Vec3& vertex(std::uint32_t index) const { return mesh_.vertices[index]; }
  std::size_t vertex_count() const { return mesh_.vertices.size(); }
  const Triangle& triangle(std::size_t index) const { return mesh_.triangles[index]; }
  std::size_t triangle_count() const { return mesh_.triangles.size(); }

  /// Throws for a coordinate that is not finite. Returns the vertex's index.
  std::uint32_t add_vertex(const Vec3& vertex, std::uint64_t place) {
    if (!vertex.allFinite()) fail_not_finite(vertex, place);
    if (mesh_.vertices.size() >= kMaxVertices) fail_too_many(place);
    mesh_.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  /// Starts an object; the faces that follow are its own. An empty name becomes "object N" in the end.
  std::uint32_t add_object(std::string_view name);
  /// Goes back to an object.
  void set_object(std::uint32_t object) { object_ = object; }
  void rename_object(std::uint32_t object, std::string_view name);
  /// Where the file says more than a name.
  void identify_object(std::uint32_t object, const SceneObject& identity);

  // A face: begin_face, add_corner for each corner, end_face. A polygon counts as flat where its corners lie within 1
  // cm and a thousandth of its width of a plane, or within what single precision can tell there. A quadrilateral that
  // is not becomes the four triangles of both its diagonals: whatever it means lies between them, and a note counts
  // them. Others become triangles, and an entry of the ledger for each object. Corners count from 0 and may be vertices
  // that come later in the file.
  void begin_face(std::uint64_t place) {
    place_ = place;
    corners_.clear();
  }
  void add_corner(std::uint64_t vertex) {
    if (vertex >= kMaxVertices) fail_out_of_range(vertex, place_);
    corners_.push_back(static_cast<std::uint32_t>(vertex));
    highest_ = std::max(highest_, corners_.back());
  }
  std::size_t corner_count() const { return corners_.size(); }
  void end_face();

  /// A triangle of vertices that have been added.
  void add_triangle(const Triangle& triangle) {
    if (object_ == kNone) add_object("");
    mesh_.triangles.push_back(triangle);
    mesh_.object_of.push_back(object_);
  }

  /// The mesh. Where `joined` is not empty, object i becomes part of the object joined[i]. Throws for indices out of
  /// range and when there is no triangle.
  RawMesh finish(const std::vector<std::uint32_t>& joined = {});

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint64_t kMaxVertices = kNone;

  /// A face with corners that were not there yet.
  struct LateFace {
    std::size_t begin, end;  // in late_corners_
    std::uint64_t place;
    std::uint32_t object;
  };

  /// Polygons of an object that are not flat and were cut into triangles in one of several ways.
  struct Uneven {
    Box box;
    double farthest = 0;  // of a corner from its polygon's plane
    std::size_t faces = 0;
  };

  void add_face();
  void add_late_faces();
  double off_plane() const;
  std::vector<std::uint32_t> keep_used_objects();
  void tell_uneven(const std::vector<std::uint32_t>& new_index);
  [[noreturn]] void fail(ErrorCode code, std::uint64_t place, std::string problem, std::string fix) const;
  [[noreturn]] void fail_not_finite(const Vec3& vertex, std::uint64_t place) const;
  [[noreturn]] void fail_too_many(std::uint64_t place) const;
  [[noreturn]] void fail_out_of_range(std::uint64_t vertex, std::uint64_t place) const;

  const MeshSource& source_;
  PlaceUnit unit_;
  const core::ReadLimits& limits_;
  std::uint32_t first_index_;
  RawMesh mesh_;
  std::uint32_t object_ = kNone;

  std::uint64_t place_ = 0;
  std::vector<std::uint32_t> corners_;
  std::uint32_t highest_ = 0;  // of the face's corners
  std::vector<LateFace> late_faces_;
  std::vector<std::uint32_t> late_corners_;
  std::vector<Vec3> polygon_;
  std::map<std::uint32_t, Uneven> uneven_;  // by object
  std::size_t doubled_ = 0;                 // quadrilaterals with both diagonals
  std::vector<Triangle> ears_;
};

/// A name for reports and files: printable(), without blanks at its ends.
std::string clean_name(std::string_view name);

}  // namespace vantage::internal::io
