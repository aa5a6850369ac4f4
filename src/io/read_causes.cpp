#include "io/read_causes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/progress_reporter.h"
#include "io/mesh_source.h"
#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

constexpr std::string_view kFaces = "property list uchar int vertex_indices\nproperty uint cause\nend_header\n";
constexpr std::size_t kFaceBytes = 1 + 3 * 4 + 4;

std::optional<CauseKind> kind_named(std::string_view name) {
  for (const CauseKind kind :
       {CauseKind::scene, CauseKind::range, CauseKind::target_plane, CauseKind::navigation, CauseKind::sensor}) {
    if (name == name_of(kind)) return kind;
  }
  return std::nullopt;
}

/// The cause that a comment states: "comment vantage cause 3 scene Building 17".
std::optional<Cause> cause_in(std::string_view line, std::size_t index) {
  const std::string begin = "comment vantage cause " + std::to_string(index) + " ";
  if (line.substr(0, begin.size()) != begin) return std::nullopt;
  line.remove_prefix(begin.size());
  const std::size_t space = line.find(' ');
  const std::optional<CauseKind> kind = kind_named(line.substr(0, space));
  if (!kind) return std::nullopt;
  Cause cause;
  cause.kind = *kind;
  if (space != std::string_view::npos) cause.name = line.substr(space + 1);
  return cause;
}

std::vector<Cause> causes_in(std::string_view header) {
  std::vector<Cause> causes;
  for (std::size_t at = 0; at < header.size();) {
    const std::size_t end = std::min(header.find('\n', at), header.size());
    if (const auto cause = cause_in(header.substr(at, end - at), causes.size())) causes.push_back(*cause);
    at = end + 1;
  }
  return causes;
}

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  return value;
}

double area(const Mesh& mesh, const Triangle& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return 0.5 * (b - a).cross(c - a).norm();
}

}  // namespace

std::optional<VolumeStatement> read_causes(const std::filesystem::path& file, Volume& volume) {
  volume.cause_of.clear();
  volume.causes.clear();
  const Progress nobody;
  core::ProgressReporter progress(nobody, file.string());
  const io::MeshSource source = io::load_mesh_source(file, progress);
  std::optional<VolumeStatement> statement = read_statement(source, progress);
  const std::string_view bytes = source.bytes();
  if (bytes.substr(0, 36) != "ply\nformat binary_little_endian 1.0\n") return statement;
  const std::size_t place = bytes.find(kFaces);
  const std::size_t faces = volume.mesh.triangles.size(), size = faces * kFaceBytes;
  if (place == std::string_view::npos || bytes.size() < place + kFaces.size() + size) return statement;

  std::vector<Cause> causes = causes_in(bytes.substr(0, place));
  if (causes.empty()) return statement;
  const std::string_view rows = bytes.substr(bytes.size() - size);
  std::vector<std::uint32_t> cause_of(faces);
  for (std::size_t t = 0; t < faces; ++t) {
    cause_of[t] = little_endian(rows.substr(t * kFaceBytes + 13, 4));
    if (cause_of[t] >= causes.size()) {
      throw Error(ErrorCode::record_garbled,
                  "facet " + std::to_string(t) + " has cause " + std::to_string(cause_of[t]) + ", but the file names " +
                      std::to_string(causes.size()),
                  file.string(), "write the volume again with \"vantage compute\"");
    }
    causes[cause_of[t]].area_m2 += area(volume.mesh, volume.mesh.triangles[t]);
  }
  volume.cause_of = std::move(cause_of);
  volume.causes = std::move(causes);
  return statement;
}

}  // namespace vantage::internal::io
