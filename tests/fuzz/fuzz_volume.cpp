// libFuzzer target: any bytes as the file of a volume, with what it states of itself: comments of a PLY or OBJ, the
// extras of a GLB, and for an STL what lies beside it. The first byte is the format; of an STL the next two are the
// length of the file beside it, which comes first. It may be refused with an input error; what is read must be sound.
#include <algorithm>
#include <cmath>
#include <string>

#include "fuzz/bytes.h"
#include "fuzz/files.h"
#include "vantage/result.h"

namespace vantage::fuzzing {
namespace {

void check(const VolumeFile& read) {
  const Volume& volume = read.volume;
  for (const Vec3& vertex : volume.mesh.vertices) require(vertex.allFinite(), "coordinates are finite");
  for (const Triangle& triangle : volume.mesh.triangles) {
    for (const std::uint32_t corner : triangle) require(corner < volume.mesh.vertices.size(), "corners are in range");
  }
  require(volume.cause_of.empty() || volume.cause_of.size() == volume.mesh.triangles.size(), "facets have causes");
  for (const std::uint32_t cause : volume.cause_of) require(cause < volume.causes.size(), "causes are in range");
  require(std::isfinite(read.rounding_m) && read.rounding_m >= 0, "a rounding is a length");
  require(std::isfinite(volume.tolerance_m) && volume.tolerance_m >= 0, "a tolerance is a length");
  for (const double lift : volume.lift_m) require(std::isfinite(lift) && lift >= 0, "a lift is a length");
  for (const Warning& note : read.notes) require(note.text.find('\n') == std::string::npos, "a note is one line");
}

constexpr const char* kNames[] = {"volume.ply", "volume.obj", "volume.glb", "volume.stl", "volume.gltf"};

/// With and without a frame that a mesh about another origin is moved to.
void read(const std::filesystem::path& file, bool has_frame) {
  try {
    check(read_volume(file, SceneReadOptions{},
                      has_frame ? std::optional(Georeference{48, 11, "", ""}) : std::optional<Georeference>()));
  } catch (const Error& error) {
    check_refusal(error);
  }
}

}  // namespace
}  // namespace vantage::fuzzing

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage::fuzzing;
  if (size == 0) return 0;
  const std::string name = kNames[data[0] % 5];
  std::string_view bytes = text_of(data + 1, size - 1);
  const auto sidecar = folder().path() / (name + ".place.json");
  std::error_code ignored;
  std::filesystem::remove(sidecar, ignored);
  if (name.ends_with(".stl") && bytes.size() >= 2) {
    const std::size_t length = static_cast<unsigned char>(bytes[0]) + 256U * static_cast<unsigned char>(bytes[1]);
    bytes.remove_prefix(2);
    folder().write(name + ".place.json", bytes.substr(0, length));
    bytes.remove_prefix(std::min(bytes.size(), length));
  }
  const auto file = folder().write(name, bytes);
  read(file, false);
  read(file, true);
  return 0;
}
