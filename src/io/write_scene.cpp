// Checks a scene, chooses the writer by the file's extension; the writers for OBJ and PLY.
#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "common/output.h"
#include "core/volume_check.h"
#include "io/axes_text.h"
#include "io/georeference_text.h"
#include "io/object_text.h"
#include "io/output_formats.h"
#include "io/scene_writers.h"
#include "io/sidecar.h"
#include "io/writers.h"
#include "vantage/error.h"
#include "vantage/version.h"

namespace vantage::internal::io {
namespace {

void check_scene(const Scene& scene) {
  constexpr const char* kFix = "give a scene as read, or mend what was changed in it";
  if (scene.mesh.triangles.empty()) throw Error(ErrorCode::mesh_empty, "the scene holds no triangles", "", kFix);
  core::check_labelled(scene.mesh, {scene.object_of, scene.objects.size(), "scene", "object", kFix});
}

/// Numbers the vertices that triangles use, in the order of their first use: no vertex is kept that none uses.
class UsedVertices {
 public:
  explicit UsedVertices(const Mesh& mesh) : number_(mesh.vertices.size(), kNone) {}

  /// The vertex's number; `is_new` tells whether this is its first use.
  std::uint32_t number(std::uint32_t vertex, bool& is_new) {
    is_new = number_[vertex] == kNone;
    if (is_new) number_[vertex] = count_++;
    return number_[vertex];
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> number_;
  std::uint32_t count_ = 0;
};

}  // namespace

ObjectTriangles::ObjectTriangles(const Scene& scene)
    : first_(scene.objects.size() + 1, 0), triangles_(scene.object_of.size()) {
  for (const std::uint32_t object : scene.object_of) ++first_[object + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) triangles_[next[scene.object_of[t]]++] = t;
}

std::string object_name(const Scene& scene, std::size_t object) {
  std::string name = display_name(scene.objects[object]);
  const bool is_blank = name.find_first_not_of(' ') == std::string::npos;
  return is_blank ? std::string("object ").append(std::to_string(object)) : name;
}

/// Each object's vertices come before its faces, where they are not another's already.
double write_scene_obj(const Scene& scene, AtomicFile& file) {
  const std::vector<Vec3>& vertices = scene.mesh.vertices;
  const std::vector<Triangle>& triangles = scene.mesh.triangles;
  file.write("# vantage " VANTAGE_VERSION " scene\n# " + io::axes_text({}) + "\n");
  file.write(place_comment(scene.georeference, "# "));
  file.write(ledger_comments(scene, FileObjects::apart, "# "));
  UsedVertices used(scene.mesh);
  std::string vertex_lines, face_lines;
  ObjectTriangles(scene).for_each([&](std::size_t object, const std::uint32_t* first, const std::uint32_t* end) {
    vertex_lines.assign("o ").append(object_name(scene, object)).append("\n");
    if (says_more_than_name(scene.objects[object])) {
      vertex_lines.append("# ").append(object_comment(scene.objects[object])).append("\n");
    }
    face_lines.clear();
    for (; first != end; ++first) {
      face_lines += 'f';
      for (const std::uint32_t vertex : triangles[*first]) {
        bool is_new = false;
        face_lines.append(" ").append(std::to_string(std::uint64_t{used.number(vertex, is_new)} + 1));
        if (!is_new) continue;
        vertex_lines += 'v';
        for (const double coordinate : vertices[vertex]) append_exact(vertex_lines += ' ', coordinate);
        vertex_lines += '\n';
      }
      face_lines += '\n';
    }
    file.write(vertex_lines);
    file.write(face_lines);
  });
  return 0;
}

double write_scene_ply(const Scene& scene, AtomicFile& file) {
  const auto& [vertices, triangles] = scene.mesh;
  UsedVertices used(scene.mesh);
  std::string vertex_rows, face_rows;
  std::size_t count = 0;
  face_rows.reserve(triangles.size() * 17);
  vertex_rows.reserve(vertices.size() * 24);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    append_little_endian(face_rows, std::uint8_t{3});
    for (const std::uint32_t vertex : triangles[t]) {
      bool is_new = false;
      append_little_endian(face_rows, used.number(vertex, is_new));
      if (!is_new) continue;
      ++count;
      for (const double coordinate : vertices[vertex]) append_little_endian(vertex_rows, coordinate);
    }
    append_little_endian(face_rows, scene.object_of[t]);
  }
  check_count(count, std::numeric_limits<std::int32_t>::max(), "vertices", "PLY");

  file.write("ply\nformat binary_little_endian 1.0\n");
  file.write("comment vantage " VANTAGE_VERSION " scene\ncomment vantage frame: scene, metres, z up\n");
  file.write(place_comment(scene.georeference, "comment "));
  file.write(ledger_comments(scene, FileObjects::one, "comment "));
  file.write("element vertex " + std::to_string(count) + "\n");
  file.write("property double x\nproperty double y\nproperty double z\n");
  file.write("element face " + std::to_string(triangles.size()) + "\n");
  file.write("property list uchar int vertex_indices\nproperty uint object\nend_header\n");
  file.write(vertex_rows);
  file.write(face_rows);
  return 0;
}

double write_scene_stl(const Scene& scene, AtomicFile& file) {
  write_stl_mesh(scene.mesh, "scene", file);
  double moved = 0;
  for (const Triangle& triangle : scene.mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      const Vec3& exact = scene.mesh.vertices[vertex];
      moved = std::max(moved, (exact.cast<float>().cast<double>() - exact).norm());
    }
  }
  return moved;
}

}  // namespace vantage::internal::io

namespace vantage {

StagedScene stage_scene(const Scene& scene, const std::filesystem::path& file) {
  using namespace internal::io;
  check_scene(scene);
  StagedScene staged;
  staged.files.push_back(std::make_unique<AtomicFile>(file));
  const OutputFormat& format = scene_format(file);
  staged.rounding_m = format.write_scene(scene, *staged.files.back());
  if (format.has_sidecar) {
    stage_sidecar({scene.georeference, std::nullopt, {}, ledger_texts(scene, FileObjects::one)}, file, staged.files);
  }
  return staged;
}

double write_scene(const Scene& scene, const std::filesystem::path& file) {
  StagedScene staged = stage_scene(scene, file);
  commit_all(staged.files);
  return staged.rounding_m;
}

}  // namespace vantage
